// Where hairs break a fiber, and how its drawn vertices keep to the break; twin: src/yarn/breaks.rs.
#ifndef WORSTED_BREAKS
#define WORSTED_BREAKS

#include "period.glsl"

// One vertex of a drawn fiber. It is joined to the next one along the yarn where that one's `entry` is
// at most one above its `exit`.
struct StrandVertex {
    float t;         // moved onto a hair's tip where that lies between this vertex and its neighbour
    Period period;
    float x;         // place in the period
    int entry;
    int exit;
};

// 0 up to the tip of the period's hair, 1 beyond.
int cut_side(Period period, float x) {
    return x <= hair_cut(period) ? 0 : 1;
}

// Marks a vertex on one side of its period: four numbers a period, the last of one next to the first of
// the following; the two sides of a break are three apart. Where periods count down along the yarn
// (`rate` < 0) the numbers are mirrored.
void mark(inout StrandVertex vertex, int side, float rate) {
    bool is_hair = vertex.period.kind == KIND_HAIR;
    int low = 4 * vertex.period.index + (is_hair && side == 1 ? 3 : 0);
    int high = 4 * vertex.period.index + (is_hair && side == 0 ? 0 : 3);
    vertex.entry = rate < 0.0 ? -high : low;
    vertex.exit = rate < 0.0 ? -low : high;
}

// Whether a hair's tip lies between a vertex that is left by `exit` and the next, reached by `entry`.
bool is_broken(int exit, int entry) {
    return entry - exit > 1;
}

// Whether the fiber, walking from `u` to `u_neighbour` (in period turns beyond the period `base`), meets the tip
// of the period's hair coming from outside the hair, and where that is.
bool meets_tip(Period period, int base, float u, float u_neighbour, out float tip) {
    tip = float(period.index - base) + hair_cut(period);
    if (period.kind != KIND_HAIR) {
        return false;
    }
    // The hair lies below its tip where its root comes first. A vertex on the tip is on the hair.
    return period.root_first ? u > tip && u_neighbour < tip : u < tip && u_neighbour > tip;
}

// The vertex on the tip of a period's hair.
StrandVertex tip_vertex(Period period, float t, float rate) {
    StrandVertex vertex;
    vertex.t = t;
    vertex.period = period;
    vertex.x = hair_cut(period);
    mark(vertex, period.root_first ? 0 : 1, rate);
    return vertex;
}

// The vertex at t between two at `neighbours`, which outside of 0 to 1 are none. Where a hair's tip lies between it and
// one of them, on whose side the hair is, the vertex moves onto the tip: hairs have their true length however coarsely
// drawn.
StrandVertex strand_vertex(Segment segment, Fiber fiber, uint fiber_index, float t, vec2 neighbours, Yarn yarn) {
    float u = period_turns(segment, fiber, t, yarn);
    float rate = period_rate(segment, yarn);
    int base = period_base(segment, yarn);
    int own_index = base + int(floor(u));
    Period own = draw_period(segment, fiber, fiber_index, own_index, yarn);
    for (int side = 0; side < 2; ++side) {
        float t_neighbour = neighbours[side];
        if (t_neighbour < -1e-4 || t_neighbour > 1.0001) {
            continue;
        }
        float u_neighbour = period_turns(segment, fiber, t_neighbour, yarn);
        float tip;
        if (meets_tip(own, base, u, u_neighbour, tip)) {
            return tip_vertex(own, t + (tip - u) / rate, rate);
        }
        int other_index = base + int(floor(u_neighbour));
        if (other_index != own_index) {
            Period other = draw_period(segment, fiber, fiber_index, other_index, yarn);
            if (meets_tip(other, base, u, u_neighbour, tip)) {
                return tip_vertex(other, t + (tip - u) / rate, rate);
            }
        }
    }
    StrandVertex vertex;
    vertex.t = t;
    vertex.period = own;
    vertex.x = fract(u);
    mark(vertex, cut_side(own, vertex.x), rate);
    return vertex;
}

#endif
