// The one function that places a fiber; twin: src/yarn/fiber.rs.
#ifndef WORSTED_FIBER
#define WORSTED_FIBER

#include "../shared/constants.glsl"
#include "../shared/layouts.glsl"
#include "../lib/curve.glsl"
#include "../lib/frame.glsl"
#include "period.glsl"

// Rotations at one point of a yarn, and what the whole piece adds to them; radians.
struct Twist {
    float ply;
    float fiber;
    float migration;
    float ply_rate;
    float fiber_rate;
    float migration_rate;
};

// The yarn's centre and orthonormal frame at one point.
struct YarnPoint {
    vec3 center;
    vec3 tangent;
    vec3 normal;
    float speed;    // |d center / dt|
    vec3 bend;      // d^2 center / dt^2
};

struct FiberPoint {
    vec3 yarn_center;
    vec3 yarn_normal;
    vec3 ply_center;
    vec3 ply_normal;       // unit, from the yarn's centre to the ply's
    vec3 ply_binormal;     // unit, around the yarn
    vec3 position;
    vec3 tangent;          // unit, along the fiber
    float center_distance; // from the yarn's centre line, in the cross-section
    float width;           // share of the fiber's full width
    float radius;          // R
};

// Rotations at t of a piece. Reduced before the multiplication by 2 pi, so that no angle is large.
Twist twist_at(Segment segment, float t) {
    Twist twist;
    twist.ply = TWO_PI * fract(segment.ply_turns + t * segment.ply_turns_delta);
    twist.fiber = TWO_PI * fract(segment.fiber_turns + t * segment.fiber_turns_delta);
    twist.migration = TWO_PI * fract(segment.migration_turns + t * segment.migration_turns_delta);
    twist.ply_rate = TWO_PI * segment.ply_turns_delta;
    twist.fiber_rate = TWO_PI * segment.fiber_turns_delta;
    twist.migration_rate = TWO_PI * segment.migration_turns_delta;
    return twist;
}

// Unit tangent of the Bezier piece `b` where its derivative is `derivative`. A cusp or a zero-length
// piece has none: the chord stands in, then the legs.
vec3 piece_tangent(vec3 b[4], vec3 derivative) {
    return direction_or(derivative, direction_or(b[3] - b[0], direction_or(b[2] - b[1], vec3(1.0, 0.0, 0.0))));
}

// The unit `normal` turned by the smallest rotation that takes the unit tangent `from` to `to`, times
// 1 + from . to: no division, so no pole where the yarn doubles back. What of it lies along `from` comes to lie along
// `to`: packed normals are not quite perpendicular.
vec3 turned_normal(vec3 from, vec3 to, vec3 normal) {
    float more = 1.0 + dot(from, to);
    float along = dot(normal, from);
    return more * (normal + 2.0 * along * to) - (along + dot(normal, to)) * (from + to);
}

// Centre and frame at t of the Bezier piece `b` whose knots carry the given unit normals. Both
// normals are turned to the tangent at t and blended, the nearer one and the less turned one first.
YarnPoint yarn_point(vec3 b[4], vec3 normal_start, vec3 normal_end, float t) {
    CurvePoint c = bezier_point(b, t);
    YarnPoint y;
    y.center = c.position;
    y.speed = length(c.derivative);
    y.bend = c.second_derivative;
    y.tangent = piece_tangent(b, c.derivative);
    vec3 start = turned_normal(piece_tangent(b, b[1] - b[0]), y.tangent, normal_start);
    vec3 end = turned_normal(piece_tangent(b, b[3] - b[2]), y.tangent, normal_end);
    y.normal = normal_perpendicular_to(y.tangent, (1.0 - t) * start + t * end);
    return y;
}

// R of the ply's surface: fibers that only migrate lie within.
float surface_radius(Yarn yarn) {
    return max(1.0, yarn.migration_max);
}

// Wu & Yuksel 2019, Sec. 3.1: ply centre, then the fiber inside the ply's rotating elliptical frame.
FiberPoint fiber_point(YarnPoint yarn_at, Twist twist, Yarn yarn, Fiber fiber, FiberShape shape) {
    float ply_angle = TWO_PI * float(fiber.ply) / float(yarn.ply_count) + twist.ply;
    float fiber_angle = fiber.angle + twist.fiber + shape.angle;
    float fiber_rate = twist.fiber_rate + shape.angle_rate;
    float cos_fiber = cos(fiber_angle);
    float sin_fiber = sin(fiber_angle);

    // Offsets in the ply's frame: x away from the yarn's centre, y around it.
    float x = shape.radius * cos_fiber * yarn.ellipse_short;
    float y = shape.radius * sin_fiber * yarn.ellipse_long;
    float x_rate = (shape.radius_rate * cos_fiber - shape.radius * sin_fiber * fiber_rate) * yarn.ellipse_short;
    float y_rate = (shape.radius_rate * sin_fiber + shape.radius * cos_fiber * fiber_rate) * yarn.ellipse_long;
    // What lies beyond the ply's surface stands out by a length of its own where the ply is flat.
    float beyond = max(shape.radius - surface_radius(yarn), 0.0);
    float beyond_rate = beyond > 0.0 ? shape.radius_rate : 0.0;
    x += beyond * cos_fiber * yarn.beyond_short;
    y += beyond * sin_fiber * yarn.beyond_long;
    x_rate += (beyond_rate * cos_fiber - beyond * sin_fiber * fiber_rate) * yarn.beyond_short;
    y_rate += (beyond_rate * sin_fiber + beyond * cos_fiber * fiber_rate) * yarn.beyond_long;

    vec3 binormal = cross(yarn_at.tangent, yarn_at.normal);
    vec3 normal_ply = cos(ply_angle) * yarn_at.normal + sin(ply_angle) * binormal;
    vec3 binormal_ply = cross(yarn_at.tangent, normal_ply);
    float away = yarn.ply_offset + x;
    vec3 from_center = away * normal_ply + y * binormal_ply;

    FiberPoint f;
    f.yarn_center = yarn_at.center;
    f.yarn_normal = yarn_at.normal;
    f.ply_normal = normal_ply;
    f.ply_binormal = binormal_ply;
    f.ply_center = yarn_at.center + yarn.ply_offset * normal_ply;
    f.position = yarn_at.center + from_center;
    f.center_distance = length(vec2(away, y));
    f.width = shape.width;
    f.radius = shape.radius;
    // On the inside of a bend the fiber advances less than the centre line.
    float bend_speed = dot(from_center, yarn_at.bend) / max(yarn_at.speed, 1e-12);
    vec3 velocity = (yarn_at.speed - bend_speed) * yarn_at.tangent
                  + (x_rate - twist.ply_rate * y) * normal_ply
                  + (y_rate + twist.ply_rate * away) * binormal_ply;
    f.tangent = direction_or(velocity, yarn_at.tangent);
    return f;
}

#endif
