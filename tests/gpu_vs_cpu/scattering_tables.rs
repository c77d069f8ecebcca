//! Tables of fiber scattering for several widths, baked once for all kernels.

use std::sync::OnceLock;
use worsted::bsdf::khungurn::tabulated::DEFAULT_ENTRIES;
use worsted::precompute::scattering_table::bake_lobe;

/// Longitudinal widths of the tables, degrees.
pub const WIDTHS_DEG: [f64; 12] = [0.5, 1.0, 2.0, 3.5, 5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 40.0, 60.0];

/// The width of a table, radians, as the device has it.
pub fn width(table: u32) -> f64 {
    f64::from(WIDTHS_DEG[table as usize].to_radians() as f32)
}

/// All tables, one after the other.
pub fn all() -> &'static [[f32; 4]] {
    static ALL: OnceLock<Vec<[f32; 4]>> = OnceLock::new();
    ALL.get_or_init(|| {
        (0..WIDTHS_DEG.len() as u32).flat_map(|i| bake_lobe(width(i), DEFAULT_ENTRIES)).collect()
    })
}

/// The table of one width.
pub fn table(index: u32) -> &'static [[f32; 4]] {
    all().chunks(DEFAULT_ENTRIES as usize).nth(index as usize).expect("a row names a table that exists")
}
