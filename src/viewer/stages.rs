//! Which picture is drawn next: coarse ones soon, fine ones while nobody wants another.

use super::draft::{Detail, Edit};
use super::pace::{Pace, TARGET_MS};
use super::painter::Wanted;
use crate::frame::Request;
use crate::frame::sampling::Sampling;
use std::time::Duration;

/// Samples of the pictures that follow one another while nothing changes.
const REFINEMENTS: [u32; 3] = [4, 16, 64];
/// Time in which somebody who waits for a whole picture sees one that is nearly so.
const SOON_MS: f64 = 900.0;
/// Time in which tables are waited for with a draft.
const SOON_BAKED: Duration = Duration::from_secs(2);

/// What is drawn next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// Nothing.
    #[default]
    Nothing,
    /// Coarser than the scene.
    Draft(Detail),
    /// The scene itself, small.
    Small,
    /// And whole, by its place among the refinements.
    Whole(usize),
}

/// What decides it.
#[derive(Clone, Copy, Debug)]
pub struct Situation {
    /// Whether drafts are worth it, and what is shown has any.
    pub has_drafts: bool,
    /// What changed last.
    pub edit: Edit,
    /// Something is dragged, or plays.
    pub moving: bool,
    /// Whether tables are those of a scene before.
    pub stale: bool,
    /// How long the last tables took.
    pub bakes_take: Duration,
    /// Width and height in pixels of a whole picture.
    pub size: [u32; 2],
    /// Samples to which it is refined.
    pub most_samples: u32,
}

/// How long pictures take, each kind by itself.
#[derive(Default)]
pub struct Paces {
    scene: Pace,
    fibers: Pace,
    cores: Pace,
}

impl Paces {
    /// What is drawn first of what is shown anew.
    pub fn first(&self, now: &Situation) -> Stage {
        if now.has_drafts {
            let cores = now.edit != Edit::Flyaways && !self.fibers.whole_is_fast();
            return Stage::Draft(if cores { Detail::Cores } else { Detail::Fibers });
        }
        match self.scene.whole_is_fast() && !now.moving {
            true => Stage::Whole(0),
            false => Stage::Small,
        }
    }

    /// What follows a picture, if nothing else is wanted meanwhile.
    pub fn after(&self, stage: Stage, now: &Situation) -> Stage {
        let step = match stage {
            Stage::Nothing => return Stage::Nothing,
            // A look from elsewhere is soon followed by the next; a value is looked at.
            Stage::Draft(Detail::Cores) if now.moving && now.edit == Edit::View => return Stage::Nothing,
            Stage::Draft(Detail::Cores) => return Stage::Draft(Detail::Fibers),
            Stage::Draft(_) | Stage::Small if now.moving => return Stage::Nothing,
            // Its own tables are there sooner if nothing is drawn beside.
            Stage::Draft(_) if now.stale && now.bakes_take < SOON_BAKED => return Stage::Nothing,
            Stage::Draft(_) if self.scene.is_slow(now.size, SOON_MS) => return Stage::Small,
            Stage::Draft(_) | Stage::Small => 0,
            Stage::Whole(step) => step + 1,
        };
        // With tables of another scene nothing is worth refining.
        let allowed = |samples: &&u32| step == 0 || !now.stale && **samples <= now.most_samples;
        REFINEMENTS.get(step).filter(allowed).map_or(Stage::Nothing, |_| Stage::Whole(step))
    }

    /// What is drawn once the tables of what was seen last are there: no picture that is coarser.
    pub fn with_own_tables(&self, last: Stage, now: &Situation) -> Stage {
        match last {
            Stage::Small | Stage::Whole(_) if !now.moving => self.after(Stage::Draft(Detail::Fibers), now),
            Stage::Draft(_) if !now.moving => Stage::Draft(Detail::Fibers),
            _ => self.first(now),
        }
    }

    /// Size and samples of a picture.
    pub fn request(&self, stage: Stage, wanted: &Wanted) -> Request {
        let whole = wanted.size;
        match stage {
            Stage::Draft(detail) => {
                let size = self.of(detail).size(whole);
                Request { statistics: false, ..request(wanted, size, 1) }
            }
            Stage::Small => {
                let within_ms = if wanted.moving { TARGET_MS } else { SOON_MS };
                request(wanted, self.scene.size_within(whole, within_ms), REFINEMENTS[0])
            }
            Stage::Nothing => request(wanted, whole, REFINEMENTS[0]),
            Stage::Whole(step) => request(wanted, whole, REFINEMENTS[step.min(REFINEMENTS.len() - 1)]),
        }
    }

