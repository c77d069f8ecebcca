//! Device memory: every allocation has a name, its bytes are counted, and what is never freed is listed.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk;
use gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};
use gpu_allocator::{AllocationError, AllocationSizes, AllocatorDebugSettings, MemoryLocation};

use super::device::Device;
use super::error::VulkanError;
use super::select::Candidate;

const MEBIBYTE: u64 = 1 << 20;

/// Who reads and writes a resource's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryKind {
    /// The device alone.
    Device,
    /// Written by the host, read by the device.
    Upload,
    /// Written by the device, read back by the host.
    Readback,
}

impl MemoryKind {
    fn location(self) -> MemoryLocation {
        match self {
            Self::Device => MemoryLocation::GpuOnly,
            Self::Upload => MemoryLocation::CpuToGpu,
            Self::Readback => MemoryLocation::GpuToCpu,
        }
    }
}

/// Everything alive on a device, by ticket.
#[derive(Default)]
struct Ledger {
    next: u64,
    live: BTreeMap<u64, Entry>,
}

struct Entry {
    kind: &'static str,
    name: String,
    bytes: u64,
}

/// The allocator of one device, with its ledger.
pub(crate) struct Memory {
    /// `None` once the device is being destroyed.
    allocator: Mutex<Option<Allocator>>,
    ledger: Mutex<Ledger>,
    largest_bytes: u64,
    /// The size of the only heap, where there is just one (a CPU device).
    only_heap_bytes: Option<u64>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Nothing under these locks can be left half done by a panic elsewhere.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether an allocation can succeed.
///
/// On a single heap (a CPU device) the driver never says no: it hands out address space, and the
/// process is killed when it writes. There the sum with what is alive is held to the heap's declared
/// size (2 GiB on lavapipe), so that too large a scene ends with an error.
fn fits(bytes: u64, largest: u64, only_heap: Option<u64>, live: impl FnOnce() -> u64) -> bool {
    bytes <= largest && only_heap.is_none_or(|heap| bytes.saturating_add(live()) <= heap)
}

impl Memory {
    pub(crate) fn new(
        instance: &ash::Instance,
        device: &ash::Device,
        candidate: &Candidate,
    ) -> Result<Self, VulkanError> {
        let sizes = AllocationSizes::new(32 * MEBIBYTE, 16 * MEBIBYTE)
            .with_max_device_memblock_size(256 * MEBIBYTE)
            .with_max_host_memblock_size(64 * MEBIBYTE);
        // The ledger reports leaks, as an error and not as a log line.
        let mut debug_settings = AllocatorDebugSettings::default();
        debug_settings.log_leaks_on_shutdown = false;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: candidate.handle,
            debug_settings,
            buffer_device_address: false,
            allocation_sizes: sizes,
        })
        .map_err(|e| VulkanError::misuse(format!("creating the allocator: {e}")))?;
        let heaps = candidate.memory.memory_heaps_as_slice();
        let largest_heap = heaps.iter().map(|heap| heap.size).max().unwrap_or(0);
        Ok(Self {
            allocator: Mutex::new(Some(allocator)),
            ledger: Mutex::default(),
            largest_bytes: largest_heap.min(candidate.max_allocation_bytes),
            only_heap_bytes: if let [heap] = heaps { Some(heap.size) } else { None },
        })
    }

    /// Refuses what no heap could hold, before any Vulkan object is made for it.
    pub(crate) fn check_size(&self, name: &str, bytes: u64) -> Result<(), VulkanError> {
        let live = || lock(&self.ledger).live.values().map(|e| e.bytes).sum();
        if !fits(bytes, self.largest_bytes, self.only_heap_bytes, live) {
            return Err(VulkanError::OutOfMemory { what: name.into(), bytes });
        }
        Ok(())
    }

    fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        kind: MemoryKind,
        scheme: AllocationScheme,
    ) -> Result<Allocation, VulkanError> {
        let bytes = requirements.size;
        self.check_size(name, bytes)?;
        let mut allocator = lock(&self.allocator);
        let Some(allocator) = allocator.as_mut() else {
            return Err(VulkanError::misuse(format!("`{name}` allocated on a destroyed device")));
        };
        let linear = !matches!(scheme, AllocationScheme::DedicatedImage(_));
        let description = AllocationCreateDesc {
            name,
            requirements,
            location: kind.location(),
            linear,
            allocation_scheme: scheme,
        };
        allocator.allocate(&description).map_err(|error| match error {
            AllocationError::OutOfMemory | AllocationError::FailedToMap(_) => {
                VulkanError::OutOfMemory { what: name.into(), bytes }
            }
            // The allocator turns every other result of vkAllocateMemory into text.
            AllocationError::Internal(text) if text.contains("DEVICE_LOST") => {
                VulkanError::DeviceLost { what: format!("allocating `{name}`") }
            }
            AllocationError::Internal(text) if text.contains("OUT_OF_HOST") => {
                VulkanError::OutOfMemory { what: name.into(), bytes }
            }
            error => VulkanError::misuse(format!("allocating `{name}` ({bytes} bytes): {error}")),
        })
    }

    fn free(&self, allocation: Allocation) {
        if let Some(allocator) = lock(&self.allocator).as_mut()
            && let Err(error) = allocator.free(allocation)
        {
            tracing::error!("freeing device memory: {error}");
        }
    }

    /// Returns all memory to the driver; later frees do nothing.
    pub(crate) fn destroy(&self) {
        drop(lock(&self.allocator).take());
    }

    /// One line per resource that is still alive.
    pub(crate) fn live(&self) -> Vec<String> {
        let ledger = lock(&self.ledger);
        ledger.live.values().map(|e| format!("{} `{}` ({} bytes)", e.kind, e.name, e.bytes)).collect()
    }

    /// Bytes by name over everything alive; resources of the same name are summed.
    pub(crate) fn bytes_by_name(&self) -> BTreeMap<String, u64> {
        let mut sums = BTreeMap::new();
        for entry in lock(&self.ledger).live.values().filter(|e| e.bytes > 0) {
            *sums.entry(entry.name.clone()).or_insert(0) += entry.bytes;
        }
        sums
    }
}

