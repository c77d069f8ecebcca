//! Whether `worsted render --max-error` and `--max-ms` keep their promise: a front is fitted to one swatch, and held
//! against cloth that it was not fitted to.
//!
//! A time is promised of the wall clock, which other programs disturb. So the same front is fitted once more with
//! processor time in its place: where that promise is kept and the other is not, other programs were to blame.

use crate::budget_scenes::{FITTED, OTHERS, Other, PROMISED, YARN, camera, other_size, size};
use crate::report::{Verdicts, print_columns, print_head};
use crate::stage::{Stage, joined, request};
use std::path::PathBuf;
use tempfile::TempDir;
use worsted::bench::budget::{ERROR_MARGIN, Facts, Promise, TIME_MARGIN, Wanted, pick, promises};
use worsted::bench::fronts::{Fronts, look};
use worsted::bench::run::{self, Plan};
use worsted::bench::settings::{Setting, quick_grid};
use worsted::bench::truth::TruthSettings;
use worsted::bench::verify;
use worsted::bench::views::{ViewKind, views};
use worsted::error::Error;
use worsted::io::cache::Cache;
use worsted::io::error::FileError;
use worsted::math::spread::Spread;
use worsted::scene::Scene;

const FITTED_VIEWS: [ViewKind; 3] = [ViewKind::Close, ViewKind::Worst, ViewKind::Full];
const FITTED_FRAMES: u32 = 2;

/// `measure budgets`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Height in pixels of the fitted pictures; they are 4 wide for 3 high.
    #[arg(long, default_value_t = 90, value_parser = clap::value_parser!(u32).range(30..=1080))]
    height: u32,
    /// Where references are kept from run to run; nowhere when not given.
    #[arg(long = "cache", value_name = "DIR")]
    cache: Option<PathBuf>,
}

/// The clocks that a time is promised of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Clock {
    Wall,
    Processor,
}

/// The front by each clock.
struct Fitted {
    wall: Fronts,
    processor: Fronts,
    cache: Cache,
}

/// What one setting did in one scene.
struct Done {
    setting: Setting,
    flip: f64,
    wall_ms: f64,
    processor_ms: f64,
}

/// Fits, asks, measures; prints what was promised and what came out.
///
/// # Errors
/// Those of scenes, files and the device; a promise that was not kept, but for those of the wall clock; a refusal where
/// there must be a promise, or a promise where there must be a refusal.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let folder = tempfile::tempdir().map_err(|e| FileError::io(&std::env::temp_dir(), "write", &e))?;
    let fitted = fit(stage, options, &folder)?;
    let [width, height] = size(options.height);
    let lines = [
        format!(
            "fitted to {} of {YARN}, {width} x {height} pixels, {} settings in {} views, {FITTED_FRAMES} frames, \
             {} samples a pixel in every reference",
            FITTED.name(),
            quick_grid().len(),
            FITTED_VIEWS.len(),
            verify::SAMPLES
        ),
        format!("margins: {ERROR_MARGIN} of errors, {TIME_MARGIN} of times"),
        "time: median of 3 frames; of the wall clock as `--verify` has it, and of the processor, all threads"
            .to_owned(),
    ];
    print_head("Budgets in scenes that were not measured", stage.device(), &lines);
    print_columns(&["scene", "asked", "picked", "promised", "measured", "verdict"]);
    let mut verdicts = Verdicts::default();
    let mut worst = Vec::new();
    for (index, other) in OTHERS.iter().enumerate() {
        let scene = camera(stage, options.height, other)?;
        worst.extend(ask(stage, &fitted, (other, options, &scene), index < PROMISED, &mut verdicts)?);
    }
    println!(
        "\nMost that any of the settings did, picked or not, as a share of what was fitted for it (without margin):\n"
    );
    print_columns(&["scene", "fiber px", "FLIP", "processor time", "wall time"]);
    worst.iter().for_each(|row| println!("{row}"));
    verdicts.finish()
}

