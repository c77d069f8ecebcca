//! The device's own clock around the commands of one submission.

use std::iter::Sum;
use std::ops::{Add, AddAssign};
use std::time::Duration;

use ash::vk;

use super::device::Device;
use super::error::{VkContext, VulkanError};

/// What a submission took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken {
    /// From submission to its fence.
    pub wall: Duration,
    /// Between timestamps before its first and after its last command; none on a CPU device, whose clock is the
    /// host's, and where the queue has no timestamps.
    pub device: Option<Duration>,
}

impl Taken {
    /// No work at all.
    pub const NOTHING: Self = Self { wall: Duration::ZERO, device: Some(Duration::ZERO) };
}

impl Add for Taken {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let device = self.device.zip(other.device).map(|(a, b)| a + b);
        Self { wall: self.wall + other.wall, device }
    }
}

impl AddAssign for Taken {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sum for Taken {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::NOTHING, Self::add)
    }
}

/// Two timestamps of one submission.
pub(super) struct Timestamps<'a> {
    device: &'a Device,
    raw: vk::QueryPool,
    valid_bits: u32,
}

impl Drop for Timestamps<'_> {
    fn drop(&mut self) {
        // SAFETY: the commands that write to the pool were never submitted, or their fence has passed (or the
        // device is lost).
        unsafe { self.device.raw().destroy_query_pool(self.raw, None) };
    }
}

impl<'a> Timestamps<'a> {
    /// Room for two, where the device has a clock of its own.
    pub(super) fn new(device: &'a Device, label: &str) -> Result<Option<Self>, VulkanError> {
        if device.is_cpu() { Ok(None) } else { Self::on_any(device, label) }
    }

    /// Room for two, where the queue has timestamps.
    fn on_any(device: &'a Device, label: &str) -> Result<Option<Self>, VulkanError> {
        let (instance, physical) = (device.instance(), device.physical());
        // SAFETY: the physical device is of this live instance.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let family = families.get(device.queue_family() as usize);
        let Some(valid_bits) = family.map(|f| f.timestamp_valid_bits).filter(|bits| *bits > 0) else {
            return Ok(None);
        };
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
        // SAFETY: a plain pool of a live device.
        let raw = unsafe { device.raw().create_query_pool(&info, None) }.during(label)?;
        Ok(Some(Self { device, raw, valid_bits }))
    }

    /// Records the first: before every command after it.
    pub(super) fn begin(&self, commands: vk::CommandBuffer) {
        let device = self.device.raw();
        // SAFETY: the buffer is recording, outside of any rendering, and the pool has two queries.
        unsafe {
            device.cmd_reset_query_pool(commands, self.raw, 0, 2);
            device.cmd_write_timestamp2(commands, vk::PipelineStageFlags2::TOP_OF_PIPE, self.raw, 0);
        }
    }

    /// Records the second: after every command before it.
    pub(super) fn end(&self, commands: vk::CommandBuffer) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: as above.
        unsafe { self.device.raw().cmd_write_timestamp2(commands, all, self.raw, 1) };
    }

    /// What lies between, once the submission's fence has passed.
    pub(super) fn read(&self, label: &str) -> Result<Duration, VulkanError> {
        let mut ticks = [0_u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: both queries were written by commands that are done.
        unsafe { self.device.raw().get_query_pool_results(self.raw, 0, &mut ticks, flags) }.during(label)?;
        let period = f64::from(self.device.limits().timestamp_period);
        Ok(Duration::from_secs_f64(1e-9 * period * ticks_between(ticks, self.valid_bits) as f64))
    }
}

/// Ticks from the first to the second of a counter of so many bits, which may have begun anew.
fn ticks_between([first, second]: [u64; 2], valid_bits: u32) -> u64 {
    second.wrapping_sub(first) & (u64::MAX >> (64 - valid_bits.clamp(1, 64)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::{Buffer, DeviceChoice, DeviceOptions, MemoryKind};

    #[test]
    fn a_counter_that_begins_anew_is_no_eternity() {
        assert_eq!(ticks_between([5, 9], 64), 4);
        assert_eq!(ticks_between([(1 << 36) - 2, 3], 36), 5);
        assert_eq!(ticks_between([u64::MAX, 0], 64), 1);
    }

    #[test]
    fn sums_have_a_device_time_only_where_all_have() {
        let ms = Duration::from_millis;
        let own = Taken { wall: ms(3), device: Some(ms(2)) };
        let none = Taken { wall: ms(1), device: None };
        assert_eq!([own, own].into_iter().sum::<Taken>(), Taken { wall: ms(6), device: Some(ms(4)) });
        assert_eq!(own + none, Taken { wall: ms(4), device: None });
    }

    #[test]
    fn the_device_counts_what_lies_between() {
        let options = DeviceOptions { choice: DeviceChoice::Software, ..Default::default() };
        let device = Device::new(&options).unwrap();
        let taken = device.run_measured("nothing", |_| Ok(())).unwrap();
        assert_eq!(taken.device, None, "a CPU device has no clock of its own");
        if let Some(timestamps) = Timestamps::on_any(&device, "test").unwrap() {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            let buffer = Buffer::new(&device, "filled", 1 << 24, usage, MemoryKind::Device).unwrap();
            let record = |commands: &crate::vulkan::Commands<'_>| {
                timestamps.begin(commands.raw());
                // SAFETY: the buffer has so many bytes and lives until the fence.
                unsafe { device.raw().cmd_fill_buffer(commands.raw(), buffer.raw(), 0, 1 << 24, 7) };
                timestamps.end(commands.raw());
                Ok(())
            };
            let wall = device.run_once("fill", record).unwrap();
            let found = timestamps.read("fill").unwrap();
            assert!(found > Duration::ZERO && found <= wall, "{found:?} of {wall:?}");
            drop(timestamps);
            drop(buffer);
        }
        Device::shutdown(device).unwrap();
    }
}
