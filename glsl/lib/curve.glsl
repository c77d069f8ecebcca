// One cubic piece of a centre line; twin: src/math/curve.rs.
#ifndef WORSTED_CURVE
#define WORSTED_CURVE

const uint BASIS_CATMULL_ROM = 0;
const uint BASIS_B_SPLINE = 1;
const uint BASIS_BEZIER = 2;
const uint BASIS_POLYLINE = 3;

struct CurvePoint {
    vec3 position;
    vec3 derivative;
    vec3 second_derivative;
};

// The same piece as a Bezier curve, whose control points bound it.
void bezier_from_basis(inout vec3 p[4], uint basis) {
    if (basis == BASIS_CATMULL_ROM) {
        vec3 b1 = p[1] + (p[2] - p[0]) * (1.0 / 6.0);
        vec3 b2 = p[2] - (p[3] - p[1]) * (1.0 / 6.0);
        p[0] = p[1];
        p[3] = p[2];
        p[1] = b1;
        p[2] = b2;
    } else if (basis == BASIS_B_SPLINE) {
        vec3 b1 = mix(p[1], p[2], 1.0 / 3.0);
        vec3 b2 = mix(p[1], p[2], 2.0 / 3.0);
        vec3 b0 = 0.5 * (mix(p[0], p[1], 2.0 / 3.0) + b1);
        vec3 b3 = 0.5 * (b2 + mix(p[2], p[3], 1.0 / 3.0));
        p[0] = b0;
        p[1] = b1;
        p[2] = b2;
        p[3] = b3;
    } else if (basis == BASIS_POLYLINE) {
        vec3 b1 = mix(p[1], p[2], 1.0 / 3.0);
        vec3 b2 = mix(p[1], p[2], 2.0 / 3.0);
        p[0] = p[1];
        p[3] = p[2];
        p[1] = b1;
        p[2] = b2;
    }
}

// Position and derivatives by t of the Bezier piece `b` at t in [0, 1].
CurvePoint bezier_point(vec3 b[4], float t) {
    float s = 1.0 - t;
    vec3 d0 = b[1] - b[0];
    vec3 d1 = b[2] - b[1];
    vec3 d2 = b[3] - b[2];
    CurvePoint c;
    // Offsets from the nearer end, so that a short piece far from the origin keeps its digits.
    c.position = t < 0.5
        ? b[0] + t * (3.0 * d0 + t * (3.0 * (d1 - d0) + t * (d2 - 2.0 * d1 + d0)))
        : b[3] - s * (3.0 * d2 + s * (3.0 * (d1 - d2) + s * (d0 - 2.0 * d1 + d2)));
    c.derivative = 3.0 * (s * s * d0 + 2.0 * s * t * d1 + t * t * d2);
    c.second_derivative = 6.0 * (s * (d1 - d0) + t * (d2 - d1));
    return c;
}

// The same for four control points of any basis. Works on offsets from a point of the piece, so that
// derivatives keep their digits far from the origin.
CurvePoint curve_point(vec3 p[4], uint basis, float t) {
    vec3 origin = p[1];
    for (int k = 0; k < 4; ++k) {
        p[k] -= origin;
    }
    bezier_from_basis(p, basis);
    CurvePoint c = bezier_point(p, t);
    c.position += origin;
    return c;
}

#endif
