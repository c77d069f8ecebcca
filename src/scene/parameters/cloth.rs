//! Parameters of the cloth: where it comes from, its yarn but for what [`crate::yarn::ranges`] lists, its fibers' look.

use super::{Group, Kind, Parameter};
use crate::bsdf::params::{NARROWEST_DEG, WIDEST_DEG};
use crate::bsdf::presets::fiber_names;
use crate::yarn::presets::yarn_names;

const KHUNGURN: &str = "Khungurn et al. 2017";
const WU: &str = "Wu & Yuksel 2019";

const fn fabric(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Fabric, key, kind, about)
}

const fn fiber(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Fiber, key, kind, about)
}

pub const FABRIC: &[Parameter] = &[
    Parameter {
        table: "",
        ..fabric("seed", Kind::Count(0, i64::MAX as u64), "Seed of everything random.").slide(0.0, 100.0)
    },
    fabric("model", Kind::File, "Yarn file."),
    fabric(
        "mm_per_unit",
        Kind::Number(1e-9, 1e9),
        "Length of the file's unit; where absent, yarns are made to touch.",
    )
    .unit("mm")
    .optional()
    .slide_shares(0.001, 1000.0),
    fabric("motion", Kind::File, "Frames of its motion: raw, or numbered yarn files (cloth.%04d.bcc).")
        .optional(),
];

pub const YARN: &[Parameter] = &[Parameter::new(
    Group::Yarn,
    "preset",
    Kind::Preset(|| yarn_names().collect()),
    "The yarn that all other parameters are of unless they are set.",
)];

pub const FIBER: &[Parameter] = &[
    fiber(
        "preset",
        Kind::Preset(|| fiber_names().collect()),
        "The fiber that all other parameters are of unless they are set.",
    ),
    fiber("color", Kind::Rgb(1.0), "Color of the cloth; the fiber is dyed (c_tt) so that the cloth has it.")
        .optional(),
    fiber("c_r", Kind::Rgb(1.0), "Share of light that the fiber's surface reflects at right angles.")
        .symbol(KHUNGURN, "C_R"),
    fiber("c_tt", Kind::Rgb(1.0), "Share of what enters the fiber that leaves it again: its dye.")
        .symbol(KHUNGURN, "C_TT"),
    fiber(
        "beta_r_deg",
        Kind::Number(NARROWEST_DEG, WIDEST_DEG),
        "Width of the reflected lobe along the fiber.",
    )
    .unit("degrees")
    .symbol(KHUNGURN, "beta_R"),
    fiber(
        "beta_tt_deg",
        Kind::Number(NARROWEST_DEG, WIDEST_DEG),
        "Width of the transmitted lobe along the fiber.",
    )
    .unit("degrees")
    .symbol(KHUNGURN, "beta_TT"),
    fiber(
        "gamma_tt_deg",
        Kind::Number(NARROWEST_DEG, WIDEST_DEG),
        "Width of the transmitted lobe around the fiber.",
    )
    .unit("degrees")
    .symbol(KHUNGURN, "gamma_TT"),
    fiber("diffuse", Kind::Rgb(1.0), "Diffuse albedo; follows from the other parameters where absent.")
        .symbol(WU, "k_d")
        .optional(),
    fiber(
        "specular",
        Kind::Rgb(1e3),
        "Highlight of the simple model; follows from the reflected lobe where absent.",
    )
    .symbol(WU, "k_s")
    .optional(),
    fiber(
        "specular_width_deg",
        Kind::Number(NARROWEST_DEG, 90.0),
        "Width of the simple model's highlight; follows from the reflected lobe where absent.",
    )
    .unit("degrees")
    .symbol(WU, "beta")
    .optional(),
];
