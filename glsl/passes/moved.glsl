// How a corner that is seen at `clip` moves to the frame before (xy) and to the frame after (zw), which have it there.
#ifndef WORSTED_MOVED
#define WORSTED_MOVED

#include "../lib/motion.glsl"

vec4 motion_of_corner(vec4 clip, vec3 before, vec3 after) {
    vec4 clip_before = frame.clip_from_world * vec4(before, 1.0);
    vec4 clip_after = frame.clip_from_world * vec4(after, 1.0);
    return vec4(seen_motion(clip, clip_before, frame.near_mm), seen_motion(clip, clip_after, frame.near_mm));
}

#endif
