//! Parameters of lights and of the light from everywhere.

use super::{FARTHEST_MM, Group, Kind, MOST_STRENGTH, MOST_TURNED_DEG, Parameter};

const fn light(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Light, key, kind, about)
}

const fn ambient(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Ambient, key, kind, about)
}

pub const ROWS: &[Parameter] = &[
    light(
        "kind",
        Kind::Name(&["directional", "point", "spot"]),
        "Parallel from infinitely far, from a point to everywhere, or from a point into a cone.",
    ),
    light(
        "angular_size_deg",
        Kind::Number(0.0, 60.0),
        "Angle that it spans seen from the cloth: how soft shadows are.",
    )
    .unit("degrees")
    .slide(0.0, 20.0),
    light("irradiance", Kind::Rgb(MOST_STRENGTH), "On a surface that faces the light (directional).")
        .optional(),
    light(
        "intensity",
        Kind::Rgb(MOST_STRENGTH),
        "On a surface that faces the light one metre away (point, spot).",
    )
    .optional(),
    light("direction", Kind::Direction, "From the light to the scene (directional, spot).").optional(),
    light("position_mm", Kind::Vector(-FARTHEST_MM, FARTHEST_MM), "Where it is (point, spot).")
        .unit("mm")
        .optional()
        .slide(-1000.0, 1000.0),
    light(
        "outer_angle_deg",
        Kind::Number(0.01, 90.0),
        "Angle from the axis beyond which there is no light (spot).",
    )
    .unit("degrees")
    .optional(),
    light(
        "inner_angle_deg",
        Kind::Number(0.0, 90.0),
        "Angle from the axis up to which it is undimmed, below the outer angle (spot).",
    )
    .unit("degrees")
    .optional(),
    ambient(
        "radiance",
        Kind::Rgb(MOST_STRENGTH),
        "The same light from everywhere; not together with environment.",
    )
    .optional(),
    ambient(
        "environment",
        Kind::File,
        "Picture of the light from everywhere: EXR, HDR or PNG, twice as wide as high.",
    )
    .optional(),
    ambient("environment_scale", Kind::Number(0.0, MOST_STRENGTH), "Factor on the picture's radiance.")
        .slide_shares(0.0, 100.0),
    ambient(
        "environment_yaw_deg",
        Kind::Number(-MOST_TURNED_DEG, MOST_TURNED_DEG),
        "Turn of the picture about the vertical.",
    )
    .unit("degrees")
    .slide(-180.0, 180.0),
];
