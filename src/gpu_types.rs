//! Every struct mirrored in `glsl/shared/layouts.glsl`; `tests/layouts` holds the two equal.

use bytemuck::{Pod, Zeroable};

/// Isolines one patch may carry; `FIBERS_PER_PATCH` in `glsl/shared/constants.glsl`.
pub const FIBERS_PER_PATCH: u32 = 64;

/// Rest length in mm after which the colours of the length view repeat; `LENGTH_STRIPE` there.
pub const LENGTH_STRIPE: f32 = 10.0;

/// Corners of a piece of yarn in the shadow map; `TUBE_CORNERS` there.
pub const TUBE_CORNERS: u32 = 12;

/// Largest finite half float, above which a frame's format would hold infinity; `RADIANCE_MAX` there.
pub const RADIANCE_MAX: f32 = 65_504.0;

/// One control point of a yarn.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ControlPoint {
    /// In mm, relative to the scene's origin.
    pub position: [f32; 3],
    /// The knot's normal as two 16-bit snorms: [`crate::math::frame::octahedral_from_normal`].
    pub normal_octahedral: u32,
}

/// One cubic piece of a yarn: [`crate::yarn::packed::packed_piece`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Piece {
    /// Rest length of the curve before it, in 2^-42 of the curve's: the low word.
    pub length_low: u32,
    /// The 10 high bits, and above them the curve's place in the table.
    pub length_high_curve: u32,
}

/// What all pieces of a curve share: [`crate::yarn::packed::PackedCurve`]. Rates are low word, high word.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Curve {
    /// First control point of piece 0 if it were of this curve; wraps around.
    pub first_point: u32,
    /// The curve's number in its fabric.
    pub curve: u32,
    /// Periods of a closed curve, or after which an open one counts anew; 0 where it does not.
    pub migration_period_count: u32,
    /// Rotation of the plies at the curve's start, in 2^-32 turns.
    pub ply_phase: u32,
    /// Twist of the fibers, likewise.
    pub fiber_phase: u32,
    /// Phase of the fibers' radius, likewise.
    pub migration_phase: u32,
    /// Rotation of the plies in each 2^-42 of the curve, in 2^-64 turns.
    pub ply_rate: [u32; 2],
    /// Twist of the fibers, likewise.
    pub fiber_rate: [u32; 2],
    /// Phase of the fibers' radius, likewise.
    pub migration_rate: [u32; 2],
    /// Stripes of [`LENGTH_STRIPE`], likewise.
    pub stripe_rate: [u32; 2],
    /// Its rest length in mm.
    pub length_mm: f32,
    /// Nothing.
    pub padding: u32,
}

/// One fiber of the cross-section.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Fiber {
    /// R_i, 0..1 of the ply's ellipse.
    pub radius: f32,
    /// theta_i in radians.
    pub angle: f32,
    /// m_i in radians.
    pub migration_phase: f32,
    /// Its ply.
    pub ply: u32,
}

/// What all yarns of one fabric share; lengths in mm.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Yarn {
    /// Plies.
    pub ply_count: u32,
    /// Fibers of all plies together.
    pub fiber_count: u32,
    /// Ply centre's distance from the yarn's centre.
    pub ply_offset: f32,
    /// e_N.
    pub ellipse_short: f32,
    /// e_B.
    pub ellipse_long: f32,
    /// R_min.
    pub migration_min: f32,
    /// R_max.
    pub migration_max: f32,
    /// Half a fiber's diameter.
    pub fiber_radius: f32,
    /// Of the circle around all plies.
    pub outer_radius: f32,
    /// Most pieces over one piece of yarn.
    pub max_subdivisions: u32,
    /// Pieces of yarn.
    pub segment_count: u32,
    /// Of the periods' types.
    pub seed: u32,
    /// Probability that a period is a loop.
    pub loop_probability: f32,
    /// Largest R of a loop.
    pub loop_radius_mean: f32,
    /// Its deviation.
    pub loop_radius_sd: f32,
    /// Probability that a period holds a hair.
    pub hair_probability: f32,
    /// R where a hair leaves the ply.
    pub hair_start_mean: f32,
    /// Its deviation.
    pub hair_start_sd: f32,
    /// How much farther out its tip is.
    pub hair_gain_mean: f32,
    /// Its deviation.
    pub hair_gain_sd: f32,
    /// Its length as a share of the period.
    pub hair_share_mean: f32,
    /// Its deviation.
    pub hair_share_sd: f32,
    /// Radians around the ply from root to tip.
    pub hair_angle_mean: f32,
    /// Its deviation.
    pub hair_angle_sd: f32,
    /// Above 0: turns around the ply per period, in place of the angle.
    pub hair_turns_per_period: f32,
    /// Turns of the fiber itself per period.
    pub fiber_turns_per_period: f32,
    /// Share of the hair's length over which it tapers to a point.
    pub hair_taper: f32,
    /// Parts of a migration for each of which loops and hairs are drawn.
    pub periods_per_migration: u32,
    /// Of the circle with the ellipse's area.
    pub ply_radius: f32,
    /// Fibers of each ply drawn one by one at full detail.
    pub core_ranks: f32,
    /// Distance from the ply's centre that the core's texture spans, as a share of the ellipse.
    pub core_extent: f32,
    /// Mean height of the core's surface over that of its ellipse.
    pub core_height: f32,
    /// Texels across the core's texture.
    pub core_rows: u32,
    /// Of the two heights that stand for all at a place of the core: how far the upper one lies above their mean,
    /// as a share of the heights' deviation.
    pub core_above: f32,
    /// Farthest fiber of each of the core's levels (`CORE_LEVELS` in `glsl/shared/constants.glsl`), as a share of the ellipse.
    pub core_thickness: [f32; 8],
    /// Between the fibers of successive slots: [`crate::yarn::detail::fiber_of_slot`].
    pub slot_stride: u32,
    /// Distance from the yarn's centre that nothing exceeds.
    pub reach: f32,
    /// gamma_TT^-2.
    pub k_tt: f32,
    /// 1 / (2 pi exp(-k) I0(k)), k = `k_tt`.
    pub n_tt: f32,
    /// Of each lobe's table.
    pub scattering_entries: u32,
    /// Of this fabric's pieces, counted through all fabrics.
    pub first_piece: u32,
    /// Of the opaque tube that takes as much light from others.
    pub shadow_radius: f32,
    /// Cosine of the angle from each ply to the next.
    pub ply_cos: f32,
    /// Its sine.
    pub ply_sin: f32,
    /// More than the ellipse's short half-axis, in mm, by which a unit of R moves a fiber outside of the ply's surface:
    /// 0 but in plies flatter than any that was measured.
    pub beyond_short: f32,
    /// The same of the long one.
    pub beyond_long: f32,
    /// Nothing.
    pub padding_0: u32,
    /// Nothing.
    pub padding_1: u32,
    /// Nothing.
    pub padding_2: u32,
    /// Visibility as a cubic of (distance from the centre / outer radius).
    pub occlusion: [f32; 4],
    /// How much more of it comes from outside than from the other side, likewise.
    pub occlusion_lean: [f32; 4],
    /// k_d, rgb, and extinction per outer radius.
    pub diffuse: [f32; 4],
    /// k_s, rgb, and beta in radians.
    pub specular: [f32; 4],
    /// C_R, rgb, and beta_R in radians.
    pub reflection: [f32; 4],
    /// C_TT, rgb, and beta_TT in radians.
    pub transmission: [f32; 4],
}

