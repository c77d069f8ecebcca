//! Buffers: named, counted, freed when the last holder lets go.

use std::ptr::NonNull;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;
use bytemuck::Pod;

use super::device::Device;
use super::error::VulkanError;
use super::memory::{BoundMemory, MemoryKind};

/// Vulkan forbids buffers of no bytes, and fills and copies work in words.
const WORD: u64 = 4;

/// A buffer with its memory. Clones share it.
#[derive(Clone)]
pub struct Buffer {
    pub(crate) inner: Arc<BufferInner>,
}

pub(crate) struct BufferInner {
    raw: vk::Buffer,
    name: String,
    bytes: u64,
    usage: vk::BufferUsageFlags,
    kind: MemoryKind,
    /// Held while the host reads or writes the mapped bytes.
    host: Mutex<()>,
    /// `None` only while the buffer is being made.
    memory: Option<BoundMemory>,
    device: Arc<Device>,
}

impl Drop for BufferInner {
    fn drop(&mut self) {
        // SAFETY: recorded commands hold a clone until their fence has passed, so the device no
        // longer uses the buffer. Its memory is freed after this body.
        unsafe { self.device.raw().destroy_buffer(self.raw, None) };
    }
}

impl std::fmt::Debug for Buffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Buffer({}, {} bytes)", self.inner.name, self.inner.bytes)
    }
}

/// The bytes of a slice's length, checked.
fn bytes_of<T>(name: &str, count: usize) -> Result<u64, VulkanError> {
    u64::try_from(size_of::<T>())
        .ok()
        .zip(u64::try_from(count).ok())
        .and_then(|(size, count)| size.checked_mul(count))
        .ok_or_else(|| VulkanError::OutOfMemory { what: name.into(), bytes: u64::MAX })
}

