// How what is seen moves from one frame to another; twin: src/math/motion.rs.
#ifndef WORSTED_MOTION
#define WORSTED_MOTION

// From where a point is seen to where it is seen in another frame, both in clip space; in halves of the picture's sides,
// y down. What is nearer than the near plane counts as on it.
vec2 seen_motion(vec4 clip, vec4 clip_then, float near) {
    return clip_then.xy / max(clip_then.w, near) - clip.xy / max(clip.w, near);
}

// A vector that turns with a frame, of which two axes, unit and perpendicular, are given now and then.
vec3 carried_vector(vec3 v, vec3 normal, vec3 binormal, vec3 normal_then, vec3 binormal_then) {
    return dot(v, normal) * normal_then + dot(v, binormal) * binormal_then
         + dot(v, cross(normal, binormal)) * cross(normal_then, binormal_then);
}

#endif
