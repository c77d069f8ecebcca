#version 460
// Puts the picture over its background, applies exposure and tone curve, and encodes it for display.
#extension GL_GOOGLE_include_directive : require
#include "../lib/tone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D picture;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D display;
layout(push_constant) uniform Constants { vec3 background; float exposure_scale; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(display)))) {
        return;
    }
    vec4 radiance = imageLoad(picture, pixel);
    vec3 shown = tone_neutral((radiance.rgb + (1.0 - radiance.a) * background) * exposure_scale);
    vec3 encoded = vec3(srgb_from_linear(shown.r), srgb_from_linear(shown.g), srgb_from_linear(shown.b));
    imageStore(display, pixel, vec4(encoded, 1.0));
}
