//! What every measurement prints, and whether its limits hold.

use std::borrow::Borrow;
use std::time::SystemTime;
use worsted::error::Error;
use worsted::vulkan::Device;

/// Prints what was measured, when and on what, as the head of a Markdown section.
pub fn print_head(title: &str, device: &Device, lines: &[String]) {
    println!("## {title}\n");
    print_date();
    println!("- device: {} ({})", device.name(), device.driver());
    for line in lines {
        println!("- {line}");
    }
    println!();
}

/// Prints when this was measured, as a line of a section's head.
pub fn print_date() {
    println!("- date: {} (UTC)", humantime::format_rfc3339_seconds(SystemTime::now()));
}

/// Prints the head of a Markdown table.
pub fn print_columns<S: Borrow<str>>(names: &[S]) {
    println!("| {} |", names.join(" | "));
    println!("|{}", "---|".repeat(names.len()));
}

/// What `--set` says, for a report's head.
pub fn overrides_line(sets: &[String]) -> String {
    if sets.is_empty() { "overrides: none".to_owned() } else { format!("overrides: {}", sets.join(", ")) }
}

/// The limits that were checked.
#[derive(Default)]
pub struct Verdicts {
    checked: usize,
    failed: Vec<String>,
}

impl Verdicts {
    /// Whether `value` is at most `limit`, as a word. What is not a number is not.
    pub fn at_most(&mut self, what: &str, value: f64, limit: f64) -> &'static str {
        self.judge(value <= limit, || format!("{what}: expected at most {limit}, found {value:.4}"))
    }

    /// Whether `value` is at least `limit`, as a word. What is not a number is not.
    pub fn at_least(&mut self, what: &str, value: f64, limit: f64) -> &'static str {
        self.judge(value >= limit, || format!("{what}: expected at least {limit}, found {value:.4}"))
    }

    fn judge(&mut self, holds: bool, complaint: impl FnOnce() -> String) -> &'static str {
        self.checked += 1;
        if holds {
            return "yes";
        }
        self.failed.push(complaint());
        "no"
    }

    /// Prints every limit that does not hold.
    ///
    /// # Errors
    /// A limit that does not hold, or none checked at all.
    pub fn finish(self) -> Result<(), Error> {
        println!();
        for complaint in &self.failed {
            println!("- does not hold: {complaint}");
        }
        let (failed, checked) = (self.failed.len(), self.checked);
        if checked > 0 && failed == 0 {
            println!("All {checked} limits hold.");
            return Ok(());
        }
        Err(Error::Failed(format!("{failed} of {checked} limits do not hold")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_beyond_their_limits_and_no_numbers_are_refused() {
        let mut good = Verdicts::default();
        assert_eq!((good.at_most("a", 1.0, 1.0), good.at_least("b", 1.0, 1.0)), ("yes", "yes"));
        assert!(good.finish().is_ok());
        for (value, limit) in [(1.1, 1.0), (f64::NAN, 1.0)] {
            let mut bad = Verdicts::default();
            assert_eq!((bad.at_most("a", value, limit), bad.at_least("b", -value, limit)), ("no", "no"));
            assert!(bad.finish().is_err());
        }
        assert!(Verdicts::default().finish().is_err(), "nothing checked");
    }
}
