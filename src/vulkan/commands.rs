//! Recording commands, submitting them and waiting for the end.

use std::cell::RefCell;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;
use bytemuck::Pod;

use super::buffer::Buffer;
use super::descriptors::{DescriptorSet, Kept};
use super::device::{Device, c_text};
use super::error::{VkContext, VulkanError};
use super::pipeline::Pipeline;
use super::timestamps::{Taken, Timestamps};

/// One wait on the fence; after each, a word to whoever watches.
const FENCE_WAIT: Duration = Duration::from_secs(30);

/// A command buffer being recorded. Whatever a command uses is kept alive until the device is done.
///
/// The methods are thin: sizes, offsets and states are the recorder's duty, and the validation layer
/// checks them.
pub struct Commands<'a> {
    device: &'a Arc<Device>,
    raw: vk::CommandBuffer,
    kept: RefCell<Vec<Kept>>,
}

/// Semaphores around a submission, for a swapchain. `Default` is none.
#[derive(Clone, Copy, Debug, Default)]
pub struct Semaphores<'a> {
    /// Waited for, each by the given stages.
    pub wait: &'a [(vk::Semaphore, vk::PipelineStageFlags2)],
    /// Signalled when all commands are done.
    pub signal: &'a [vk::Semaphore],
}

/// A command pool for one submission; its buffer goes with it.
struct Pool<'a> {
    device: &'a Device,
    raw: vk::CommandPool,
}

impl Drop for Pool<'_> {
    fn drop(&mut self) {
        // SAFETY: the pool's buffer was never submitted, or its fence has passed (or the device is lost).
        unsafe { self.device.raw().destroy_command_pool(self.raw, None) };
    }
}

struct Fence<'a> {
    device: &'a Device,
    raw: vk::Fence,
}

impl Drop for Fence<'_> {
    fn drop(&mut self) {
        // SAFETY: the fence was never submitted, or has passed (or the device is lost).
        unsafe { self.device.raw().destroy_fence(self.raw, None) };
    }
}

