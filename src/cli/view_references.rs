//! References for the window: traced as `worsted bench` traces them, and kept in the same cache.

use super::job::pose;
use crate::bench::budget::{Facts, promises};
use crate::bench::fronts::Fronts;
use crate::bench::references::reference;
use crate::bench::truth::TruthSettings;
use crate::error::Error;
use crate::io::cache::Cache;
use crate::scene::Scene;
use crate::viewer::references::{Asked, Found, Known, References};

/// Traces references of the window's scenes.
pub struct Traced {
    /// Where they are kept, and what was measured on devices.
    pub cache: Cache,
}

impl References for Traced {
    fn reference(&self, asked: &Asked, goes_on: &dyn Fn(f64) -> bool) -> Result<Option<Found>, Error> {
        let mut scene = Scene::from_file(asked.file.clone(), &asked.folder, &asked.name)?;
        pose(&mut scene, Some(asked.size))?;
        let settings = TruthSettings { samples: asked.samples, floors: Vec::new() };
        let mut stopped = false;
        let truth = reference(&self.cache, &scene, asked.size, &settings, &mut |share| {
            stopped = !goes_on(share);
            let stop = || Err(Error::Failed("the reference is given up".into()));
            if stopped { stop() } else { Ok(()) }
        });
        if stopped && truth.is_err() {
            return Ok(None);
        }
        let light = truth?.picture.mean;
        Ok(Some(Found { light, known: self.known(&scene, asked)? }))
    }
}

impl Traced {
    /// What other ways to draw the scene did where they were measured, in proportion to its size.
    fn known(&self, scene: &Scene, asked: &Asked) -> Result<Vec<Known>, Error> {
        let fronts = Fronts::read(&self.cache, asked.device.name(), asked.device.driver())?;
        let facts = Facts::of(scene, asked.size)?;
        // Where nothing of the kind was measured there is nothing to show.
        let promises = promises(&fronts, &facts, &asked.name).unwrap_or_default();
        let known = promises.iter().map(|promise| {
            let (flip, ms) = promise.expected();
            Known { name: promise.setting.name.clone(), ms, flip }
        });
        Ok(known.collect())
    }
}
