//! Spoils files as fuzzers do, from a seed.

use worsted::math::rng::Rng;

/// Longest that a file grows, in bytes.
const LONGEST: usize = 1 << 16;
/// Words that readers trip over.
const WORDS: [u64; 12] = [
    0,
    1,
    3,
    0x7f,
    0xff,
    0x7fff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    1_000_000_000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];
/// Texts that readers of text trip over.
const TEXTS: [&str; 22] = [
    "nan",
    "-inf",
    "1e999",
    "-0",
    "1e-400",
    "9223372036854775808",
    "-1",
    "0",
    "0.5",
    "1000000000",
    "\u{0}",
    "\n",
    "\"",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\\",
    "null",
    "\u{e9}\u{1f9f6}",
    ",",
];

/// One file spoiled in up to eight ways; the other files of its kind lend parts.
pub fn spoiled(files: &[Vec<u8>], seed: u64, round: u64) -> Vec<u8> {
    let mut rng = Rng::new(seed, &[round]);
    let mut file = files[below(&mut rng, files.len())].clone();
    for _ in 0..=below(&mut rng, 8) {
        spoil(&mut file, files, &mut rng);
        file.truncate(LONGEST);
    }
    file
}

fn below(rng: &mut Rng, count: usize) -> usize {
    (rng.next_u64() % count.max(1) as u64) as usize
}

fn spoil(file: &mut Vec<u8>, files: &[Vec<u8>], rng: &mut Rng) {
    let at = below(rng, file.len() + 1);
    let length = 1 + below(rng, 16);
    let end = (at + length).min(file.len());
    match below(rng, 9) {
        0 if at < file.len() => file[at] ^= 1 << below(rng, 8),
        1 if at < file.len() => file[at] = rng.next_u64() as u8,
        2 => drop(file.drain(at..end)),
        3 => {
            let part = file[at..end].to_vec();
            file.splice(at..at, part);
        }
        4 => file.truncate(at),
        5 => {
            let word = WORDS[below(rng, WORDS.len())].to_le_bytes();
            let size = [1, 2, 4, 8][below(rng, 4)];
            let end = (at + size).min(file.len());
            file.splice(at..end, word[..size].iter().copied());
        }
        6 => {
            // A number of a text, or whatever is there, becomes another.
            let start = file[..at].iter().rposition(|b| !number(*b)).map_or(0, |i| i + 1);
            let end = at + file[at..].iter().position(|b| !number(*b)).unwrap_or(file.len() - at);
            let text = TEXTS[below(rng, TEXTS.len())];
            file.splice(start..end, text.bytes());
        }
        7 => {
            let other = &files[below(rng, files.len())];
            let from = below(rng, other.len());
            let to = (from + 1 + below(rng, 64)).min(other.len());
            file.splice(at..at, other[from..to].iter().copied());
        }
        _ => file.splice(at..at, TEXTS[below(rng, TEXTS.len())].bytes()).for_each(drop),
    }
}

fn number(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e')
}

#[test]
fn the_same_seed_spoils_the_same_way_and_most_files_are_spoiled() {
    let files = [b"v 1 2 3\nl 1 2\n".to_vec(), vec![7; 40]];
    let all = |seed| (0..500).map(|round| spoiled(&files, seed, round)).collect::<Vec<_>>();
    assert_eq!(all(1), all(1));
    assert_ne!(all(1), all(2));
    assert!(all(1).iter().filter(|file| files.contains(file)).count() < 25);
}
