//! Baked tables as bytes, to be kept from one run to the next: this machine's own, exact in all that the device reads.

use super::chord_shadow::ChordShadow;
use super::core_texture::{CoreMip, CoreTexture, Moments};
use super::occlusion_fit::OcclusionFit;
use super::occlusion_table::OcclusionTable;
use super::scattering_table::ScatteringTable;
use super::self_shadow::{SelfShadowSize, SelfShadowTable};
use bytemuck::{AnyBitPattern, NoUninit};
use glam::DVec4;
use half::f16;

/// Hash of the code that bakes, of all it calls and of the versions of crates: tables of another are not taken.
pub const BAKERS: &str = env!("WORSTED_BAKERS");

/// A table that can be kept.
pub trait Stored: Sized {
    /// As bytes.
    fn to_bytes(&self) -> Vec<u8>;
    /// From what [`Self::to_bytes`] gave; none where it did not.
    fn from_bytes(bytes: &[u8]) -> Option<Self>;
}

/// What is left to be read.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn one<T: AnyBitPattern>(&mut self) -> Option<T> {
        let (head, rest) = self.0.split_at_checked(size_of::<T>())?;
        self.0 = rest;
        Some(bytemuck::pod_read_unaligned(head))
    }

    fn many<T: NoUninit + AnyBitPattern>(&mut self, count: u64) -> Option<Vec<T>> {
        let bytes = usize::try_from(count).ok()?.checked_mul(size_of::<T>())?;
        let (head, rest) = self.0.split_at_checked(bytes)?;
        self.0 = rest;
        Some(bytemuck::pod_collect_to_vec(head))
    }

    /// The value read, where nothing is left.
    fn end<T>(self, value: T) -> Option<T> {
        self.0.is_empty().then_some(value)
    }
}

fn bytes_of<T: NoUninit, U: NoUninit>(head: &[T], body: &[U]) -> Vec<u8> {
    [bytemuck::cast_slice(head), bytemuck::cast_slice(body)].concat()
}

impl Stored for f64 {
    fn to_bytes(&self) -> Vec<u8> {
        bytemuck::bytes_of(self).to_vec()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let value = reader.one()?;
        reader.end(value)
    }
}

impl Stored for OcclusionFit {
    fn to_bytes(&self) -> Vec<u8> {
        bytes_of(&[self.visibility.to_array(), self.lean.to_array()], &[0_u8; 0])
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let [visibility, lean] = reader.one::<[[f64; 4]; 2]>()?.map(DVec4::from_array);
        reader.end(Self { visibility, lean })
    }
}

impl Stored for OcclusionTable {
    fn to_bytes(&self) -> Vec<u8> {
        bytes_of(&[self.across], &self.visibilities)
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let across: u32 = reader.one()?;
        let visibilities = reader.many(u64::from(across).checked_mul(across.into())?)?;
        reader.end(Self { across, visibilities })
    }
}

impl Stored for SelfShadowTable {
    fn to_bytes(&self) -> Vec<u8> {
        bytes_of(&[self.size.across, self.size.slices], &self.depths)
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let size = SelfShadowSize { across: reader.one()?, slices: reader.one()? };
        let texels =
            size.extent().iter().try_fold(1_u64, |product, &side| product.checked_mul(side.into()))?;
        let depths = reader.many(texels)?;
        reader.end(Self { size, depths })
    }
}

impl Stored for ChordShadow {
    fn to_bytes(&self) -> Vec<u8> {
        bytes_of(&[self.rests.len() as u64], &self.rests)
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let count: u64 = reader.one()?;
        let rests = reader.many(count)?;
        reader.end(Self { rests })
    }
}

impl Stored for ScatteringTable {
    fn to_bytes(&self) -> Vec<u8> {
        bytes_of(&[self.entries], &self.values)
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let entries: u32 = reader.one()?;
        // R's and TT's.
        let values = reader.many(2 * u64::from(entries))?;
        reader.end(Self { entries, values })
    }
}

/// What is open of the sky, fabric by fabric.
impl Stored for Vec<Vec<[f16; 4]>> {
    fn to_bytes(&self) -> Vec<u8> {
        let counts: Vec<u64> =
            [self.len()].into_iter().chain(self.iter().map(Vec::len)).map(|n| n as u64).collect();
        bytes_of(&counts, &self.concat())
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let fabrics: u64 = reader.one()?;
        let counts: Vec<u64> = reader.many(fabrics)?;
        let skies = counts.into_iter().map(|count| reader.many(count)).collect::<Option<_>>()?;
        reader.end(skies)
    }
}

/// The texels as half floats, as the device reads them.
impl Stored for CoreTexture {
    fn to_bytes(&self) -> Vec<u8> {
        let scale =
            [[self.extent, self.height_share, self.height_above].as_slice(), &self.thickness].concat();
        let mut bytes = bytes_of(&[self.layers, self.ranks, self.mips.len() as u32, 0], &scale);
        for mip in &self.mips {
            let halves = |texel: &Moments| {
                [texel.normals, texel.shape, texel.spread].map(|part| part.map(f16::from_f64))
            };
            let texels: Vec<[[f16; 4]; 3]> = mip.texels.iter().map(halves).collect();
            bytes.extend(bytes_of(&[mip.columns, mip.rows], &texels));
        }
        bytes
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let [layers, ranks, levels, _]: [u32; 4] = reader.one()?;
        let [extent, height_share, height_above] = reader.one()?;
        let thickness = reader.one()?;
        let mut mips = Vec::new();
        for _ in 0..levels {
            let [columns, rows]: [u32; 2] = reader.one()?;
            let texels = u64::from(columns).checked_mul(rows.into())?.checked_mul(layers.into())?;
            let halves: Vec<[[f16; 4]; 3]> = reader.many(texels)?;
            let whole = |halves: &[[f16; 4]; 3]| {
                let [normals, shape, spread] = halves.map(|part| part.map(f64::from));
                Moments { normals, shape, spread }
            };
            mips.push(CoreMip { columns, rows, texels: halves.iter().map(whole).collect() });
        }
        reader.end(Self { layers, mips, extent, thickness, ranks, height_share, height_above })
    }
}
