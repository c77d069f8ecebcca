// Where a piece of yarn turns much within little of itself, and where its fibers are cut then: at a hairpin what stands
// out swings around half a circle in a hundredth of a piece. Twin: src/yarn/turning.rs.
#ifndef WORSTED_TURNING
#define WORSTED_TURNING

#include "../lib/angle.glsl"
#include "../lib/curve.glsl"
#include "level.glsl"

// The two places of a piece at which it turns fastest. A cubic in a plane turns by atan((t - place) / width), of both.
struct Turning {
    vec2 places;  // may lie outside of the piece
    vec2 widths;
    float swift;  // 0 where the piece turns evenly enough to be cut evenly, 1 where cuts must follow its turns
};

// How a fiber is cut over a piece of yarn.
struct Cut {
    uint pieces;
    float share;  // of the cuts that goes to turns
};

// Radians per piece from which on cuts follow turns, and from which on wholly: a quarter turn in an eighth and in a
// sixteenth of the piece. Cloth as it is knitted stays below.
const float SWIFT_TURN = 4.0 * PI;
const float SWIFTEST_TURN = 8.0 * PI;
// Most of the cuts that turns get.
const float MOST_TURNED = 0.75;
// Width of a turn that is none, and the least one: at a cusp it would be 0.
const float WIDEST_TURN = 1e3;
const float NARROWEST_TURN = 1e-4;
// Steps toward the place where the piece is slowest; each squares what is missing where that is a sharp turn.
const int SPOT_STEPS = 6;
// Halvings of a piece after which a cut is found.
const int BREAK_STEPS = 24;
// Cuts that a table holds, between which others lie evenly.
const uint TABLED_BREAKS = 16u;

// Place and width of the turn that is found from t: where the curve's derivative, taken as linear, is least.
vec2 turn_spot(vec3 b[4], float t) {
    vec3 q;
    vec3 a;
    float along = 0.0;
    for (int k = 0; k <= SPOT_STEPS; ++k) {
        t = clamp(t - along, 0.0, 1.0);
        CurvePoint c = bezier_point(b, t);
        q = c.derivative;
        a = c.second_derivative;
        if (dot(a, a) * WIDEST_TURN * WIDEST_TURN <= dot(q, q)) {
            return vec2(t, WIDEST_TURN);
        }
        along = dot(q, a) / dot(a, a);
    }
    return vec2(t - along, clamp(length(cross(q, a)) / dot(a, a), NARROWEST_TURN, WIDEST_TURN));
}

// How the Bezier piece `b` turns.
Turning turning_of(vec3 b[4]) {
    vec2 first = turn_spot(b, 0.0);
    vec2 second = turn_spot(b, 1.0);
    Turning turning;
    turning.places = vec2(first.x, second.x);
    turning.widths = vec2(first.y, second.y);
    vec2 beyond = max(max(-turning.places, turning.places - 1.0), 0.0);
    vec2 rates = turning.widths / (turning.widths * turning.widths + beyond * beyond);
    turning.swift = smoothstep(SWIFT_TURN, SWIFTEST_TURN, max(rates.x, rates.y));
    return turning;
}

// Angle that the piece has turned by at t, but for a constant.
float turned_angle(Turning turning, float t) {
    vec2 from = t - turning.places;
    return angle_of(from.x, turning.widths.x) + angle_of(from.y, turning.widths.y);
}

// Share of the cuts that lies before t, where `turned_share` of them goes to turns.
float share_before(Turning turning, float turned_share, float t) {
    float start = turned_angle(turning, 0.0);
    float whole = turned_angle(turning, 1.0) - start;
    float turned = (turned_angle(turning, t) - start) / max(whole, 1e-6);
    return mix(t, turned, turned_share);
}

// Where the cut lies before which a share of all of them does.
float break_at(Turning turning, float turned_share, float share) {
    float low = 0.0;
    float high = 1.0;
    for (int k = 0; k < BREAK_STEPS; ++k) {
        float middle = 0.5 * (low + high);
        bool beyond = share_before(turning, turned_share, middle) > share;
        low = beyond ? low : middle;
        high = beyond ? middle : high;
    }
    return 0.5 * (low + high);
}

// The same from a table of those of 1, 2, ... of TABLED_BREAKS equal shares. Exactly 0 and 1 at the ends.
float tabled_break(vec4 breaks[TABLED_BREAKS / 4u], float share) {
    float place = clamp(share, 0.0, 1.0) * float(TABLED_BREAKS);
    uint next = min(uint(place), TABLED_BREAKS - 1u);
    uint last = max(next, 1u) - 1u;
    float low = next == 0u ? 0.0 : breaks[last / 4u][last % 4u];
    return mix(low, breaks[next / 4u][next % 4u], place - float(next));
}

// How a fiber is cut over the Bezier piece `b` where `even` pieces would do if it turned evenly, and `calm` if it did not
// turn: enough in its turns for what swings around them at `reach` to depart by no more than `tolerance`, and as many as
// they would be in between.
Cut uneven_cut(Turning turning, vec3 b[4], uint even, uint calm, float reach, float tolerance, uint largest) {
    if (turning.swift <= 0.0) {
        return Cut(even, 0.0);
    }
    float bend = turning_angle(b[1] - b[0], b[2] - b[1]) + turning_angle(b[2] - b[1], b[3] - b[2]);
    float turned = max(bend * sqrt(reach / (8.0 * max(tolerance, 1e-12))), 1e-3);
    float share = min(turned / (turned + float(calm)), MOST_TURNED);
    float pieces = mix(float(even), max(turned / share, float(calm) / (1.0 - share)), turning.swift);
    return Cut(uint(clamp(ceil(pieces), 1.0, float(largest))), turning.swift * share);
}

#endif
