//! Egui in a window: its input from winit, its triangles through Vulkan.

use crate::error::Error;
use crate::vulkan::{Device, Presented, Swapchain, VulkanError};
use egui_ash_renderer::allocator::DefaultAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, RendererError};
use std::sync::Arc;
use std::time::Duration;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// A window with egui in it. Its device is not the painter's: on a CPU device commands run one after the other, and a
/// button would wait for cloth.
pub struct Gui {
    context: egui::Context,
    input: egui_winit::State,
    renderer: Option<Renderer<DefaultAllocator>>,
    pool: ash::vk::CommandPool,
    swapchain: Option<Swapchain<Window>>,
    device: Arc<Device>,
    window: Arc<Window>,
}

impl Gui {
    /// In this window, by a device that was opened for it.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        device: Arc<Device>,
        window: Arc<Window>,
        event_loop: &ActiveEventLoop,
    ) -> Result<Self, Error> {
        let size = window.inner_size();
        let swapchain = Swapchain::new(&device, window.clone(), [size.width, size.height])?;
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: swapchain.format()?,
            depth_attachment_format: None,
            stencil_attachment_format: None,
        });
        let renderer = Renderer::with_default_allocator(
            device.instance(),
            device.physical(),
            device.raw().clone(),
            mode,
            // Its own shader takes sRGB for a power of 2.2: up to nine levels off where the cloth is dark.
            Options { srgb_framebuffer: true, ..Options::default() },
        )
        .map_err(failed)?;
        let info = ash::vk::CommandPoolCreateInfo::default()
            .flags(ash::vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(device.queue_family());
        // SAFETY: the family is the device's own; the pool is used by this thread alone.
        let pool = unsafe { device.raw().create_command_pool(&info, None) }
            .map_err(|result| VulkanError::from_vk("the window's commands", result))?;
        let context = egui::Context::default();
        let most = device.limits().max_image_dimension2_d as usize;
        let scale = Some(window.scale_factor() as f32);
        let id = egui::ViewportId::ROOT;
        let input = egui_winit::State::new(context.clone(), id, event_loop, scale, None, Some(most));
        Ok(Self {
            context,
            input,
            renderer: Some(renderer),
            pool,
            swapchain: Some(swapchain),
            device,
            window,
        })
    }

    /// Egui's own state.
    pub fn context(&self) -> &egui::Context {
        &self.context
    }

    /// The window.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Hears an event; whether the window is to be drawn again for it.
    pub fn hear(&mut self, event: &WindowEvent) -> bool {
        if let WindowEvent::Resized(size) = event
            && let Some(swapchain) = &mut self.swapchain
        {
            swapchain.resize([size.width, size.height]);
        }
        self.input.on_window_event(&self.window, event).repaint
    }

    /// Draws the window, and says after which time it wants to be drawn again if nothing happens.
    ///
    /// # Errors
    /// Those of the device.
    pub fn draw(&mut self, ui: impl FnMut(&mut egui::Ui)) -> Result<Duration, Error> {
        let input = self.input.take_egui_input(&self.window);
        let output = self.context.run_ui(input, ui);
        self.input.handle_platform_output(&self.window, output.platform_output);
        let root = output.viewport_output.get(&egui::ViewportId::ROOT);
        let wait = root.map_or(Duration::MAX, |root| root.repaint_delay);
        let triangles = self.context.tessellate(output.shapes, output.pixels_per_point);
        let (Some(renderer), Some(swapchain)) = (&mut self.renderer, &mut self.swapchain) else {
            return Ok(wait);
        };
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                renderer.set_texture(*self.device.lock_queue(), self.pool, *id, delta).map_err(failed)?;
            }
        }
        let scale = output.pixels_per_point;
        let presented = swapchain.present(|commands, [width, height]| {
            let extent = ash::vk::Extent2D { width, height };
            renderer
                .cmd_draw(commands, extent, scale, &triangles)
                .map_err(|e| VulkanError::misuse(e.to_string()))
        })?;
        for id in &output.textures_delta.free {
            renderer.free_texture(*id).map_err(failed)?;
        }
        let mut deltas = output.textures_delta;
        // They were applied.
        deltas.clear();
        match presented {
            Presented::Shown => Ok(wait),
            // A window without an area is not drawn again before it has one.
            Presented::NotYet if self.window.inner_size().width == 0 => Ok(Duration::MAX),
            Presented::NotYet => Ok(Duration::from_millis(20)),
        }
    }

    /// Takes down all that it has on the device, and gives the device back.
    ///
    /// # Errors
    /// Those of the device.
    pub fn close(mut self) -> Result<(), Error> {
        self.device.wait_idle()?;
        self.renderer = None;
        self.swapchain = None;
        // SAFETY: the device is idle, and the pool's commands were waited for.
        unsafe { self.device.raw().destroy_command_pool(self.pool, None) };
        Ok(Device::shutdown(self.device)?)
    }
}

fn failed(error: RendererError) -> Error {
    match error {
        RendererError::Vulkan(result) => VulkanError::from_vk("drawing the window", result).into(),
        other => Error::Failed(format!("drawing the window: {other}")),
    }
}
