// What a debug view shows of a vertex, in one word.
#ifndef WORSTED_SHOWN
#define WORSTED_SHOWN

#include "../shared/debug_views.glsl"
#include "level.glsl"

// Stripes along the yarn where its normal (red) and binormal (green) point.
vec3 frame_color(FiberPoint f, vec3 yarn_tangent) {
    vec3 outward = direction_or(f.position - f.yarn_center, f.yarn_normal);
    float along_normal = dot(outward, f.yarn_normal);
    float along_binormal = dot(outward, cross(yarn_tangent, f.yarn_normal));
    return along_normal > 0.9 ? vec3(0.9, 0.1, 0.05) : along_binormal > 0.9 ? vec3(0.1, 0.7, 0.1) : vec3(0.45);
}

vec3 length_color(Segment segment, float t) {
    float turns = (segment.length_start + t * segment.length_mm) / LENGTH_STRIPE;
    vec3 hue = 0.5 + 0.45 * cos(TWO_PI * (turns + vec3(0.0, 1.0, 2.0) / 3.0));
    return fract(turns) < 0.06 ? vec3(0.05) : hue;
}

// From blue (the core alone) over green to red (every fiber that is ever drawn one by one).
vec3 detail_color(vec3 position) {
    float share = CORE_FIBERS ? detail_at(pixel_mm_at(position)).kept / max(yarn.core_ranks, 1e-6) : 1.0;
    return clamp(vec3(2.0 * share - 0.6, 1.0 - 2.0 * abs(share - 0.5), 1.2 - 3.0 * share), 0.0, 1.0);
}

int shown(Segment segment, FiberPoint f, uint kind, float t) {
    if (DEBUG_VIEW == VIEW_FRAME) {
        vec3 b[4];
        fetch_bezier(segment.first_point, b);
        vec3 yarn_tangent = piece_tangent(b, bezier_point(b, t).derivative);
        return int(packUnorm4x8(vec4(frame_color(f, yarn_tangent), 1.0)));
    }
    if (DEBUG_VIEW == VIEW_LENGTH) {
        return int(packUnorm4x8(vec4(length_color(segment, t), 1.0)));
    }
    if (DEBUG_VIEW == VIEW_LEVEL_OF_DETAIL) {
        return int(packUnorm4x8(vec4(detail_color(f.yarn_center), 1.0)));
    }
    return int(kind);
}

#endif
