//! Passes that declare what they touch; barriers, debug labels and timings follow from it.

use crate::vulkan::{Access, Buffer, Commands, Device, Image, ImageState, Taken, VulkanError, vk};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// One declared use of a resource.
#[derive(Clone, Copy)]
pub enum Use<'a> {
    /// An image, in the state the pass needs.
    Image(&'a Image, ImageState),
    /// An image whose earlier contents the pass replaces.
    Discard(&'a Image, ImageState),
    /// A buffer.
    Buffer(&'a Buffer, Access),
}

/// Records a pass's own commands.
pub type Record<'a> = Box<dyn Fn(&Commands<'_>) -> Result<(), VulkanError> + 'a>;

/// One pass: its name is also its debug label and its key in timings.
pub struct Pass<'a> {
    /// Name.
    pub name: &'static str,
    /// Everything it reads or writes.
    pub uses: Vec<Use<'a>>,
    /// Its commands, with every declared use in its state.
    pub record: Record<'a>,
}

/// The last known state of every resource, from one submission to the next.
#[derive(Default)]
pub struct Graph {
    images: HashMap<vk::Image, ImageState>,
    buffers: HashMap<vk::Buffer, Access>,
}

fn writes(access: Access) -> bool {
    use vk::AccessFlags2 as A;
    let write = A::SHADER_WRITE
        | A::SHADER_STORAGE_WRITE
        | A::COLOR_ATTACHMENT_WRITE
        | A::DEPTH_STENCIL_ATTACHMENT_WRITE
        | A::TRANSFER_WRITE
        | A::HOST_WRITE
        | A::MEMORY_WRITE;
    access.access.intersects(write)
}

impl Graph {
    /// Runs the passes in order in one submission, waits, and returns what that took.
    ///
    /// # Errors
    /// Whatever a pass's recording or the submission reports.
    pub fn run(
        &mut self,
        device: &Arc<Device>,
        label: &str,
        passes: &[Pass<'_>],
    ) -> Result<Taken, VulkanError> {
        device.run_measured(label, |commands| passes.iter().try_for_each(|pass| self.record(commands, pass)))
    }

    /// Runs every pass in a submission of its own, adding its wall time to `timings`: the only method
    /// that tells passes apart on a CPU device.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_timed(
        &mut self,
        device: &Arc<Device>,
        passes: &[Pass<'_>],
        timings: &mut HashMap<&'static str, Duration>,
    ) -> Result<Taken, VulkanError> {
        let mut total = Taken::NOTHING;
        for pass in passes {
            let taken = device.run_measured(pass.name, |commands| self.record(commands, pass))?;
            *timings.entry(pass.name).or_default() += taken.wall;
            total += taken;
        }
        Ok(total)
    }

    fn record(&mut self, commands: &Commands<'_>, pass: &Pass<'_>) -> Result<(), VulkanError> {
        commands.label(pass.name, || {
            for used in &pass.uses {
                self.transition(commands, used);
            }
            (pass.record)(commands)
        })
    }

    /// Brings one resource into its declared state. Reads after reads need no barrier.
    fn transition(&mut self, commands: &Commands<'_>, used: &Use<'_>) {
        match *used {
            Use::Image(image, to) | Use::Discard(image, to) => {
                let mut from = self.images.insert(image.raw(), to).unwrap_or(ImageState::UNDEFINED);
                if matches!(used, Use::Discard(..)) {
                    from.layout = vk::ImageLayout::UNDEFINED;
                }
                if from.layout != to.layout || writes(from.access) || writes(to.access) {
                    commands.image_barrier(image, from, to);
                } else {
                    self.images.insert(image.raw(), ImageState { access: from.access.and(to.access), ..to });
                }
            }
            Use::Buffer(buffer, to) => {
                let from = self.buffers.insert(buffer.raw(), to).unwrap_or(Access::NONE);
                if writes(from) || writes(to) {
                    commands.memory_barrier(from, to);
                } else {
                    self.buffers.insert(buffer.raw(), from.and(to));
                }
            }
        }
    }
}
