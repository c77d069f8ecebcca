// What the layers of a picture hold of what is seen at a pixel's centre; twin of the images: src/passes/layers.rs.
#ifndef WORSTED_LAYERED
#define WORSTED_LAYERED

#include "../shared/features.glsl"

layout(push_constant) uniform Constants {
    uint fabric;
};

layout(location = 9) in vec4 fragment_motion;  // passes/moved.glsl
layout(location = 10) flat in uint fragment_curve;

// Bits of the motion to the frame before and to the frame after, or where that was not asked for, the ids.
layout(location = 0) out uvec4 first_layer;
layout(location = 1) out uvec4 second_layer;

void write_layers() {
    if (MOTION_LAYER) {
        // What stands still moves by nothing.
        first_layer = uvec4(0u);
        if (NEIGHBOURS) {
            first_layer = floatBitsToUint(fragment_motion * gl_FragCoord.w);
        }
    }
    if (ID_LAYER) {
        // Counted from 1: where nothing is drawn there is 0.
        uvec4 ids = uvec4(fabric + 1u, fragment_curve + 1u, 0u, 0u);
        if (MOTION_LAYER) {
            second_layer = ids;
        } else {
            first_layer = ids;
        }
    }
}

#endif
