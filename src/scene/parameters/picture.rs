//! Parameters of what is seen: camera, display, debug views, which frame of a motion, and what is beside light.

use super::{FARTHEST_MM, Group, Kind, MOST_TURNED_DEG, Parameter};

const fn camera(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Camera, key, kind, about)
}

const fn display(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Display, key, kind, about)
}

const fn animation(key: &'static str, kind: Kind, about: &'static str) -> Parameter {
    Parameter::new(Group::Animation, key, kind, about)
}

pub const ROWS: &[Parameter] = &[
    camera("yaw_deg", Kind::Number(-MOST_TURNED_DEG, MOST_TURNED_DEG), "Turn about the vertical.")
        .unit("degrees")
        .slide(-180.0, 180.0),
    camera(
        "pitch_deg",
        Kind::Number(-90.0, 90.0),
        "Rise above the horizon; where absent cloth that lies flat is seen from above.",
    )
    .unit("degrees")
    .optional(),
    camera("fov_y_deg", Kind::Number(1.0, 170.0), "Vertical field of view.")
        .unit("degrees")
        .slide(5.0, 120.0),
    camera(
        "distance_mm",
        Kind::Number(1e-3, FARTHEST_MM),
        "From the target; where absent everything is in view.",
    )
    .unit("mm")
    .optional()
    .slide_shares(1.0, 10_000.0),
    camera(
        "target_mm",
        Kind::Vector(-FARTHEST_MM, FARTHEST_MM),
        "What it looks at; the model's centre where absent.",
    )
    .unit("mm")
    .optional()
    .slide(-1000.0, 1000.0),
    camera(
        "fit",
        Kind::Switch,
        "Choose distance and target so that everything is in view, whatever they say.",
    ),
    display("exposure_stops", Kind::Number(-30.0, 30.0), "Factor of two for each stop.")
        .unit("stops")
        .slide(-8.0, 8.0),
    display("background", Kind::Rgb(1e6), "Radiance behind the cloth."),
    display(
        "tone",
        Kind::Name(&["neutral", "filmic"]),
        "Tone curve: the identity up to 0.8, or more contrast.",
    ),
    display("transparent", Kind::Switch, "The yarn alone, without background."),
    Parameter::new(
        Group::Debug,
        "view",
        Kind::Name(&[
            "shaded",
            "normal",
            "tangent",
            "occlusion",
            "ply",
            "kind",
            "frame",
            "length",
            "level_of_detail",
        ]),
        "What fibers are colored by.",
    )
    .symbol("Wu & Yuksel 2019", "Fig. 4, 11"),
    Parameter::new(
        Group::Debug,
        "fibers",
        Kind::Name(&["both", "core", "regular", "every"]),
        "Which fibers are drawn.",
    )
    .symbol("Wu & Yuksel 2019", "Fig. 9"),
    animation(
        "frame",
        Kind::Number(0.0, 1e9),
        "Frame that a still picture shows; the model at rest where absent.",
    )
    .optional()
    .slide(0.0, 1000.0),
    animation("interpolation", Kind::Name(&["linear", "catmull_rom"]), "How points move between two frames."),
    animation("frames_per_second", Kind::Number(0.01, 1e3), "Pictures of a film in a second.")
        .slide(1.0, 120.0),
    animation("speed", Kind::Number(1e-6, 1e6), "Frames from one picture to the next.")
        .slide_shares(0.01, 100.0),
    animation("repeat", Kind::Switch, "The first frame follows the last, again and again."),
    Parameter::new(
        Group::Layers,
        "motion",
        Kind::Switch,
        "An EXR holds how far each pixel moves, both ways.",
    ),
    Parameter::new(Group::Layers, "id", Kind::Switch, "An EXR holds which fabric and yarn each pixel shows."),
];
