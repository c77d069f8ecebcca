// How much light reaches a fiber through its own yarn, ply by ply, where plies are too thin for the table of
// self_shadow.glsl; twin: src/precompute/chord_shadow.rs.
#ifndef WORSTED_CHORD_SHADOW
#define WORSTED_CHORD_SHADOW

#include "table.glsl"

// A yarn's plies, in outer radii.
struct Plies {
    uint count;
    float offset; // of each one's centre from the yarn's
    vec2 axes;    // half-axes, the one toward the yarn's centre first
    vec2 turn;    // unit vector at the angle from each ply to the next
};

// The chord of a ply on the line from `position` toward the light, the unit vector `toward`, both in the ply's frame:
// place in the table along it and among chords, each from 0 to 1, and its half's length, 0 where the line misses the
// ply. Both differences of squares stand as products, of what is small as it is: plies may be a thousand times thinner
// than the yarn.
vec3 ply_chord(vec2 position, vec2 toward, float offset, vec2 axes) {
    vec2 from_center = position - vec2(offset, 0.0);
    // Half of the ply's width across the light.
    float width = length(axes.yx * toward);
    float closest = abs(toward.x * from_center.y - toward.y * from_center.x) / width;
    float half_share = sqrt(max((1.0 - closest) * (1.0 + closest), 0.0));
    float passed = dot(from_center / axes, axes.yx * toward);
    float along = half_share > 0.0 ? clamp(passed / (width * half_share), -1.0, 1.0) : 1.0;
    return vec3(0.5 + 0.5 * along, 0.5 * (1.0 + half_share - min(closest, 1.0)), half_share * axes.x * axes.y / width);
}

// Optical depth toward the light for light across the yarn, in units of the outer radius, of a fiber at `position` in
// the cross-section (ply 0 along x, in outer radii); `light` is the projection there of the direction toward the light,
// of any length; where it has none, ply 0's direction stands for it.
float chord_depth(sampler3D table, vec2 position, vec2 light, Plies plies) {
    float projected = length(light);
    vec2 toward = projected > 0.0 ? light / projected : vec2(1.0, 0.0);
    uvec2 size = uvec2(textureSize(table, 0).xy);
    mat2 back = mat2(plies.turn.x, -plies.turn.y, plies.turn.y, plies.turn.x);
    float depth = 0.0;
    for (uint ply = 0u; ply < plies.count; ++ply) {
        vec3 chord = ply_chord(position, toward, plies.offset, plies.axes);
        vec3 place = vec3(node_coordinate(chord.x, size.x), node_coordinate(chord.y, size.y), 0.5);
        depth += chord.z * textureLod(table, place, 0.0).r;
        position = back * position;
        toward = back * toward;
    }
    return depth;
}

#endif
