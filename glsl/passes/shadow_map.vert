#version 460
// Places a corner of a yarn's ribbon as a light sees it.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../lib/curve.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/tube.glsl"

layout(push_constant) uniform Constants {
    uint view_index;
};

layout(location = 0) out float depth_mm;
layout(location = 1) flat out uint piece;

void main() {
    ShadowView view = shadow_views[view_index];
    uint row = uint(gl_VertexIndex) / 2u;
    float edge = float(gl_VertexIndex & 1) * 2.0 - 1.0;
    uint index = uint(gl_InstanceIndex);
    vec3 b[4];
    fetch_bezier(first_point_of(index), b);
    CurvePoint at = bezier_point(b, tube_row(row));
    vec3 tangent = piece_tangent(b, at.derivative);
    vec3 toward = direction_or(view.toward.xyz - view.toward.w * at.position, vec3(0.0, 0.0, 1.0));
    vec3 corner = tube_corner(at.position, tangent, toward, yarn.shadow_radius, row, edge);
    gl_Position = view.clip_from_world * vec4(corner, 1.0);
    depth_mm = dot(view.depth_axis.xyz, corner) + view.depth_axis.w;
    piece = yarn.first_piece + index;
}