/// Measures the swatch as `worsted bench` does.
fn fit(stage: &Stage, options: &Options, folder: &TempDir) -> Result<Fitted, Error> {
    let cache =
        Cache::new(Some(options.cache.as_deref().unwrap_or(folder.path()))).map_err(Error::Arguments)?;
    let scene = stage.model(YARN, FITTED)?.path;
    let plan = Plan {
        views: views(&scene, &[], size(options.height), &FITTED_VIEWS)?,
        scene,
        model: format!("{} of {YARN}", FITTED.name()),
        sets: Vec::new(),
        settings: quick_grid(),
        size: size(options.height),
        truth: TruthSettings { samples: verify::SAMPLES, floors: Vec::new() },
        frames: FITTED_FRAMES,
        folder: folder.path().join("report"),
        cache: cache.clone(),
    };
    let mut report = run::run(stage.device(), &plan, &mut |_, _| ())?;
    let look = look(&Scene::load(&plan.scene, &[])?);
    let empty = Fronts {
        device: report.head.device.clone(),
        driver: report.head.driver.clone(),
        entries: Vec::new(),
    };
    let [mut wall, mut processor] = [empty.clone(), empty];
    wall.add(&report, &look);
    for cell in &mut report.cells {
        cell.wall_ms =
            cell.cpu_ms.unwrap_or(Spread { median: f64::NAN, min: f64::NAN, max: f64::NAN, frames: 0 });
    }
    processor.add(&report, &look);
    Ok(Fitted { wall, processor, cache })
}

/// Asks for budgets in one scene and holds what was promised against what is measured. Returns the row of the second
/// table, where there were promises.
fn ask(
    stage: &Stage,
    fitted: &Fitted,
    (other, options, (path, sets)): (&Other, &Options, &(PathBuf, Vec<String>)),
    must_promise: bool,
    verdicts: &mut Verdicts,
) -> Result<Option<String>, Error> {
    let size = other_size(options.height, other);
    let scene = Scene::load(path, sets)?;
    let facts = Facts::of(&scene, size)?;
    let all = match promises(&fitted.wall, &facts, other.name) {
        Ok(all) => all,
        Err(refusal) => {
            let why = refusal.to_string();
            let why = why.split(": make one").next().unwrap_or_default();
            println!("| {} | anything | | | | said it cannot: {why} |", other.name);
            verdicts.at_most(
                &format!("refusals in {}", other.name),
                1.0,
                if must_promise { 0.0 } else { 1.0 },
            );
            return Ok(None);
        }
    };
    verdicts.at_least(
        &format!("promises in {}", other.name),
        1.0,
        if must_promise { 1.0 } else { f64::INFINITY },
    );
    let mut done = Vec::new();
    for promise in &all {
        done.push(draw(stage, &fitted.cache, (path, sets, &scene), size, &promise.setting)?);
    }
    let processor =
        promises(&fitted.processor, &facts, other.name).map_err(|e| Error::Failed(e.to_string()))?;
    let asked = Asked { name: other.name, facts: &facts, done: &done };
    asked.errors(&fitted.wall, &all, verdicts)?;
    asked.times(&fitted.processor, &processor, Clock::Processor, verdicts)?;
    asked.times(&fitted.wall, &all, Clock::Wall, verdicts)?;
    let most = |of: &dyn Fn(&Done) -> f64, from: &[Promise], promised: fn(&Promise) -> f64| {
        let shares = done.iter().filter_map(|done| {
            let promise = from.iter().find(|promise| promise.setting == done.setting)?;
            Some((of(done) / promised(promise), &done.setting.name))
        });
        let most = shares.max_by(|a, b| a.0.total_cmp(&b.0));
        most.map_or((f64::NAN, String::new()), |(share, name)| (share, name.clone()))
    };
    let (error, error_name) = most(&|done| done.flip, &all, |promise| promise.error / ERROR_MARGIN);
    let (cpu, cpu_name) = most(&|done| done.processor_ms, &processor, |promise| promise.ms / TIME_MARGIN);
    let (wall, wall_name) = most(&|done| done.wall_ms, &all, |promise| promise.ms / TIME_MARGIN);
    Ok(Some(format!(
        "| {} | {:.3} | {error:.2} ({error_name}) | {cpu:.2} ({cpu_name}) | {wall:.2} ({wall_name}) |",
        other.name, facts.fiber_px
    )))
}