impl Device {
    /// Records commands, submits them, waits until the device is done, and returns the wall time from
    /// submission to the end. Everything written is then visible to later submissions; host reads
    /// also need a barrier to [`super::Access::HOST_READ`].
    ///
    /// # Errors
    /// Whatever `record` returns; device lost; out of memory; [`VulkanError::Validation`] for any
    /// error of the layer since the last check, before or after submission. Commands that the layer
    /// rejected while they were recorded are not submitted.
    pub fn run_once(
        self: &Arc<Self>,
        label: &str,
        record: impl FnOnce(&Commands<'_>) -> Result<(), VulkanError>,
    ) -> Result<Duration, VulkanError> {
        self.run_once_with(label, Semaphores::default(), record)
    }

    /// As [`Self::run_once`], and says what the device's own clock counted.
    ///
    /// # Errors
    /// As [`Self::run_once`].
    pub fn run_measured(
        self: &Arc<Self>,
        label: &str,
        record: impl FnOnce(&Commands<'_>) -> Result<(), VulkanError>,
    ) -> Result<Taken, VulkanError> {
        let timestamps = Timestamps::new(self, label)?;
        let wall = self.run_once(label, |commands| {
            timestamps.iter().for_each(|timestamps| timestamps.begin(commands.raw()));
            record(commands)?;
            timestamps.iter().for_each(|timestamps| timestamps.end(commands.raw()));
            Ok(())
        })?;
        let device = timestamps.map(|timestamps| timestamps.read(label)).transpose()?;
        Ok(Taken { wall, device })
    }

    /// As [`Self::run_once`], with semaphores before and after.
    ///
    /// # Errors
    /// As [`Self::run_once`].
    pub fn run_once_with(
        self: &Arc<Self>,
        label: &str,
        semaphores: Semaphores<'_>,
        record: impl FnOnce(&Commands<'_>) -> Result<(), VulkanError>,
    ) -> Result<Duration, VulkanError> {
        let pool = create_pool(self, label)?;
        let raw = allocate(self, &pool, label)?;
        let commands = Commands { device: self, raw, kept: RefCell::default() };
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the buffer is new.
        unsafe { self.raw().begin_command_buffer(raw, &begin) }.during(label)?;
        commands.label(label, || record(&commands))?;
        // SAFETY: recording was begun above and every label and rendering scope is closed again.
        unsafe { self.raw().end_command_buffer(raw) }.during(label)?;
        self.check_validation()?;
        let taken = submit_and_wait(self, label, raw, semaphores)?;
        self.check_validation()?;
        Ok(taken)
    }
}

fn create_pool<'a>(device: &'a Device, label: &str) -> Result<Pool<'a>, VulkanError> {
    let info = vk::CommandPoolCreateInfo::default()
        .flags(vk::CommandPoolCreateFlags::TRANSIENT)
        .queue_family_index(device.queue_family());
    // SAFETY: the family is the device's own. A pool a submission needs no lock between threads.
    let raw = unsafe { device.raw().create_command_pool(&info, None) }.during(label)?;
    Ok(Pool { device, raw })
}

fn allocate(device: &Device, pool: &Pool<'_>, label: &str) -> Result<vk::CommandBuffer, VulkanError> {
    let info = vk::CommandBufferAllocateInfo::default()
        .command_pool(pool.raw)
        .level(vk::CommandBufferLevel::PRIMARY)
        .command_buffer_count(1);
    // SAFETY: the pool is alive and used by this thread alone.
    let buffers = unsafe { device.raw().allocate_command_buffers(&info) }.during(label)?;
    let raw = buffers.first().copied().unwrap_or_default();
    device.set_name(raw, label);
    Ok(raw)
}

fn submit_and_wait(
    device: &Device,
    label: &str,
    commands: vk::CommandBuffer,
    semaphores: Semaphores<'_>,
) -> Result<Duration, VulkanError> {
    // SAFETY: a plain fence, unsignalled.
    let raw = unsafe { device.raw().create_fence(&vk::FenceCreateInfo::default(), None) }.during(label)?;
    let fence = Fence { device, raw };
    let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
    let waits: Vec<_> = semaphores
        .wait
        .iter()
        .map(|(semaphore, stages)| {
            vk::SemaphoreSubmitInfo::default().semaphore(*semaphore).stage_mask(*stages)
        })
        .collect();
    let signals: Vec<_> = semaphores
        .signal
        .iter()
        .map(|semaphore| {
            let all = vk::PipelineStageFlags2::ALL_COMMANDS;
            vk::SemaphoreSubmitInfo::default().semaphore(*semaphore).stage_mask(all)
        })
        .collect();
    let submit = [vk::SubmitInfo2::default()
        .command_buffer_infos(&buffers)
        .wait_semaphore_infos(&waits)
        .signal_semaphore_infos(&signals)];
    let start = Instant::now();
    {
        let queue = device.lock_queue();
        // SAFETY: the queue is locked, the commands are complete, and the fence is unsignalled.
        unsafe { device.raw().queue_submit2(*queue, &submit, fence.raw) }.during(label)?;
    }
    wait(device, label, &fence, start)?;
    Ok(start.elapsed())
}

/// Waits without a deadline: a large picture on a CPU takes minutes, and a device that hangs is
/// reported lost by its driver.
fn wait(device: &Device, label: &str, fence: &Fence<'_>, start: Instant) -> Result<(), VulkanError> {
    let nanoseconds = u64::try_from(FENCE_WAIT.as_nanos()).unwrap_or(u64::MAX);
    loop {
        // SAFETY: the fence is alive and was submitted.
        match unsafe { device.raw().wait_for_fences(&[fence.raw], true, nanoseconds) } {
            Err(vk::Result::TIMEOUT) => {
                tracing::warn!("`{label}` has been running for {} s", start.elapsed().as_secs());
            }
            Err(vk::Result::ERROR_DEVICE_LOST) => {
                return Err(VulkanError::DeviceLost { what: format!("`{label}`") });
            }
            Err(result) => {
                // The commands may still run, and what they use is about to be freed.
                device.wait_idle()?;
                return Err(VulkanError::from_vk(label, result));
            }
            Ok(()) => return Ok(()),
        }
    }
}

impl Commands<'_> {
    /// The device that will run the commands.
    pub fn device(&self) -> &Arc<Device> {
        self.device
    }

    /// The Vulkan handle, for commands that have no wrapper here.
    pub fn raw(&self) -> vk::CommandBuffer {
        self.raw
    }

    /// Keeps something alive until the device is done.
    pub(crate) fn keep(&self, what: Kept) {
        self.kept.borrow_mut().push(what);
    }

    /// Keeps a buffer alive until the device is done; for raw commands.
    pub fn keep_buffer(&self, buffer: &Buffer) {
        self.keep(buffer.inner.clone());
    }

