//! `worsted::probe`: the device against f64 at random arguments, and what the domains refuse.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

mod compare;
#[path = "../support/device.rs"]
mod device;
mod domains;

use compare::Figures;
use serde_json::Value;
use std::time::Instant;
use worsted::probe::{FUNCTIONS, Function, Kernel, Tally, probe};
use worsted::stress::queries;
use worsted::vulkan::DeviceChoice;

/// Lines of each function in a usual run of the tests.
const LINES: usize = 2000;
/// Lines of each that the figures in the README are of.
const MANY_LINES: usize = 100_000;

/// The answers to queries: on the device, or in f64.
pub fn answers(function: &'static Function, queries: &[Value], on_device: bool) -> Vec<Value> {
    let text: String = queries.iter().map(|query| format!("{query}\n")).collect();
    let kernel = on_device.then(|| Kernel::new(device::shared(DeviceChoice::Auto), function).unwrap());
    let mut written = Vec::new();
    let tally = probe(function, kernel, text.as_bytes(), &mut written).unwrap();
    let lines: Vec<Value> = written
        .split(|byte| *byte == b'\n')
        .filter(|line| !line.is_empty())
        .map(|line| serde_json::from_slice(line).unwrap())
        .collect();
    let fault = lines.iter().zip(queries).find(|(answer, _)| answer.get("error").is_some());
    assert_eq!(tally, Tally { lines: queries.len() as u64, errors: 0 }, "{}: {fault:?}", function.name);
    lines
}

fn measure(function: &'static Function, count: usize) -> Figures {
    let queries = queries::random(function.name, count);
    let started = Instant::now();
    let found = answers(function, &queries, true);
    let device_seconds = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let exact = answers(function, &queries, false);
    let exact_seconds = started.elapsed().as_secs_f64();
    let figures = compare::figures(function.name, &queries, &found, &exact);
    println!("{:<24} {figures}  device {device_seconds:.1} s, f64 {exact_seconds:.1} s", function.name);
    // The comparison itself: answers one part in fifty off, or another query's, do not pass.
    let off: Vec<Value> = found.iter().map(|answer| compare::scaled(answer, 1.02)).collect();
    assert!(
        !compare::figures(function.name, &queries, &off, &exact).good(),
        "{}: 2% off passes",
        function.name
    );
    let mut turned = found;
    turned.rotate_left(1);
    assert!(
        !compare::figures(function.name, &queries, &turned, &exact).good(),
        "{}: a line off",
        function.name
    );
    figures
}

#[test]
fn the_device_agrees_with_f64() {
    let bad: Vec<String> = FUNCTIONS
        .iter()
        .map(|function| (function.name, measure(function, LINES)))
        .filter(|(_, figures)| !figures.good())
        .map(|(name, figures)| format!("{name}: {}", figures.worst_query))
        .collect();
    assert!(bad.is_empty(), "{}", bad.join("\n"));
    device::shared(DeviceChoice::Auto).check_validation().unwrap();
}

#[test]
#[ignore = "takes minutes: the figures over 100,000 lines of each function"]
fn the_device_agrees_with_f64_over_many_lines() {
    for function in FUNCTIONS.iter() {
        let figures = measure(function, MANY_LINES);
        if !figures.good() {
            println!("    {}", figures.worst_query);
        }
    }
}
