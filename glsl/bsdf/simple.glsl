// Wu & Yuksel 2019's simple shading; twin: src/bsdf/simple.rs.
#ifndef WORSTED_SIMPLE
#define WORSTED_SIMPLE

#include "../shared/constants.glsl"
#include "../lib/angle.glsl"

// Diffuse reflection of a round fiber with unit normal `normal`: k_d max(0, n.l) / pi.
vec3 simple_diffuse(vec3 strength, vec3 normal, vec3 to_light) {
    return strength * (max(0.0, dot(normal, to_light)) / PI);
}

// Wu & Yuksel 2019, Eq. 5, without its colour: |cos(phi/2)| exp(-theta_h^2 / (2 beta^2)).
// `cos_half_phi` >= 0; `theta_h` and `width` in radians.
float simple_specular(float cos_half_phi, float theta_h, float width) {
    float x = theta_h / width;
    return cos_half_phi * exp(-0.5 * x * x);
}

// The specular lobe for unit directions away from a fiber with unit `tangent`, times the cosine of
// the light's angle to the fiber's cross-section.
float simple_specular_cos(vec3 tangent, vec3 to_light, vec3 to_eye, float width) {
    float theta_h = 0.5 * (longitudinal_angle(tangent, to_light) + longitudinal_angle(tangent, to_eye));
    float cos_theta = length(cross(tangent, to_light));
    return simple_specular(cos_half_azimuth(tangent, to_light, to_eye), theta_h, width) * cos_theta;
}

#endif
