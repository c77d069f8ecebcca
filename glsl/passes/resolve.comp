#version 460
// Adds one jittered frame, already resolved from its samples, to the picture. Light was scaled to fit half floats.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform readonly image2D frame_radiance;
layout(set = 0, binding = 1, rgba32f) uniform image2D picture;
layout(push_constant) uniform Constants { float weight; float light_weight; uint first; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(picture)))) {
        return;
    }
    vec4 sum = vec4(vec3(light_weight), weight) * imageLoad(frame_radiance, pixel);
    // The first frame overwrites: the picture's memory holds nothing yet.
    if (first == 0) {
        sum += imageLoad(picture, pixel);
    }
    imageStore(picture, pixel, sum);
}
