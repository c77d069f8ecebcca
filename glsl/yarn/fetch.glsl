// Reads one piece of yarn from the buffers of passes/bindings.glsl and places fibers on it.
#ifndef WORSTED_FETCH
#define WORSTED_FETCH

#include "fiber.glsl"

// First and last control point of a piece that lie on (or next to) its knots carry its normals.
const uint KNOT_START = BASIS == BASIS_BEZIER ? 0 : 1;
const uint KNOT_END = BASIS == BASIS_BEZIER ? 3 : 2;

// The piece as a Bezier curve.
void fetch_bezier(Segment segment, out vec3 b[4]) {
    for (uint k = 0; k < 4; ++k) {
        b[k] = control_points[segment.first_point + k].position;
    }
    bezier_from_basis(b, BASIS);
}

// The fiber with this index in the yarn's table, at t of the piece.
FiberPoint fetch_fiber_point(uint segment_index, uint fiber_index, float t) {
    Segment segment = segments[segment_index];
    vec3 b[4];
    fetch_bezier(segment, b);
    vec3 normal_start = unit_from_octahedral(control_points[segment.first_point + KNOT_START].normal_octahedral);
    vec3 normal_end = unit_from_octahedral(control_points[segment.first_point + KNOT_END].normal_octahedral);
    YarnPoint yarn_at = yarn_point(b, normal_start, normal_end, t);
    return fiber_point(yarn_at, twist_at(segment, t), yarn, fibers[fiber_index]);
}

#endif
