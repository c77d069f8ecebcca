//! Settings that keep an error or a time, picked from what was measured on this device.

use super::fronts::{Entry, Fronts, look};
use super::settings::Setting;
use super::views::fiber_px;
use super::work::work;
use crate::error::Error;
use crate::scene::Scene;

/// Factor on measured errors: another cloth of the same look came out up to 1.36 times worse (`measure budgets`).
pub const ERROR_MARGIN: f64 = 1.5;
/// The same of times: there up to 1.82 times as long, by processor time.
pub const TIME_MARGIN: f64 = 2.0;
/// How far beyond the measured widths of a fiber a scene's may lie, as a factor.
const REACH: f64 = 1.5;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Most FLIP over covered pixels.
    pub error: Option<f64>,
    /// Most wall time of a picture, ms.
    pub ms: Option<f64>,
}

/// What is known of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// [`super::fronts::look`].
    pub look: String,
    /// Width in pixels of a fiber at what the camera looks at.
    pub fiber_px: f64,
    /// [`super::work::work`].
    pub work: f64,
}

impl Facts {
    /// Those of the scene for a picture of `size` pixels.
    ///
    /// # Errors
    /// A scene without fabric.
    pub fn of(scene: &Scene, size: [u32; 2]) -> Result<Self, Error> {
        Ok(Self { look: look(scene), fiber_px: fiber_px(scene, size)?, work: work(scene, size) })
    }
}

/// Settings with what they are good for.
#[derive(Clone, Debug, PartialEq)]
pub struct Promise {
    /// The way to draw.
    pub setting: Setting,
    /// Mean FLIP over covered pixels that is not exceeded.
    pub error: f64,
    /// Wall time of a picture, ms, that is not exceeded.
    pub ms: f64,
    /// What it was measured on.
    pub measured_on: String,
}

impl Promise {
    /// FLIP and milliseconds as they were measured, in proportion to the scene's work: without the margins.
    pub fn expected(&self) -> (f64, f64) {
        (self.error / ERROR_MARGIN, self.ms / TIME_MARGIN)
    }
}

/// Why nothing is promised; one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Nothing was measured that would tell.
    #[error("no measured front {0}: make one with `worsted bench -o report{1}`")]
    NotMeasured(String, String),
    /// It was, and nothing is good enough.
    #[error("cannot keep {0}")]
    OutOfReach(String),
}

/// What every measured setting would do in the scene; `model` names the scene in advice.
///
/// # Errors
/// Nothing was measured that would tell.
pub fn promises(fronts: &Fronts, facts: &Facts, model: &str) -> Result<Vec<Promise>, Refusal> {
    let advice = || format!(" --model {model}");
    if fronts.entries.is_empty() {
        return Err(Refusal::NotMeasured(format!("on {}", fronts.device), advice()));
    }
    let alike: Vec<&Entry> = fronts.entries.iter().filter(|entry| entry.look == facts.look).collect();
    if alike.is_empty() {
        let what = format!("of this yarn, fiber, light and shading on {}", fronts.device);
        return Err(Refusal::NotMeasured(what, advice()));
    }
    let widths = || alike.iter().map(|entry| entry.fiber_px);
    let [narrowest, widest] = [widths().fold(f64::INFINITY, f64::min), widths().fold(0.0, f64::max)];
    if !(narrowest / REACH..=widest * REACH).contains(&facts.fiber_px) {
        let what = format!(
            "of fibers {:.3} pixels wide (measured are {narrowest:.3} to {widest:.3})",
            facts.fiber_px
        );
        return Err(Refusal::NotMeasured(what, format!("{} --views distance", advice())));
    }
    let mut found: Vec<Promise> = Vec::new();
    for entry in &alike {
        if found.iter().all(|promise| promise.setting != entry.setting) {
            found.extend(promise(&alike, &entry.setting, facts));
        }
    }
    Ok(found)
}

/// What one setting would do: the worse of what it did at the next wider and the next narrower fibers.
fn promise(alike: &[&Entry], setting: &Setting, facts: &Facts) -> Option<Promise> {
    let own = || alike.iter().copied().filter(|entry| entry.setting == *setting);
    let below = own().filter(|entry| entry.fiber_px <= facts.fiber_px).map(|entry| entry.fiber_px);
    let above = own().filter(|entry| entry.fiber_px >= facts.fiber_px).map(|entry| entry.fiber_px);
    let (below, above) = (below.fold(f64::NAN, f64::max), above.fold(f64::NAN, f64::min));
    let near: Vec<&Entry> =
        own().filter(|entry| entry.fiber_px == below || entry.fiber_px == above).collect();
    let worst = |of: &dyn Fn(&Entry) -> f64| near.iter().map(|entry| of(entry)).fold(f64::NAN, f64::max);
    let mut views: Vec<String> =
        near.iter().map(|entry| format!("{} ({}, {})", entry.view, entry.model, entry.date)).collect();
    views.dedup();
    let (error, rate) = (worst(&|entry| entry.flip), worst(&|entry| entry.wall_ms / entry.work));
    (error.is_finite() && rate.is_finite()).then(|| Promise {
        setting: setting.clone(),
        error: ERROR_MARGIN * error,
        ms: TIME_MARGIN * rate * facts.work,
        measured_on: views.join(" and "),
    })
}

