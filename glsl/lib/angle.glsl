// Angles of directions about a fiber; twin: src/math/angle.rs.
#ifndef WORSTED_ANGLE
#define WORSTED_ANGLE

#include "../shared/constants.glsl"
#include "frame.glsl"

// atan(y, x) to 2e-7 of the angle, 0 where both are 0 (Cephes' atanf, Moshier 1989). Drivers' own may
// be off by 2e-5 of the angle, which a lobe half a degree wide shows, and gives anything for (0, 0).
float angle_of(float y, float x) {
    float low = min(abs(x), abs(y));
    float high = max(abs(x), abs(y));
    bool steep = low > 0.41421356 * high;
    float r = steep ? (low - high) / (low + high) : low / max(high, 1e-30);
    float z = r * r;
    float angle = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z
                   - 3.33329491539e-1) * z * r + r;
    angle += steep ? 0.25 * PI : 0.0;
    angle = abs(y) > abs(x) ? 0.5 * PI - angle : angle;
    angle = x < 0.0 ? PI - angle : angle;
    return y < 0.0 ? -angle : angle;
}

// theta: angle of unit `w` out of the plane perpendicular to the unit `tangent`, in [-pi/2, pi/2].
// From two exact lengths: the driver's asin is off by up to 4e-4 rad.
float longitudinal_angle(vec3 tangent, vec3 w) {
    return angle_of(dot(w, tangent), length(cross(w, tangent)));
}

// |cos(phi / 2)|, phi the azimuth between two unit directions about `tangent`: half the length of the
// sum of their projections' unit vectors. Where a direction is parallel to the tangent its azimuth
// is undefined and one fixed perpendicular stands for it.
float cos_half_azimuth(vec3 tangent, vec3 a, vec3 b) {
    vec3 u = normal_perpendicular_to(tangent, a);
    vec3 v = normal_perpendicular_to(tangent, b);
    return min(1.0, 0.5 * length(u + v));
}

#endif
