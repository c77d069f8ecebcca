// Scattering tables of which a row of arguments holds the few entries that are read; filled by
// src/probe/entries.rs.
#ifndef WORSTED_PROBE_ENTRIES
#define WORSTED_PROBE_ENTRIES

#include "../test/scattering_numbers.glsl"

const uint KEPT = 4; // entries in a row

uint first_entry[2];
uint entries_at[2];

vec4 scattering_entry(uint lobe, uint index) {
    uint kept = index - first_entry[lobe];
    uint at = entries_at[lobe] + 4 * kept;
    // No number where the row does not hold the entry.
    return kept < KEPT ? uintBitsToFloat(uvec4(inputs[at], inputs[at + 1], inputs[at + 2], inputs[at + 3]))
                       : vec4(uintBitsToFloat(0x7fc00000u));
}

// The entries of one lobe; returns how many the whole table has.
uint take_entries(uint lobe) {
    uint entries = take_uint();
    first_entry[lobe] = take_uint();
    entries_at[lobe] = next_input;
    next_input += 4 * KEPT;
    return entries;
}

Scattering take_scattering() {
    Scattering s = take_scattering_numbers();
    s.entries = take_entries(LOBE_R);
    take_entries(LOBE_TT);
    return s;
}

#endif
