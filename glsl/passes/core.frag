#version 460
// Shades a core fiber, or shows what its vertices were shaded with.
#extension GL_GOOGLE_include_directive : require
#include "covered.glsl"
#include "core_strand.glsl"

layout(location = 0) centroid in vec3 fragment_position;
layout(location = 1) centroid in vec3 fragment_tangent;
layout(location = 2) centroid in vec3 fragment_side;
layout(location = 3) centroid in vec4 fragment_section;  // width, depth, shear (mm), turns
layout(location = 4) centroid in vec4 fragment_rates;    // of the first three and of the turn (radians), per mm
layout(location = 5) centroid in vec3 fragment_place;    // from_yarn along side and toward, level
layout(location = 6) flat in uvec3 fragment_core;        // ply, what a debug view shows, piece of yarn
layout(location = 7) noperspective in float fragment_across; // as a share of the ellipse
layout(location = 8) centroid in vec3 fragment_radiance; // where it is shaded at its vertices

layout(location = 0) out vec4 radiance;

void main() {
    CorePlace at = CorePlace(fragment_position, fragment_tangent, fragment_side, fragment_section, fragment_rates,
                             fragment_place, fragment_core, covered_values(fragment_across, gl_SampleMaskIn[0]).x);
    CoreTexel texel = core_texel(at, frame.pixel_tangent / gl_FragCoord.w);
    uint mask = coverage_mask(core_coverage(texel), SAMPLES, texel.word);
    if (mask == 0u) {
        discard;
    }
    gl_SampleMask[0] = int(mask);
    radiance = AT_VERTICES ? vec4(fragment_radiance, 1.0) : strand_color(core_strand(at, texel));
}
