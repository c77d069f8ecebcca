#version 460
// Places one vertex of one fiber.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../shared/debug_views.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_segment;
layout(location = 1) patch in uint patch_first_fiber;
layout(location = 2) patch in uint patch_fibers;
layout(location = 3) patch in uint patch_pieces;

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec4 tangent_world;   // a: share of the fiber's width
layout(location = 2) out float center_distance;
layout(location = 3) out uint fiber_index;
layout(location = 4) out ivec4 joining;        // entry, exit, what a debug view shows, place along the piece

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

// What a debug view shows of this vertex, in one word.
int shown(FiberPoint f, uint kind, float t) {
    Segment segment = segments[patch_segment];
    if (DEBUG_VIEW == VIEW_FRAME) {
        vec3 b[4];
        fetch_bezier(segment, b);
        vec3 yarn_tangent = piece_tangent(b, bezier_point(b, t).derivative);
        return int(packUnorm4x8(vec4(frame_color(f, yarn_tangent), 1.0)));
    }
    if (DEBUG_VIEW == VIEW_LENGTH) {
        return int(packUnorm4x8(vec4(length_color(segment, t), 1.0)));
    }
    return int(kind);
}

void main() {
    // TessCoord is 16.16 fixed point on some drivers: round, never floor.
    fiber_index = patch_first_fiber + uint(gl_TessCoord.y * float(patch_fibers) + 0.5);
    float place = floor(gl_TessCoord.x * float(patch_pieces) + 0.5);
    float t = place / float(patch_pieces);
    FiberPoint f;
    if (FLYAWAYS) {
        StrandVertex vertex;
        f = fetch_fiber_vertex(patch_segment, fiber_index, t, patch_pieces, vertex);
        // Beyond its tip a hair's period goes on as a fiber that only migrates.
        bool migrates = vertex.period.kind == KIND_HAIR && !on_hair(vertex.period, vertex.x);
        uint kind = migrates ? KIND_MIGRATION : vertex.period.kind;
        joining = ivec4(vertex.entry, vertex.exit, shown(f, kind, vertex.t), int(place));
    } else {
        Period period;
        f = fetch_fiber_at(patch_segment, fiber_index, t, period);
        joining = ivec4(0, 0, shown(f, period.kind, t), int(place));
    }
    position_world = f.position;
    tangent_world = vec4(f.tangent, f.width);
    center_distance = f.center_distance;
}
