//! `worsted render --max-error` and `--max-ms`: settings by what was measured on this device.

use super::bench_args::Budget;
use super::job::{RenderJob, in_range};
use crate::bench::budget::{Facts, Promise, Wanted, pick};
use crate::bench::fronts::Fronts;
use crate::bench::verify;
use crate::cli::say::tell;
use crate::error::Error;
use crate::frame::Picture;
use crate::frame::sampling::Sampling;
use crate::io::cache::Cache;
use crate::io::picture::LinearImage;
use crate::scene::Scene;
use crate::vulkan::Device;
use std::sync::Arc;

/// What a picture may cost, and where that is known from.
pub struct BudgetJob {
    wanted: Wanted,
    verify: bool,
    cache: Cache,
}

impl BudgetJob {
    /// Resolves arguments; none where nothing is asked for.
    ///
    /// # Errors
    /// Arguments that make no sense.
    pub fn new(args: &Budget) -> Result<Option<Self>, Error> {
        let wanted = Wanted { error: args.max_error, ms: args.max_ms };
        if let Some(error) = wanted.error {
            in_range("--max-error", error, 0.0, 1.0)?;
        }
        if let Some(ms) = wanted.ms {
            in_range("--max-ms", ms, 0.0, 1e9)?;
        }
        if wanted.error.is_none() && wanted.ms.is_none() {
            if args.verify {
                return Err(Error::Arguments("--verify: expected --max-error or --max-ms to verify".into()));
            }
            return Ok(None);
        }
        Ok(Some(Self {
            wanted,
            verify: args.verify,
            cache: Cache::new(args.cache.folder.as_deref()).map_err(Error::Arguments)?,
        }))
    }

    /// Picks settings for the job's scene and puts them in place; says which and why.
    ///
    /// # Errors
    /// Nothing measured that would tell, or nothing good enough.
    pub fn settle(&self, job: &mut RenderJob, device: &Device) -> Result<Promise, Error> {
        let fronts = Fronts::read(&self.cache, device.name(), device.driver())?;
        let facts = Facts::of(&job.scene, job.request.size)?;
        let path = job.path.display().to_string();
        let promise =
            pick(&fronts, &facts, self.wanted, &path).map_err(|e| Error::Arguments(e.to_string()))?;
        job.sets.extend(promise.setting.sets.iter().cloned());
        let settled = Scene::load(&job.path, &job.sets)?;
        job.asked_for = Some(std::mem::replace(&mut job.scene, settled));
        job.request.sampling = Sampling::new(promise.setting.samples).map_err(Error::Arguments)?;
        if !job.common.quiet {
            tell!(
                "settings: {} ({}), FLIP at most {:.3}, at most {:.0} ms: measured on {}; a fiber is {:.2} pixels \
                 wide here",
                promise.setting.name,
                promise.setting.as_options(),
                promise.error,
                promise.ms,
                promise.measured_on,
                facts.fiber_px
            );
        }
        Ok(promise)
    }

    /// Whether the picture is what was asked for, where that is to be known; says what was measured.
    ///
    /// # Errors
    /// A promise that was not kept; those of the reference and the device.
    pub fn verify(&self, job: &RenderJob, device: &Arc<Device>, picture: &Picture) -> Result<(), Error> {
        if !self.verify {
            return Ok(());
        }
        let mut broken = Vec::new();
        let mut hold = |what: &str, found: f64, most: f64| {
            let kept = found <= most;
            let said = format!("{what} {found:.4}, at most {most} was asked for");
            if !job.common.quiet {
                tell!("verified: {said}: {}", if kept { "kept" } else { "broken" });
            }
            if !kept {
                broken.push(said);
            }
        };
        if let Some(most) = self.wanted.ms {
            let measured = verify::times(device, job.scene.clone(), job.request)?;
            hold("wall time in ms", measured.wall_ms.median, most);
        }
        if let Some(most) = self.wanted.error {
            let asked_for = job.asked_for.as_ref().unwrap_or(&job.scene);
            let [width, height] = picture.size;
            let drawn = LinearImage { width, height, pixels: picture.linear.clone() };
            hold("FLIP", verify::error(&self.cache, asked_for, &drawn, &mut |_| Ok(()))?, most);
        }
        if broken.is_empty() {
            Ok(())
        } else {
            Err(Error::Failed(format!("not kept: {}", broken.join("; "))))
        }
    }
}
