//! What the painter has on the device: the scene that is shown, and how it follows what is wanted.

use super::draft::{Detail, Edit, drafted};
use super::painter::Shown;
use crate::error::Error;
use crate::frame::moving::Poser;
use crate::frame::tables::Tables;
use crate::frame::{Picture, Renderer, Request};
use crate::io::kept::Kept;
use crate::motion::mover::Movers;
use crate::scene::Scene;
use crate::scene::file::{CameraTable, SceneFile};
use crate::scene::models::Models;
use crate::shaders::ShaderSet;
use crate::vulkan::Device;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

/// A scene on the device.
pub struct Showing {
    renderer: Renderer,
    /// What it is to draw from its next picture on: drafts of a value that is dragged need only what drafts need.
    next: Option<(Scene, Tables)>,
    /// The scene whose own tables are still to be baked: those that it is drawn with are of another one.
    pub stale: Option<Scene>,
    motion: Option<Moving>,
    drafts: [Option<Renderer>; 2],
}

/// What moves, worked out on another thread.
struct Moving {
    times: Sender<f64>,
    poser: Poser,
    /// For a camera that is fitted to all that is played.
    movers: Movers,
    at: Option<f64>,
    fitted: Option<(CameraTable, [u32; 2], CameraTable)>,
}

/// How far what is on the device can follow what is wanted.
pub enum Followed {
    /// It is shown already.
    Already,
    /// It is shown from now on: of a scene that was edited in place (its view alone), or made anew.
    Shown {
        /// What that changes of what is seen.
        edit: Edit,
    },
    /// Nothing on the device can stand for this scene before its tables are baked.
    Awaited(Box<Scene>),
}

impl Showing {
    /// A scene with its tables, or with such as stand for them unless `own`.
    ///
    /// # Errors
    /// Those of the device; motions that cannot be opened.
    pub fn new(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        tables: Tables,
        kept: &Kept,
        own: bool,
    ) -> Result<Self, Error> {
        let movers = Movers::open(&scene)?;
        let stale = (!own).then(|| scene.clone());
        let renderer = Renderer::with_tables(device, scene, request, tables, kept)?;
        let motion = Moving::start(&renderer, movers)?;
        let mut showing = Self { renderer, next: None, stale, motion, drafts: [None, None] };
        showing.pose(showing.scene().file.animation.frame)?;
        Ok(showing)
    }

    /// The scene that is shown.
    fn scene(&self) -> &Scene {
        self.next.as_ref().map_or_else(|| self.renderer.scene(), |(scene, _)| scene)
    }

    /// The tables that it is drawn with.
    fn tables(&self) -> &Tables {
        self.next.as_ref().map_or_else(|| self.renderer.tables(), |(_, tables)| tables)
    }

    /// What draws it as it is.
    ///
    /// # Errors
    /// Those of the device: then the scene before is shown.
    pub fn renderer(&mut self) -> Result<&mut Renderer, Error> {
        if let Some((scene, tables)) = self.next.take() {
            self.renderer.edit(scene, tables)?;
        }
        Ok(&mut self.renderer)
    }

    /// Shows what `file` says, as far as what is on the device can.
    ///
    /// # Errors
    /// A scene that cannot be had; those of the device. What was shown before is then shown still.
    pub fn follow(
        &mut self,
        file: &SceneFile,
        (folder, name): (&Path, &str),
        request: Request,
        models: &mut Models,
    ) -> Result<Followed, Error> {
        let mut file = file.clone();
        if file.animation.frame.is_some() {
            file.camera = self.fitted(&file.camera, request.size)?;
        }
        if file == self.scene().file {
            return Ok(Followed::Already);
        }
        if self.next.is_none() && self.renderer.edit_in_place(&file)? {
            self.pose(file.animation.frame)?;
            return Ok(Followed::Shown { edit: Edit::View });
        }
        let scene = Scene::of_file(file, folder, name, models)?;
        if !self.tables().may_stand_for(&scene, &request) {
            return Ok(Followed::Awaited(Box::new(scene)));
        }
        let tables = self.tables().clone();
        // Tables are of rest, and of no camera.
        let SceneFile { animation, camera, .. } = scene.file.clone();
        let own = self.stale.is_none()
            && SceneFile { animation, camera, ..self.scene().file.clone() } == scene.file;
        let edit = Edit::between(&self.scene().file, &scene.file);
        self.show(scene, tables, own)?;
        Ok(Followed::Shown { edit })
    }

    /// Draws with the scene's own tables, which were baked meanwhile.
    ///
    /// # Errors
    /// Those of the device; motions that cannot be opened.
    pub fn settle(&mut self, tables: Tables) -> Result<(), Error> {
        let Some(mut scene) = self.stale.take() else { return Ok(()) };
        // What was edited in place since.
        scene.file = self.scene().file.clone();
        self.put(scene, tables)
    }

