// Shadows between yarns (Wu & Yuksel 2019, Sec. 4.1); twin: src/scene/shadow_light.rs.
#ifndef WORSTED_SHADOW_MAP
#define WORSTED_SHADOW_MAP

#include "../shared/layouts.glsl"

// Largest cotangent of the angle between light and yarn for which a yarn's own tube is told from others.
const float SHADOW_STEEPEST = 24.0;
// Room around that, for texels beside the one that a fiber falls on.
const float SHADOW_MARGIN = 1.3;
// How much nearer to the light than a fiber a tube's centre must be to hide it, in the fiber's yarn's radii:
// tubes that touch are at least one apart where one lies on the other.
const float SHADOW_BIAS = 0.5;
// Most texels that a soft shadow is blurred over, to either side.
const float SHADOW_WIDEST = 24.0;
// Places at which a soft shadow is looked up, for the distance of what hides and for the share that is hidden.
const uint SHADOW_TAPS = 16;
const float GOLDEN_ANGLE = 2.39996323;

// Pieces of its own yarn, to either side, whose tube may lie between a fiber and the light without hiding it:
// inside the tube, shadow is another table's matter. `along` is the cosine of the angle between light and yarn.
float shadow_window(float along, float radius, float piece_length) {
    float across = sqrt(max(1.0 - along * along, 0.0));
    float cotangent = min(abs(along) / max(across, 1e-6), SHADOW_STEEPEST);
    // Along the yarn a fiber on the far side lies one cotangent from the ribbon, and a cap reaches another.
    return 1.0 + 2.0 * radius * (1.0 + SHADOW_MARGIN * cotangent) / max(piece_length, 1e-6);
}

// Place in the map's texels (the first one's centre is at 0.5), and depth in mm away from the light.
vec3 shadow_place(ShadowView view, vec3 position, float resolution) {
    vec4 clip = view.clip_from_world * vec4(position, 1.0);
    vec2 place = (0.5 + 0.5 * clip.xy / max(clip.w, 1e-6)) * resolution;
    return vec3(place, dot(view.depth_axis.xyz, position) + view.depth_axis.w);
}

// Which of a point light's six views looks along `from_light`.
uint shadow_face(vec3 from_light) {
    vec3 size = abs(from_light);
    if (size.x >= size.y && size.x >= size.z) {
        return from_light.x > 0.0 ? 0u : 1u;
    }
    if (size.y >= size.z) {
        return from_light.y > 0.0 ? 2u : 3u;
    }
    return from_light.z > 0.0 ? 4u : 5u;
}

// Whether what the map holds hides a fiber of piece `piece` (counted through all yarns) at `depth`. A texel is the
// bits of a depth, and a piece's number plus one or 0 for nothing.
bool shadow_hides(uvec2 texel, float depth, uint piece, float window) {
    if (texel.y == 0u) {
        return false;
    }
    uint other = texel.y - 1u;
    uint apart = other > piece ? other - piece : piece - other;
    return uintBitsToFloat(texel.x) < depth && float(apart) > window;
}

// Places on a disk of radius 1, equally dense, turned by `turn` radians (Vogel 1979).
vec2 shadow_tap(uint tap, float turn) {
    float radius = sqrt((float(tap) + 0.5) / float(SHADOW_TAPS));
    float angle = float(tap) * GOLDEN_ANGLE + turn;
    return radius * vec2(cos(angle), sin(angle));
}

#endif
