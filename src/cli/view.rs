//! `worsted view`.

use super::args::Common;
use super::device_options;
use super::job::{assignments, kept, parse_size};
use super::view_args::View;
use super::view_references::Traced;
use crate::error::Error;
use crate::frame::check_tables;
use crate::io::cache::Cache;
use crate::io::whole::check_target;
use crate::scene::Scene;
use crate::shaders::ShaderSet;
use crate::viewer::app::{Opening, run as open};
use crate::viewer::desk::Look;
use crate::viewer::document::Document;
use crate::viewer::recent::Recent;
use crate::viewer::references::References;
use crate::viewer::scripts::Script;
use std::sync::Arc;

/// Opens a window and waits until it is closed.
///
/// # Errors
/// Arguments that make no sense, a scene that cannot be had, no display, no device, a device that fails.
pub fn run(args: &View, common: &Common) -> Result<(), Error> {
    if let Some(path) = &args.screenshot {
        check_target(path)?;
    }
    #[cfg(feature = "hot-reload")]
    if let Some(folder) = args.shaders.as_ref().filter(|folder| !folder.is_dir()) {
        let found = if folder.exists() { "a file" } else { "none" };
        let what = format!("--shaders {}: expected a folder of shaders, found {found}", folder.display());
        return Err(Error::Arguments(what));
    }
    let mut document = Document::open(&args.scene.path)?;
    for assignment in assignments(&args.scene, args.time.frame, args.view.camera.as_deref())? {
        document.assign(&assignment).map_err(|why| Error::Arguments(format!("--set {assignment}: {why}")))?;
    }
    // What cannot be had is said before a window opens.
    let name = args.scene.path.display().to_string();
    check_tables(&Scene::from_file(document.scene_file().clone(), document.folder(), &name)?)?;
    let mut recent = if args.screenshot.is_some() { Recent::nowhere() } else { Recent::of_user() };
    recent.note(&args.scene.path);
    open(Opening {
        document,
        look: Look { most_samples: args.samples, statistics: true, shaders: ShaderSet::default() },
        reference: args.reference.clone(),
        #[cfg(feature = "hot-reload")]
        shaders: args.shaders.clone(),
        size: parse_size(&args.view.size)?,
        device: device_options(common),
        kept: kept(args.no_cache, &args.cache),
        recent,
        references: references(args),
        script: Script { screenshot: args.screenshot.clone(), exit_after: args.exit_after_frames },
    })
}

/// Who traces references; nobody for a user without a home, who named no folder to keep them in.
fn references(args: &View) -> Option<Arc<dyn References>> {
    let cache = Cache::new(args.cache.folder.as_deref()).ok()?;
    Some(Arc::new(Traced { cache }))
}
