use super::*;
use crate::yarn::presets;
use crate::yarn::table::fiber_table;

const ROWS: u32 = 32;

fn baked(preset: &str) -> (YarnParams, CoreTexture) {
    let yarn = presets::yarn(preset).unwrap();
    let texture = bake_core(&yarn, &fiber_table(&yarn, 3), ROWS, 0.02);
    (yarn, texture)
}

fn layer(texture: &CoreTexture, index: u32) -> &[Moments] {
    let mip = &texture.mips[0];
    let size = (mip.columns * mip.rows) as usize;
    &mip.texels[index as usize * size..][..size]
}

#[test]
fn every_preset_bakes_to_finite_moments_that_normals_can_have() {
    for preset in presets::yarn_names() {
        let (yarn, texture) = baked(preset);
        assert_eq!(texture.layers, yarn.ply_count * CORE_LEVELS);
        assert!(texture.ranks <= yarn.fibers_per_ply && texture.ranks > 0, "{preset}: {}", texture.ranks);
        assert!(texture.thickness.windows(2).all(|w| w[0] <= w[1]), "{preset}: {:?}", texture.thickness);
        assert!(texture.thickness[7] <= texture.extent + 1e-12);
        assert!((0.1..1.0).contains(&texture.height_share), "{preset}: height {}", texture.height_share);
        for mip in &texture.mips {
            for m in &mip.texels {
                let [coverage, height, s, d] = m.shape;
                assert!((0.0..=1.0 + 1e-12).contains(&coverage), "{preset}: covers {coverage}");
                assert!([height, s, d].iter().all(|v| v.abs() <= 1.5 * coverage), "{preset}: {m:?}");
                assert!(m.normals[0].hypot(m.normals[1]) <= coverage + 1e-12, "{preset}: {m:?}");
                assert!(m.spread[0] * coverage >= s * s - 1e-9, "{preset}: no variance below 0: {m:?}");
            }
        }
    }
}

#[test]
fn levels_stand_for_ever_more_fibers() {
    let (yarn, texture) = baked("worsted_3ply");
    let covered = |level: u32| layer(&texture, level).iter().map(|m| m.shape[0]).sum::<f64>();
    for level in 1..CORE_LEVELS {
        assert!(covered(level) >= covered(level - 1), "level {level} covers less than the one before");
    }
    // The whole ply hides nearly all that lies behind it, out to near its edge.
    let mip = &texture.mips[0];
    let middle = |m: &Moments| m.shape[0];
    let whole = layer(&texture, CORE_LEVELS - 1);
    let inner: Vec<f64> = (mip.rows / 4..3 * mip.rows / 4)
        .flat_map(|row| whole[(row * mip.columns) as usize..][..mip.columns as usize].iter().map(middle))
        .collect();
    let mean = inner.iter().sum::<f64>() / inner.len() as f64;
    assert!(mean > 0.95, "covers {mean}");
    assert!(texture.ranks < yarn.fibers_per_ply, "nothing of a dense ply is hidden");
}

#[test]
fn the_turn_tiles() {
    let (_, texture) = baked("cotton1");
    let whole = layer(&texture, CORE_LEVELS - 1);
    let columns = texture.mips[0].columns as usize;
    // Across the tile's ends neighbouring columns differ no more than anywhere else.
    let step = |a: usize, b: usize| -> f64 {
        (0..ROWS as usize)
            .map(|row| (whole[row * columns + a].shape[1] - whole[row * columns + b].shape[1]).abs())
            .sum()
    };
    let inside = (1..columns).map(|c| step(c - 1, c)).fold(0.0, f64::max);
    assert!(step(columns - 1, 0) <= inside, "{} at the seam, {inside} inside", step(columns - 1, 0));
}

#[test]
fn mips_are_averages_and_the_last_still_tells_edges_from_the_middle() {
    let (_, texture) = baked("silk1");
    let last = texture.mips.last().unwrap();
    assert_eq!((last.columns, last.rows), (4 * FEWEST_ROWS, FEWEST_ROWS));
    let mean = |texels: &[Moments]| {
        texels.iter().copied().fold(Moments::default(), Add::add) * (1.0 / texels.len() as f64)
    };
    for (index, texels) in last.texels.chunks_exact((last.columns * last.rows) as usize).enumerate() {
        let mean_of_all = mean(layer(&texture, index as u32));
        let found = mean(texels);
        let pairs = mean_of_all.shape.iter().zip(found.shape);
        for (a, b) in pairs.chain(mean_of_all.normals.iter().zip(found.normals)) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}

#[test]
fn a_share_of_nothing_hides_only_what_is_never_seen_and_a_share_of_all_draws_no_fiber() {
    let yarn = presets::yarn("cotton1").unwrap();
    let fibers = fiber_table(&yarn, 3);
    let ranks = |share: f64| bake_core(&yarn, &fibers, ROWS, share).ranks;
    assert!(ranks(0.0) > ranks(0.05) && ranks(0.05) > ranks(0.3));
    assert_eq!(ranks(1.1), 0);
}

#[test]
fn the_upper_of_two_heights_is_nearer_where_few_fibers_lie_deep() {
    for preset in presets::yarn_names() {
        let (_, texture) = baked(preset);
        // More fibers are seen near the round than far below it; as a share of the deviation 1 is no skewness.
        assert!((0.4..1.0).contains(&texture.height_above), "{preset}: {}", texture.height_above);
    }
}

#[test]
fn heights_and_slopes_hardly_depend_on_the_place_across() {
    let (_, texture) = baked("worsted_3ply");
    let (columns, whole) = (texture.mips[0].columns as usize, layer(&texture, CORE_LEVELS - 1));
    let row_mean = |row: usize| {
        let sum = whole[row * columns..][..columns].iter().copied().fold(Moments::default(), Add::add);
        sum.shape.map(|value| value / sum.shape[0])
    };
    let rows: Vec<[f64; 4]> = (ROWS as usize / 6..ROWS as usize * 5 / 6).map(row_mean).collect();
    for (k, most) in [(1, 0.4), (2, 0.25), (3, 0.25)] {
        let low = rows.iter().map(|row| row[k]).fold(f64::INFINITY, f64::min);
        let high = rows.iter().map(|row| row[k]).fold(f64::NEG_INFINITY, f64::max);
        assert!(high - low < most, "moment {k} runs from {low} to {high}");
    }
}