    /// Puts the commands that `record` records under a debug label.
    pub fn label<R>(&self, name: &str, record: impl FnOnce() -> R) -> R {
        let Some(debug) = self.device.debug_utils() else { return record() };
        let name = c_text(name);
        let label = vk::DebugUtilsLabelEXT::default().label_name(&name);
        // SAFETY: recording is open; the label is closed below.
        unsafe { debug.cmd_begin_debug_utils_label(self.raw, &label) };
        let result = record();
        // SAFETY: closes the label opened above.
        unsafe { debug.cmd_end_debug_utils_label(self.raw) };
        result
    }

    /// Binds a pipeline.
    pub fn bind_pipeline(&self, pipeline: &Pipeline) {
        self.keep(pipeline.inner.clone());
        // SAFETY: recording is open; the pipeline is kept until the fence.
        unsafe { self.device.raw().cmd_bind_pipeline(self.raw, pipeline.bind_point(), pipeline.raw()) };
    }

    /// Binds sets 0, 1 ... for a pipeline.
    pub fn bind_sets(&self, pipeline: &Pipeline, sets: &[&DescriptorSet]) {
        let raw: Vec<_> = sets.iter().map(|s| s.raw()).collect();
        sets.iter().for_each(|s| self.keep(s.inner.clone()));
        if raw.is_empty() {
            return;
        }
        let (point, layout) = (pipeline.bind_point(), pipeline.layout());
        // SAFETY: recording is open; the sets and what they bind are kept until the fence.
        unsafe { self.device.raw().cmd_bind_descriptor_sets(self.raw, point, layout, 0, &raw, &[]) };
    }

    /// Sets a pipeline's push constants from the start.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if the pipeline has fewer bytes of them, or `T` is not whole words.
    pub fn push_constants<T: Pod>(&self, pipeline: &Pipeline, value: &T) -> Result<(), VulkanError> {
        let bytes = bytemuck::bytes_of(value);
        let declared = pipeline.push_constants();
        match declared {
            Some((stages, room))
                if !bytes.is_empty()
                    && bytes.len().is_multiple_of(4)
                    && u32::try_from(bytes.len()).is_ok_and(|n| n <= room) =>
            {
                // SAFETY: recording is open; the range lies in the layout's only range.
                unsafe {
                    self.device.raw().cmd_push_constants(self.raw, pipeline.layout(), stages, 0, bytes)
                };
                Ok(())
            }
            _ => Err(VulkanError::misuse(format!(
                "{} bytes of push constants for pipeline `{}`, which has {}",
                bytes.len(),
                pipeline.name(),
                declared.map_or(0, |(_, room)| room)
            ))),
        }
    }

    /// Runs a compute pipeline over groups in x, y and z.
    pub fn dispatch(&self, groups: [u32; 3]) {
        // SAFETY: recording is open; counts over the device's limit are found by validation.
        unsafe { self.device.raw().cmd_dispatch(self.raw, groups[0], groups[1], groups[2]) };
    }

    /// Runs a compute pipeline over the groups that a buffer holds at `offset` bytes.
    pub fn dispatch_indirect(&self, arguments: &Buffer, offset: u64) {
        self.keep(arguments.inner.clone());
        // SAFETY: recording is open; the buffer is kept until the fence.
        unsafe { self.device.raw().cmd_dispatch_indirect(self.raw, arguments.raw(), offset) };
    }

    /// Copies bytes between buffers (or within one, where the ranges do not overlap).
    pub fn copy_buffer(&self, from: &Buffer, from_offset: u64, to: &Buffer, to_offset: u64, bytes: u64) {
        self.keep(from.inner.clone());
        self.keep(to.inner.clone());
        let region = [vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size: bytes }];
        // SAFETY: recording is open; both buffers are kept until the fence.
        unsafe { self.device.raw().cmd_copy_buffer(self.raw, from.raw(), to.raw(), &region) };
    }

    /// Fills all of a buffer with one word.
    pub fn fill_buffer(&self, buffer: &Buffer, word: u32) {
        self.keep(buffer.inner.clone());
        // SAFETY: recording is open; the buffer is kept until the fence and is whole words long.
        unsafe { self.device.raw().cmd_fill_buffer(self.raw, buffer.raw(), 0, vk::WHOLE_SIZE, word) };
    }
}
