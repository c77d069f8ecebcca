//! Colours for the yarn presets. A yarn preset has none: the same yarn is dyed in every colour.

use toml::Table;

/// Widths of a fiber's lobes in degrees: beta_R, beta_TT, gamma_TT.
type Widths = [f64; 3];

const WOOL: Widths = [7.2, 10.0, 26.0];
const COTTON: Widths = [9.0, 27.0, 38.0];
const POLYESTER: Widths = [5.2, 10.0, 25.0];
const SILK: Widths = [2.5, 10.0, 20.0];

/// A dyed fiber that fits the yarn preset of that name, as a scene's fiber table.
pub fn fiber(preset: &str) -> Table {
    let ([beta_r, beta_tt, gamma_tt], color) = match preset {
        "worsted_3ply" => (WOOL, [0.42, 0.10, 0.05]),
        "mercerised_2ply_cotton" => (POLYESTER, [0.05, 0.30, 0.36]),
        "mohair" => (POLYESTER, [0.50, 0.36, 0.60]),
        "cotton1" => (COTTON, [0.76, 0.70, 0.58]),
        "cotton2" => (COTTON, [0.10, 0.16, 0.36]),
        "polyester1" => (POLYESTER, [0.62, 0.66, 0.68]),
        "rayon1" => (POLYESTER, [0.46, 0.03, 0.06]),
        "rayon2" => (POLYESTER, [0.06, 0.30, 0.12]),
        "rayon3" => (POLYESTER, [0.26, 0.07, 0.28]),
        "rayon4" => (POLYESTER, [0.72, 0.38, 0.05]),
        "silk1" => (SILK, [0.70, 0.52, 0.32]),
        "silk2" => (SILK, [0.62, 0.36, 0.34]),
        _ => (WOOL, [0.56, 0.50, 0.40]),
    };
    let mut table = Table::new();
    table.insert("color".into(), color.to_vec().into());
    table.insert("beta_r_deg".into(), beta_r.into());
    table.insert("beta_tt_deg".into(), beta_tt.into());
    table.insert("gamma_tt_deg".into(), gamma_tt.into());
    table
}
