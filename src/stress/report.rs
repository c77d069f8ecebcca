//! The table, for people and for scripts.

use super::Report;
use super::verdict::{Findings, Row};
use std::fmt::Write;

/// Longest place that the Markdown table shows; JSON has all of it.
const SHOWN: usize = 90;

/// The report as JSON.
///
/// # Errors
/// None that serde has for such data.
pub fn json(report: &Report) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(report)
}

/// The report as a Markdown table for each group, and what is wrong below.
pub fn markdown(report: &Report) -> String {
    let mut text = String::new();
    let mut groups: Vec<&str> = report.rows.iter().map(|row| row.group).collect();
    groups.dedup();
    for group in groups {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "### {}{}\n", group[..1].to_uppercase(), &group[1..]);
        let _ = writeln!(
            text,
            "| what | swept | domain | tried | worst | allowed | 99.9% | broken | refused | worst at | holds |"
        );
        let _ = writeln!(text, "|---|---|---|---|---|---|---|---|---|---|---|");
        for row in report.rows.iter().filter(|row| row.group == group) {
            let _ = writeln!(text, "{}", line(row));
        }
        text.push('\n');
    }
    let bad = report.rows.iter().filter(|row| !row.holds()).count();
    let _ = writeln!(
        text,
        "{} rows, {} of which do not hold; {} inputs in {:.0} s on {}.",
        report.rows.len(),
        bad,
        tried(report),
        report.seconds,
        report.device
    );
    text
}

fn tried(report: &Report) -> u64 {
    report.rows.iter().map(|row| row.found.points + row.found.refused + row.found.taken).sum()
}

fn line(row: &Row) -> String {
    let f = &row.found;
    let at: String = f.at.chars().take(SHOWN).collect();
    let at = if at.len() < f.at.len() { format!("{at}...") } else { at };
    let at = if at.is_empty() { at } else { format!("`{}`", at.replace('|', "\\|")) };
    let holds = if row.holds() { "yes".to_owned() } else { format!("**no**: {}", row.faults.join("; ")) };
    let [worst, limit, p999] = [f.worst, f.limit, f.p999].map(|v| format!("{v:.1e}"));
    // Rows that only count have no error.
    let [worst, limit, p999] =
        if f.limit > 0.0 { [worst, limit, p999] } else { [const { String::new() }; 3] };
    let (broken, refused) = (broken(f), if f.refused > 0 { f.refused.to_string() } else { String::new() });
    format!(
        "| {} | {} | {} | {} | {worst} | {limit} | {p999} | {broken} | {refused} | {at} | {holds} |",
        row.what, row.swept, row.domain, f.points
    )
}

/// What was counted of what may not be; 0 where all is well.
fn broken(f: &Findings) -> String {
    let counts = [
        (f.nan, "NaN"),
        (f.infinite, "infinite"),
        (f.negative, "negative"),
        (f.reversals, "reversals"),
        (f.jumps, "jumps"),
        (f.taken, "taken"),
    ];
    let some: Vec<String> = counts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    if some.is_empty() { "0".to_owned() } else { some.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::verdict::Collector;

    #[test]
    fn the_table_shows_every_row_and_what_is_wrong_with_it() {
        let mut good = Collector::default();
        good.error(2e-6, 1e-4, || "{\"x\": 1}".to_owned());
        good.points(7);
        let mut bad = Collector::default();
        bad.numbers(&[f64::NAN], false, || format!("{{\"y\": \"a|{}\"}}", "z".repeat(200)));
        bad.points(1);
        let rows = vec![good.row("tables", "f", "x", "0 to 1"), bad.row("frames", "g", "y", "any")];
        let report = Report { device: "none".into(), quick: true, seconds: 1.0, rows };
        let text = markdown(&report);
        assert!(text.contains("### Tables") && text.contains("### Frames"), "{text}");
        assert!(
            text.contains("| f | x | 0 to 1 | 7 | 2.0e-6 | 1.0e-4 | 2.0e-6 | 0 |  | `{\"x\": 1}` | yes |"),
            "{text}"
        );
        assert!(text.contains("1 NaN") && text.contains("**no**: 1 results that are no numbers"), "{text}");
        assert!(text.contains("a\\|z") && text.contains("...`"), "{text}");
        assert!(text.contains("2 rows, 1 of which do not hold"), "{text}");
        assert!(!report.holds());
        let parsed: serde_json::Value = serde_json::from_str(&json(&report).unwrap()).unwrap();
        assert_eq!(parsed["rows"][1]["found"]["nan"], 1);
        assert!(parsed["rows"][1]["found"]["at"].as_str().unwrap().len() > 200);
    }
}
