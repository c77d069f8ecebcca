// Every struct the host writes; twins in src/gpu_types.rs, held equal by tests/layouts.
#ifndef WORSTED_LAYOUTS
#define WORSTED_LAYOUTS

#include "constants.glsl"

// One control point of a yarn: 16 bytes. Lengths in mm, relative to the scene's origin.
struct ControlPoint {
    vec3 position;
    uint normal_octahedral; // rest-frame normal of the knot, two 16-bit snorms
};

// One cubic piece of a yarn: 8 bytes. glsl/yarn/packed.glsl reads it.
struct Piece {
    uint length_low;        // rest length of the curve before it, in 2^-42 of the curve's
    uint length_high_curve; // its 10 high bits, and above them the curve's place in the table
};

// What all pieces of a curve share: 64 bytes. Phases in 2^-32 turns, rates in 2^-64 turns per unit of length.
struct Curve {
    uint first_point;       // of piece 0 if it were of this curve
    uint curve;
    uint migration_period_count; // periods of a closed curve; 0 on an open one that does not count anew
    uint ply_phase;
    uint fiber_phase;
    uint migration_phase;
    uvec2 ply_rate;         // low word, high word; two's complement
    uvec2 fiber_rate;
    uvec2 migration_rate;
    uvec2 stripe_rate;      // of LENGTH_STRIPE
    float length_mm;        // of the whole curve at rest
    uint padding;
};

// One fiber of the cross-section: 16 bytes.
struct Fiber {
    float radius;           // R_i, 0..1 of the ply's ellipse
    float angle;            // theta_i, radians, in the ply frame
    float migration_phase;  // m_i, radians
    uint ply;
};

// What all yarns of one fabric share. Lengths in mm.
struct Yarn {
    uint ply_count;
    uint fiber_count;       // of all plies together
    float ply_offset;       // ply centre's distance from the yarn's centre: yarn_radius / 2
    float ellipse_short;    // e_N, radial
    float ellipse_long;     // e_B, tangential
    float migration_min;    // R_min
    float migration_max;    // R_max
    float fiber_radius;
    float outer_radius;
    uint max_subdivisions;
    uint segment_count;
    uint seed;
    float loop_probability; // that a period is a loop
    float loop_radius_mean; // largest R of a loop
    float loop_radius_sd;
    float hair_probability; // that a period holds a hair
    float hair_start_mean;  // R where a hair leaves the ply
    float hair_start_sd;
    float hair_gain_mean;   // how much farther out its tip is
    float hair_gain_sd;
    float hair_share_mean;  // its length as a share of the period
    float hair_share_sd;
    float hair_angle_mean;  // radians around the ply from root to tip
    float hair_angle_sd;
    float hair_turns_per_period;  // above 0: takes the place of the angle
    float fiber_turns_per_period; // 1 / s
    float hair_taper;       // share of the hair's length over which it tapers to a point
    uint periods_per_migration; // parts of a migration for each of which loops and hairs are drawn
    float ply_radius;       // of the circle with the ellipse's area
    float core_ranks;       // fibers of each ply drawn one by one at full detail
    float core_extent;      // distance from the ply's centre that the core's texture spans, as share of the ellipse
    float core_height;      // mean height of the core's surface over that of its ellipse
    uint core_rows;         // texels across the core's texture
    float core_above;       // of the two heights that stand for all: the upper one above their mean, per deviation
    float core_thickness[CORE_LEVELS]; // farthest fiber of each level, as share of the ellipse
    uint slot_stride;       // between the fibers of successive slots: glsl/yarn/detail.glsl
    float reach;            // of anything, hairs included, from the yarn's centre
    float k_tt;             // gamma_TT^-2
    float n_tt;             // 1 / (2 pi exp(-k) I0(k)), k = k_tt
    uint scattering_entries; // of each lobe's table
    uint first_piece;       // of this fabric's, counted through all fabrics
    float shadow_radius;    // of the opaque tube that takes as much light from others
    float ply_cos;          // of the angle from each ply to the next
    float ply_sin;
    float beyond_short;     // more than ellipse_short by which a unit of R moves a fiber outside of the ply's surface;
    float beyond_long;      // likewise: 0 but in plies flatter than any that was measured
    uint padding_0;
    uint padding_1;
    uint padding_2;
    vec4 occlusion;         // visibility as a cubic of (distance from the centre / outer_radius)
    vec4 occlusion_lean;    // how much more of it comes from outside, likewise
    vec4 diffuse;           // k_d, rgb; a: extinction per outer_radius
    vec4 specular;          // k_s, rgb; a: beta, radians
    vec4 reflection;        // C_R, rgb; a: beta_R, radians
    vec4 transmission;      // C_TT, rgb; a: beta_TT, radians
};

// One light: 64 bytes. World space: mm, relative to the scene's origin.
struct Light {
    vec3 position;          // of a point or spot light
    uint is_local;          // 1 for these, 0 for a directional light
    vec3 toward;            // unit: toward a directional light; against a spot's axis
    float cone_scale;       // falloff from a spot's axis; 0 otherwise
    vec3 strength;          // rgb: irradiance of a directional light, or irradiance at one metre
    float cone_offset;      // with cone_scale; 1 otherwise
    uint shadow_view;       // first of its views of the shadow map
    uint shadow_view_count; // 1, 6 for a point light, or 0 without a shadow
    float angular_tangent;  // of half the angle that the light spans in the sky; 0 for sharp shadows
    float padding;
};

// What one light sees of the cloth, in one layer of the shadow map.
struct ShadowView {
    mat4 clip_from_world;
    vec4 depth_axis;        // depth in mm away from the light is xyz . p + w
    vec4 toward;            // toward the light: xyz - w p
    float texel;            // its width: mm for a directional light, mm per mm of depth for another
    uint padding[3];
};

// What one picture of the scene needs. World space: mm, relative to the scene's origin.
struct Frame {
    mat4 clip_from_world;
    vec4 eye_world;             // xyz
    vec4 frustum_world[5];      // inward planes: left, right, bottom, top, near; n . x + w >= 0 inside
    vec4 ambient_radiance;      // rgb
    vec4 environment[9];        // rgb: glsl/shading/environment.glsl
    float tolerance_px;         // allowed departure of a fiber's chords, in pixels
    float near_mm;              // distance of the near plane
    float pixel_tangent;        // width of a pixel at depth 1
    float lod_threshold_px;
    float thin_fiber_px;        // narrowest that level of detail draws a fiber
    uint index;                 // of the jittered frame
    float shading_spacing_px;   // between the places of a pixel at which one thing is shaded
    float vertex_shaded_px;     // width of a ply below which its fibers are shaded at their vertices
    uint light_count;           // of which anything may arrive in this picture
    uint padding_0;
    uint padding_1;
    uint padding_2;
};

// Counted by the control stage; each count is two words, low then high.
struct Statistics {
    uint patches_drawn;
    uint patches_culled;
    uint fiber_segments_low;
    uint fiber_segments_high;
    uint patches_coarse;    // drawn with fewer pieces of fiber than the tolerance asks for
    uint patches_along_light;          // drawn and lying so along a light that its own tube may shadow it
    uint patches_softer_than_searched; // drawn and farther from what may hide it than soft shadows are looked up
};

#endif
