// Ambient occlusion inside a yarn by distance from its centre; twin: src/precompute/occlusion_fit.rs.
#ifndef WORSTED_OCCLUSION
#define WORSTED_OCCLUSION

// Wu & Yuksel 2019, Sec. 4.2: visibility as a cubic of the distance, fitted to the radial average of
// the exact integral. `distance` is a share of the outer radius; beyond it nothing occludes more.
float distance_occlusion(vec4 cubic, float distance) {
    float d = clamp(distance, 0.0, 1.0);
    return clamp(cubic.x + d * (cubic.y + d * (cubic.z + d * cubic.w)), 0.0, 1.0);
}

#endif
