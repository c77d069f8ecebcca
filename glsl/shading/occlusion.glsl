// Ambient occlusion inside a yarn: by distance from its centre, twin: src/precompute/occlusion_fit.rs; by place
// in its cross-section, twin: src/precompute/occlusion_table.rs.
#ifndef WORSTED_OCCLUSION
#define WORSTED_OCCLUSION

#include "table.glsl"

// Wu & Yuksel 2019, Sec. 4.2: visibility as a cubic of the distance, fitted to the radial average of
// the exact integral. `distance` is a share of the outer radius; beyond it nothing occludes more.
float distance_occlusion(vec4 cubic, float distance) {
    float d = clamp(distance, 0.0, 1.0);
    return clamp(cubic.x + d * (cubic.y + d * (cubic.z + d * cubic.w)), 0.0, 1.0);
}

// Share of ambient light that a fiber reflects, of which `visibility` reaches it from all around: R's azimuthal lobe,
// cos(phi / 2) about the viewer, has a third of what leans toward there. `facing` is the cosine of the angle between
// the way out of the yarn and the viewer, `distance` the fiber's from the yarn's centre as a share of the outer radius.
float reflected_occlusion(float visibility, vec4 lean, float distance, float facing) {
    float d = clamp(distance, 0.0, 1.0);
    float leaning = lean.x + d * (lean.y + d * (lean.z + d * lean.w));
    return clamp(visibility + leaning * facing / 3.0, 0.0, 1.0);
}

// Where to read the table for `position` in the cross-section (ply 0 along x, in outer radii); `across` is its
// texels across. Beyond the square around the outer circle nothing occludes less.
vec2 occlusion_place(vec2 position, uint across) {
    vec2 share = clamp(0.5 + 0.5 * position, 0.0, 1.0);
    return vec2(node_coordinate(share.x, across), node_coordinate(share.y, across));
}

// Wu & Yuksel 2019, Sec. 4.2: share of ambient light that reaches a place of the cross-section.
float texture_occlusion(sampler2D table, vec2 place) {
    return textureLod(table, place, 0.0).r;
}

#endif