/// Picks settings: of those that keep what is asked for, the fastest where an error is given, else the most accurate.
/// `model` names the scene in advice.
///
/// # Errors
/// Nothing was measured that would tell, or nothing measured is good enough.
pub fn pick(fronts: &Fronts, facts: &Facts, wanted: Wanted, model: &str) -> Result<Promise, Refusal> {
    let all = promises(fronts, facts, model)?;
    let keeps_error = |promise: &&Promise| wanted.error.is_none_or(|most| promise.error <= most);
    let keeps_time = |promise: &&Promise| wanted.ms.is_none_or(|most| promise.ms <= most);
    let by = |of: fn(&Promise) -> f64| move |a: &&Promise, b: &&Promise| of(a).total_cmp(&of(b));
    let (error, ms) = (|promise: &Promise| promise.error, |promise: &Promise| promise.ms);
    let good = all.iter().filter(keeps_error).filter(keeps_time);
    let picked = if wanted.error.is_some() { good.min_by(by(ms)) } else { good.min_by(by(error)) };
    if let Some(picked) = picked {
        return Ok(picked.clone());
    }
    let mut lacks = Vec::new();
    if let Some(most) = wanted.error {
        let best = all.iter().map(error).fold(f64::INFINITY, f64::min);
        lacks.push(format!("FLIP {most}: the least that can be promised is {best:.3}"));
    }
    if let Some(most) = wanted.ms {
        let best = all.iter().map(ms).fold(f64::INFINITY, f64::min);
        lacks.push(format!("{most} ms: the least that can be promised is {best:.0} ms"));
    }
    Err(Refusal::OutOfReach(lacks.join(", or together with ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(view: &str, fiber_px: f64, name: &str, flip: f64, wall_ms: f64) -> Entry {
        Entry {
            look: "look".into(),
            model: "swatch".into(),
            view: view.into(),
            fiber_px,
            size: [480, 360],
            setting: Setting { name: name.into(), samples: 4, sets: Vec::new() },
            flip,
            floor_flip: None,
            wall_ms,
            work: 1e6,
            date: "2026".into(),
        }
    }

    fn fronts() -> Fronts {
        let entries = vec![
            entry("close", 1.2, "default", 0.10, 1000.0),
            entry("full", 0.2, "default", 0.12, 500.0),
            entry("close", 1.2, "rough", 0.20, 100.0),
            entry("full", 0.2, "rough", 0.30, 50.0),
        ];
        Fronts { device: "a device".into(), driver: "a driver".into(), entries }
    }

    fn facts(fiber_px: f64) -> Facts {
        Facts { look: "look".into(), fiber_px, work: 2e6 }
    }

    const ERROR: fn(f64) -> Wanted = |most| Wanted { error: Some(most), ms: None };
    const TIME: fn(f64) -> Wanted = |most| Wanted { error: None, ms: Some(most) };

    #[test]
    fn an_error_gets_the_fastest_and_a_time_the_most_accurate_that_keep_it() {
        let name = |wanted: Wanted| pick(&fronts(), &facts(0.5), wanted, "x").map(|p| p.setting.name);
        assert_eq!(name(ERROR(0.2)).unwrap(), "default");
        assert_eq!(name(ERROR(0.5)).unwrap(), "rough");
        assert_eq!(name(TIME(1e4)).unwrap(), "default");
        assert_eq!(name(TIME(1000.0)).unwrap(), "rough");
        let promise = pick(&fronts(), &facts(0.5), ERROR(0.2), "x").unwrap();
        // The worse of its neighbours, with a margin; twice the work takes twice the time.
        assert!((promise.error - ERROR_MARGIN * 0.12).abs() < 1e-12);
        assert!((promise.ms - TIME_MARGIN * 2000.0).abs() < 1e-9);
        // At the close view's own width only that one counts.
        let close = pick(&fronts(), &facts(1.2), ERROR(0.2), "x").unwrap();
        assert!((close.error - ERROR_MARGIN * 0.10).abs() < 1e-12 && close.measured_on.contains("close"));
    }

    #[test]
    fn what_cannot_be_promised_is_refused_with_the_reason() {
        let refusal = |fronts: &Fronts, facts: &Facts, wanted| {
            pick(fronts, facts, wanted, "x.toml").unwrap_err().to_string()
        };
        let out = refusal(&fronts(), &facts(0.5), ERROR(0.1));
        assert!(out.contains("0.1:") && out.contains("0.180"), "{out}");
        let out = refusal(&fronts(), &facts(0.5), TIME(1.0));
        assert!(out.contains("400 ms"), "{out}");
        let both = Wanted { error: Some(0.2), ms: Some(1000.0) };
        assert!(refusal(&fronts(), &facts(0.5), both).contains("together"));
        let empty = Fronts { device: "a device".into(), ..Default::default() };
        let out = refusal(&empty, &facts(0.5), ERROR(0.5));
        assert!(out.contains("worsted bench") && out.contains("a device") && out.contains("x.toml"), "{out}");
        let other = Facts { look: "another".into(), ..facts(0.5) };
        assert!(refusal(&fronts(), &other, ERROR(0.5)).contains("of this yarn"));
        for fiber_px in [0.01, 5.0, f64::NAN] {
            assert!(refusal(&fronts(), &facts(fiber_px), ERROR(0.5)).contains("--views distance"));
        }
    }
}