/// A line in the ledger for as long as its resource lives.
pub(crate) struct Ticket {
    device: Arc<Device>,
    id: u64,
}

impl Ticket {
    pub(crate) fn new(device: &Arc<Device>, kind: &'static str, name: &str, bytes: u64) -> Self {
        let mut ledger = lock(&device.memory().ledger);
        let id = ledger.next;
        ledger.next += 1;
        ledger.live.insert(id, Entry { kind, name: name.into(), bytes });
        Self { device: device.clone(), id }
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        &self.device
    }
}

impl Drop for Ticket {
    fn drop(&mut self) {
        lock(&self.device.memory().ledger).live.remove(&self.id);
    }
}

/// Memory bound to one buffer or image; returned to the allocator when dropped.
pub(crate) struct BoundMemory {
    allocation: Option<Allocation>,
    /// Dropped after the memory is freed.
    ticket: Ticket,
}

impl BoundMemory {
    pub(crate) fn for_buffer(
        device: &Arc<Device>,
        name: &str,
        buffer: vk::Buffer,
        kind: MemoryKind,
    ) -> Result<Self, VulkanError> {
        // SAFETY: the buffer was created on this device by the caller and is not yet bound.
        let requirements = unsafe { device.raw().get_buffer_memory_requirements(buffer) };
        let scheme = AllocationScheme::GpuAllocatorManaged;
        let bound = Self::allocate(device, "buffer", name, requirements, kind, scheme)?;
        let (memory, offset) = bound.place()?;
        // SAFETY: the allocation satisfies the buffer's own requirements and is used by nothing else.
        unsafe { device.raw().bind_buffer_memory(buffer, memory, offset) }
            .map_err(|r| VulkanError::sized(format!("binding memory to `{name}`"), requirements.size, r))?;
        Ok(bound)
    }

    pub(crate) fn for_image(device: &Arc<Device>, name: &str, image: vk::Image) -> Result<Self, VulkanError> {
        // SAFETY: the image was created on this device by the caller and is not yet bound.
        let requirements = unsafe { device.raw().get_image_memory_requirements(image) };
        let scheme = AllocationScheme::DedicatedImage(image);
        let bound = Self::allocate(device, "image", name, requirements, MemoryKind::Device, scheme)?;
        let (memory, offset) = bound.place()?;
        // SAFETY: the allocation was made for this image alone and satisfies its requirements.
        unsafe { device.raw().bind_image_memory(image, memory, offset) }
            .map_err(|r| VulkanError::sized(format!("binding memory to `{name}`"), requirements.size, r))?;
        Ok(bound)
    }

    fn allocate(
        device: &Arc<Device>,
        what: &'static str,
        name: &str,
        requirements: vk::MemoryRequirements,
        kind: MemoryKind,
        scheme: AllocationScheme,
    ) -> Result<Self, VulkanError> {
        let allocation = device.memory().allocate(name, requirements, kind, scheme)?;
        let ticket = Ticket::new(device, what, name, requirements.size);
        Ok(Self { allocation: Some(allocation), ticket })
    }

    fn place(&self) -> Result<(vk::DeviceMemory, u64), VulkanError> {
        let missing = || VulkanError::misuse("memory used after it was freed");
        let allocation = self.allocation.as_ref().ok_or_else(missing)?;
        // SAFETY: the handle is only bound to a resource that is destroyed before this allocation.
        Ok((unsafe { allocation.memory() }, allocation.offset()))
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        self.ticket.device()
    }

    /// The mapped bytes, where the host may touch them without flushing.
    pub(crate) fn mapped(&self) -> Option<std::ptr::NonNull<u8>> {
        let allocation = self.allocation.as_ref()?;
        let coherent = allocation.memory_properties().contains(vk::MemoryPropertyFlags::HOST_COHERENT);
        if coherent { allocation.mapped_ptr().map(std::ptr::NonNull::cast) } else { None }
    }
}

impl Drop for BoundMemory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take() {
            self.device().memory().free(allocation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn what_no_heap_could_hold_is_refused() {
        assert!(fits(100, 100, None, || 1000), "with several heaps the driver decides");
        assert!(!fits(101, 100, None, || 0));
        assert!(fits(60, 100, Some(100), || 40));
        assert!(!fits(61, 100, Some(100), || 40));
        assert!(!fits(u64::MAX, u64::MAX, Some(u64::MAX - 1), || u64::MAX));
    }
}
