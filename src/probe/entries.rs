//! Entries of the scattering tables, baked as they are asked for: a query reads two of 128 and may have widths that
//! no other query has.

use crate::bsdf::khungurn::tabulated::DEFAULT_ENTRIES;
use crate::precompute::scattering_table::{ambient_factors, normaliser_factor};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// Entries that a row of arguments holds; `KEPT` of `glsl/probe/entries.glsl`.
const KEPT: u32 = 4;
/// How far the device may be from f64 about a place in the table, in entries.
const MARGIN: f64 = 0.01;
/// Entries remembered, of 40 bytes or so each.
const MOST_REMEMBERED: usize = 1 << 18;

/// What is read of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Column {
    /// The factor of G.
    Normaliser,
    /// The three of light from everywhere.
    Ambient,
}

/// Entries that were baked.
#[derive(Default)]
pub struct Entries(Mutex<HashMap<(Column, u64, u32), [f32; 4]>>);

impl Entries {
    /// How many entries the whole table has, which one comes first, and those around `position` in the table of
    /// this width. What the device should not read is no number.
    pub fn around(&self, column: Column, width: f64, position: f64) -> Vec<u32> {
        let last = DEFAULT_ENTRIES - 1;
        let at = position.clamp(0.0, 1.0) * f64::from(last);
        let low = (at as u32).min(last - 1);
        let first = low.saturating_sub(1).min(DEFAULT_ENTRIES - KEPT);
        let mut row = vec![DEFAULT_ENTRIES, first];
        for index in first..first + KEPT {
            let off = at - f64::from(index);
            let read = (-1.0 - MARGIN..=1.0 + MARGIN).contains(&off);
            let entry = if read { self.entry(column, width, index) } else { [f32::NAN; 4] };
            row.extend(entry.map(f32::to_bits));
        }
        row
    }

    fn entry(&self, column: Column, width: f64, index: u32) -> [f32; 4] {
        let key = (column, width.to_bits(), index);
        let remembered = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(entry) = remembered().get(&key) {
            return *entry;
        }
        let position = f64::from(index) / f64::from(DEFAULT_ENTRIES - 1);
        let none = f64::NAN;
        let entry = match column {
            Column::Normaliser => [normaliser_factor(position, width), none, none, none],
            Column::Ambient => {
                let [all, grazing, through] = ambient_factors(position, width);
                [none, all, grazing, through]
            }
        }
        .map(|factor| factor as f32);
        let mut all = remembered();
        if all.len() >= MOST_REMEMBERED {
            all.clear();
        }
        all.insert(key, entry);
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precompute::scattering_table::bake_lobe;

    #[test]
    fn entries_are_those_of_the_whole_table_and_two_or_three_are_baked() {
        let (width, entries) = (0.2, Entries::default());
        let table = bake_lobe(width, DEFAULT_ENTRIES);
        for step in 0..=1000 {
            let position = f64::from(step) / 1000.0;
            let row = entries.around(Column::Normaliser, width, position);
            let (first, low) = (row[1] as usize, ((position * 127.0) as usize).min(126));
            for index in [low, low + 1] {
                let found = f32::from_bits(row[2 + 4 * (index - first)]);
                assert_eq!(found, table[index][0], "{position}: {index}");
            }
            let read = (0..4).filter(|k| !f32::from_bits(row[2 + 4 * k]).is_nan()).count();
            assert!(read == 2 || read == 3, "{position}: {read}");
        }
        let row = entries.around(Column::Ambient, width, 1.0);
        let last = [15, 16, 17].map(|k| f32::from_bits(row[k]));
        assert_eq!(last, [table[127][1], table[127][2], table[127][3]]);
    }
}
