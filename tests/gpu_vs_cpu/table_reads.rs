//! Baked tables as the device reads them, its own filter included, against the integrals they stand for.

use crate::device::shared;
use crate::harness::Word;
use crate::inputs::row;
use crate::kernel;
use glam::{DVec2, DVec3};
use half::f16;
use rayon::prelude::*;
use std::f64::consts::TAU;
use worsted::precompute::chord_shadow::{CHORD_LIMIT, ChordShadow, Plies, bake_chord_shadow, chord_depth};
use worsted::precompute::occlusion_table::{
    OCCLUSION_ACROSS, OCCLUSION_LIMIT, bake_occlusion_table, exact_occlusion, occlusion_place,
    texture_occlusion,
};
use worsted::precompute::optical_depth::CrossSection;
use worsted::precompute::self_shadow::{
    SELF_SHADOW_LIMIT, SelfShadowSize, SelfShadowTable, bake_self_shadow, exact_self_shadow_depth,
    self_shadow_depth, self_shadow_light, self_shadow_place,
};
use worsted::precompute::table_error::{TableError, places};
use worsted::vulkan::{DeviceChoice, Image, ImageInfo, ImageState, Sampler, SamplerInfo, VulkanError, vk};
use worsted::yarn::density::extinction_per_mm;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// How far a device's filter may be from an exact one, as a share of the table's range: its weights may have as
/// few as 8 bits, and neighbouring texels differ by up to a third of the range.
const FILTER: f64 = 2e-3;
/// Most that the share of light at a fiber may change as the yarn turns by one ply.
const MOST_CHANGE: f64 = 2e-3;
/// Most that a depth may change, as a share of the table's range, as light turns by one twentieth of a degree.
const LARGEST_STEP: f64 = 0.015;

/// Runs a kernel over a table in a texture.
fn read(
    function: &str,
    extent: [u32; 3],
    texels: &[f16],
    rows: &[Vec<Word>],
) -> Result<Vec<f64>, VulkanError> {
    let device = shared(DeviceChoice::Auto);
    let info = ImageInfo {
        name: function,
        format: vk::Format::R16_SFLOAT,
        extent,
        volume: function != "texture_occlusion",
        usage: vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::SAMPLED,
        ..Default::default()
    };
    let image = Image::new(device, &info)?;
    image.upload(texels, ImageState::SAMPLED_COMPUTE)?;
    let sampler = Sampler::new(device, function, &SamplerInfo::default())?;
    let words: Vec<Vec<u32>> = rows.iter().map(|row| row.iter().map(|word| word.bits()).collect()).collect();
    let results = kernel::run_with(function, &words, 1, Some((&image, &sampler)))?;
    device.check_validation()?;
    Ok(results.iter().map(|row| f64::from(row[0])).collect())
}

fn read_depths(table: &SelfShadowTable, places: &[DVec3]) -> Vec<f64> {
    let rows: Vec<_> = places.iter().map(|place| row().vec3(*place).end()).collect();
    read("self_shadow_depth", table.size.extent(), &table.depths, &rows).expect("a table the device reads")
}

fn presets() -> Vec<(&'static str, YarnParams)> {
    presets::yarn_names().map(|name| (name, presets::yarn(name).expect("a preset"))).collect()
}

fn yarn_of(ply_count: u32) -> YarnParams {
    YarnParams { ply_count, ..presets::yarn(presets::DEFAULT_YARN).expect("a preset") }
}

