//! Vulkan 1.3 behind plain types: a device, named memory, pipelines, and commands that are recorded,
//! run and waited for in one call.
//!
//! [`Device`] is opened once and shared; [`Buffer`], [`Image`], [`Pipeline`] and the rest hold it and
//! free themselves. Every failure is a [`VulkanError`] whose one line says what to do. Knows nothing
//! of yarn.

mod barriers;
mod buffer;
mod commands;
mod descriptors;
mod device;
mod doctor;
mod error;
mod image;
mod instance;
mod interfaces;
mod memory;
mod pipeline;
mod pipeline_cache;
mod rendering;
mod sampler;
mod select;
mod shader;
#[cfg(feature = "viewer")]
mod swapchain;
mod timestamps;
mod transfer;
mod trim;

pub use ash::vk;

pub use barriers::{Access, ImageState};
pub use buffer::Buffer;
pub use commands::{Commands, Semaphores};
pub use descriptors::{Binding, DescriptorLayout, DescriptorSet, Resource};
pub use device::{Device, DeviceOptions};
pub use doctor::{DeviceFacts, DoctorReport, LayerFacts, inspect};
pub use error::VulkanError;
pub use image::{Image, ImageInfo, ImageView};
pub use instance::Validation;
pub use interfaces::Interfaces;
pub use memory::MemoryKind;
pub use pipeline::{Blend, ComputePipelineInfo, DepthState, GraphicsPipelineInfo, Pipeline};
pub use pipeline_cache::PipelineCache;
pub use rendering::{ColorTarget, DepthTarget, Rendering};
pub use sampler::{Sampler, SamplerInfo};
pub use select::{DeviceChoice, OptionalFeatures};
pub use shader::{ShaderStage, SpecializationConstants};
#[cfg(feature = "viewer")]
pub use swapchain::{Presented, Swapchain, surface_extensions, swapchain_extension};
pub use timestamps::Taken;
pub use trim::trimmed;
