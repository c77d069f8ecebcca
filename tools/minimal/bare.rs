//! A scene that needs nothing that can be left out: for the comparison here, and for `tests/leave_out.rs`.

/// One yarn without loops and hairs, one light, the simple model: everything that a default scene has besides is left out.
pub const MINIMAL: [&str; 9] = [
    "shading.model='simple'",
    "shading.ambient=false",
    "shadow.map=false",
    "shadow.self=false",
    "occlusion.mode='none'",
    "occlusion.yarns=false",
    "debug.fibers='every'",
    "yarn.hair_density_per_mm=0",
    "yarn.loop_density_per_mm=0",
];
