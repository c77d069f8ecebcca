// How much light reaches a fiber through its own yarn (Wu & Yuksel 2019, Sec. 4.1); twin:
// src/precompute/self_shadow.rs.
#ifndef WORSTED_SELF_SHADOW
#define WORSTED_SELF_SHADOW

#include "../shared/constants.glsl"
#include "../lib/angle.glsl"
#include "table.glsl"

// Sine of the least angle between light and yarn that lengthens the way into it. A way across the whole yarn, two
// outer radii, is then 16 of them long: about as far as a loop of knitwear is straight (chosen, not measured).
const float SELF_SHADOW_LEAST_SIN = 0.125;

// Where to read the table for a fiber at `position` in the cross-section (ply 0 along x, in outer radii) and
// the projection there of the direction toward the light, of any length; where it has none, ply 0's direction
// stands for it. `size` is the table's texels across and its slices. The slices end where light between two
// plies is its own mirror image, so that the coordinate folds there and needs no wrapping. Places clamp to the
// outer circle's square, which loses nothing: only fly-aways, which the table does not hold, lie outside of it.
vec3 self_shadow_place(vec2 position, vec2 light, uint ply_count, uvec2 size) {
    float projected = length(light);
    vec2 toward = projected > 0.0 ? light / projected : vec2(1.0, 0.0);
    float turns = angle_of(toward.y, toward.x) * (float(ply_count) / (2.0 * PI));
    float from_ply = turns - round(turns);
    float across = toward.x * position.y - toward.y * position.x;
    across = from_ply < 0.0 ? -across : across;
    vec2 share = clamp(0.5 + 0.5 * vec2(dot(toward, position), across), 0.0, 1.0);
    return vec3(node_coordinate(share.x, size.x), node_coordinate(share.y, size.x),
                node_coordinate(2.0 * abs(from_ply), size.y));
}

// Optical depth toward the light for light across the yarn, in units of the outer radius.
float self_shadow_depth(sampler3D table, vec3 place) {
    return textureLod(table, place, 0.0).r;
}

// How much longer than across the yarn the way into it is; `sin_angle` is that of the angle between the light
// and the yarn. A way across the whole yarn is no longer than the yarn is straight.
float self_shadow_stretch(float sin_angle) {
    return 1.0 / max(sin_angle, SELF_SHADOW_LEAST_SIN);
}

// Share of light that comes through: `depth` for light across the yarn, `extinction` per unit of it. Toward the
// yarn's own direction it falls to nothing, as it does without the cap wherever there is anything to pass;
// where there is nothing, it would depend on which side of the yarn the light is just on, and jump.
float self_shadow_light(float depth, float extinction, float sin_angle) {
    float seen = min(1.0, sin_angle / SELF_SHADOW_LEAST_SIN);
    return seen * exp(-extinction * depth * self_shadow_stretch(sin_angle));
}

#endif
