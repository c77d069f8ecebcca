// A core fiber as the fibers that it stands for, by its texture.
#ifndef WORSTED_CORE_STRAND
#define WORSTED_CORE_STRAND

#include "surface.glsl"
#include "../lib/coverage.glsl"
#include "../lib/frame.glsl"

// A place on a core's strip.
struct CorePlace {
    vec3 position;
    vec3 tangent;   // of the ply
    vec3 side;
    vec4 section;   // width, depth, shear (mm), turns
    vec4 rates;     // of the first three and of the turn (radians), per mm
    vec3 place;     // from_yarn along side and toward, level
    uvec3 core;     // ply, what a debug view shows, piece of yarn
    float v;        // across, as a share of the ellipse
};

// What the texture holds there.
struct CoreTexel {
    Surface surface;
    float texels;   // of the finer direction that a pixel spans
    uint word;      // random, of the texture's cell
};

float texels_of(CorePlace at, float pixel_mm) {
    float across = pixel_mm * float(yarn.core_rows) / (2.0 * yarn.core_extent * at.section.x);
    float along = pixel_mm * abs(at.rates.w) / TWO_PI * float(textureSize(core_shape, 0).x);
    return max(across, along);
}

// Random words of one cell of the texture, as large as a pixel: stable where the cloth moves.
uvec4 cell_words(CorePlace at, vec2 uv, float texels) {
    float cell = exp2(ceil(log2(max(texels, 1.0))));
    ivec2 place = ivec2(floor(uv * vec2(textureSize(core_shape, 0).xy) / cell));
    return hash_words(uvec4(uvec2(place), at.core.z * 8u + at.core.x, frame.index));
}

// Level and mip are each one of the two nearest, by chance in proportion: on average that is what blending
// them gives, for a quarter of the texture reads.
CoreTexel core_texel(CorePlace at, float pixel_mm) {
    CoreTexel texel;
    texel.texels = texels_of(at, pixel_mm);
    vec2 uv = vec2(fract(at.section.w), 0.5 + 0.5 * at.v / yarn.core_extent);
    uvec4 words = cell_words(at, uv, texel.texels);
    texel.word = words.x;
    float lod = log2(max(texel.texels * frame.shading_spacing_px, 1e-3));
    float level = clamp(floor(at.place.z + uniform_from_word(words.y)), 0.0, float(CORE_LEVELS - 1u));
    float mip = max(floor(lod + uniform_from_word(words.z)), 0.0);
    vec3 place = vec3(uv, float(at.core.x * CORE_LEVELS) + level);
    vec4 spread = SPECULAR || DISTANCE_OCCLUSION || TEXTURE_OCCLUSION || SELF_SHADOW ? textureLod(core_spread, place, mip) : vec4(0.0);
    texel.surface = surface_of(textureLod(core_normals, place, mip), textureLod(core_shape, place, mip), spread);
    return texel;
}

// Share of what is seen there that the core covers.
float core_coverage(CoreTexel texel) {
    return sharpened_coverage(texel.surface.coverage, texel.texels);
}

// Place in the yarn's cross-section, along side and toward and as a share of outer_radius, of what lies
// `height` above; `from_yarn` is the unit direction of the ply's centre there.
vec2 yarn_place(CorePlace at, float height, vec2 from_yarn) {
    vec2 offset = vec2(at.section.x * at.v, at.section.y * height + at.section.z * at.v);
    return (offset + yarn.ply_offset * from_yarn) / yarn.outer_radius;
}

Strand core_strand(CorePlace at, CoreTexel texel) {
    Surface surface = texel.surface;
    float v = at.v;
    // Height of the ply's round here, as a share of the section's depth.
    float round = sqrt(max(0.0, yarn.core_extent * yarn.core_extent - v * v));
    float height = round * surface.height;
    float rough = round * surface.rough;
    // Fibers turn about the ply, and migrate.
    surface.slope += vec2(-height, v);
    surface.spread.x += rough * rough;
    // From the texture's turn to the ply in space.
    vec4 rates = at.rates;
    vec2 slope = rates.w * vec2(at.section.x * surface.slope.x,
                                at.section.y * surface.slope.y + at.section.z * surface.slope.x);
    slope += vec2(rates.x * v, rates.y * height + rates.z * v);
    vec2 scale = rates.w * at.section.xy;
    float shrink = 1.0 / (1.0 + dot(slope, slope));

    vec3 axis = direction_or(at.tangent, vec3(1.0, 0.0, 0.0));
    vec3 side = normal_perpendicular_to(axis, at.side);
    vec3 toward = cross(axis, side);
    Strand strand;
    strand.position = at.position;
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
    vec2 normal = direction_or(vec3(at.place.xy, 0.0), vec3(0.0, 1.0, 0.0)).xy;
    mat2 ply_from_view = mat2(normal.x, -normal.y, normal.y, normal.x);
    strand.near_place = ply_from_view * yarn_place(at, height + above, normal);
    strand.far_place = ply_from_view * yarn_place(at, height - below, normal);
    strand.far_share = above + below > 0.0 ? above / (above + below) : 0.0;
    strand.ply_normal = normal.x * side + normal.y * toward;
    strand.ply_binormal = normal.x * toward - normal.y * side;
    strand.piece = at.core.z;
    strand.ply = at.core.x;
    strand.shown = at.core.y;
    return strand;
}

#endif
