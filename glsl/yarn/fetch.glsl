// Reads one piece of yarn from the buffers of passes/bindings.glsl and places fibers on it.
#ifndef WORSTED_FETCH
#define WORSTED_FETCH

#include "fiber.glsl"
#include "breaks.glsl"
#include "pieces.glsl"

// First and last control point of a piece that lie on (or next to) its knots carry its normals.
const uint KNOT_START = BASIS == BASIS_BEZIER ? 0 : 1;
const uint KNOT_END = BASIS == BASIS_BEZIER ? 3 : 2;

// The piece that begins with this control point as a Bezier curve.
void fetch_bezier(uint first_point, out vec3 b[4]) {
    for (uint k = 0; k < 4; ++k) {
        b[k] = control_points[first_point + k].position;
    }
    bezier_from_basis(b, BASIS);
}

// Where a piece of yarn runs: its Bezier curve, and the unit normals of its knots.
struct Span {
    vec3 bezier[4];
    vec3 normal_start;
    vec3 normal_end;
};

// That of the piece that begins with this control point.
Span fetch_span(uint first_point) {
    Span span;
    fetch_bezier(first_point, span.bezier);
    span.normal_start = unit_from_octahedral(control_points[first_point + KNOT_START].normal_octahedral);
    span.normal_end = unit_from_octahedral(control_points[first_point + KNOT_END].normal_octahedral);
    return span;
}

// The control point in the frame after the one that is drawn, or before it.
ControlPoint fetch_neighbour(uint index, bool after) {
    if (after) {
        return points_after[index];
    }
    return points_before[index];
}

// The same piece where one of these frames has it.
Span fetch_neighbour_span(uint first_point, bool after) {
    Span span;
    for (uint k = 0; k < 4; ++k) {
        span.bezier[k] = fetch_neighbour(first_point + k, after).position;
    }
    bezier_from_basis(span.bezier, BASIS);
    span.normal_start = unit_from_octahedral(fetch_neighbour(first_point + KNOT_START, after).normal_octahedral);
    span.normal_end = unit_from_octahedral(fetch_neighbour(first_point + KNOT_END, after).normal_octahedral);
    return span;
}

// A fiber at t of the piece, in the given shape.
FiberPoint fetch_fiber_point(Segment segment, Span span, Fiber fiber, float t, FiberShape shape) {
    YarnPoint yarn_at = yarn_point(span.bezier, span.normal_start, span.normal_end, t);
    return fiber_point(yarn_at, twist_at(segment, t), yarn, fiber, shape);
}

// The fiber at exactly t, whatever it is there.
FiberPoint fetch_fiber_at(Segment segment, Span span, uint fiber_index, float t, out Period period) {
    Fiber fiber = fibers[fiber_index];
    if (!FLYAWAYS) {
        period.kind = KIND_MIGRATION;
        Twist twist = twist_at(segment, t);
        FiberShape shape = migration_shape(fiber, twist.migration, twist.migration_rate, yarn);
        return fetch_fiber_point(segment, span, fiber, t, shape);
    }
    float u = period_turns(segment, fiber, t, yarn);
    period = draw_period(segment, fiber, fiber_index, period_base(segment, yarn) + int(floor(u)), yarn);
    FiberShape shape = period_shape(fiber, period, fract(u), period_rate(segment, yarn), yarn);
    return fetch_fiber_point(segment, span, fiber, t, shape);
}

// A vertex of the fiber, with what joins it to those at `neighbours`.
FiberPoint fetch_fiber_vertex(Segment segment, Span span, uint fiber_index, float t, vec2 neighbours,
                              out StrandVertex vertex) {
    Fiber fiber = fibers[fiber_index];
    vertex = strand_vertex(segment, fiber, fiber_index, t, neighbours, yarn);
    FiberShape shape = period_shape(fiber, vertex.period, vertex.x, period_rate(segment, yarn), yarn);
    return fetch_fiber_point(segment, span, fiber, vertex.t, shape);
}

#endif
