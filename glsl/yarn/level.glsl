// How finely a piece of yarn is cut, and whether it is in view; twin: src/yarn/level.rs.
#ifndef WORSTED_LEVEL
#define WORSTED_LEVEL

#include "../shared/constants.glsl"
#include "../lib/angle.glsl"
#include "../lib/frame.glsl"

// Angle between two directions that may be zero-length: 0 where one has none.
float turning_angle(vec3 a, vec3 b) {
    vec3 u = direction_or(a, vec3(0.0));
    vec3 v = direction_or(b, vec3(0.0));
    return angle_of(length(cross(u, v)), dot(u, v));
}

// Pieces a fiber is cut into over the Bezier piece `b` of yarn, so that no chord departs from the
// curve by more than `tolerance` (mm). Over an angle a at radius r, n chords depart by r a^2 / (8 n^2);
// the plies' rotation about the yarn (radius `ply_offset`), the fibers' about the ply (at most
// `ellipse_long`) and the bend of the centre line add up. At least `per_turn` pieces a turn, whose directions
// shading can interpolate; 1 to `largest`.
uint subdivisions(vec3 b[4], float ply_turns, float fiber_turns, float ply_offset, float ellipse_long,
                  float tolerance, float per_turn, uint largest) {
    float bend = turning_angle(b[1] - b[0], b[2] - b[1]) + turning_angle(b[2] - b[1], b[3] - b[2]);
    float length_mm = length(b[1] - b[0]) + length(b[2] - b[1]) + length(b[3] - b[2]);
    float ply = TWO_PI * ply_turns;
    float fiber = TWO_PI * (ply_turns + fiber_turns);
    float departure = (ply_offset * ply * ply + ellipse_long * fiber * fiber + length_mm * bend) / 8.0;
    float smooth_pieces = (abs(ply) + abs(fiber) + bend) * (per_turn / TWO_PI);
    float pieces = max(sqrt(departure / max(tolerance, 1e-12)), smooth_pieces);
    return uint(clamp(ceil(pieces), 1.0, float(largest)));
}

// At least `pieces`, and enough that no two vertices are more than a quarter of a period apart: a step
// must not pass over a whole period.
uint period_pieces(uint pieces, float periods, uint largest) {
    return uint(clamp(ceil(4.0 * abs(periods)), float(min(pieces, largest)), float(largest)));
}

// Depth of the nearest control point of `b` along the view axis, less `margin`, at least `nearest`;
// `depth` gives a point's depth as depth.xyz . p + depth.w.
float nearest_depth(vec3 b[4], vec4 depth, float margin, float nearest) {
    float least = dot(depth.xyz, b[0]);
    for (int k = 1; k < 4; ++k) {
        least = min(least, dot(depth.xyz, b[k]));
    }
    return max(least + depth.w - margin, nearest);
}

// Whether everything within `margin` of the Bezier curve `b` lies outside one of the planes.
bool outside_frustum(vec3 b[4], float margin, vec4 planes[5]) {
    for (int i = 0; i < 5; ++i) {
        float nearest = -margin;
        bool outside = true;
        for (int k = 0; k < 4; ++k) {
            outside = outside && dot(planes[i].xyz, b[k]) + planes[i].w < nearest;
        }
        if (outside) {
            return true;
        }
    }
    return false;
}

#endif
