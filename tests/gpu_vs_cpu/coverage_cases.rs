//! `glsl/lib/coverage.glsl`.

use crate::flyaway_rows::halves;
use crate::harness::{Case, number};
use crate::inputs::{random_rows, row};
use worsted::math::coverage;
use worsted::math::hash::uniform_from_word;

/// Below this a coverage has no relative error worth speaking of.
const FLOOR: f64 = 1e-3;
/// How far alpha's samples and the draw together stay from a whole number, where rounding decides.
const CLEAR: f64 = 1e-4;

pub fn cases() -> Vec<Case> {
    vec![coverage_mask(), sharpened_coverage()]
}

fn coverage_mask() -> Case {
    let mut rows = random_rows("coverage_mask", |random| {
        loop {
            let alpha = f64::from(random.between(0.0, 1.0) as f32);
            let (samples, word) = (1 + random.below(32), random.bits());
            // A whole number counts one sample more or less as the last digit falls; both are right.
            let taken = alpha * f64::from(samples) + uniform_from_word(word);
            if (CLEAR..1.0 - CLEAR).contains(&taken.fract()) {
                return row().real(alpha).bits(samples).bits(word).end();
            }
        }
    });
    // None and all of the samples, which no draw changes, and what a sum of weights may overshoot by.
    for samples in [1, 2, 4, 8, 31, 32] {
        for word in [0, 1, 31, 32, 0x8000_0000, u32::MAX] {
            rows.extend(
                [0.0, 1.0, -0.5, 1.5, 1e30].map(|alpha| row().real(alpha).bits(samples).bits(word).end()),
            );
        }
    }
    Case {
        function: "coverage_mask",
        rows,
        twin: |args| vec![halves(coverage::coverage_mask(args.real(), args.bits(), args.bits()))],
        invariant: None,
    }
}

fn sharpened_coverage() -> Case {
    let mut rows = random_rows("sharpened_coverage", |random| {
        let texels = random.magnitude(1e-4, 10.0);
        // About one half as wide as the edge is, so that both of its ends are met.
        let alpha = 0.5 + texels.min(1.0) * random.between(-0.7, 0.7);
        row().real(alpha.clamp(0.0, 1.0)).real(texels).end()
    });
    for texels in [0.0, 1e-6, 1e-3, 0.5, 0.999_999_9, 1.0, 1e30] {
        rows.extend([0.0, 0.499_9, 0.5, 0.75, 1.0].map(|alpha| row().real(alpha).real(texels).end()));
    }
    Case {
        function: "sharpened_coverage",
        rows,
        twin: |args| vec![number("alpha", coverage::sharpened_coverage(args.real(), args.real()), FLOOR)],
        invariant: None,
    }
}
