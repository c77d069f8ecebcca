//! Every shader function on the device itself against its f64 twin.

#![expect(clippy::panic, reason = "the helpers of a test may fail it")]

mod bsdf_cases;
mod completeness;
mod core_cases;
mod coverage_cases;
mod detail_cases;
#[path = "../support/device.rs"]
mod device;
mod fiber_case;
mod flyaway_cases;
mod flyaway_rows;
mod harness;
mod inputs;
mod kernel;
mod khungurn_cases;
mod khungurn_rows;
mod khungurn_truth;
mod light_cases;
mod math_cases;
mod packed_cases;
mod rejects;
mod scattering_tables;
mod shading_cases;
mod shadow_cases;
mod table_reads;
mod turning_cases;
mod yarn_cases;

use harness::{Case, Word, compare, twin_of};

/// One case per function; the completeness test demands a case for each.
fn cases() -> Vec<Case> {
    let mut all = math_cases::cases();
    all.extend(yarn_cases::cases());
    all.extend(packed_cases::cases());
    all.extend(turning_cases::cases());
    all.extend([fiber_case::case(), fiber_case::surface_radius()]);
    all.extend(flyaway_cases::cases());
    all.extend(detail_cases::cases());
    all.extend(core_cases::cases());
    all.extend(coverage_cases::cases());
    all.extend(bsdf_cases::cases());
    all.extend(light_cases::cases());
    all.extend(khungurn_cases::cases());
    all.extend(shading_cases::cases());
    all.extend(shadow_cases::cases());
    all
}

/// What the device returns for every row of a case.
fn answers(case: &Case) -> Vec<Vec<f32>> {
    let words: Vec<Vec<u32>> =
        case.rows.iter().map(|row| row.iter().map(|word: &Word| word.bits()).collect()).collect();
    let result_words = twin_of(case, &case.rows[0]).iter().map(|part| part.values.len()).sum();
    kernel::run(case.function, &words, result_words).expect("a kernel that runs without validation errors")
}

#[test]
fn shader_functions_agree_with_their_twins() {
    println!("{:<26} {:>5}  {:>9}  {:>10}  {:>11}", "function", "rows", "worst", "held to it", "worst steps");
    let mut wrong = Vec::new();
    for case in cases() {
        match compare(&case, &answers(&case), |row| twin_of(&case, row)) {
            Ok(s) => println!(
                "{:<26} {:>5}  {:>9.1e}  {:>9.1}%  {:>11.2}",
                case.function,
                s.rows,
                s.worst,
                100.0 * s.well_conditioned,
                s.worst_steps
            ),
            Err(message) => wrong.push(message),
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n\n"));
}
