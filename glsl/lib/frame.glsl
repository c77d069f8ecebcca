// Directions and frames that stay finite; twin: src/math/frame.rs.
#ifndef WORSTED_FRAME
#define WORSTED_FRAME

// Below this squared length a vector has no direction (the square of the smallest mm that matters).
const float NO_DIRECTION = 1e-24;

// A unit vector from two 16-bit snorms (octahedral map, Meyer et al. 2010).
vec3 unit_from_octahedral(uint bits) {
    vec2 e = vec2(ivec2(int(bits << 16) >> 16, int(bits) >> 16)) * (1.0 / 32767.0);
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-v.z, 0.0);
    v.x += v.x >= 0.0 ? -fold : fold;
    v.y += v.y >= 0.0 ? -fold : fold;
    return normalize(v);
}

// Some unit vector perpendicular to the unit vector `v`: never degenerate (Duff et al. 2017).
vec3 any_perpendicular(vec3 v) {
    float s = v.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + v.z);
    return vec3(1.0 + s * v.x * v.x * a, s * v.x * v.y * a, -s * v.x);
}

// v / |v|, or `fallback` where v has no direction.
vec3 direction_or(vec3 v, vec3 fallback) {
    // Scaled first: squares of tiny or huge components would leave f32's range.
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    vec3 scaled = v / max(largest, 1e-30);
    return largest * largest > NO_DIRECTION ? normalize(scaled) : fallback;
}

// The part of `normal` perpendicular to the unit `tangent`, as a unit vector. Where the two are nearly
// parallel the difference is rounding that may point anywhere, along the tangent too: what is left of
// its direction after a second subtraction is perpendicular, or too short to be used.
vec3 normal_perpendicular_to(vec3 tangent, vec3 normal) {
    vec3 some = any_perpendicular(tangent);
    vec3 n = direction_or(normal - tangent * dot(tangent, normal), some);
    n -= tangent * dot(tangent, n);
    return dot(n, n) > 0.5 ? normalize(n) : some;
}

#endif
