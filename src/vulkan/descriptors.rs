//! Descriptor layouts and sets. A set is complete when made and never changes: what a pass reads is
//! decided in one place, and a set that is in use cannot be rewritten.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use super::buffer::Buffer;
use super::device::Device;
use super::error::VulkanError;
use super::image::ImageView;
use super::memory::Ticket;
use super::sampler::Sampler;

/// One binding of a layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// `layout(binding = N)`.
    pub binding: u32,
    /// Storage or uniform buffer, storage image, or combined image sampler.
    pub kind: vk::DescriptorType,
    /// The stages that use it.
    pub stages: vk::ShaderStageFlags,
}

/// What a shader's `layout(set = N)` declares. Clones share it.
#[derive(Clone)]
pub struct DescriptorLayout {
    pub(crate) inner: Arc<LayoutInner>,
}

pub(crate) struct LayoutInner {
    raw: vk::DescriptorSetLayout,
    name: String,
    bindings: Vec<Binding>,
    ticket: Ticket,
}

impl Drop for LayoutInner {
    fn drop(&mut self) {
        // SAFETY: pipelines and sets made with the layout hold it, so nothing uses it any more.
        unsafe { self.ticket.device().raw().destroy_descriptor_set_layout(self.raw, None) };
    }
}

impl DescriptorLayout {
    /// Makes a layout; it may be empty.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if a binding is declared twice.
    pub fn new(device: &Arc<Device>, name: &str, bindings: &[Binding]) -> Result<Self, VulkanError> {
        for (place, binding) in bindings.iter().enumerate() {
            if bindings[..place].iter().any(|b| b.binding == binding.binding) {
                let what = format!("descriptor layout `{name}` declares binding {} twice", binding.binding);
                return Err(VulkanError::misuse(what));
            }
        }
        let raw_bindings: Vec<_> = bindings
            .iter()
            .map(|b| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(b.binding)
                    .descriptor_type(b.kind)
                    .descriptor_count(1)
                    .stage_flags(b.stages)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&raw_bindings);
        // SAFETY: the bindings are distinct and outlive the call.
        let raw = unsafe { device.raw().create_descriptor_set_layout(&info, None) }
            .map_err(|r| VulkanError::from_vk(format!("descriptor layout `{name}`"), r))?;
        device.set_name(raw, name);
        let ticket = Ticket::new(device, "descriptor layout", name, 0);
        Ok(Self {
            inner: Arc::new(LayoutInner { raw, name: name.into(), bindings: bindings.to_vec(), ticket }),
        })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::DescriptorSetLayout {
        self.inner.raw
    }

    /// The bindings it was made with.
    pub fn bindings(&self) -> &[Binding] {
        &self.inner.bindings
    }
}

/// What a binding is bound to.
#[derive(Clone, Copy)]
pub enum Resource<'a> {
    /// All of a storage buffer.
    Storage(&'a Buffer),
    /// All of a uniform buffer.
    Uniform(&'a Buffer),
    /// A storage image, in layout `GENERAL`.
    StorageImage(&'a ImageView),
    /// A texture, in layout `SHADER_READ_ONLY_OPTIMAL`.
    Sampled(&'a ImageView, &'a Sampler),
}

impl Resource<'_> {
    fn kind(&self) -> vk::DescriptorType {
        match self {
            Self::Storage(_) => vk::DescriptorType::STORAGE_BUFFER,
            Self::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER,
            Self::StorageImage(_) => vk::DescriptorType::STORAGE_IMAGE,
            Self::Sampled(..) => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::Storage(buffer) | Self::Uniform(buffer) => buffer.name(),
            Self::StorageImage(view) | Self::Sampled(view, _) => view.image_name(),
        }
    }

    fn buffer_info(&self) -> Option<vk::DescriptorBufferInfo> {
        match self {
            Self::Storage(buffer) | Self::Uniform(buffer) => {
                Some(vk::DescriptorBufferInfo::default().buffer(buffer.raw()).range(vk::WHOLE_SIZE))
            }
            _ => None,
        }
    }

    fn image_info(&self) -> Option<vk::DescriptorImageInfo> {
        let info = vk::DescriptorImageInfo::default();
        match self {
            Self::StorageImage(view) => {
                Some(info.image_view(view.raw()).image_layout(vk::ImageLayout::GENERAL))
            }
            Self::Sampled(view, sampler) => Some(
                info.image_view(view.raw())
                    .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
                    .sampler(sampler.raw()),
            ),
            _ => None,
        }
    }

    fn keep(&self, kept: &mut Vec<Kept>) {
        match self {
            Self::Storage(buffer) | Self::Uniform(buffer) => kept.push(buffer.inner.clone()),
            Self::StorageImage(view) => kept.push(view.inner.clone()),
            Self::Sampled(view, sampler) => {
                kept.push(view.inner.clone());
                kept.push(sampler.inner.clone());
            }
        }
    }
}

/// Something that must outlive its use by the device.
pub(crate) type Kept = Arc<dyn Any + Send + Sync>;

/// A descriptor set with its own pool. Clones share it; it keeps what it binds alive.
#[derive(Clone)]
pub struct DescriptorSet {
    pub(crate) inner: Arc<SetInner>,
}

pub(crate) struct SetInner {
    pool: vk::DescriptorPool,
    raw: vk::DescriptorSet,
    /// The layout and the bound resources.
    _kept: Vec<Kept>,
    ticket: Ticket,
}

impl Drop for SetInner {
    fn drop(&mut self) {
        // SAFETY: recorded commands hold the set until their fence has passed; destroying the pool
        // frees the set.
        unsafe { self.ticket.device().raw().destroy_descriptor_pool(self.pool, None) };
    }
}

impl DescriptorSet {
    /// Makes a set that binds exactly what the layout declares.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if a binding is missing, extra, given twice, or of another type.
    pub fn new(
        layout: &DescriptorLayout,
        name: &str,
        resources: &[(u32, Resource<'_>)],
    ) -> Result<Self, VulkanError> {
        check(&layout.inner, name, resources)?;
        let device = layout.inner.ticket.device();
        let pool = create_pool(device, name, layout.bindings())?;
        let mut kept: Vec<Kept> = vec![layout.inner.clone()];
        resources.iter().for_each(|(_, resource)| resource.keep(&mut kept));
        let ticket = Ticket::new(device, "descriptor set", name, 0);
        // From here on `inner` destroys the pool, also on failure.
        let mut inner = SetInner { pool, raw: vk::DescriptorSet::null(), _kept: kept, ticket };
        let layouts = [layout.raw()];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool was made for exactly this layout and is used by nothing else.
        let sets = unsafe { device.raw().allocate_descriptor_sets(&info) }
            .map_err(|r| VulkanError::from_vk(format!("descriptor set `{name}`"), r))?;
        inner.raw = sets.first().copied().unwrap_or_default();
        device.set_name(inner.raw, name);
        write(device, inner.raw, resources);
        Ok(Self { inner: Arc::new(inner) })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::DescriptorSet {
        self.inner.raw
    }
}

fn write(device: &Device, set: vk::DescriptorSet, resources: &[(u32, Resource<'_>)]) {
    let infos: Vec<_> = resources
        .iter()
        .map(|(_, r)| (r.buffer_info().as_slice().to_vec(), r.image_info().as_slice().to_vec()))
        .collect();
    let writes: Vec<_> = resources
        .iter()
        .zip(&infos)
        .map(|((binding, resource), (buffers, images))| {
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(*binding)
                .descriptor_type(resource.kind());
            if images.is_empty() { write.buffer_info(buffers) } else { write.image_info(images) }
        })
        .collect();
    // SAFETY: the set is new and in no command buffer; every handle is alive and held by the set;
    // types were checked against the layout.
    unsafe { device.raw().update_descriptor_sets(&writes, &[]) };
}

fn check(layout: &LayoutInner, name: &str, resources: &[(u32, Resource<'_>)]) -> Result<(), VulkanError> {
    let fault = |what: String| {
        Err(VulkanError::misuse(format!("descriptor set `{name}` of layout `{}`: {what}", layout.name)))
    };
    for (place, (number, resource)) in resources.iter().enumerate() {
        if resources[..place].iter().any(|(other, _)| other == number) {
            return fault(format!("binding {number} is given twice"));
        }
        match layout.bindings.iter().find(|b| b.binding == *number) {
            None => return fault(format!("binding {number} (`{}`) is not in the layout", resource.name())),
            Some(declared) if declared.kind != resource.kind() => {
                return fault(format!(
                    "binding {number} is declared as {:?}, `{}` is given as {:?}",
                    declared.kind,
                    resource.name(),
                    resource.kind()
                ));
            }
            Some(_) => {}
        }
    }
    match layout.bindings.iter().find(|b| !resources.iter().any(|(number, _)| *number == b.binding)) {
        Some(missing) => fault(format!("binding {} ({:?}) is not given", missing.binding, missing.kind)),
        None => Ok(()),
    }
}

fn create_pool(device: &Device, name: &str, bindings: &[Binding]) -> Result<vk::DescriptorPool, VulkanError> {
    // A pool must hold something, even for an empty layout.
    let mut sizes =
        vec![vk::DescriptorPoolSize { ty: vk::DescriptorType::STORAGE_BUFFER, descriptor_count: 1 }];
    sizes.extend(bindings.iter().map(|b| vk::DescriptorPoolSize { ty: b.kind, descriptor_count: 1 }));
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    // SAFETY: the sizes are positive and outlive the call.
    unsafe { device.raw().create_descriptor_pool(&info, None) }
        .map_err(|r| VulkanError::from_vk(format!("descriptor pool of `{name}`"), r))
}
