//! The Rust side: layouts of `src/gpu_types.rs` as the compiler has them.

use crate::reflection::{Layout, Member};
use worsted::gpu_types::{ControlPoint, Curve, Fiber, Frame, Light, Piece, ShadowView, Statistics, Yarn};

/// A Rust type's name in GLSL.
trait Glsl {
    fn kind() -> String;
}

macro_rules! glsl_names {
    ($($rust:ty => $glsl:literal),* $(,)?) => {
        $(impl Glsl for $rust {
            fn kind() -> String {
                $glsl.to_owned()
            }
        })*
    };
}

glsl_names! {
    f32 => "float", u32 => "uint", i32 => "int", [f32; 3] => "vec3", [f32; 4] => "vec4",
    [[f32; 4]; 4] => "mat4", [[f32; 4]; 5] => "vec4[5]",
    [[f32; 4]; 9] => "vec4[9]",
    [f32; 8] => "float[8]",
    [u32; 2] => "uvec2",
    [u32; 3] => "uint[3]",
}

/// The GLSL name of a field's type.
fn field_kind<S, F: Glsl>(_: fn(&S) -> &F) -> String {
    F::kind()
}

/// The layout of a struct. The pattern names every field, so that leaving one out does not compile.
macro_rules! layout {
    ($name:ident { $($field:ident),* $(,)? }) => {{
        let $name { $($field: _),* } = bytemuck::Zeroable::zeroed();
        Layout {
            name: stringify!($name).to_owned(),
            stride: size_of::<$name>(),
            members: vec![$(Member {
                name: stringify!($field).to_owned(),
                offset: std::mem::offset_of!($name, $field),
                kind: field_kind(|value: &$name| &value.$field),
            }),*],
        }
    }};
}

/// Every struct that both sides have.
pub fn layouts() -> Vec<Layout> {
    vec![
        layout!(ControlPoint { position, normal_octahedral }),
        layout!(Piece { length_low, length_high_curve }),
        layout!(Curve {
            first_point,
            curve,
            migration_period_count,
            ply_phase,
            fiber_phase,
            migration_phase,
            ply_rate,
            fiber_rate,
            migration_rate,
            stripe_rate,
            length_mm,
            padding
        }),
        layout!(Fiber { radius, angle, migration_phase, ply }),
        layout!(Yarn {
            ply_count,
            fiber_count,
            ply_offset,
            ellipse_short,
            ellipse_long,
            migration_min,
            migration_max,
            fiber_radius,
            outer_radius,
            max_subdivisions,
            segment_count,
            seed,
            loop_probability,
            loop_radius_mean,
            loop_radius_sd,
            hair_probability,
            hair_start_mean,
            hair_start_sd,
            hair_gain_mean,
            hair_gain_sd,
            hair_share_mean,
            hair_share_sd,
            hair_angle_mean,
            hair_angle_sd,
            hair_turns_per_period,
            fiber_turns_per_period,
            hair_taper,
            periods_per_migration,
            ply_radius,
            core_ranks,
            core_extent,
            core_height,
            core_rows,
            core_above,
            core_thickness,
            slot_stride,
            reach,
            k_tt,
            n_tt,
            scattering_entries,
            first_piece,
            shadow_radius,
            ply_cos,
            ply_sin,
            beyond_short,
            beyond_long,
            padding_0,
            padding_1,
            padding_2,
            occlusion,
            occlusion_lean,
            diffuse,
            specular,
            reflection,
            transmission
        }),
        layout!(Light {
            position,
            is_local,
            toward,
            cone_scale,
            strength,
            cone_offset,
            shadow_view,
            shadow_view_count,
            angular_tangent,
            padding
        }),
        layout!(ShadowView { clip_from_world, depth_axis, toward, texel, padding }),
        layout!(Frame {
            clip_from_world,
            eye_world,
            frustum_world,
            ambient_radiance,
            environment,
            tolerance_px,
            near_mm,
            pixel_tangent,
            lod_threshold_px,
            thin_fiber_px,
            index,
            shading_spacing_px,
            vertex_shaded_px,
            light_count,
            padding_0,
            padding_1,
            padding_2
        }),
        layout!(Statistics {
            patches_drawn,
            patches_culled,
            fiber_segments_low,
            fiber_segments_high,
            patches_coarse,
            patches_along_light,
            patches_softer_than_searched
        }),
    ]
}
