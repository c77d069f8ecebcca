// The numbers of a fiber's scattering in a row of arguments, whatever tables it reads.
#ifndef WORSTED_SCATTERING_NUMBERS
#define WORSTED_SCATTERING_NUMBERS

#include "kernel.glsl"
#include "../bsdf/khungurn.glsl"

Scattering take_scattering_numbers() {
    Scattering s;
    s.c_r = take_vec3();
    s.c_tt = take_vec3();
    s.beta_r = take_float();
    s.beta_tt = take_float();
    s.k_tt = take_float();
    s.n_tt = take_float();
    return s;
}

#endif
