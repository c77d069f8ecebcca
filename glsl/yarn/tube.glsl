// A yarn as a light sees it: a ribbon as wide as the tube around all of its plies; twin: src/yarn/tube.rs.
#ifndef WORSTED_TUBE
#define WORSTED_TUBE

#include "../shared/constants.glsl"
#include "../lib/strip.glsl"

// Rows of two corners.
const uint TUBE_ROWS = TUBE_CORNERS / 2;
// Half-width of the ends' caps as a share of the radius: of an octagon around the tube's round end.
const float TUBE_CAP = 0.41421356;

// t of a row on its piece of yarn.
float tube_row(uint row) {
    return clamp((float(row) - 1.0) / float(TUBE_STEPS), 0.0, 1.0);
}

// A corner of the ribbon: `edge` is -1 or 1, `center` and `tangent` (unit) the yarn's at the row's t, and
// `toward` a unit vector toward the light. The ribbon runs through the yarn's centre, so that what it hides
// lies a radius behind the tube's surface: a tube never hides its own surface from a light that it faces.
vec3 tube_corner(vec3 center, vec3 tangent, vec3 toward, float radius, uint row, float edge) {
    // Where the yarn points at the light its side is rounding, that may point anywhere.
    vec3 side = normal_perpendicular_to(toward, strip_side(tangent, toward));
    vec3 along = cross(toward, side);
    bool first = row == 0u;
    bool last = row == TUBE_ROWS - 1u;
    float half_width = first || last ? TUBE_CAP : 1.0;
    float beyond = first ? -1.0 : last ? 1.0 : 0.0;
    return center + radius * (edge * half_width * side + beyond * along);
}

#endif
