// The camera-facing strip that stands for a round fiber; twin: src/math/strip.rs.
#ifndef WORSTED_STRIP
#define WORSTED_STRIP

#include "frame.glsl"

// Unit vector across the strip at a point of a fiber: perpendicular to the fiber and to the line of
// sight. Seen end on, the fiber has no side; any perpendicular of the line of sight will do.
vec3 strip_side(vec3 tangent, vec3 to_eye) {
    return direction_or(cross(tangent, to_eye), any_perpendicular(to_eye));
}

// Outward normal of the round fiber at `across` in [-1, 1] of its strip, by its azimuth phi from the viewer (0)
// to the strip's side (pi/2): sin phi, cos phi, sin 2 phi, cos 2 phi.
vec4 strip_normals(float across) {
    float z = sqrt(max(0.0, 1.0 - across * across));
    return vec4(across, z, 2.0 * across * z, z * z - across * across);
}

// Their mean over the strip.
const vec4 STRIP_MEAN_NORMALS = vec4(0.0, 0.785398163, 0.0, 0.333333333);

#endif
