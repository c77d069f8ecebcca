#version 460
// Puts the picture over its background or leaves it transparent, applies exposure and tone curve, and encodes it
// for display.
#extension GL_GOOGLE_include_directive : require
#include "../lib/tone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D picture;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D display;
layout(constant_id = 0) const uint TONE = 0;              // src/scene/file.rs, `ToneCurve`
layout(constant_id = 1) const bool TRANSPARENT = false;   // the yarn alone, straight alpha
layout(push_constant) uniform Constants { vec3 background; float exposure_scale; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(display)))) {
        return;
    }
    vec4 radiance = imageLoad(picture, pixel);
    vec3 linear = radiance.rgb + (1.0 - radiance.a) * background;
    float alpha = 1.0;
    if (TRANSPARENT) {
        linear = radiance.a > 0.0 ? radiance.rgb / radiance.a : vec3(0.0);
        // Never from above 0 down to 0.
        alpha = radiance.a > 0.0 ? clamp(radiance.a, 1.0 / 255.0, 1.0) : 0.0;
    }
    linear *= exposure_scale;
    vec3 shown = TONE == 1u ? tone_filmic(linear) : tone_neutral(linear);
    vec3 encoded = vec3(srgb_from_linear(shown.r), srgb_from_linear(shown.g), srgb_from_linear(shown.b));
    imageStore(display, pixel, vec4(encoded, alpha));
}
