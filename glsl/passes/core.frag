#version 460
// Shades a core fiber as the fibers it stands for, by its texture.
#extension GL_GOOGLE_include_directive : require
#include "core_seen.glsl"
#include "../lib/frame.glsl"

layout(location = 0) centroid in vec3 fragment_position;
layout(location = 1) centroid in vec3 fragment_tangent;
layout(location = 2) centroid in vec3 fragment_side;

layout(location = 0) out vec4 radiance;

// Place in the yarn's cross-section, along side and toward and as a share of outer_radius, of what lies at `v`
// across and `height` above; `from_yarn` is the unit direction of the ply's centre there.
vec2 yarn_place(float v, float height, vec2 from_yarn) {
    vec2 offset = vec2(fragment_section.x * v, fragment_section.y * height + fragment_section.z * v);
    return (offset + yarn.ply_offset * from_yarn) / yarn.outer_radius;
}

void main() {
    CoreSeen seen = seen_core();
    if (seen.mask == 0u) {
        discard;
    }
    gl_SampleMask[0] = int(seen.mask);
    float v = seen.across;
    Surface surface = seen.surface;

    // Height of the ply's round here, as a share of the section's depth.
    float round = sqrt(max(0.0, yarn.core_extent * yarn.core_extent - v * v));
    float height = round * surface.height;
    float rough = round * surface.rough;
    // Fibers turn about the ply, and migrate.
    surface.slope += vec2(-height, v);
    surface.spread.x += rough * rough;
    // From the texture's turn to the ply in space.
    vec4 rates = fragment_rates;
    vec2 slope = rates.w * vec2(fragment_section.x * surface.slope.x,
                                fragment_section.y * surface.slope.y + fragment_section.z * surface.slope.x);
    slope += vec2(rates.x * v, rates.y * height + rates.z * v);
    vec2 scale = rates.w * fragment_section.xy;
    float shrink = 1.0 / (1.0 + dot(slope, slope));

    vec3 axis = direction_or(fragment_tangent, vec3(1.0, 0.0, 0.0));
    vec3 side = normal_perpendicular_to(axis, fragment_side);
    vec3 toward = cross(axis, side);
    Strand strand;
    strand.position = fragment_position;
    strand.tangent = direction_or(axis + slope.x * side + slope.y * toward, axis);
    strand.toward = normal_perpendicular_to(strand.tangent, toward);
    strand.side = cross(strand.toward, strand.tangent);
    strand.spread = shrink * vec3(scale.x * scale.x, scale.y * scale.y, scale.x * scale.y) * surface.spread;
    strand.normals = surface.normals;
    // Two heights with the mean, deviation and skewness of all; none lies above the ply's round.
    float above = clamp(round - height, 0.25 * rough, yarn.core_above * rough);
    float below = above > 0.0 ? rough * rough / above : 0.0;
    // The ply's own frame, in the plane of side and toward. Straight pieces cut its way around the yarn short; its
    // distance from the yarn's centre stays true.
    vec2 normal = direction_or(vec3(fragment_place.xy, 0.0), vec3(0.0, 1.0, 0.0)).xy;
    mat2 ply_from_view = mat2(normal.x, -normal.y, normal.y, normal.x);
    strand.near_place = ply_from_view * yarn_place(v, height + above, normal);
    strand.far_place = ply_from_view * yarn_place(v, height - below, normal);
    strand.far_share = above + below > 0.0 ? above / (above + below) : 0.0;
    strand.ply_normal = normal.x * side + normal.y * toward;
    strand.ply_binormal = normal.x * toward - normal.y * side;
    strand.piece = fragment_core.z;
    strand.ply = fragment_core.x;
    strand.shown = fragment_core.y;
    radiance = strand_color(strand);
}
