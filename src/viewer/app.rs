//! The window's thread: from events to pictures, and to the end.

use super::comparing::Comparing;
use super::desk::{Desk, Look};
use super::document::Document;
use super::gui::Gui;
use super::painter::Painter;
use super::recent::Recent;
use super::references::References;
use super::scripts::{Script, screenshot};
use crate::error::Error;
use crate::io::kept::Kept;
use crate::vulkan::{Device, DeviceOptions, surface_extensions, swapchain_extension};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

/// What a window is opened with.
pub struct Opening {
    /// What is edited.
    pub document: Document,
    /// How pictures are drawn.
    pub look: Look,
    /// A picture to compare with.
    pub reference: Option<PathBuf>,
    /// A folder of shaders to draw with.
    #[cfg(feature = "hot-reload")]
    pub shaders: Option<PathBuf>,
    /// Width and height of the window in pixels.
    pub size: [u32; 2],
    /// The device of pictures; that of the window is opened likewise.
    pub device: DeviceOptions,
    /// Tables and pipelines of earlier runs.
    pub kept: Kept,
    /// Files that were open before.
    pub recent: Recent,
    /// Who makes what pictures are compared with.
    pub references: Option<Arc<dyn References>>,
    /// What the window does by itself.
    pub script: Script,
}

/// The painter has told something.
struct Woken;

/// Opens a window, and returns once it is closed.
///
/// # Errors
/// No display; no device, or one that fails; a script's picture that cannot be written; anything left on a device at
/// the end.
pub fn run(opening: Opening) -> Result<(), Error> {
    let event_loop = EventLoop::<Woken>::with_user_event().build().map_err(|e| no_display(&e.to_string()))?;
    event_loop.set_control_flow(ControlFlow::Wait);
    let proxy = event_loop.create_proxy();
    let mut app = App { opening: Some(opening), open: None, proxy, result: Ok(()) };
    event_loop.run_app(&mut app).map_err(|e| no_display(&e.to_string()))?;
    let closed = app.open.take().map_or(Ok(()), Open::close);
    app.result.and(closed)
}

fn no_display(why: &str) -> Error {
    let why = why.lines().next().unwrap_or_default().trim();
    Error::NoDisplay(format!(
        "expected a display to open a window on, found none ({why}): `worsted render` needs none"
    ))
}

struct App {
    opening: Option<Opening>,
    open: Option<Open>,
    proxy: EventLoopProxy<Woken>,
    result: Result<(), Error>,
}

/// An open window.
struct Open {
    gui: Gui,
    desk: Desk,
    device: Arc<Device>,
    script: Script,
    /// When it is to be drawn again though nothing happens.
    again: Option<Instant>,
    /// When it was drawn last.
    drawn: Option<Instant>,
    hidden: bool,
}

impl Open {
    fn new(
        event_loop: &ActiveEventLoop,
        opening: Opening,
        proxy: EventLoopProxy<Woken>,
    ) -> Result<Self, Error> {
        let [width, height] = opening.size;
        let title = format!("Worsted - {}", opening.document.path().display());
        let attributes =
            Window::default_attributes().with_title(title).with_inner_size(PhysicalSize::new(width, height));
        let window = event_loop.create_window(attributes).map_err(|e| no_display(&e.to_string()))?;
        let window = Arc::new(window);
        let device = Device::new(&opening.device)?;
        let of_window = DeviceOptions {
            instance_extensions: surface_extensions(&*window)?,
            device_extensions: vec![swapchain_extension()],
            ..opening.device
        };
        let gui = Gui::new(Device::new(&of_window)?, window, event_loop)?;
        let from_threads = proxy.clone();
        gui.context().set_request_repaint_callback(move |asked| {
            // What egui wants later it says where the window is drawn.
            if asked.delay.is_zero() {
                drop(from_threads.send_event(Woken));
            }
        });
        #[cfg(feature = "hot-reload")]
        let by_shaders = proxy.clone();
        let wake = move || drop(proxy.send_event(Woken));
        let painter = Painter::start(device.clone(), opening.kept, wake);
        let mut desk = Desk::new(opening.document, painter, opening.look, opening.recent);
        desk.comparing = Comparing::new(opening.references, &device);
        #[cfg(feature = "hot-reload")]
        if let Some(folder) = opening.shaders {
            let wake = move || drop(by_shaders.send_event(Woken));
            desk.reload = Some(super::reload::Reload::start(folder, wake)?);
        }
        if let Some(reference) = &opening.reference {
            desk.canvas.compare_with(reference, gui.context())?;
        }
        Ok(Self { gui, desk, device, script: opening.script, again: None, drawn: None, hidden: false })
    }

