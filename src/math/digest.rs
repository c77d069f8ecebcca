//! A number that stands for much data: equal data give equal numbers, on every machine.

use super::rng::mix64;

/// What was fed in so far. It begins as any number but 0, on which words of 0 leave no trace, where such may come
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Digest {
    /// Feeds words.
    pub fn words(&mut self, words: impl IntoIterator<Item = u64>) {
        for word in words {
            self.0 = mix64(self.0.rotate_left(23) ^ mix64(word));
        }
    }

    /// Feeds a text and its length, so that texts in a row do not run into one another.
    pub fn text(&mut self, text: &str) {
        self.words([text.len() as u64]);
        self.words(text.bytes().map(u64::from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_borders_and_every_byte_count() {
        let of = |texts: &[&str]| {
            let mut digest = Digest(1);
            texts.iter().for_each(|text| digest.text(text));
            digest.0
        };
        let all = [of(&[]), of(&[""]), of(&["ab", "c"]), of(&["a", "bc"]), of(&["c", "ab"]), of(&["abc"])];
        for (i, one) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|other| other != one), "{all:x?}");
        }
        assert_eq!(of(&["ab", "c"]), all[2]);
    }
}
