//! The comparison itself: it must refuse a wrong twin, for every function.

use crate::harness::{Args, Case, Part, compare, number, twin_of};
use crate::inputs::row;
use crate::{answers, cases};

/// The twin with every answer off by 1%, or by one where it is a whole number.
fn off_by_a_percent(mut parts: Vec<Part>) -> Vec<Part> {
    parts.iter_mut().for_each(|part| part.values.iter_mut().for_each(|v| *v *= 1.01));
    parts
}

/// The twin with two axes of every vector exchanged.
fn axes_swapped(mut parts: Vec<Part>) -> Vec<Part> {
    parts.iter_mut().filter(|part| part.values.len() == 3).for_each(|part| part.values.swap(0, 1));
    parts
}

#[test]
fn a_wrong_twin_is_refused_for_every_function() {
    for case in cases() {
        let found = answers(&case);
        let percent = compare(&case, &found, |row| off_by_a_percent(twin_of(&case, row)));
        assert!(percent.is_err(), "{}: a twin 1% off passed", case.function);
        let returns_vectors = twin_of(&case, &case.rows[0]).iter().any(|part| part.values.len() == 3);
        // The tone curve treats all colours alike, and is given greys only where it must be.
        if returns_vectors {
            let swapped = compare(&case, &found, |row| axes_swapped(twin_of(&case, row)));
            assert!(swapped.is_err(), "{}: a twin with swapped axes passed", case.function);
        }
    }
}

fn identity() -> Case {
    Case {
        function: "identity",
        rows: (1..=10).map(|i| row().real(f64::from(i)).end()).collect(),
        twin: |args| vec![number("value", args.real(), 1e-3)],
        invariant: None,
    }
}

#[test]
fn one_wrong_row_among_many_is_refused_and_named() {
    let case = identity();
    let right: Vec<Vec<f32>> = (1..=10_u16).map(|i| vec![f32::from(i)]).collect();
    let check = |found: &[Vec<f32>]| compare(&case, found, |row| twin_of(&case, row));
    assert!(check(&right).unwrap().well_conditioned > 0.99);
    for bad in [7.001, f32::NAN, f32::INFINITY, -7.0, 0.0] {
        let mut wrong = right.clone();
        wrong[6][0] = bad;
        let message = check(&wrong).unwrap_err();
        assert!(message.contains("1 of 10") && message.contains("Real(7.0)"), "{message}");
    }
}

#[test]
fn a_case_that_tests_nothing_is_refused() {
    // Every answer is all rounding error, so that conditioning would excuse anything.
    let noisy = Case {
        twin: |args: &mut Args<'_>| vec![number("noise", (1e9 * args.real()).sin(), 1.0)],
        ..identity()
    };
    let found: Vec<Vec<f32>> =
        noisy.rows.iter().map(|row| vec![twin_of(&noisy, row)[0].values[0] as f32]).collect();
    let message = compare(&noisy, &found, |row| twin_of(&noisy, row)).unwrap_err();
    assert!(message.contains("too few rows"), "{message}");
}

#[test]
fn a_broken_invariant_is_refused() {
    let case = Case {
        invariant: Some(|_, found| (found[0] < 9.5).then_some(()).ok_or("too large".into())),
        ..identity()
    };
    let found: Vec<Vec<f32>> = (1..=10_u16).map(|i| vec![f32::from(i)]).collect();
    let message = compare(&case, &found, |row| twin_of(&case, row)).unwrap_err();
    assert!(message.contains("too large") && message.contains("1 of 10"), "{message}");
}