impl Buffer {
    /// An uninitialised buffer of `bytes` bytes. Zero is allowed: a buffer of one word is made then,
    /// and [`Self::bytes`] is 0.
    ///
    /// Device buffers can always be copied to, readback buffers copied to, upload buffers copied from;
    /// `usage` adds to that.
    ///
    /// # Errors
    /// [`VulkanError::TooLarge`] for a storage or uniform buffer that one descriptor could not cover;
    /// [`VulkanError::OutOfMemory`].
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        kind: MemoryKind,
    ) -> Result<Self, VulkanError> {
        check_ranges(device, name, bytes, usage)?;
        let out_of_memory = || VulkanError::OutOfMemory { what: name.into(), bytes };
        let padded = bytes.max(1).checked_next_multiple_of(WORD).ok_or_else(out_of_memory)?;
        if padded > device.candidate().max_buffer_bytes {
            return Err(out_of_memory());
        }
        device.memory().check_size(name, padded)?;
        let usage = usage
            | match kind {
                MemoryKind::Device | MemoryKind::Readback => vk::BufferUsageFlags::TRANSFER_DST,
                MemoryKind::Upload => vk::BufferUsageFlags::TRANSFER_SRC,
            };
        let info = vk::BufferCreateInfo::default()
            .size(padded)
            .usage(usage)
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the size is at least a word and within the device's limit.
        let raw = unsafe { device.raw().create_buffer(&info, None) }
            .map_err(|r| VulkanError::sized(format!("buffer `{name}`"), padded, r))?;
        device.set_name(raw, name);
        // From here on `inner` destroys the buffer, also when binding fails.
        let mut inner = BufferInner {
            raw,
            name: name.into(),
            bytes,
            usage,
            kind,
            host: Mutex::default(),
            memory: None,
            device: device.clone(),
        };
        inner.memory = Some(BoundMemory::for_buffer(device, name, raw, kind)?);
        Ok(Self { inner: Arc::new(inner) })
    }

    /// A device buffer holding `data`: written in place where the host sees device memory, else
    /// through a staging buffer. Returns when the data is there.
    ///
    /// # Errors
    /// As [`Self::new`], and those of a submission.
    pub fn upload<T: Pod>(
        device: &Arc<Device>,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: &[T],
    ) -> Result<Self, VulkanError> {
        let buffer = Self::new(device, name, bytes_of::<T>(name, data.len())?, usage, MemoryKind::Device)?;
        buffer.replace(data)?;
        Ok(buffer)
    }

    /// Replaces the start of any buffer by the shortest way: in place where the host sees the memory,
    /// else through a staging buffer. Returns when the data is there; the device must not be using it.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if the data is longer than the buffer; those of a submission.
    pub fn replace<T: Pod>(&self, data: &[T]) -> Result<(), VulkanError> {
        match self.mapped() {
            Some(mapped) => self.write_mapped(mapped, 0, data),
            None => self.write_staged(data),
        }
    }

    /// Fills the start of a device buffer through a staging buffer. Returns when the data is there.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if the data is longer than the buffer; those of a submission.
    pub fn write_staged<T: Pod>(&self, data: &[T]) -> Result<(), VulkanError> {
        let bytes = bytes_of::<T>(self.name(), data.len())?;
        self.check_range(0, bytes, "write")?;
        if bytes == 0 {
            return Ok(());
        }
        let device = &self.inner.device;
        let name = format!("staging for {}", self.name());
        let staging = Self::new(device, &name, bytes, vk::BufferUsageFlags::empty(), MemoryKind::Upload)?;
        staging.write(0, data)?;
        device.run_once(&name, |cmd| {
            cmd.copy_buffer(&staging, 0, self, 0, bytes);
            Ok(())
        })?;
        Ok(())
    }

    /// Writes `data` at `offset` bytes of an upload buffer. The device must not be using those bytes.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if it is not an upload buffer (also where this device would let the
    /// host write to others, for the next device may not), or the data runs past the end.
    pub fn write<T: Pod>(&self, offset: u64, data: &[T]) -> Result<(), VulkanError> {
        self.write_mapped(self.mapped_for(MemoryKind::Upload, "write to")?, offset, data)
    }

    fn write_mapped<T: Pod>(&self, mapped: NonNull<u8>, offset: u64, data: &[T]) -> Result<(), VulkanError> {
        let source: &[u8] = bytemuck::cast_slice(data);
        let start = self.check_range(offset, bytes_of::<T>(self.name(), data.len())?, "write")?;
        let _host = self.inner.host.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the range was checked against the buffer's size and lies in its own mapped memory,
        // which no reference points into (reads copy out) and which other threads touch only under
        // the same lock.
        unsafe { std::ptr::copy_nonoverlapping(source.as_ptr(), mapped.as_ptr().add(start), source.len()) };
        Ok(())
    }

    /// Reads all of a readback buffer; trailing bytes that fill no whole `T` are left out. The
    /// submission that wrote it must end with a barrier to [`super::Access::HOST_READ`].
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if it is not a readback buffer.
    pub fn read<T: Pod>(&self) -> Result<Vec<T>, VulkanError> {
        let mapped = self.mapped_for(MemoryKind::Readback, "read of")?;
        let count = usize::try_from(self.inner.bytes).unwrap_or(0).checked_div(size_of::<T>()).unwrap_or(0);
        let mut data = vec![T::zeroed(); count];
        let target: &mut [u8] = bytemuck::cast_slice_mut(&mut data);
        let _host = self.inner.host.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `target` is no longer than the buffer, and the mapped memory is live, coherent and
        // written by other threads only under the same lock.
        unsafe { std::ptr::copy_nonoverlapping(mapped.as_ptr(), target.as_mut_ptr(), target.len()) };
        Ok(data)
    }

    /// Copies the buffer to the host through a readback buffer; it needs `TRANSFER_SRC` usage, and
    /// earlier submissions must have finished (they have: submissions wait).
    ///
    /// # Errors
    /// Those of allocation and submission.
    pub fn read_staged<T: Pod>(&self) -> Result<Vec<T>, VulkanError> {
        let bytes = self.inner.bytes;
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let device = &self.inner.device;
        let name = format!("readback of {}", self.name());
        let target = Self::new(device, &name, bytes, vk::BufferUsageFlags::empty(), MemoryKind::Readback)?;
        device.run_once(&name, |cmd| {
            cmd.memory_barrier(super::Access::ANY_WRITE, super::Access::TRANSFER_READ);
            cmd.copy_buffer(self, 0, &target, 0, bytes);
            cmd.memory_barrier(super::Access::TRANSFER_WRITE, super::Access::HOST_READ);
            Ok(())
        })?;
        target.read()
    }

    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.inner.name
    }

    /// The bytes asked for (the buffer itself may be padded to a word).
    pub fn bytes(&self) -> u64 {
        self.inner.bytes
    }

    /// What it may be used for.
    pub fn usage(&self) -> vk::BufferUsageFlags {
        self.inner.usage
    }

    /// Where its memory is.
    pub fn kind(&self) -> MemoryKind {
        self.inner.kind
    }

    /// The Vulkan handle, for calls that have no wrapper here.
    pub fn raw(&self) -> vk::Buffer {
        self.inner.raw
    }

    fn mapped(&self) -> Option<NonNull<u8>> {
        self.inner.memory.as_ref()?.mapped()
    }

    fn mapped_for(&self, kind: MemoryKind, action: &str) -> Result<NonNull<u8>, VulkanError> {
        let found = self.inner.kind;
        let mapped = if found == kind { self.mapped() } else { None };
        mapped.ok_or_else(|| {
            VulkanError::misuse(format!(
                "host {action} buffer `{}` needs {kind:?} memory, it is {found:?}",
                self.name()
            ))
        })
    }

    /// The offset as `usize`, if `offset..offset + bytes` lies in the buffer.
    fn check_range(&self, offset: u64, bytes: u64, action: &str) -> Result<usize, VulkanError> {
        let fits = offset.checked_add(bytes).is_some_and(|end| end <= self.inner.bytes);
        fits.then_some(offset).and_then(|o| usize::try_from(o).ok()).ok_or_else(|| {
            VulkanError::misuse(format!(
                "{action} of {bytes} bytes at {offset} is past the end of buffer `{}` ({} bytes)",
                self.name(),
                self.inner.bytes
            ))
        })
    }
}

fn check_ranges(
    device: &Device,
    name: &str,
    bytes: u64,
    usage: vk::BufferUsageFlags,
) -> Result<(), VulkanError> {
    let limits = device.limits();
    for (flag, limit_name, limit) in [
        (vk::BufferUsageFlags::STORAGE_BUFFER, "maxStorageBufferRange", limits.max_storage_buffer_range),
        (vk::BufferUsageFlags::UNIFORM_BUFFER, "maxUniformBufferRange", limits.max_uniform_buffer_range),
    ] {
        let limit = u64::from(limit);
        if usage.contains(flag) && bytes > limit {
            return Err(VulkanError::TooLarge {
                what: format!("buffer `{name}`"),
                asked: bytes,
                limit_name,
                limit,
            });
        }
    }
    Ok(())
}
