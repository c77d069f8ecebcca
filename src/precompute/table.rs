//! Baked tables whose first and last nodes lie on the ends of their sides; where these lie in a texture is the
//! twin of `glsl/shading/table.glsl`.

use half::f16;

/// Place of node `index` of `count`, from 0 to 1; one node alone stands for the start.
pub fn node(index: u32, count: u32) -> f64 {
    if count > 1 { f64::from(index) / f64::from(count - 1) } else { 0.0 }
}

/// Texture coordinate of `share` in [0, 1] of a side whose first and last texels lie on its ends, so that
/// clamping at the texture's edge clamps at the table's.
pub fn node_coordinate(share: f64, texels: u32) -> f64 {
    let count = f64::from(texels);
    (share * (count - 1.0) + 0.5) / count
}

/// What linear filtering with exact weights reads at texture coordinates `place`, clamped to the edges. `size`
/// is the texels of each side, the one that changes fastest first.
pub fn filtered<const N: usize>(texels: &[f16], size: [u32; N], place: [f64; N]) -> f64 {
    let at: [f64; N] = std::array::from_fn(|k| {
        (place[k] * f64::from(size[k]) - 0.5).clamp(0.0, f64::from(size[k].max(1) - 1))
    });
    let corner = |corner: u32| {
        let (mut index, mut weight) = (0, 1.0);
        for k in (0..N).rev() {
            let up = corner >> k & 1;
            weight *= if up == 1 { at[k].fract() } else { 1.0 - at[k].fract() };
            index = index * size[k] as usize + (at[k] as u32 + up).min(size[k] - 1) as usize;
        }
        weight * f64::from(texels[index])
    };
    (0..1 << N).map(corner).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_table_is_read_back_and_clamped() {
        let size = [3, 5, 2];
        let value = |x: f64, y: f64, z: f64| 1.0 + 2.0 * x + 8.0 * y + 64.0 * z;
        let mut texels = Vec::new();
        for (z, y, x) in (0..30).map(|i| (i / 15, i / 3 % 5, i % 3)) {
            texels.push(f16::from_f64(value(node(x, 3), node(y, 5), node(z, 2))));
        }
        let read = |share: [f64; 3]| {
            filtered(&texels, size, std::array::from_fn(|k| node_coordinate(share[k], size[k])))
        };
        for share in [[0.0; 3], [1.0; 3], [0.3, 0.6, 0.9], [0.5, 0.01, 0.2]] {
            assert!((read(share) - value(share[0], share[1], share[2])).abs() < 1e-12, "{share:?}");
        }
        assert_eq!(read([-3.0, 0.0, 0.0]), value(0.0, 0.0, 0.0));
        assert_eq!(read([0.5, 7.0, 1.2]), value(0.5, 1.0, 1.0));
        assert_eq!(node(0, 1), 0.0);
    }
}