#[test]
fn the_device_reads_depths_close_to_the_integral() {
    for (name, yarn) in presets() {
        let table = bake_self_shadow(&yarn, SelfShadowSize::default());
        let section = CrossSection::new(&yarn);
        let points: Vec<(DVec2, DVec2)> = places(20_000).collect();
        let coordinates: Vec<DVec3> = points
            .iter()
            .map(|(position, light)| self_shadow_place(*position, *light, yarn.ply_count, table.size))
            .collect();
        let found = read_depths(&table, &coordinates);
        let exact =
            points.par_iter().map(|(position, light)| exact_self_shadow_depth(&section, *position, *light));
        let pairs: Vec<_> = found.iter().copied().zip(exact.collect::<Vec<_>>()).collect();
        let error = TableError::new(&pairs, table.largest());
        println!("{name}: {error:?}");
        assert!(error.within(&SELF_SHADOW_LIMIT), "{name}: {error:?}");

        let twins: Vec<_> = coordinates.iter().map(|place| self_shadow_depth(&table, *place)).collect();
        let pairs: Vec<_> = found.iter().copied().zip(twins).collect();
        let filter = TableError::new(&pairs, table.largest());
        println!("{name}: filter {filter:?}");
        assert!(filter.worst <= FILTER, "{name}: filter {filter:?}");

        let beside: Vec<DVec3> = coordinates.iter().map(|p| *p + DVec3::new(0.05, 0.0, 0.0)).collect();
        let exact: Vec<f64> = pairs.iter().map(|(_, twin)| *twin).collect();
        let wrong: Vec<_> = read_depths(&table, &beside).into_iter().zip(exact).collect();
        let wrong = TableError::new(&wrong, table.largest());
        assert!(!wrong.within(&SELF_SHADOW_LIMIT), "{name}: a wrong place passes with {wrong:?}");
    }
}

#[test]
fn the_device_reads_occlusion_close_to_the_integral() {
    for (name, yarn) in presets() {
        let table = bake_occlusion_table(&yarn, extinction_per_mm(&yarn), OCCLUSION_ACROSS);
        let section = CrossSection::new(&yarn);
        let points: Vec<DVec2> = places(2000).map(|(position, _)| position).collect();
        let coordinates: Vec<DVec2> = points.iter().map(|p| occlusion_place(*p, table.across)).collect();
        let rows: Vec<_> = coordinates.iter().map(|place| row().real(place.x).real(place.y).end()).collect();
        let extent = [table.across, table.across, 1];
        let found = read("texture_occlusion", extent, &table.visibilities, &rows).expect("a table");
        let exact: Vec<f64> =
            points.par_iter().map(|p| exact_occlusion(&section, extinction_per_mm(&yarn), *p)).collect();
        let error = TableError::new(&found.iter().copied().zip(exact).collect::<Vec<_>>(), 1.0);
        println!("{name}: {error:?}");
        assert!(error.worst <= OCCLUSION_LIMIT, "{name}: {error:?}");

        let twins = coordinates.iter().map(|place| texture_occlusion(&table, *place));
        let filter = TableError::new(&found.into_iter().zip(twins).collect::<Vec<_>>(), 1.0);
        assert!(filter.worst <= FILTER, "{name}: filter {filter:?}");
    }
}

/// Light through plies of all kinds that fit no table by place, and through a preset's: the device works out the chords
/// itself, in f32.
#[test]
fn the_device_reads_chords_close_to_the_integral() {
    let wool = yarn_of(3);
    let flat =
        |short: f64, long: f64| YarnParams { ellipse_short_mm: short, ellipse_long_mm: long, ..wool.clone() };
    let step = YarnParams { migration_min: 1.0, density_beta: 0.0, ..flat(0.0042, 4.0) };
    let yarns = [wool.clone(), flat(4.0, 0.04), flat(0.04, 4.0), step, yarn_of(1), yarn_of(8)];
    for yarn in yarns {
        let (table, plies) = (bake_chord_shadow(&yarn), Plies::new(&yarn));
        let section = CrossSection::new(&yarn);
        let points: Vec<(DVec2, DVec2)> = (0..20_000)
            .zip(places(20_000))
            .map(|(index, (place, light))| {
                let turn = DVec2::from_angle(TAU * f64::from(index) / f64::from(plies.count));
                let in_ply = turn.rotate(DVec2::new(plies.offset, 0.0) + plies.axes * place);
                (if index % 2 == 0 { place } else { in_ply }, light)
            })
            .collect();
        let rows: Vec<_> = points
            .iter()
            .map(|(at, light)| {
                let placed = row().real(at.x).real(at.y).real(light.x).real(light.y).bits(plies.count);
                let axes = placed.real(plies.offset).real(plies.axes.x).real(plies.axes.y);
                axes.real(plies.turn.x).real(plies.turn.y).end()
            })
            .collect();
        let found = read("chord_depth", ChordShadow::EXTENT, &table.rests, &rows).expect("a table");
        let exact: Vec<f64> =
            points.par_iter().map(|(at, light)| exact_self_shadow_depth(&section, *at, *light)).collect();
        let range = exact.iter().copied().fold(0.0, f64::max);
        let error = |off: f64| {
            let pairs: Vec<_> = found.iter().copied().zip(exact.iter().map(|e| off * e)).collect();
            TableError::new(&pairs, range)
        };
        println!("{} plies {}: {:?}", plies.count, plies.axes, error(1.0));
        assert!(error(1.0).within(&CHORD_LIMIT), "{plies:?}: {:?}", error(1.0));
        assert!(!error(1.05).within(&CHORD_LIMIT), "{plies:?}: what is 5% off passes");
        let twins: Vec<_> =
            points.iter().map(|(at, light)| chord_depth(&table, *at, *light, &plies)).collect();
        let filter = TableError::new(&found.iter().copied().zip(twins).collect::<Vec<_>>(), range);
        assert!(filter.rms <= 0.5 * CHORD_LIMIT.rms, "{plies:?}: filter {filter:?}");
    }
}

