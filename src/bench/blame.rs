//! What each approximation costs in error and saves in time: left out by itself, and as the only one of its group.

use super::report::Report;
use super::settings::{DEFAULT, GROUPS, Group};

/// One approximation in one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Blame {
    /// The approximation.
    pub name: &'static str,
    /// The view.
    pub view: String,
    /// Against the default: what it adds to the error and to the time, as the default has it and with it left out.
    pub off: Option<Change>,
    /// Against the picture without any of its group: what it adds to that by itself.
    pub alone: Option<Change>,
}

/// What an approximation does to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// FLIP with it less FLIP without: above 0 it costs error.
    pub flip: f64,
    /// Time with it as a share of the time without: below 1 it saves.
    pub time: f64,
}

/// Every approximation of the report, by view; what was not measured is absent.
pub fn blame(report: &Report) -> Vec<Blame> {
    let rows = GROUPS.iter().flat_map(|group| group.members.iter().map(move |member| (group, member)));
    let all = rows.flat_map(|(group, member)| {
        report.views.iter().map(move |view| {
            let change = |with: &str, without: &str| {
                let (with, without) = (report.cell(&view.name, with)?, report.cell(&view.name, without)?);
                let time = with.time(&report.head).median / without.time(&report.head).median;
                Some(Change { flip: with.flip - without.flip, time })
            };
            Blame {
                name: member.name,
                view: view.name.clone(),
                off: change(DEFAULT, &Group::off(member, 1).name),
                alone: change(&group.alone(member, 1).name, group.bare),
            }
        })
    });
    all.filter(|blame| blame.off.is_some() || blame.alone.is_some()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::sample;

    #[test]
    fn costs_and_savings_have_the_right_signs_and_what_was_not_measured_is_absent() {
        let mut report = sample();
        report.cells[1].setting.name = "shadow map off".into();
        report.cells[2].setting.name = "shadow map alone".into();
        let found = blame(&report);
        assert_eq!(found.len(), 1);
        let Blame { name, off, alone, .. } = &found[0];
        assert_eq!((*name, alone), ("shadow map", &None), "there is no picture without any shadow");
        // The default errs by 0.2 in 100 ms, without the map by 0.15 in 80.
        let off = off.unwrap();
        assert!((off.flip - 0.05).abs() < 1e-12 && (off.time - 1.25).abs() < 1e-12, "{off:?}");
    }
}
