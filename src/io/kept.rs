//! Results kept in the [`Cache`] by what they were worked out from. A file that is missing, broken or of something else
//! counts as not kept, and one that cannot be written is done without: whoever asks works it out again.

use super::cache::Cache;
use super::whole::write_whole;
use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Bytes of a hash in front of what a file holds.
const HASH_BYTES: usize = blake3::OUT_LEN;
/// Bytes that the files of one part of the cache may take together; the longest unused go first.
const MOST_BYTES: u64 = 256 << 20;

/// Everything that decides a result, hashed.
#[derive(Clone, Debug)]
pub struct Key(blake3::Hasher);

impl Key {
    /// Of a kind of result, as these `makers` (their code, a driver) work it out.
    pub fn new(kind: &str, makers: &str) -> Self {
        Self(blake3::Hasher::new()).bytes(kind.as_bytes()).bytes(makers.as_bytes())
    }

    /// The hash in hexadecimal digits.
    pub fn hex(&self) -> String {
        self.0.finalize().to_hex().to_string()
    }

    /// The key with more that decides. Numbers are shown with all their digits.
    #[must_use]
    pub fn shown(self, value: &dyn fmt::Debug) -> Self {
        self.bytes(format!("{value:?}").as_bytes())
    }

    /// The key with more that decides; its length counts, so that bytes in a row do not run into one another.
    #[must_use]
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.update(&(bytes.len() as u64).to_le_bytes()).update(bytes);
        self
    }
}

/// Where results are kept, if anywhere.
#[derive(Clone, Debug, Default)]
pub struct Kept(Option<Cache>);

impl Kept {
    /// Nothing is kept, and nothing found.
    pub const NOTHING: Self = Self(None);

    /// In this cache.
    pub fn within(cache: Cache) -> Self {
        Self(Some(cache))
    }

    /// Whether anything is kept.
    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// What was kept under a key, whole and unchanged.
    pub fn get(&self, part: &str, key: &Key) -> Option<Vec<u8>> {
        let path = self.0.as_ref()?.path(part, &key.hex());
        let mut bytes = std::fs::read(&path).ok()?;
        let start = bytes.len().checked_sub(HASH_BYTES)?;
        let whole = bytes[start..] == seal(key, &bytes[..start]);
        if !whole {
            tracing::debug!("{}: broken, done anew", path.display());
            return None;
        }
        bytes.truncate(start);
        // What is used is not what goes first. Where that cannot be noted, it may.
        drop(File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now())));
        Some(bytes)
    }

    /// Keeps a result.
    pub fn put(&self, part: &str, key: &Key, bytes: &[u8]) {
        let Some(cache) = &self.0 else { return };
        let write = || {
            let path = cache.file(part, &key.hex())?;
            write_whole(&path, |out| {
                out.write_all(bytes)?;
                out.write_all(&seal(key, bytes))
            })?;
            Ok::<_, super::error::FileError>(path)
        };
        match write() {
            Ok(path) => make_room(&path, MOST_BYTES),
            Err(error) => tracing::debug!("not kept: {error}"),
        }
    }
}

/// Of what is kept and of what it is kept under: a file under another's name is not taken for it.
fn seal(key: &Key, bytes: &[u8]) -> [u8; HASH_BYTES] {
    let key = key.0.finalize();
    *blake3::Hasher::new_keyed(key.as_bytes()).update(bytes).finalize().as_bytes()
}

/// Removes the files beside `newest` that were not used for longest, until all take at most `most` bytes.
fn make_room(newest: &Path, most: u64) {
    let Some(entries) = newest.parent().and_then(|folder| std::fs::read_dir(folder).ok()) else { return };
    let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
        .filter_map(|entry| {
            let entry = entry.ok()?;
            let facts = entry.metadata().ok().filter(std::fs::Metadata::is_file)?;
            Some((facts.modified().ok()?, facts.len(), entry.path()))
        })
        .collect();
    files.sort();
    let mut total: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
    for (_, bytes, path) in files.iter().filter(|(.., path)| path != newest) {
        if total <= most {
            break;
        }
        // Another run may have removed it: it is gone either way.
        drop(std::fs::remove_file(path));
        total -= bytes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(home: &tempfile::TempDir) -> Kept {
        Kept::within(Cache::new(Some(home.path())).unwrap())
    }

    #[test]
    fn only_what_was_kept_is_found_and_only_whole() {
        let home = tempfile::tempdir().unwrap();
        let kept = kept(&home);
        let (key, other) = (Key::new("a", "1").shown(&0.1), Key::new("a", "1").shown(&0.2));
        assert_eq!(kept.get("part", &key), None);
        kept.put("part", &key, b"result");
        assert_eq!(kept.get("part", &key).as_deref(), Some(&b"result"[..]));
        assert_eq!((kept.get("part", &other), kept.get("other", &key)), (None, None));
        let [path, other_path] = [&key, &other].map(|key| home.path().join("part").join(key.hex()));
        let whole = std::fs::read(&path).unwrap();
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            assert_eq!(kept.get("part", &key), None, "cut to {cut}");
            let mut flipped = whole.clone();
            flipped[cut] ^= 1;
            std::fs::write(&path, &flipped).unwrap();
            assert_eq!(kept.get("part", &key), None, "byte {cut}");
        }
        // Whole, and of something else.
        std::fs::write(&other_path, &whole).unwrap();
        assert_eq!(kept.get("part", &other), None);
        kept.put("part", &key, b"");
        assert_eq!(kept.get("part", &key), Some(Vec::new()));
    }

    #[test]
    fn everything_that_decides_counts() {
        let keys = [
            Key::new("a", "1"),
            Key::new("b", "1"),
            Key::new("a", "2"),
            Key::new("a1", ""),
            Key::new("a", "1").bytes(b"x").bytes(b"yz"),
            Key::new("a", "1").bytes(b"xy").bytes(b"z"),
            Key::new("a", "1").shown(&f64::MIN_POSITIVE),
            Key::new("a", "1").shown(&f64::MIN_POSITIVE.next_up()),
        ];
        for (i, key) in keys.iter().enumerate() {
            assert!(keys[..i].iter().all(|other| other.hex() != key.hex()), "{i}");
        }
        assert_eq!(Key::new("a", "1").hex(), keys[0].hex());
    }

    #[test]
    fn what_was_not_used_for_longest_makes_room() {
        let home = tempfile::tempdir().unwrap();
        let path = |name: &str| home.path().join(name);
        for (age, name) in [(3, "old"), (4, "older"), (1, "young"), (0, "newest")] {
            std::fs::write(path(name), [0; 100]).unwrap();
            let when = SystemTime::now() - std::time::Duration::from_secs(100 * age);
            File::options().append(true).open(path(name)).unwrap().set_modified(when).unwrap();
        }
        make_room(&path("newest"), 399);
        assert!(!path("older").exists() && path("old").exists());
        make_room(&path("newest"), 0);
        assert!(!path("young").exists() && path("newest").exists());
    }

    #[test]
    fn nothing_is_kept_where_nothing_may_be_and_nobody_minds() {
        let key = Key::new("a", "1");
        Kept::NOTHING.put("part", &key, b"result");
        assert_eq!(Kept::NOTHING.get("part", &key), None);
        // A file where the folder should be.
        let home = tempfile::tempdir().unwrap();
        std::fs::write(home.path().join("part"), b"in the way").unwrap();
        kept(&home).put("part", &key, b"result");
        assert_eq!(kept(&home).get("part", &key), None);
        assert_eq!(std::fs::read(home.path().join("part")).unwrap(), b"in the way");
    }
}
