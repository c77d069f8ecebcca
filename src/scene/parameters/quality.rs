//! Parameters of how the picture is worked out: shading, shadow, occlusion, and what is traded for time.

use super::{Group, Kind, Parameter};

const WU: &str = "Wu & Yuksel 2019";

const fn shading(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Shading, key, kind, about)
}

const fn shadow(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Shadow, key, kind, about)
}

const fn occlusion(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Occlusion, key, kind, about)
}

const fn quality(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Quality, key, kind, about)
}

pub const ROWS: &[Parameter] = &[
    shading(
        "model",
        Kind::Name(&["physical", "simple"]),
        "Scattering model: Khungurn et al. 2017, or Wu & Yuksel's Eq. 5.",
    ),
    shading("specular", Kind::Switch, "Highlights: what fibers reflect and transmit."),
    shading("diffuse", Kind::Switch, "Diffuse reflection."),
    shading("ambient", Kind::Switch, "Light from everywhere."),
    shading(
        "extinction_scale",
        Kind::Number(0.0, 1e3),
        "Factor of how much light the fibers of a yarn take from one another.",
    )
    .symbol(WU, "sigma")
    .slide(0.0, 5.0),
    shadow("map", Kind::Switch, "Shadows between yarns.").symbol(WU, "Sec. 4.1"),
    shadow("self", Kind::Switch, "Shadows inside the yarn.").symbol(WU, "Sec. 4.1"),
    shadow("resolution", Kind::Count(16, 8192), "Texels of the shadow map along a side, for each light.")
        .slide_shares(64.0, 8192.0),
    occlusion(
        "mode",
        Kind::Name(&["distance", "texture", "none"]),
        "How ambient occlusion inside the yarn is worked out.",
    )
    .symbol(WU, "Sec. 4.2"),
    occlusion("yarns", Kind::Switch, "Other yarns hide parts of the sky as well."),
    quality("culling", Kind::Switch, "Leave out pieces of yarn outside the picture."),
    quality(
        "level_of_detail",
        Kind::Switch,
        "Draw fewer fibers, and thicker cores, where they are small in the picture.",
    ),
    quality(
        "lod_threshold_samples",
        Kind::Number(0.01, 1e4),
        "Width of a fiber above which nothing is simplified.",
    )
    .unit("samples")
    .symbol(WU, "Eq. 4")
    .slide_shares(0.1, 20.0),
    quality("thin_fiber_samples", Kind::Number(0.01, 10.0), "Narrowest that level of detail draws a fiber.")
        .unit("samples")
        .slide_shares(0.05, 5.0),
    quality(
        "vertex_shaded_samples",
        Kind::Number(0.0, 1e3),
        "Width of a ply below which its fibers are shaded at vertices.",
    )
    .unit("samples")
    .slide(0.0, 100.0),
    quality(
        "core_visible_share",
        Kind::Number(0.0, 1.0),
        "Most of what is seen of a ply that a core fiber stands for.",
    ),
    quality("core_texture_rows", Kind::PowerOfTwo(8, 512), "Texels across a core fiber's texture.")
        .slide_shares(8.0, 512.0),
    quality(
        "scattering_entries",
        Kind::Count(4, 1024),
        "Entries of the tables of each lobe of the physical model.",
    )
    .slide_shares(4.0, 1024.0),
    quality(
        "self_shadow_texels",
        Kind::Count(8, 512),
        "Texels across the table of light inside the yarn; 128 where absent.",
    )
    .optional()
    .slide_shares(8.0, 512.0),
    quality(
        "occlusion_texels",
        Kind::Count(8, 1024),
        "Texels across the texture of ambient light inside the yarn; 256 where absent.",
    )
    .optional()
    .slide_shares(8.0, 1024.0),
    quality(
        "subdivision_tolerance_px",
        Kind::Number(1e-3, 100.0),
        "How far straight pieces of a fiber may depart from its curve.",
    )
    .unit("pixels")
    .slide_shares(0.01, 10.0),
    quality(
        "max_subdivisions",
        Kind::Count(1, 64),
        "Most pieces that a fiber is cut into over one piece of yarn.",
    ),
    quality(
        "patches_per_draw",
        Kind::Count(1, 1_000_000_000),
        "Patches for each draw call; the device's limit where absent.",
    )
    .optional()
    .slide_shares(1.0, 1e9),
    quality(
        "curves_per_submission",
        Kind::Count(1, i64::MAX as u64),
        "Fiber curves handed to the device at once.",
    )
    .slide_shares(1e3, 1e8),
    // 16 bytes each: below 128 MiB.
    quality("points_per_buffer", Kind::Count(4, 8_000_000), "Control points of a fabric in one buffer.")
        .slide_shares(4.0, 8e6),
];
