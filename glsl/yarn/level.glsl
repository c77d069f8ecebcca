// How finely a piece of yarn is cut, and whether it is in view; twin: src/yarn/level.rs.
#ifndef WORSTED_LEVEL
#define WORSTED_LEVEL

#include "../shared/constants.glsl"
#include "../lib/frame.glsl"

// Angle between two directions that may be zero-length: 0 where one has none.
float turning_angle(vec3 a, vec3 b) {
    vec3 u = direction_or(a, vec3(0.0));
    vec3 v = direction_or(b, vec3(0.0));
    return atan(length(cross(u, v)), dot(u, v));
}

// Pieces a fiber is cut into: enough for the turns it makes around its ply and with the yarn, and
// for the bending of the centre line (`b`: the piece as a Bezier curve). At least 1.
uint subdivisions(vec3 b[4], float ply_turns, float fiber_turns, float per_turn, uint largest) {
    float bend = turning_angle(b[1] - b[0], b[2] - b[1]) + turning_angle(b[2] - b[1], b[3] - b[2]);
    float turns = abs(ply_turns) + abs(fiber_turns) + bend / TWO_PI;
    return uint(clamp(ceil(turns * per_turn), 1.0, float(largest)));
}

// Whether everything within `margin` of the Bezier curve `b` lies outside one of the planes.
bool outside_frustum(vec3 b[4], float margin, vec4 planes[5]) {
    for (int i = 0; i < 5; ++i) {
        float nearest = -margin;
        bool outside = true;
        for (int k = 0; k < 4; ++k) {
            outside = outside && dot(planes[i].xyz, b[k]) + planes[i].w < nearest;
        }
        if (outside) {
            return true;
        }
    }
    return false;
}

#endif