    /// Shows another scene, with tables that stand for its own unless `own`.
    ///
    /// # Errors
    /// Those of the device; motions that cannot be opened.
    pub fn show(&mut self, scene: Scene, tables: Tables, own: bool) -> Result<(), Error> {
        self.stale = (!own).then(|| scene.clone());
        self.put(scene, tables)
    }

    /// Whether it counts what is drawn.
    pub fn counts(&self) -> bool {
        self.renderer.request().statistics
    }

    /// A picture of it, and what is known of that.
    pub fn shown(
        &self,
        picture: Picture,
        draft: Option<Detail>,
        (revision, settled): (u64, bool),
        delay: Duration,
    ) -> Shown {
        let (renderer, scene) = (&self.renderer, self.scene());
        let drawn = draft.and_then(|detail| self.drafts[detail as usize].as_ref()).unwrap_or(renderer);
        let mut stats = drawn.stats().clone();
        stats.set_gpu_bytes(renderer.device());
        Shown {
            camera: scene.fitted_camera(renderer.request().size),
            picture,
            stats,
            file: scene.file.clone(),
            frame_count: self.frame_count(),
            own_tables: self.stale.is_none(),
            settled,
            revision,
            delay,
            refused: None,
            notes: scene.fabrics.iter().flat_map(|fabric| fabric.notes.clone()).collect(),
        }
    }

    fn put(&mut self, scene: Scene, tables: Tables) -> Result<(), Error> {
        let movers = Movers::open(&scene)?;
        self.drafts = [None, None];
        self.next = Some((scene, tables));
        if movers.0.is_empty() {
            self.motion = None;
            return Ok(());
        }
        self.renderer()?;
        self.motion = Moving::start(&self.renderer, movers)?;
        self.pose(self.renderer.scene().file.animation.frame)
    }

    /// Whether it can be drafted: what moves by itself cannot.
    pub fn has_drafts(&self) -> bool {
        self.motion.is_none()
    }

    /// What drafts the scene.
    ///
    /// # Errors
    /// Those of the device.
    pub fn draft(&mut self, detail: Detail, request: Request) -> Result<&mut Renderer, Error> {
        let file = drafted(&self.scene().file, detail);
        let kept = match self.drafts[detail as usize].take() {
            Some(mut draft) => {
                let stays = draft.scene().file == file || draft.edit_in_place(&file)?;
                stays.then_some(draft)
            }
            None => None,
        };
        let mut draft = match kept {
            Some(draft) => draft,
            None => {
                let scene = Scene { file, ..self.scene().clone() };
                self.renderer.beside(scene, request, self.tables().clone())?
            }
        };
        draft.set_request(request)?;
        Ok(self.drafts[detail as usize].insert(draft))
    }

    /// Draws with these shaders from now on; whether they are others than before.
    ///
    /// # Errors
    /// As [`Renderer::set_shaders`].
    pub fn set_shaders(&mut self, shaders: &ShaderSet) -> Result<bool, Error> {
        if self.renderer.shaders() == shaders {
            return Ok(false);
        }
        for draft in self.drafts.iter_mut().flatten() {
            draft.set_shaders(shaders.clone())?;
        }
        self.renderer.set_shaders(shaders.clone())?;
        Ok(true)
    }

    /// Frames that its motions have; none where nothing moves.
    pub fn frame_count(&self) -> Option<u64> {
        self.motion.as_ref().and_then(|motion| motion.movers.frame_count())
    }

    /// Puts what moves where it is at a time, in frames.
    fn pose(&mut self, frame: Option<f64>) -> Result<(), Error> {
        let Some((motion, frame)) = self.motion.as_mut().zip(frame) else { return Ok(()) };
        if motion.at == Some(frame) || motion.times.send(frame).is_err() {
            return Ok(());
        }
        if let Some(mut posed) = motion.poser.next_frame()? {
            self.renderer.pose(&mut posed)?;
            motion.poser.give_back(posed);
            motion.at = Some(frame);
        }
        Ok(())
    }

    /// The camera with what is left to be fitted fitted to the whole motion, as where it is played.
    fn fitted(&mut self, camera: &CameraTable, size: [u32; 2]) -> Result<CameraTable, Error> {
        let Some(motion) = &mut self.motion else { return Ok(camera.clone()) };
        if let Some((asked, of_size, fitted)) = &motion.fitted
            && (asked, of_size) == (camera, &size)
        {
            return Ok(fitted.clone());
        }
        let mut scene = self.renderer.scene().clone();
        scene.file.camera = camera.clone();
        motion.movers.fix_camera(&mut scene, size)?;
        motion.fitted = Some((camera.clone(), size, scene.file.camera.clone()));
        Ok(scene.file.camera)
    }
}

impl Moving {
    fn start(renderer: &Renderer, movers: Movers) -> Result<Option<Self>, Error> {
        if movers.0.is_empty() {
            return Ok(None);
        }
        let at_rest = renderer.scene();
        let for_cameras = Movers::open(at_rest)?;
        let (times, asked) = channel();
        let poser = renderer.poser(movers, asked.into_iter());
        Ok(Some(Self { times, poser, movers: for_cameras, at: None, fitted: None }))
    }
}
