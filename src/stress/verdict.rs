//! What was found of one thing that was swept, what it may be, and whether it is.

use serde::Serialize;

/// Share of the errors that the second figure leaves out.
const RARE: f64 = 1e-3;
/// Longest text of an input that a row keeps.
const LONGEST: usize = 1000;

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What it belongs to: scattering, geometry, ...
    pub group: &'static str,
    /// The function or the thing that was tried.
    pub what: String,
    /// What was swept.
    pub swept: String,
    /// What that may be.
    pub domain: String,
    /// What was found.
    pub found: Findings,
    /// What of it is not as it must be; empty where all is well.
    pub faults: Vec<String>,
}

impl Row {
    /// Whether nothing is wrong.
    pub fn holds(&self) -> bool {
        self.faults.is_empty()
    }
}

/// Figures of a sweep. Errors are relative, by `equations.md`'s floors, unless the row says otherwise.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Findings {
    /// Inputs that were evaluated.
    pub points: u64,
    /// The error that is the largest share of what is allowed at its input.
    pub worst: f64,
    /// What is allowed there.
    pub limit: f64,
    /// What all but a thousandth of the errors keep within.
    pub p999: f64,
    /// Results that are no numbers.
    pub nan: u64,
    /// Infinite results.
    pub infinite: u64,
    /// Results below 0 that cannot be.
    pub negative: u64,
    /// Neighbours between which a result moves the wrong way.
    pub reversals: u64,
    /// Neighbours between which a result moves by more than it may.
    pub jumps: u64,
    /// Inputs outside the domain that were refused with an error that names what is wrong.
    pub refused: u64,
    /// Inputs outside the domain that were taken, or refused unclearly.
    pub taken: u64,
    /// The input of the worst error, or of the first fault that is none of precision.
    pub at: String,
}

/// Gathers the findings of one row.
#[derive(Debug, Default)]
pub struct Collector {
    errors: Vec<f64>,
    worst_share: f64,
    /// Whether `at` names a fault that no error outdoes.
    broken: bool,
    found: Findings,
    faults: Vec<String>,
}

impl Collector {
    /// One evaluated input with its error and what is allowed of it. A NaN is beyond every limit.
    pub fn error(&mut self, error: f64, limit: f64, at: impl Fn() -> String) {
        self.errors.push(error);
        let share = error / limit;
        let share = if share.is_nan() { f64::INFINITY } else { share };
        if share > self.worst_share || self.errors.len() == 1 {
            self.worst_share = share;
            (self.found.worst, self.found.limit) = (error, limit);
            if !self.broken {
                self.found.at = cut(&at());
            }
        }
    }

    /// The numbers that a result is made of. `may_be_negative`: whether it has a sign.
    pub fn numbers(&mut self, numbers: &[f64], may_be_negative: bool, at: impl Fn() -> String) {
        let count = |is: fn(&f64) -> bool| numbers.iter().filter(|n| is(n)).count() as u64;
        let (nan, infinite) = (count(|n| n.is_nan()), count(|n| n.is_infinite()));
        let negative = if may_be_negative { 0 } else { count(|n| *n < 0.0) };
        self.found.nan += nan;
        self.found.infinite += infinite;
        self.found.negative += negative;
        if nan + infinite + negative > 0 {
            self.broken(at);
        }
    }

    /// So many inputs were evaluated.
    pub fn points(&mut self, count: u64) {
        self.found.points += count;
    }

    /// A result moved the wrong way between neighbours.
    pub fn reversal(&mut self, at: impl Fn() -> String) {
        self.found.reversals += 1;
        self.broken(at);
    }

    /// A result moved too far between neighbours.
    pub fn jump(&mut self, at: impl Fn() -> String) {
        self.found.jumps += 1;
        self.broken(at);
    }

    /// What came of an input outside the domain: the error's text, if there was one, and what it must name.
    pub fn refusal(&mut self, error: Option<&str>, names: &str, at: impl Fn() -> String) {
        if error.is_some_and(|text| text.contains(names) && !text.contains('\n')) {
            self.found.refused += 1;
        } else {
            self.found.taken += 1;
            self.broken(at);
        }
    }

