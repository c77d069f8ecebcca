// Angles of directions about a fiber; twin: src/math/angle.rs.
#ifndef WORSTED_ANGLE
#define WORSTED_ANGLE

#include "frame.glsl"

// theta: angle of unit `w` out of the plane perpendicular to the unit `tangent`, in [-pi/2, pi/2].
// By atan of two exact lengths: the driver's asin is off by up to 4e-4 rad.
float longitudinal_angle(vec3 tangent, vec3 w) {
    return atan(dot(w, tangent), length(cross(w, tangent)));
}

// |cos(phi / 2)|, phi the azimuth between two unit directions about `tangent`: half the length of the
// sum of their projections' unit vectors. Where a direction is parallel to the tangent its azimuth
// is undefined and one fixed perpendicular stands for it.
float cos_half_azimuth(vec3 tangent, vec3 a, vec3 b) {
    vec3 some = any_perpendicular(tangent);
    vec3 u = direction_or(a - tangent * dot(a, tangent), some);
    vec3 v = direction_or(b - tangent * dot(b, tangent), some);
    return min(1.0, 0.5 * length(u + v));
}

#endif
