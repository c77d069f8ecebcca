// Where the nodes of a baked table lie in its texture; twin: src/precompute/table.rs.
#ifndef WORSTED_TABLE
#define WORSTED_TABLE

// Texture coordinate of `share` in [0, 1] of a side whose first and last texels lie on its ends, so that
// clamping at the texture's edge clamps at the table's.
float node_coordinate(float share, uint texels) {
    float count = float(texels);
    return (share * (count - 1.0) + 0.5) / count;
}

#endif