    /// Anything else that must hold.
    pub fn demand(&mut self, holds: bool, what: impl Fn() -> String) {
        if !holds {
            self.faults.push(what());
        }
    }

    fn broken(&mut self, at: impl Fn() -> String) {
        if !self.broken {
            self.broken = true;
            self.found.at = cut(&at());
        }
    }

    /// The row, judged.
    pub fn row(mut self, group: &'static str, what: &str, swept: &str, domain: &str) -> Row {
        // NaN sorts last.
        self.errors.sort_by(f64::total_cmp);
        let last = self.errors.len().saturating_sub(1);
        let rank = ((1.0 - RARE) * self.errors.len() as f64) as usize;
        self.found.p999 = self.errors.get(rank.min(last)).copied().unwrap_or(0.0);
        let f = &self.found;
        if f.points == 0 && f.refused + f.taken == 0 {
            self.faults.push("nothing was tried".to_owned());
        }
        if self.worst_share > 1.0 {
            self.faults.push(format!("error {:.2e} of at most {:.2e}", f.worst, f.limit));
        }
        for (count, what) in [
            (f.nan, "results that are no numbers"),
            (f.infinite, "infinite results"),
            (f.negative, "results below 0"),
            (f.reversals, "reversals"),
            (f.jumps, "jumps"),
            (f.taken, "inputs outside the domain that were not refused clearly"),
        ] {
            if count > 0 {
                self.faults.push(format!("{count} {what}"));
            }
        }
        let (what, swept, domain) = (what.to_owned(), swept.to_owned(), domain.to_owned());
        Row { group, what, swept, domain, found: self.found, faults: self.faults }
    }
}

fn cut(text: &str) -> String {
    text.chars().take(LONGEST).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at() -> String {
        "here".to_owned()
    }

    /// A sweep without a fault.
    fn sound() -> Collector {
        let mut c = Collector::default();
        for i in 0..2000 {
            c.error(1e-5 * f64::from(i % 10), 1e-4, || format!("input {i}"));
            c.numbers(&[0.0, 1.0], false, at);
        }
        c.points(2000);
        c.refusal(Some("theta = 7: expected less"), "theta", at);
        c
    }

    fn judged(c: Collector) -> Row {
        c.row("group", "what", "swept", "domain")
    }

    #[test]
    fn sound_sweeps_hold_and_say_where_they_are_worst() {
        let row = judged(sound());
        assert!(row.holds(), "{:?}", row.faults);
        assert_eq!((row.found.worst, row.found.p999, row.found.refused), (9e-5, 9e-5, 1));
        assert_eq!(row.found.at, "input 9");
    }

    #[test]
    fn every_kind_of_wrong_number_is_rejected() {
        type Spoil = fn(&mut Collector);
        let spoils: [(&str, Spoil); 12] = [
            ("error 1.10e-4", |c| c.error(1.1e-4, 1e-4, at)),
            ("error NaN", |c| c.error(f64::NAN, 1e-4, at)),
            ("error inf", |c| c.error(f64::INFINITY, 1e-4, at)),
            ("error 2.00e-6", |c| c.error(2e-6, 1e-6, at)),
            ("1 results that are no numbers", |c| c.numbers(&[1.0, f64::NAN], false, at)),
            ("2 infinite", |c| c.numbers(&[f64::INFINITY, f64::NEG_INFINITY], true, at)),
            ("1 results below 0", |c| c.numbers(&[-1e-30], false, at)),
            ("1 reversals", |c| c.reversal(at)),
            ("1 jumps", |c| c.jump(at)),
            ("1 inputs outside", |c| c.refusal(None, "theta", at)),
            ("1 inputs outside", |c| c.refusal(Some("wrong"), "theta", at)),
            ("the sky", |c| c.demand(false, || "the sky fell".to_owned())),
        ];
        for (expected, spoil) in spoils {
            let mut c = sound();
            spoil(&mut c);
            let row = judged(c);
            assert!(
                row.faults.len() == 1 && row.faults[0].contains(expected),
                "{expected}: {:?}",
                row.faults
            );
            assert!(row.found.at == "here" || expected == "the sky", "{expected}: {}", row.found.at);
        }
        assert!(!judged(Collector::default()).holds(), "a sweep of nothing passes");
    }
}
