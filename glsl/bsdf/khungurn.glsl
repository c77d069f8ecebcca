// Khungurn's two lobes, R and TT, by tables; twin: src/bsdf/khungurn/tabulated.rs, whose table-free truth is
// src/bsdf/khungurn/mod.rs. Angles in radians; theta is the angle to the fiber's cross-section, phi the azimuth
// between the directions, 0 where light returns.
#ifndef WORSTED_KHUNGURN
#define WORSTED_KHUNGURN

#include "../shared/constants.glsl"
#include "../lib/angle.glsl"
#include "../lib/frame.glsl"
#include "../lib/special.glsl"

// How one kind of fiber scatters light, and what is constant about it.
struct Scattering {
    vec3 c_r;
    vec3 c_tt;
    float beta_r;  // longitudinal width of R
    float beta_tt; // of TT
    float k_tt;    // gamma_tt^-2
    float n_tt;    // 1 / (2 pi exp(-k) I0(k)), k = k_tt
    uint entries;  // of each lobe's table, at least 2
};

const uint LOBE_R = 0;
const uint LOBE_TT = 1;

// One entry of a lobe's table (src/precompute/scattering_table.rs); whoever includes this file defines it.
vec4 scattering_entry(uint lobe, uint index);

// Both tables have their entries closer together within about so many widths of where their functions bend.
const float TABLE_SPACING = 2.0;

// (1 - cos theta)^5.
float schlick(float cos_theta) {
    float one = max(0.0, 1.0 - cos_theta);
    float two = one * one;
    return two * two * one;
}

// 1 - (1 - cos theta)^5, without the difference, which cancels at grazing angles.
float schlick_rest(float cos_theta) {
    float c = cos_theta;
    return c * (5.0 + c * (-10.0 + c * (10.0 + c * (-5.0 + c))));
}

// G(theta, width), but for a factor near 1 that the table holds: the integral of (cos theta - u)^2 times a
// Gaussian in u, over u below cos theta.
float gaussian_normaliser(float cos_theta, float width) {
    float z = cos_theta / width;
    return (cos_theta * cos_theta + width * width) * normal_cdf(z) + cos_theta * width * normal_density(z);
}

// Where the normaliser's table holds this angle: 0 at the pole, where cos theta = 0, to 1.
float normaliser_position(float cos_theta, float width) {
    float spacing = TABLE_SPACING * width;
    return cos_theta * (1.0 + spacing) / (cos_theta + spacing);
}

// Where the ambient tables hold the direction at x_o = pi/2 - |theta_o| from the pole: 0 there, to 1. Entries
// crowd at both ends, where the lobe reaches over the pole and where it reaches beyond the normal plane.
float ambient_position(float x_o, float width) {
    float spacing = TABLE_SPACING * width;
    float end = 0.5 * PI;
    float rest = max(0.0, end - x_o);
    float at_end = end / (end + spacing);
    return ((x_o / (x_o + spacing) - 0.5 * rest / (rest + spacing)) / at_end + 0.5) / 1.5;
}

// The integral of (1 - cos theta_i)^5 M cos^2, but for a factor that the table holds: the tenth moment over 32
// of a Gaussian whose mean is the chord of theta_o. Its variance grows beyond the lobe's where the lobe is wide: the
// integral is then nearly the same everywhere.
float grazing_moment(float cos_o, float width) {
    float y = 2.0 * max(0.0, 1.0 - cos_o);
    float v = width * width * (1.0 + 4.0 * width * width);
    float moment = y + 45.0 * v;
    moment = moment * y + 630.0 * v * v;
    moment = moment * y + 3150.0 * v * v * v;
    moment = moment * y + 4725.0 * v * v * (v * v);
    return (moment * y + 945.0 * v * v * (v * v * v)) * (1.0 / 32.0);
}

// The integral of (1 - (1 - cos theta_i)^5) M cos^2, but for a factor that the table holds: its integrand at a
// cosine that the width keeps from 0.
float through_moment(float cos_o, float width) {
    float w = 0.6 * width * width;
    w /= 1.0 + w;
    return schlick_rest(sqrt(cos_o * cos_o + w * max(0.0, 1.0 - cos_o * cos_o)));
}

// A lobe's table at a position, 0 to 1: linear between entries, in f32, because texture filters weigh with 8 bits.
vec4 scattering_table_at(uint lobe, float position, uint entries) {
    float at = clamp(position, 0.0, 1.0) * float(entries - 1);
    uint low = min(uint(at), entries - 2);
    return mix(scattering_entry(lobe, low), scattering_entry(lobe, low + 1), at - float(low));
}