/// Draws and compares as `worsted render --verify` does.
fn draw(
    stage: &Stage,
    cache: &Cache,
    (path, sets, asked_for): (&PathBuf, &[String], &Scene),
    size: [u32; 2],
    setting: &Setting,
) -> Result<Done, Error> {
    let settled = Scene::load(path, &joined(sets, &setting.sets))?;
    let measured = verify::times(stage.device(), settled, request(size, setting.samples, false)?)?;
    Ok(Done {
        flip: verify::error(cache, asked_for, &measured.linear, &mut |_| Ok(()))?,
        wall_ms: measured.wall_ms.median,
        processor_ms: measured.cpu_ms.median,
        setting: setting.clone(),
    })
}

/// A scene that budgets are asked for in.
struct Asked<'a> {
    name: &'a str,
    facts: &'a Facts,
    done: &'a [Done],
}

impl Asked<'_> {
    fn errors(&self, fronts: &Fronts, all: &[Promise], verdicts: &mut Verdicts) -> Result<(), Error> {
        for most in asks(all.iter().map(|promise| promise.error), 1e3) {
            let wanted = Wanted { error: Some(most), ms: None };
            let said = format!("FLIP {most:.3}");
            let of = (|promise: &Promise| promise.error, |done: &Done| done.flip);
            self.row(fronts, wanted, &said, of, most, Some(verdicts))?;
        }
        Ok(())
    }

    /// What is promised of the wall clock is printed, and judged where no other clock can be.
    fn times(
        &self,
        fronts: &Fronts,
        all: &[Promise],
        clock: Clock,
        verdicts: &mut Verdicts,
    ) -> Result<(), Error> {
        for most in asks(all.iter().map(|promise| promise.ms), 1.0) {
            let wanted = Wanted { error: None, ms: Some(most) };
            let promised = |promise: &Promise| promise.ms;
            match clock {
                Clock::Wall => {
                    let of = (promised, |done: &Done| done.wall_ms);
                    self.row(fronts, wanted, &format!("{most} ms, wall"), of, most, None)?;
                }
                Clock::Processor => {
                    let of = (promised, |done: &Done| done.processor_ms);
                    self.row(fronts, wanted, &format!("{most} ms, processor"), of, most, Some(verdicts))?;
                }
            }
        }
        Ok(())
    }

    fn row(
        &self,
        fronts: &Fronts,
        wanted: Wanted,
        said: &str,
        (promised, measured): (impl Fn(&Promise) -> f64, impl Fn(&Done) -> f64),
        most: f64,
        verdicts: Option<&mut Verdicts>,
    ) -> Result<(), Error> {
        let name = self.name;
        let promise = match pick(fronts, self.facts, wanted, name) {
            Ok(promise) => promise,
            Err(refusal) => {
                println!("| {name} | {said} | | | | said it cannot: {refusal} |");
                return Ok(());
            }
        };
        let done = self.done.iter().find(|done| done.setting == promise.setting);
        let found = done.map_or(f64::NAN, measured);
        if let Some(verdicts) = verdicts {
            verdicts.at_most(&format!("{name}, {said}, {}", promise.setting.name), found, most);
        }
        let verdict = if found <= most { "kept" } else { "broken" };
        let digits = if wanted.error.is_some() { 3 } else { 0 };
        let promised = promised(&promise);
        println!(
            "| {name} | {said} | {} | {promised:.digits$} | {found:.digits$} | {verdict} |",
            promise.setting.name
        );
        Ok(())
    }
}

/// What to ask for where `promised` can be had: less than the least of it, the least, the middle and the most, the last
/// three rounded up to a whole `per_unit`th, so that nothing is left between what is asked and what is promised.
fn asks(promised: impl Iterator<Item = f64>, per_unit: f64) -> Vec<f64> {
    let mut all: Vec<f64> = promised.filter(|value| value.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    let (Some(least), Some(most)) = (all.first(), all.last()) else { return Vec::new() };
    let up = |value: f64| (value * per_unit).ceil() / per_unit;
    let mut asked = vec![up(0.5 * least), up(*least), up(all[all.len() / 2]), up(*most)];
    asked.dedup();
    asked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_little_is_asked_for_and_then_what_can_just_be_had() {
        let found = asks([0.3001, 0.1, 0.2, f64::NAN].into_iter(), 1e3);
        assert_eq!(found, [0.05, 0.1, 0.2, 0.301]);
        assert_eq!(asks([40.0, 40.0].into_iter(), 1.0), [20.0, 40.0]);
        assert!(asks(std::iter::empty(), 1.0).is_empty());
    }
}
