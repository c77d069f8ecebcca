// How what is seen at a corner moves. What the geometry stages hand on is linear in the picture once it is divided by the
// corner's w, as the device does, so that multiplied by 1 / w of the pixel it is linear in the picture itself: as
// `noperspective` would have it, which is no number on some drivers where a triangle is clipped.
#ifndef WORSTED_MOVED
#define WORSTED_MOVED

#include "../lib/motion.glsl"

// Of a corner that is seen at `clip`, to where the frame before (xy) and the frame after (zw) have it, times clip.w.
vec4 motion_of_corner(vec4 clip, vec3 before, vec3 after) {
    vec4 clip_before = frame.clip_from_world * vec4(before, 1.0);
    vec4 clip_after = frame.clip_from_world * vec4(after, 1.0);
    return clip.w * vec4(seen_motion(clip, clip_before, frame.near_mm), seen_motion(clip, clip_after, frame.near_mm));
}

#endif
