//! Runs a function's kernel over rows of arguments.

use super::entries::Entries;
use super::fields::Values;
use super::function::{Function, Table, TableOf};
use crate::precompute::chord_shadow::ChordShadow;
use crate::shaders::ShaderSet;
use crate::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Device, Image, ImageInfo,
    ImageState, MemoryKind, Pipeline, Resource, Sampler, SamplerInfo, SpecializationConstants, VulkanError,
    vk,
};
use bytemuck::{Pod, Zeroable};
use half::f16;
use rayon::prelude::*;
use std::sync::Arc;

/// Invocations of a work group, in `glsl/test/kernel.glsl`.
const GROUP: u32 = 64;
/// Baked tables kept on the device, of at most two mebibytes each.
const MOST_TABLES: usize = 64;

/// Push constants of `glsl/test/kernel.glsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Shape {
    rows: u32,
    input_words: u32,
    result_words: u32,
}

/// A function's kernel on a device, with the tables that its queries asked for last.
pub struct Kernel {
    device: Arc<Device>,
    function: &'static Function,
    layout: DescriptorLayout,
    pipeline: Pipeline,
    sampler: Sampler,
    entries: Entries,
    tables: Vec<(Vec<u64>, Kept)>,
}

/// Numbers, or why there are none.
pub type Answer = Result<Vec<f64>, String>;
/// A table on the device, or why none is good enough.
type Kept = Result<Image, String>;

impl Kernel {
    /// Compiles the kernel.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Arc<Device>, function: &'static Function) -> Result<Self, VulkanError> {
        Self::with_shaders(device, function, &ShaderSet::default())
    }

    /// The same with other shaders.
    ///
    /// # Errors
    /// Those of the device.
    #[doc(hidden)]
    pub fn with_shaders(
        device: &Arc<Device>,
        function: &'static Function,
        shaders: &ShaderSet,
    ) -> Result<Self, VulkanError> {
        let binding = |binding, kind| Binding { binding, kind, stages: vk::ShaderStageFlags::COMPUTE };
        let texture = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let buffer = vk::DescriptorType::STORAGE_BUFFER;
        let mut bindings = vec![binding(0, buffer), binding(1, buffer)];
        bindings.push(binding(2, if function.device.table.is_some() { texture } else { buffer }));
        let layout = DescriptorLayout::new(device, function.name, &bindings)?;
        let missing = || VulkanError::misuse(format!("no embedded shader `{}`", function.device.kernel));
        let info = ComputePipelineInfo {
            name: function.name,
            spirv: shaders.get(function.device.kernel).ok_or_else(missing)?,
            constants: &SpecializationConstants::new(),
            set_layouts: &[&layout],
            push_constant_bytes: size_of::<Shape>() as u32,
            cache: None,
        };
        Ok(Self {
            device: device.clone(),
            function,
            pipeline: Pipeline::compute(device, &info)?,
            layout,
            sampler: Sampler::new(device, "table", &SamplerInfo::default())?,
            entries: Entries::default(),
            tables: Vec::new(),
        })
    }

    /// The function's answer to each query, in order; in its place why there is none, where no table is good enough.
    ///
    /// # Errors
    /// Those of the device.
    pub fn answers(&mut self, queries: &[&[f64]]) -> Result<Vec<Answer>, VulkanError> {
        let Some(table) = self.function.device.table else {
            return Ok(self.run(queries, None)?.into_iter().map(Ok).collect());
        };
        let mut answers = vec![Ok(Vec::new()); queries.len()];
        for group in groups(queries, table.numbers) {
            let members: Vec<&[f64]> = group.iter().map(|index| queries[*index]).collect();
            let found: Vec<Answer> = match self.table(table, members[0])? {
                Ok(image) => self.run(&members, Some(&image))?.into_iter().map(Ok).collect(),
                Err(why) => vec![Err(why); members.len()],
            };
            group.into_iter().zip(found).for_each(|(index, answer)| answers[index] = answer);
        }
        Ok(answers)
    }

    /// The same for functions and queries whose tables are known to be good enough.
    ///
    /// # Errors
    /// Those of the device; a query without an answer.
    pub fn numbers(&mut self, queries: &[&[f64]]) -> Result<Vec<Vec<f64>>, VulkanError> {
        self.answers(queries)?.into_iter().map(|answer| answer.map_err(VulkanError::misuse)).collect()
    }

    fn run(&self, queries: &[&[f64]], table: Option<&Image>) -> Result<Vec<Vec<f64>>, VulkanError> {
        let side = &self.function.device;
        let words = |query: &&[f64]| (side.words)(Values::new(query), &self.entries);
        let rows: Vec<Vec<u32>> = queries.par_iter().map(words).collect();
        let Some(input_words) = rows.first().map(Vec::len) else { return Ok(Vec::new()) };
        let result_words = side.given;
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let inputs = Buffer::upload(&self.device, "queries", storage, &rows.concat())?;
        let bytes = 4 * (rows.len() * result_words) as u64;
        let results = Buffer::new(&self.device, "answers", bytes, storage, MemoryKind::Readback)?;
        let third =
            table.map_or(Resource::Storage(&inputs), |image| Resource::Sampled(image.view(), &self.sampler));
        let bound = [(0, Resource::Storage(&inputs)), (1, Resource::Storage(&results)), (2, third)];
        let set = DescriptorSet::new(&self.layout, self.function.name, &bound)?;
        let shape = Shape {
            rows: rows.len() as u32,
            input_words: input_words as u32,
            result_words: result_words as u32,
        };
        self.device.run_once(self.function.name, |commands| {
            commands.bind_pipeline(&self.pipeline);
            commands.bind_sets(&self.pipeline, &[&set]);
            commands.push_constants(&self.pipeline, &shape)?;
            commands.dispatch([shape.rows.div_ceil(GROUP), 1, 1]);
            commands.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
            Ok(())
        })?;
        let given: Vec<f32> = results.read()?;
        let finish = |(query, given): (&&[f64], &[f32])| (side.finish)(Values::new(query), given);
        Ok(queries.iter().zip(given.chunks(result_words)).map(finish).collect())
    }

    /// The table of a query, from those kept or baked.
    fn table(&mut self, table: TableOf, query: &[f64]) -> Result<Kept, VulkanError> {
        let key = key(query, table.numbers);
        if let Some(at) = self.tables.iter().position(|(kept, _)| *kept == key) {
            let kept = self.tables.remove(at);
            self.tables.push(kept);
        } else {
            if self.tables.len() >= MOST_TABLES {
                drop(self.tables.remove(0));
            }
            let baked = (table.bake)(Values::new(query));
            let kept = baked.map(|baked| image(&self.device, &baked));
            self.tables.push((key, kept.map_or_else(|why| Ok(Err(why)), |image| image.map(Ok))?));
        }
        self.tables.last().map(|(_, kept)| kept.clone()).ok_or_else(|| VulkanError::misuse("no table"))
    }
}

