//! What may change between the pictures of a renderer, from what costs nothing to what is built anew.

use super::keeping::KeptPipelines;
use super::lighting::LightRoom;
use super::tables::{Tables, features_by};
use super::{Renderer, Request};
use crate::io::kept::Kept;
use crate::passes::pipelines::Builder;
use crate::passes::resolve::ResolvePass;
use crate::passes::targets::Targets;
use crate::passes::tonemap::TonemapPass;
use crate::scene::animation::AnimationTable;
use crate::scene::camera::Camera;
use crate::scene::file::{CameraTable, DebugView, DisplayTable, SceneFile};
use crate::scene::light::{LightTable, check_lights};
use crate::scene::{Scene, SceneError};
use crate::shaders::ShaderSet;
use crate::vulkan::{Device, VulkanError};
use std::sync::Arc;

impl Renderer {
    /// As [`Self::keeping`], with tables that are there.
    ///
    /// # Errors
    /// Those of the device.
    pub fn with_tables(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        tables: Tables,
        kept: &Kept,
    ) -> Result<Self, VulkanError> {
        let pipelines = KeptPipelines::new(device, ShaderSet::default(), kept)?;
        Self::assembled(device, scene, request, pipelines, tables)
    }

    /// The camera the scene asks for.
    pub fn camera(&self) -> Camera {
        self.scene.camera(self.request.size)
    }

    /// Looks at the scene from elsewhere from now on.
    pub fn set_camera(&mut self, camera: CameraTable) {
        self.scene.file.camera = camera;
    }

    /// Lights the scene by others from now on. Those that give no light cost nothing.
    ///
    /// # Errors
    /// What a scene file may not say of lights; more that shine or cast shadows than the scene had when the
    /// renderer was built, or a point or spot light where it had none: its pipelines hold no code for them.
    pub fn set_lights(&mut self, lights: Vec<LightTable>) -> Result<(), SceneError> {
        let wrong = |message: String| SceneError::Value { scene: "lights".to_owned(), message };
        check_lights(&lights).map_err(|error| wrong(error.to_string()))?;
        // Views that show no light have no room for any, and need none.
        let shaded = self.scene.file.debug.view == DebugView::Shaded;
        let needed = LightRoom::needed(&lights, self.light_room.views > 0);
        let needed = if shaded { needed } else { self.light_room };
        if let Some(message) = self.light_room.lacks(&needed) {
            return Err(wrong(message));
        }
        self.scene.file.light = Some(lights);
        Ok(())
    }

    /// Another renderer of the same device, shaders and pipelines, with tables that are there.
    ///
    /// # Errors
    /// Those of the device.
    pub fn beside(&self, scene: Scene, request: Request, tables: Tables) -> Result<Self, VulkanError> {
        Self::assembled(&self.device, scene, request, self.pipelines.clone(), tables)
    }

    /// Shows pictures otherwise from now on.
    ///
    /// # Errors
    /// Those of the device.
    pub fn set_display(&mut self, display: DisplayTable) -> Result<(), VulkanError> {
        self.tonemap = TonemapPass::new(&self.pipelines.builder, &self.targets, &display)?;
        self.scene.file.display = display;
        Ok(())
    }

    /// Draws pictures of another size, or of more or fewer samples, from now on.
    ///
    /// # Errors
    /// Those of the device; other statistics or another number of samples a frame (1, or 4 and more) than the renderer
    /// was built for.
    pub fn set_request(&mut self, request: Request) -> Result<(), VulkanError> {
        let samples = request.sampling.multisampling();
        if request.statistics != self.request.statistics || samples != self.targets.samples {
            let message =
                "expected pictures with as many samples a frame and with the same statistics as at first";
            return Err(VulkanError::misuse(message));
        }
        if request.size != self.targets.size {
            let building = &self.pipelines.builder;
            self.targets = Targets::new(&self.device, request.size, samples)?;
            self.resolve = ResolvePass::new(building, &self.targets)?;
            self.tonemap = TonemapPass::new(building, &self.targets, &self.scene.file.display)?;
            if let Some(layers) = &mut self.layers {
                layers.resize(request.size)?;
            }
        }
        self.request = request;
        self.stats.set_request(&request);
        Ok(())
    }

    /// Takes over what `file` says of camera, lights, display, and the frame that fabrics that move are shown at (where
    /// [`Self::pose`] puts them), if nothing else in it differs from the scene that is drawn and its pipelines have the code
    /// for it; whether they have.
    ///
    /// # Errors
    /// Those of the device.
    pub fn edit_in_place(&mut self, file: &SceneFile) -> Result<bool, VulkanError> {
        let shown = &self.scene.file;
        let same_but_for_these = SceneFile {
            camera: file.camera.clone(),
            light: file.light.clone(),
            display: file.display.clone(),
            animation: AnimationTable { frame: file.animation.frame, ..shown.animation.clone() },
            ..shown.clone()
        };
        // To rest, and from it, nothing is posed.
        let moved = |file: &SceneFile| file.animation.frame.is_some();
        if same_but_for_these != *file || moved(shown) != moved(file) {
            return Ok(false);
        }
        let features = |file| features_by(file, &self.scene, &self.request);
        if features(file) != features(shown) {
            return Ok(false);
        }
        if file.light != shown.light && self.set_lights(file.light()).is_err() {
            return Ok(false);
        }
        if file.display != self.scene.file.display {
            self.set_display(file.display.clone())?;
        }
        self.scene.file = file.clone();
        Ok(true)
    }

    /// Draws another scene from now on, with tables that are there: [`Tables::bake`] makes them, on another thread if need
    /// be, and those of another scene may stand for them meanwhile ([`Tables::may_stand_for`]). Pipelines that it shares with
    /// the scene before stay.
    ///
    /// # Errors
    /// Those of the device; the renderer is then as before.
    pub fn edit(&mut self, scene: Scene, tables: Tables) -> Result<(), VulkanError> {
        *self = Self::assembled(&self.device.clone(), scene, self.request, self.pipelines.clone(), tables)?;
        Ok(())
    }

    /// Draws with other shaders from now on. Nothing but pipelines is made anew, and of them those alone whose shaders
    /// differ: here, or where a picture first needs them.
    ///
    /// # Errors
    /// [`VulkanError::Shaders`] where the device refuses them; the renderer is then as before. Shaders that only a
    /// picture finds to be refused are its error, and others may be set instead.
    pub fn set_shaders(&mut self, shaders: ShaderSet) -> Result<(), VulkanError> {
        if shaders == *self.shaders() {
            return Ok(());
        }
        let builder = Builder { shaders, ..self.pipelines.builder.clone() };
        let resolve = ResolvePass::new(&builder, &self.targets)?;
        let tonemap = TonemapPass::new(&builder, &self.targets, &self.scene.file.display)?;
        (self.resolve, self.tonemap) = (resolve, tonemap);
        self.fibers.rebuild(&builder);
        if let Some(layers) = &mut self.layers {
            layers.rebuild(&builder);
        }
        if let Some(shadow_map) = &mut self.shadow_map {
            shadow_map.rebuild(&builder);
        }
        self.pipelines.builder = builder;
        Ok(())
    }

    /// The shaders that pictures are drawn with.
    pub fn shaders(&self) -> &ShaderSet {
        &self.pipelines.builder.shaders
    }

    /// The tables that pictures are drawn with.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// What pictures are asked to be.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Where tables and pipelines are kept.
    pub fn kept(&self) -> &Kept {
        &self.pipelines.kept
    }

    /// Statistics of the pictures that follow, without the times of those before.
    pub fn forget_pictures(&mut self) {
        self.stats.forget_pictures();
    }
}
