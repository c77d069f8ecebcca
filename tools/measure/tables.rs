//! Error of the tables of fiber scattering against quadrature, by their size, and the time to bake them.

use crate::report::{Verdicts, print_columns, print_date};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::time::Instant;
use worsted::bsdf::khungurn::tabulated::DEFAULT_ENTRIES;
use worsted::bsdf::khungurn::tabulated::{self, TabulatedLobe};
use worsted::bsdf::khungurn::{ambient_integrals, longitudinal_normaliser};
use worsted::error::Error;
use worsted::precompute::scattering_table::bake_lobe;

const SIZES: [u32; 6] = [8, 16, 32, 64, 128, 256];
const WIDTHS_DEG: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0];
/// Largest error of the default size, as a share of a table's range.
const LIMIT: f64 = 1e-3;
/// Places at which a table is compared. Odd, and so are their distances against any size's: few fall on entries.
const PLACES: u32 = 1999;
/// Bakes of which the fastest counts.
const BAKES: u32 = 5;
/// What a lobe's table holds.
const HELD: [&str; 4] = ["G", "A = all", "B = grazing", "A - B = through"];

/// The truth at one place.
struct Place {
    x: f64,
    cos: f64,
    exact: [f64; 4],
}

/// Prints the errors and times and whether the default size is good enough.
///
/// # Errors
/// A limit that does not hold.
pub fn run() -> Result<(), Error> {
    println!("## Tables of fiber scattering\n");
    print_date();
    println!("- device: none; f64 on the CPU");
    println!(
        "- error: largest difference from quadrature at {PLACES} places, as a share of the range over theta;"
    );
    println!("  for G, of the factor that the table holds, as a share of the factor");
    println!("- bake: the fastest of {BAKES}, one lobe, all threads\n");
    let columns =
        ["width deg", "entries", HELD[0], HELD[1], HELD[2], HELD[3], "bake ms", "bake / default", "holds"];
    print_columns(&columns);
    let mut verdicts = Verdicts::default();
    for width_deg in WIDTHS_DEG {
        let width = width_deg.to_radians();
        let places = truth(width);
        let default_ms = bake_ms(width, DEFAULT_ENTRIES);
        for entries in SIZES {
            let errors = worst(width, &places, &bake_lobe(width, entries));
            let ms = bake_ms(width, entries);
            let holds = if entries == DEFAULT_ENTRIES {
                let judged = HELD.iter().zip(errors).map(|(held, error)| {
                    verdicts.at_most(&format!("{held} at {width_deg} degrees"), error, LIMIT)
                });
                if judged.fold(true, |all, word| all & (word == "yes")) { "yes" } else { "no" }
            } else {
                ""
            };
            let [g, a, b, d] = errors;
            let ratio = ms / default_ms;
            println!(
                "| {width_deg} | {entries} | {g:.1e} | {a:.1e} | {b:.1e} | {d:.1e} | {ms:.2} | {ratio:.2} | {holds} |"
            );
        }
    }
    verdicts.finish()
}

/// Milliseconds to bake one lobe.
fn bake_ms(width: f64, entries: u32) -> f64 {
    let time = |_| {
        let start = Instant::now();
        std::hint::black_box(bake_lobe(width, entries));
        1e3 * start.elapsed().as_secs_f64()
    };
    (0..BAKES).map(time).fold(f64::INFINITY, f64::min)
}

/// Places that crowd where entries do, with what quadrature gives there.
fn truth(width: f64) -> Vec<Place> {
    let place = |i: u32| {
        let position = (f64::from(i) + 0.5) / f64::from(PLACES);
        // A third evenly, two thirds at distances from the pole that grow with it.
        let even = i.is_multiple_of(3);
        let grown = width * ((1.0 + FRAC_PI_2 / width).powf(position) - 1.0);
        let x = if even { FRAC_PI_2 * position } else { grown };
        let theta = FRAC_PI_2 - x;
        let [all, grazing, through] = ambient_integrals(theta, width);
        Place { x, cos: x.sin(), exact: [longitudinal_normaliser(theta, width), all, grazing, through] }
    };
    (0..PLACES).into_par_iter().map(place).collect()
}

/// Largest errors of what the table holds.
fn worst(width: f64, places: &[Place], table: &[[f32; 4]]) -> [f64; 4] {
    let lobe = TabulatedLobe { width, table };
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    let mut errors = [0.0_f64; 4];
    for Place { x, cos, exact } in places {
        let position = tabulated::normaliser_position(*cos, width);
        let [factor, ..] = tabulated::scattering_table_at(table, position);
        let [all, grazing, through] = tabulated::ambient_integrals(*x, *cos, lobe);
        let g = factor * tabulated::gaussian_normaliser(*cos, width) / exact[0];
        let pairs = [(g, 1.0), (all, exact[1]), (grazing, exact[2]), (through, exact[3])];
        for (n, (found, exact)) in pairs.into_iter().enumerate() {
            // A NaN would vanish in `max`.
            let error = (found - exact).abs();
            errors[n] = if error.is_finite() { errors[n].max(error) } else { f64::INFINITY };
            ranges[n] = [ranges[n][0].min(exact), ranges[n][1].max(exact)];
        }
    }
    // G's error is of the factor itself.
    ranges[0] = [0.0, 1.0];
    std::array::from_fn(|n| errors[n] / (ranges[n][1] - ranges[n][0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_table_is_refused_in_the_column_that_is_wrong() {
        let width = 0.1;
        let places = truth(width);
        let right = bake_lobe(width, DEFAULT_ENTRIES);
        assert!(worst(width, &places, &right).iter().all(|error| *error < LIMIT));
        for (n, bad) in [(0, 1.01), (1, 1.01), (2, 1.01), (3, f32::NAN)] {
            let mut wrong = right.clone();
            wrong[20][n] *= bad;
            let errors = worst(width, &places, &wrong);
            for (m, error) in errors.into_iter().enumerate() {
                assert_eq!(error > LIMIT, m == n, "entry's part {n}: {errors:?}");
            }
        }
    }
}