fn key(query: &[f64], numbers: usize) -> Vec<u64> {
    query[..numbers].iter().map(|number| number.to_bits()).collect()
}

/// Indices of queries that read the same table, table by table in the order in which they are first read.
fn groups(queries: &[&[f64]], numbers: usize) -> Vec<Vec<usize>> {
    let mut place = std::collections::HashMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, query) in queries.iter().enumerate() {
        let at = *place.entry(key(query, numbers)).or_insert(groups.len());
        if at == groups.len() {
            groups.push(Vec::new());
        }
        groups[at].push(index);
    }
    groups
}

fn image(device: &Arc<Device>, table: &Table) -> Result<Image, VulkanError> {
    let (extent, volume, texels): ([u32; 3], bool, &[f16]) = match table {
        Table::SelfShadow(table) => (table.size.extent(), true, &table.depths),
        Table::Chords(table) => (ChordShadow::EXTENT, true, &table.rests),
        Table::Occlusion(table) => ([table.across, table.across, 1], false, &table.visibilities),
    };
    let usage = vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::SAMPLED;
    let format = vk::Format::R16_SFLOAT;
    let image = Image::new(
        device,
        &ImageInfo { name: "table", format, extent, volume, usage, ..Default::default() },
    )?;
    image.upload(texels, ImageState::SAMPLED_COMPUTE)?;
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn queries_of_one_table_are_grouped_in_order() {
        let queries: [&[f64]; 5] =
            [&[1.0, 2.0, 7.0], &[1.0, 3.0, 7.0], &[1.0, 2.0, 9.0], &[0.0, 2.0, 1.0], &[1.0, 3.0, 0.0]];
        assert_eq!(groups(&queries, 2), [vec![0, 2], vec![1, 4], vec![3]]);
        assert_eq!(groups(&queries, 0), [vec![0, 1, 2, 3, 4]]);
        assert!(groups(&[], 2).is_empty());
    }
}
