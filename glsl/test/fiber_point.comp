#version 460
// Runs the renderer's own fiber function over a list of queries, for tests against the f64 twin.
#extension GL_GOOGLE_include_directive : require
#include "../passes/bindings.glsl"
#include "../yarn/fetch.glsl"

layout(local_size_x = 64) in;

struct Query { uint segment; uint fiber; float t; uint padding; };
struct Answer { vec4 position; vec4 tangent; };

layout(std430, set = 2, binding = 0) readonly buffer QueryBlock { Query queries[]; };
layout(std430, set = 2, binding = 1) writeonly buffer AnswerBlock { Answer answers[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= queries.length()) {
        return;
    }
    Period period;
    Segment segment = segment_at(queries[i].segment);
    Span span = fetch_span(segment.first_point);
    FiberPoint f = fetch_fiber_at(segment, span, queries[i].fiber, queries[i].t, period);
    answers[i].position = vec4(f.position, f.center_distance);
    answers[i].tangent = vec4(f.tangent, float(period.kind));
}
