// What the passes over fibers read; twin of the set layouts: src/passes/fibers.rs.
#ifndef WORSTED_BINDINGS
#define WORSTED_BINDINGS

#include "../shared/layouts.glsl"
#include "../shared/features.glsl"

layout(std140, set = 0, binding = 0) uniform FrameBlock { Frame frame; };
layout(std430, set = 0, binding = 1) buffer StatisticsBlock { Statistics statistics; };
layout(std430, set = 0, binding = 2) readonly buffer LightBlock { Light lights[]; };
layout(std430, set = 0, binding = 3) readonly buffer ShadowViewBlock { ShadowView shadow_views[]; };

layout(std430, set = 1, binding = 0) readonly buffer ControlPointBlock { ControlPoint control_points[]; };
layout(std430, set = 1, binding = 1) readonly buffer PieceBlock { Piece yarn_pieces[]; }; // and one behind them
layout(std430, set = 1, binding = 2) readonly buffer FiberBlock { Fiber fibers[]; };
layout(std430, set = 1, binding = 3) readonly buffer YarnBlock { Yarn yarn; };

// The core texture: glsl/passes/surface.glsl reads it. Layer ply * CORE_LEVELS + level.
layout(set = 1, binding = 4) uniform sampler2DArray core_normals; // means of sin phi, cos phi, sin 2 phi, cos 2 phi
layout(set = 1, binding = 5) uniform sampler2DArray core_shape;   // coverage, height, slope
layout(set = 1, binding = 6) uniform sampler2DArray core_spread;  // mean squares and product of the slope, mean square of the height

// Of R and then of TT: src/precompute/scattering_table.rs.
layout(std430, set = 1, binding = 7) readonly buffer ScatteringBlock { vec4 scattering_table[]; };

// Of the yarn's cross-section: src/precompute/self_shadow.rs and occlusion_table.rs.
layout(set = 1, binding = 8) uniform sampler3D self_shadow_table;
layout(set = 1, binding = 9) uniform sampler2D occlusion_table;

// For each control point four halves: src/precompute/sky.rs.
layout(std430, set = 1, binding = 10) readonly buffer SkyBlock { uvec2 skies[]; };

layout(std430, set = 1, binding = 11) readonly buffer CurveBlock { Curve curves[]; };

// Where the frames before and after have the control points: src/frame/layers.rs.
layout(std430, set = 1, binding = 12) readonly buffer BeforeBlock { ControlPoint points_before[]; };
layout(std430, set = 1, binding = 13) readonly buffer AfterBlock { ControlPoint points_after[]; };

#endif