/// One light; world space in mm, relative to the scene's origin. [`crate::scene::light::Light`] says more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Light {
    /// Of a point or spot light.
    pub position: [f32; 3],
    /// 1 for these, 0 for a directional light.
    pub is_local: u32,
    /// Unit: toward a directional light; against a spot's axis.
    pub toward: [f32; 3],
    /// Falloff from a spot's axis.
    pub cone_scale: f32,
    /// rgb: irradiance of a directional light, or irradiance at one metre.
    pub strength: [f32; 3],
    /// With `cone_scale`.
    pub cone_offset: f32,
    /// First of its views of the shadow map.
    pub shadow_view: u32,
    /// 1, 6 for a point light, or 0 without a shadow.
    pub shadow_view_count: u32,
    /// Of half the angle that the light spans in the sky; 0 for sharp shadows.
    pub angular_tangent: f32,
    /// Not used.
    pub padding: f32,
}

/// What one light sees of the cloth, in one layer of the shadow map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ShadowView {
    /// Column-major.
    pub clip_from_world: [[f32; 4]; 4],
    /// Depth in mm away from the light is xyz . p + w.
    pub depth_axis: [f32; 4],
    /// Toward the light: xyz - w p.
    pub toward: [f32; 4],
    /// Width of a texel: mm for a directional light, mm per mm of depth for another.
    pub texel: f32,
    /// Not used.
    pub padding: [u32; 3],
}

/// What one picture of the scene needs; world space in mm, relative to the scene's origin.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Frame {
    /// Column-major.
    pub clip_from_world: [[f32; 4]; 4],
    /// xyz.
    pub eye_world: [f32; 4],
    /// Inward planes: left, right, bottom, top, near.
    pub frustum_world: [[f32; 4]; 5],
    /// rgb.
    pub ambient_radiance: [f32; 4],
    /// rgb: [`crate::precompute::environment::Environment`].
    pub environment: [[f32; 4]; 9],
    /// Allowed departure of a fiber's chords, in pixels.
    pub tolerance_px: f32,
    /// Distance of the near plane.
    pub near_mm: f32,
    /// Width of a pixel at depth 1.
    pub pixel_tangent: f32,
    /// Width of a fiber above which nothing is simplified.
    pub lod_threshold_px: f32,
    /// Narrowest that level of detail draws a fiber.
    pub thin_fiber_px: f32,
    /// Of the jittered frame.
    pub index: u32,
    /// Between the places of a pixel at which one thing is shaded.
    pub shading_spacing_px: f32,
    /// Width of a ply below which its fibers are shaded at their vertices.
    pub vertex_shaded_px: f32,
    /// Lights of which anything may arrive in this picture.
    pub light_count: u32,
    /// Not used.
    pub padding_0: u32,
    /// Not used.
    pub padding_1: u32,
    /// Not used.
    pub padding_2: u32,
}

/// Counted by the control stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Statistics {
    /// Pieces of yarn drawn.
    pub patches_drawn: u32,
    /// Pieces of yarn outside the picture.
    pub patches_culled: u32,
    /// Straight pieces of fiber, low word.
    pub fiber_segments_low: u32,
    /// High word.
    pub fiber_segments_high: u32,
    /// Pieces of yarn drawn with fewer pieces of fiber than the tolerance asks for.
    pub patches_coarse: u32,
    /// Pieces of yarn drawn that lie so nearly along a light that their own tube may shadow them.
    pub patches_along_light: u32,
    /// Pieces of yarn drawn whose soft shadows may be wider than they are looked up.
    pub patches_softer_than_searched: u32,
}

impl Statistics {
    /// Straight pieces of fiber drawn.
    pub fn fiber_segments(&self) -> u64 {
        u64::from(self.fiber_segments_high) << 32 | u64::from(self.fiber_segments_low)
    }
}