    /// Stops everything and takes it down, in order.
    fn close(mut self) -> Result<(), Error> {
        self.desk.painter.stop();
        drop(self.desk);
        let closed = self.gui.close();
        closed.and(Device::shutdown(self.device).map_err(Error::from))
    }

    fn draw(&mut self) -> Result<(), Error> {
        if self.hidden {
            return Ok(());
        }
        self.drawn = Some(Instant::now());
        let mut tick = None;
        let desk = &mut self.desk;
        let wait = self.gui.draw(|ui| tick = desk.show(ui))?;
        let wait = tick.map_or(wait, |tick| tick.min(wait));
        self.again = Instant::now().checked_add(wait).filter(|_| wait < Duration::from_secs(3600));
        Ok(())
    }

    /// Asks for the window to be drawn, but not more often than it needs to be seen: on a CPU device that takes the time
    /// of pictures.
    fn draw_soon(&mut self) {
        let least = if self.device.is_cpu() { Duration::from_millis(60) } else { Duration::ZERO };
        let next = self.drawn.map_or_else(Instant::now, |drawn| drawn + least);
        if next <= Instant::now() {
            self.gui.window().request_redraw();
        } else {
            self.again = Some(self.again.map_or(next, |again| again.min(next)));
        }
    }

    /// Handles an event; whether the window is to be closed.
    fn hear(&mut self, event: &WindowEvent) -> Result<bool, Error> {
        // Egui would want to draw again for being drawn.
        if !matches!(event, WindowEvent::RedrawRequested) && self.gui.hear(event) {
            self.draw_soon();
        }
        match event {
            WindowEvent::CloseRequested => return Ok(true),
            WindowEvent::RedrawRequested => {
                self.draw()?;
                return Ok(self.desk.quits);
            }
            WindowEvent::Resized(size) => {
                self.hidden = size.width == 0 || size.height == 0;
                self.gui.window().request_redraw();
            }
            WindowEvent::Occluded(hidden) => {
                self.hidden = *hidden;
                self.gui.window().request_redraw();
            }
            WindowEvent::DroppedFile(path) => {
                self.desk.take_file(path, self.gui.context());
                self.gui.window().request_redraw();
            }
            _ => (),
        }
        Ok(false)
    }

    /// Hears the painter; whether the script is over.
    fn wake(&mut self) -> Result<bool, Error> {
        self.desk.hear(self.gui.context())?;
        self.gui.window().request_redraw();
        if !self.script.is_over(&self.desk) {
            return Ok(false);
        }
        if let Some(path) = &self.script.screenshot {
            screenshot(&self.desk, path)?;
        }
        Ok(true)
    }
}

impl App {
    /// Ends if something failed, or is over.
    fn settle(&mut self, event_loop: &ActiveEventLoop, done: Result<bool, Error>) {
        match done {
            Ok(false) => return,
            Ok(true) => (),
            Err(error) => self.result = Err(error),
        }
        event_loop.exit();
    }
}

impl ApplicationHandler<Woken> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some(opening) = self.opening.take() else { return };
        match Open::new(event_loop, opening, self.proxy.clone()) {
            Ok(open) => {
                open.gui.window().request_redraw();
                self.open = Some(open);
            }
            Err(error) => self.settle(event_loop, Err(error)),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Some(done) = self.open.as_mut().map(|open| open.hear(&event)) {
            self.settle(event_loop, done);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, _: Woken) {
        if let Some(done) = self.open.as_mut().map(Open::wake) {
            self.settle(event_loop, done);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let again = self.open.as_ref().and_then(|open| open.again);
        match (&mut self.open, again) {
            (Some(open), Some(again)) if again <= Instant::now() => {
                open.again = None;
                open.gui.window().request_redraw();
                event_loop.set_control_flow(ControlFlow::Wait);
            }
            (_, Some(again)) => event_loop.set_control_flow(ControlFlow::WaitUntil(again)),
            (_, None) => event_loop.set_control_flow(ControlFlow::Wait),
        }
    }
}
