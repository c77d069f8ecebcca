//! Colours for the presets. A yarn preset has none: the same yarn is dyed in every colour.

use worsted::scene::file::FiberTable;

/// A dyed fiber that fits the yarn preset of that name.
pub fn fiber(preset: &str) -> FiberTable {
    let (diffuse, shine, specular_width_deg) = match preset {
        "worsted_3ply" => ([0.42, 0.10, 0.05], 0.010, 14.0),
        "mercerised_2ply_cotton" => ([0.05, 0.30, 0.36], 0.022, 9.0),
        "mohair" => ([0.50, 0.36, 0.60], 0.03, 9.0),
        "cotton1" => ([0.76, 0.70, 0.58], 0.010, 16.0),
        "cotton2" => ([0.10, 0.16, 0.36], 0.010, 16.0),
        "polyester1" => ([0.62, 0.66, 0.68], 0.018, 9.0),
        "rayon1" => ([0.46, 0.03, 0.06], 0.018, 9.0),
        "rayon2" => ([0.06, 0.30, 0.12], 0.018, 9.0),
        "rayon3" => ([0.26, 0.07, 0.28], 0.018, 9.0),
        "rayon4" => ([0.72, 0.38, 0.05], 0.018, 9.0),
        "silk1" => ([0.70, 0.52, 0.32], 0.03, 7.0),
        "silk2" => ([0.62, 0.36, 0.34], 0.03, 7.0),
        _ => ([0.56, 0.50, 0.40], 0.025, 12.0),
    };
    FiberTable { diffuse, specular: [shine; 3], specular_width_deg }
}
