// Wu & Yuksel 2019's simple shading; twin: src/bsdf/simple.rs.
#ifndef WORSTED_SIMPLE
#define WORSTED_SIMPLE

#include "../shared/constants.glsl"
#include "../lib/angle.glsl"

// E[max(0, n.l)] over the visible normals of one fiber or of many that a pixel holds. Normals lie in the
// fiber's cross-section at azimuth phi, measured from `toward` (0) to `side` (pi/2); `normals` are the means
// of sin phi, cos phi, sin 2 phi and cos 2 phi. Exact for a single normal: the clamped cosine's Fourier
// series to the second harmonic is linear in the means, and the rest of it, which starts with the fourth,
// fades as it does for normals spread like a wrapped Gaussian with the same mean resultant length.
float filtered_cosine(vec4 normals, vec3 side, vec3 toward, vec3 to_light) {
    vec2 light = vec2(dot(to_light, side), dot(to_light, toward));
    float light_length = length(light);
    vec2 l = light_length > 0.0 ? light / light_length : vec2(0.0, 1.0);
    vec2 l2 = vec2(2.0 * l.x * l.y, l.y * l.y - l.x * l.x);
    float series = 1.0 / PI + 0.5 * dot(normals.xy, l) + (2.0 / (3.0 * PI)) * dot(normals.zw, l2);
    float resultant = length(normals.xy);
    vec2 n = resultant > 0.0 ? normals.xy / resultant : vec2(0.0, 1.0);
    float c = dot(n, l);
    float rest = max(0.0, c) - (1.0 / PI + 0.5 * c + (2.0 / (3.0 * PI)) * (2.0 * c * c - 1.0));
    // The sixteenth power, by squaring: `pow` may err by more than the lobe's foot.
    float fourth = min(resultant, 1.0);
    for (int k = 0; k < 4; ++k) {
        fourth *= fourth;
    }
    return light_length * max(0.0, series + fourth * rest);
}

// Diffuse reflection, k_d E[max(0, n.l)] / pi, of the normals that `filtered_cosine` speaks of.
vec3 simple_diffuse(vec3 strength, vec4 normals, vec3 side, vec3 toward, vec3 to_light) {
    return strength * (filtered_cosine(normals, side, toward, to_light) / PI);
}

// Variance of theta_h, radians squared, where tangents vary about their mean: `spread` is their variance
// along `side`, along `toward`, and their covariance. To first order; the half vector is not normalised.
float half_angle_variance(vec3 spread, vec3 side, vec3 toward, vec3 to_light, vec3 to_eye) {
    vec3 h = 0.5 * (to_light + to_eye);
    vec2 p = vec2(dot(h, side), dot(h, toward));
    return max(0.0, p.x * p.x * spread.x + p.y * p.y * spread.y + 2.0 * p.x * p.y * spread.z);
}

// Wu & Yuksel 2019, Eq. 5, without its colour: |cos(phi/2)| exp(-theta_h^2 / (2 beta^2)), averaged over a
// normally distributed theta_h of the given mean and variance. `cos_half_phi` >= 0; radians.
float simple_specular(float cos_half_phi, float theta_h, float width, float variance) {
    float widened = width * width + variance;
    return cos_half_phi * (width * inversesqrt(widened)) * exp(-0.5 * theta_h * theta_h / widened);
}

// The specular lobe for unit directions away from a fiber with unit `tangent`, times the cosine of
// the light's angle to the fiber's cross-section.
float simple_specular_cos(vec3 tangent, vec3 to_light, vec3 to_eye, float width, float variance) {
    float theta_h = 0.5 * (longitudinal_angle(tangent, to_light) + longitudinal_angle(tangent, to_eye));
    float cos_theta = length(cross(tangent, to_light));
    float cos_half_phi = cos_half_azimuth(tangent, to_light, to_eye);
    return simple_specular(cos_half_phi, theta_h, width, variance) * cos_theta;
}

#endif
