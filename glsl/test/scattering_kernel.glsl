// What the kernels of glsl/bsdf/khungurn.glsl share: tables of several widths, of which a row names those of its
// lobes. Filled by tests/gpu_vs_cpu/scattering_tables.rs.
#ifndef WORSTED_SCATTERING_KERNEL
#define WORSTED_SCATTERING_KERNEL

#include "scattering_numbers.glsl"

const uint TABLE_ENTRIES = 128; // `DEFAULT_ENTRIES` of src/precompute/scattering_table.rs

layout(std430, set = 0, binding = 2) readonly buffer Tables { vec4 tables[]; };

uint table_of_lobe[2];

vec4 scattering_entry(uint lobe, uint index) {
    return tables[table_of_lobe[lobe] * TABLE_ENTRIES + index];
}

// R, with the table that the row names.
uint take_lobe() {
    table_of_lobe[LOBE_R] = take_uint();
    return LOBE_R;
}

Scattering take_scattering() {
    table_of_lobe[LOBE_R] = take_uint();
    table_of_lobe[LOBE_TT] = take_uint();
    Scattering s = take_scattering_numbers();
    s.entries = TABLE_ENTRIES;
    return s;
}

#endif
