// A ply as its viewer sees it: what places a core fiber and its texture; twin: src/yarn/core.rs.
#ifndef WORSTED_CORE
#define WORSTED_CORE

#include "../shared/constants.glsl"
#include "../shared/layouts.glsl"
#include "../lib/frame.glsl"

// The ply's elliptical cross-section, seen along `toward`. A fiber at angle a and radius R of the ellipse
// lies R width cos(a - phase) along `side` and R (depth sin(a - phase) + shear cos(a - phase)) toward the
// viewer: the image of a circle, whatever the ellipse and the view.
struct CoreSection {
    vec3 side;      // unit, perpendicular to the ply and the view
    vec3 toward;    // unit, perpendicular to the ply, toward the viewer
    vec2 from_yarn; // of the ply's centre from the yarn's, along side and toward, as a share of ply_offset
    float width;    // mm
    float depth;    // mm
    float shear;    // mm
    float phase;    // radians
};

// `ply_normal` and `ply_binormal`: unit, the ellipse's short and long axis.
CoreSection core_section(vec3 ply_normal, vec3 ply_binormal, vec3 ply_tangent, vec3 to_eye, float ellipse_short,
                         float ellipse_long) {
    CoreSection section;
    section.toward = normal_perpendicular_to(ply_tangent, to_eye);
    section.side = cross(section.toward, ply_tangent);
    vec2 s = vec2(dot(section.side, ply_normal), dot(section.side, ply_binormal));
    vec2 d = vec2(dot(section.toward, ply_normal), dot(section.toward, ply_binormal));
    vec2 axes = vec2(ellipse_short, ellipse_long);
    section.width = max(length(axes * s), 1e-30);
    section.depth = ellipse_short * ellipse_long * (s.x * d.y - s.y * d.x) / section.width;
    section.shear = dot(axes * axes, s * d) / section.width;
    section.phase = atan(axes.y * s.y, axes.x * s.x);
    section.from_yarn = vec2(s.x, d.x);
    return section;
}

// Direction in which the core's strip runs: the ply's, without what is not continuous from one piece of yarn to
// the next (the rate of twist by the curve's own parameter, and its second derivative), or strips would part.
vec3 core_axis(vec3 ply_normal, vec3 ply_binormal, float ply_turns_per_mm, float ply_offset) {
    vec3 yarn_tangent = cross(ply_normal, ply_binormal);
    return direction_or(yarn_tangent + TWO_PI * ply_turns_per_mm * ply_offset * ply_binormal, yarn_tangent);
}

// Where in a turn the texture is read, in turns. Wu & Yuksel 2019, Eq. 3, derived anew: as printed it has
// a pole where plies and fibers twist alike. What a viewer sees turn is the fibers' angle in the ply's
// frame less the direction from which the ply is seen in that frame.
float core_turns(float fiber_twist, float phase) {
    return (fiber_twist - phase) / TWO_PI;
}

// `turns` moved by whole turns to within half a turn of `expected`.
float nearest_turn(float turns, float expected) {
    return turns - round(turns - expected);
}

// Distance of the farthest fiber that the core stands for from the ply's centre, as a share of the
// ellipse, at a place in its levels.
float core_thickness(float level, Yarn yarn) {
    float place = clamp(level, 0.0, float(CORE_LEVELS - 1u));
    uint low = min(uint(place), CORE_LEVELS - 2u);
    return mix(yarn.core_thickness[low], yarn.core_thickness[low + 1u], place - float(low));
}

#endif
