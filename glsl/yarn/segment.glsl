// What functions of a piece of yarn are told of it: src/yarn/strand.rs has its f64 twin, `Piece`.
#ifndef WORSTED_SEGMENT
#define WORSTED_SEGMENT

// One cubic piece of a yarn, unpacked. Turns are reduced to [0, 1]; a delta is what the piece adds, never the difference of
// two reduced values.
struct Segment {
    uint first_point;       // of four consecutive control points
    uint curve;
    int migration_period;   // whole periods of R before this piece
    uint migration_period_count; // periods of a closed curve; 0 on an open one
    float ply_turns;        // ply rotation about the yarn, in turns
    float fiber_turns;      // fiber twist inside the ply frame, in turns
    float migration_turns;  // phase of R, in turns
    float length_start;     // rest length of the curve before this piece, modulo LENGTH_STRIPE
    float ply_turns_delta;
    float fiber_turns_delta;
    float migration_turns_delta;
    float length_mm;        // rest length of this piece
};

#endif