    /// Takes note of what a picture of `size` took, of one that is `whole`.
    pub fn learn(&mut self, stage: Stage, size: [u32; 2], whole: [u32; 2], taken: Duration) {
        match stage {
            Stage::Draft(Detail::Fibers) => self.fibers.learn(size, whole, taken),
            Stage::Draft(Detail::Cores) => self.cores.learn(size, whole, taken),
            Stage::Small | Stage::Whole(0) => self.scene.learn(size, whole, taken),
            // Of more samples than those that are foreseen.
            Stage::Nothing | Stage::Whole(_) => (),
        }
    }

    fn of(&self, detail: Detail) -> &Pace {
        match detail {
            Detail::Fibers => &self.fibers,
            Detail::Cores => &self.cores,
        }
    }
}

/// A picture of what is wanted, with so many samples.
pub fn request(wanted: &Wanted, size: [u32; 2], samples: u32) -> Request {
    let sampling = Sampling::new(samples).unwrap_or(Sampling::FOUR);
    Request { size, sampling, statistics: wanted.statistics, profile: false }
}

/// What is drawn of it first on whatever device, by which tables are told.
pub fn whole_request(wanted: &Wanted) -> Request {
    request(wanted, wanted.size, REFINEMENTS[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: Situation = Situation {
        has_drafts: true,
        edit: Edit::Cloth,
        moving: false,
        stale: false,
        bakes_take: Duration::from_millis(300),
        size: [960, 720],
        most_samples: 64,
    };

    /// Everything that is drawn of it, one after the other.
    fn all(paces: &Paces, now: &Situation) -> Vec<Stage> {
        let mut stages = vec![paces.first(now)];
        while let Some(last) = stages.last().copied().filter(|stage| *stage != Stage::Nothing) {
            stages.push(paces.after(last, now));
        }
        stages
    }

    /// Of a device on which a whole picture takes so many milliseconds, and drafts a tenth of that.
    fn paces(ms: u64) -> Paces {
        let mut paces = Paces::default();
        for _ in 0..20 {
            paces.learn(Stage::Whole(0), NOW.size, NOW.size, Duration::from_millis(ms));
            paces.learn(Stage::Draft(Detail::Fibers), NOW.size, NOW.size, Duration::from_millis(ms / 10));
        }
        paces
    }

    #[test]
    fn on_a_slow_device_it_comes_step_by_step_and_ends_with_the_samples_that_are_asked_for() {
        use Stage::{Draft, Nothing, Small, Whole};
        let (cores, fibers) = (Draft(Detail::Cores), Draft(Detail::Fibers));
        let slow = paces(10_000);
        assert_eq!(all(&slow, &NOW), [cores, fibers, Small, Whole(0), Whole(1), Whole(2), Nothing]);
        let few = Situation { most_samples: 4, ..NOW };
        assert_eq!(all(&slow, &few), [cores, fibers, Small, Whole(0), Nothing]);
        // Plies do not show hairs.
        assert_eq!(all(&slow, &Situation { edit: Edit::Flyaways, ..few })[0], fibers);
        // Tables that will be there soon are waited for; others are not, and nothing is refined without them.
        assert_eq!(all(&slow, &Situation { stale: true, ..NOW }), [cores, fibers, Nothing]);
        let long = Situation { stale: true, bakes_take: Duration::from_secs(60), ..NOW };
        assert_eq!(all(&slow, &long), [cores, fibers, Small, Whole(0), Nothing]);
        assert_eq!(all(&paces(500), &NOW)[..2], [fibers, Whole(0)], "soon enough");
    }

    #[test]
    fn while_something_moves_nothing_whole_is_drawn() {
        use Stage::{Draft, Nothing, Small};
        let moving = Situation { moving: true, ..NOW };
        let (cores, fibers) = (Draft(Detail::Cores), Draft(Detail::Fibers));
        let slow = paces(10_000);
        assert_eq!(all(&slow, &moving), [cores, fibers, Nothing]);
        assert_eq!(all(&slow, &Situation { edit: Edit::View, ..moving }), [cores, Nothing]);
        assert_eq!(all(&slow, &Situation { has_drafts: false, ..moving }), [Small, Nothing]);
    }

    #[test]
    fn tables_never_make_a_picture_coarser() {
        use Stage::{Draft, Small, Whole};
        let slow = paces(10_000);
        assert_eq!(slow.with_own_tables(Draft(Detail::Fibers), &NOW), Draft(Detail::Fibers));
        assert_eq!(slow.with_own_tables(Small, &NOW), Small);
        assert_eq!(slow.with_own_tables(Whole(0), &NOW), Small, "as sharp as can be had soon");
        assert_eq!(paces(500).with_own_tables(Whole(0), &NOW), Whole(0));
        assert_eq!(slow.with_own_tables(Stage::Nothing, &NOW), Draft(Detail::Cores));
    }
}