/// Depths that the device reads where the device says to read them.
fn depths(table: &SelfShadowTable, ply_count: u32, points: impl Iterator<Item = (DVec2, DVec2)>) -> Vec<f64> {
    let words = |(position, light): (DVec2, DVec2)| {
        let placed = row().real(position.x).real(position.y).real(light.x).real(light.y);
        let row = placed.bits(ply_count).bits(table.size.across).bits(table.size.slices).end();
        row.iter().map(|word| word.bits()).collect()
    };
    let rows: Vec<Vec<u32>> = points.map(words).collect();
    let found = kernel::run("self_shadow_place", &rows, 3).expect("a kernel that runs");
    let place = |row: &Vec<f32>| DVec3::from_array(std::array::from_fn(|k| f64::from(row[k])));
    read_depths(table, &found.iter().map(place).collect::<Vec<_>>())
}

#[test]
fn a_turn_by_one_ply_changes_nothing_on_the_device() {
    for ply_count in [1, 2, 3, 4, 8] {
        let yarn = yarn_of(ply_count);
        let extinction = extinction_per_mm(&yarn) * yarn.outer_radius_mm();
        let table = bake_self_shadow(&yarn, SelfShadowSize::default());
        // Fibers and light that stay in the world as the yarn turns.
        let factors = |phase: f64| -> Vec<f64> {
            let from_world = DVec2::from_angle(-phase);
            let points = places(5000).map(|(p, light)| (from_world.rotate(p), from_world.rotate(light)));
            let depths = depths(&table, ply_count, points);
            depths.into_iter().map(|depth| self_shadow_light(depth, extinction, 1.0)).collect()
        };
        let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let turn = TAU / f64::from(ply_count);
        let (before, after) = (factors(0.37), factors(0.37 + turn));
        let worst = largest(&before, &after);
        println!("{ply_count} plies: {worst}");
        assert!(worst <= MOST_CHANGE, "{ply_count} plies: {worst}");
        let half = largest(&before, &factors(0.37 + 0.5 * turn));
        assert!(half > 10.0 * MOST_CHANGE, "{ply_count} plies: half a turn changes no more than {half}");
    }
}

#[test]
fn the_devices_depths_are_continuous_all_the_way_round() {
    const STEPS: u32 = 7200;
    for ply_count in [1, 2, 3, 4, 8] {
        let table = bake_self_shadow(&yarn_of(ply_count), SelfShadowSize::default());
        let mut largest = 0.0_f64;
        for (position, _) in places(5) {
            let light = |step: u32| DVec2::from_angle(TAU * f64::from(step % STEPS) / f64::from(STEPS));
            let depths = depths(&table, ply_count, (0..=STEPS).map(|step| (position, light(step))));
            let steps = depths.windows(2).map(|pair| (pair[0] - pair[1]).abs());
            largest = largest.max(steps.fold(0.0, f64::max) / table.largest());
        }
        println!("{ply_count} plies: {largest}");
        assert!(largest <= LARGEST_STEP + FILTER, "{ply_count} plies: {largest}");
    }
}