// M, per radian, of theta_sum = theta_i + theta_o: g(theta_o; -theta_i, width) / G(-theta_i, width). `variance`
// widens g alone: the mean over tangents for which theta_i + theta_o varies so much about its mean.
float longitudinal(float theta_sum, float cos_i, float width, float variance, uint lobe, uint entries) {
    float deviation = sqrt(width * width + variance);
    float ratio = scattering_table_at(lobe, normaliser_position(cos_i, width), entries).x;
    return normal_density(theta_sum / deviation) / (deviation * gaussian_normaliser(cos_i, width) * ratio);
}

// N_TT = exp(-k cos phi) / (2 pi I0(k)) in a form that does not overflow.
float azimuthal_tt(float cos_half_phi, float k, float n_tt) {
    return n_tt * exp(-2.0 * k * cos_half_phi * cos_half_phi);
}

// S, per steradian, lobe by lobe, of theta_sum = theta_i + theta_o, cos theta_i and |cos(phi / 2)|.
void bcsdf(float theta_sum, float cos_i, float cos_half_phi, float variance, Scattering s, out vec3 r, out vec3 tt) {
    float m_r = longitudinal(theta_sum, cos_i, s.beta_r, variance, LOBE_R, s.entries);
    float m_tt = longitudinal(theta_sum, cos_i, s.beta_tt, variance, LOBE_TT, s.entries);
    vec3 rest = 1.0 - s.c_r;
    r = (s.c_r + rest * schlick(cos_i)) * (m_r * (1.0 / TWO_PI));
    // 1 - F, which cancels at grazing angles.
    tt = rest * s.c_tt * (schlick_rest(cos_i) * m_tt * azimuthal_tt(cos_half_phi, s.k_tt, s.n_tt));
}

// S cos(theta_i), lobe by lobe, of unit directions away from a fiber with unit `tangent`. `variance` is that of
// `longitudinal`.
void bcsdf_cos(
    vec3 tangent, vec3 to_light, vec3 to_eye, float variance, Scattering s, out vec3 r, out vec3 tt
) {
    r = vec3(0.0);
    tt = vec3(0.0);
    // Perpendicular to the tangent and to the directions: as long as the cosines, as far apart as the azimuths.
    vec3 across_i = cross(tangent, to_light);
    vec3 across_o = cross(tangent, to_eye);
    float cos_i = min(1.0, length(across_i));
    float cos_o = length(across_o);
    float sin_i = dot(tangent, to_light);
    float sin_o = dot(tangent, to_eye);
    float theta_sum = angle_of(sin_i * cos_o + cos_i * sin_o, cos_i * cos_o - sin_i * sin_o);
    float widest = max(s.beta_r, s.beta_tt);
    // Beyond eight deviations the lobes are below 2e-14 of their peaks.
    if (theta_sum * theta_sum > 64.0 * (widest * widest + variance)) {
        return;
    }
    vec3 some = any_perpendicular(tangent);
    vec3 azimuths = direction_or(across_i, some) + direction_or(across_o, some);
    bcsdf(theta_sum, cos_i, min(1.0, 0.5 * length(azimuths)), variance, s, r, tt);
    r *= cos_i;
    tt *= cos_i;
}

// Integrals over theta_i of M cos^2, of (1 - cos theta_i)^5 M cos^2 and of the rest of the first, toward
// theta_o: x_o = pi/2 - |theta_o| and its sine.
vec3 ambient_integrals(uint lobe, float x_o, float cos_o, float width, uint entries) {
    vec4 entry = scattering_table_at(lobe, ambient_position(x_o, width), entries);
    return entry.yzw * vec3(1.0, grazing_moment(cos_o, width), through_moment(cos_o, width));
}

// The integral of S cos(theta_i) over all directions of light, lobe by lobe (Wu & Yuksel 2019, Eq. 8).
void ambient_scattering(vec3 tangent, vec3 to_eye, Scattering s, out vec3 r, out vec3 tt) {
    float cos_o = min(1.0, length(cross(tangent, to_eye)));
    float x_o = angle_of(cos_o, abs(dot(tangent, to_eye)));
    vec3 reflected = ambient_integrals(LOBE_R, x_o, cos_o, s.beta_r, s.entries);
    vec3 rest = 1.0 - s.c_r;
    r = s.c_r * reflected.x + rest * reflected.y;
    tt = rest * s.c_tt * ambient_integrals(LOBE_TT, x_o, cos_o, s.beta_tt, s.entries).z;
}

#endif
