// What of a core fiber a pixel sees: place across it, its surface there, and which of the pixel's samples it covers.
#ifndef WORSTED_CORE_SEEN
#define WORSTED_CORE_SEEN

#include "covered.glsl"
#include "surface.glsl"
#include "../lib/coverage.glsl"

layout(location = 3) centroid in vec4 fragment_section;  // width, depth, shear (mm), turns
layout(location = 4) centroid in vec4 fragment_rates;    // of the first three and of the turn (radians), per mm
layout(location = 5) centroid in vec3 fragment_place;    // from_yarn along side and toward, level
layout(location = 6) flat in uvec3 fragment_core;        // ply, what a debug view shows, piece of yarn
layout(location = 7) noperspective in float fragment_across; // as a share of the ellipse

struct CoreSeen {
    float across;  // as fragment_across
    Surface surface;
    uint mask;     // of the samples; 0: what is behind is seen
};

// Level and mip are each one of the two nearest, by chance in proportion: on average that is what blending
// them gives, for a quarter of the texture reads.
Surface read_core(vec2 uv, float lod, uvec2 words) {
    float level = clamp(floor(fragment_place.z + uniform_from_word(words.x)), 0.0, float(CORE_LEVELS - 1u));
    float mip = max(floor(lod + uniform_from_word(words.y)), 0.0);
    vec3 place = vec3(uv, float(fragment_core.x * CORE_LEVELS) + level);
    vec4 spread = SPECULAR || DISTANCE_OCCLUSION || TEXTURE_OCCLUSION || SELF_SHADOW ? textureLod(core_spread, place, mip) : vec4(0.0);
    return surface_of(textureLod(core_normals, place, mip), textureLod(core_shape, place, mip), spread);
}

// Texels of the finer direction that a pixel spans.
float texels_of(float pixel_mm) {
    float across = pixel_mm * float(yarn.core_rows) / (2.0 * yarn.core_extent * fragment_section.x);
    float along = pixel_mm * abs(fragment_rates.w) / TWO_PI * float(textureSize(core_shape, 0).x);
    return max(across, along);
}

// Random words of one cell of the texture, as large as a pixel: stable where the cloth moves.
uvec4 cell_words(vec2 uv, float texels) {
    float cell = exp2(ceil(log2(max(texels, 1.0))));
    ivec2 place = ivec2(floor(uv * vec2(textureSize(core_shape, 0).xy) / cell));
    return hash_words(uvec4(uvec2(place), (yarn.first_piece + fragment_core.z) * 8u + fragment_core.x, frame.index));
}

CoreSeen seen_core() {
    CoreSeen seen;
    float pixel_mm = frame.pixel_tangent / gl_FragCoord.w;
    float texels = texels_of(pixel_mm);
    seen.across = covered_values(fragment_across, gl_SampleMaskIn[0]).x;
    vec2 uv = vec2(fract(fragment_section.w), 0.5 + 0.5 * seen.across / yarn.core_extent);
    uvec4 words = cell_words(uv, texels);
    seen.surface = read_core(uv, log2(max(texels * frame.shading_spacing_px, 1e-3)), words.yz);
    seen.mask = coverage_mask(sharpened_coverage(seen.surface.coverage, texels), SAMPLES, words.x);
    return seen;
}

#endif
