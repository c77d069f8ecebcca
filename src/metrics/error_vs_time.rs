//! Error against run time: which of many ways to draw a picture nobody beats.

/// One way to draw: what it errs and what it takes. The units are the caller's, alike for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Error; less is better.
    pub error: f64,
    /// Time; less is better.
    pub time: f64,
}

impl Outcome {
    /// Whether this is at least as good in both and better in one.
    pub fn beats(&self, other: &Self) -> bool {
        let as_good = self.error <= other.error && self.time <= other.time;
        as_good && (self.error < other.error || self.time < other.time)
    }

    fn is_finite(&self) -> bool {
        self.error.is_finite() && self.time.is_finite()
    }
}

/// Indices of the outcomes that no other beats (the Pareto front), the fastest first. What is not finite is never
/// among them; of equal ones all are.
pub fn front(outcomes: &[Outcome]) -> Vec<usize> {
    let finite = || outcomes.iter().enumerate().filter(|(_, outcome)| outcome.is_finite());
    let beaten = |outcome: &Outcome| finite().any(|(_, other)| other.beats(outcome));
    let mut front: Vec<usize> =
        finite().filter(|(_, outcome)| !beaten(outcome)).map(|(index, _)| index).collect();
    front.sort_by(|&a, &b| outcomes[a].time.total_cmp(&outcomes[b].time));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcomes(pairs: &[[f64; 2]]) -> Vec<Outcome> {
        pairs.iter().map(|&[error, time]| Outcome { error, time }).collect()
    }

    #[test]
    fn the_front_is_what_nobody_beats_the_fastest_first() {
        let all = outcomes(&[[0.1, 5.0], [0.3, 1.0], [0.2, 2.0], [0.2, 3.0], [0.35, 1.0], [0.15, 6.0]]);
        assert_eq!(front(&all), [1, 2, 0]);
        assert!(all[2].beats(&all[3]) && !all[3].beats(&all[2]) && !all[0].beats(&all[0]));
    }

    #[test]
    fn equals_stay_together_and_what_is_no_number_stays_out() {
        assert_eq!(front(&outcomes(&[[0.1, 1.0], [0.1, 1.0]])), [0, 1]);
        assert_eq!(front(&outcomes(&[[f64::NAN, 0.1], [0.2, 1.0], [0.1, f64::INFINITY]])), [1]);
        assert!(front(&[]).is_empty());
    }
}
