//! Numbered files: `cloth.%04d.bcc` names one for every number.

use std::path::{Path, PathBuf};

/// Most digits that a number may be padded to.
const MOST_DIGITS: usize = 18;

/// A path with one number in its file's name, as printf writes it: `%d`, or `%04d` for four digits at least.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedPath {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl NumberedPath {
    /// Whether a path's file name has a number in it, or what may have been meant as one.
    pub fn is_meant(path: &Path) -> bool {
        path.file_name().is_some_and(|name| name.to_string_lossy().contains('%'))
    }

    /// Reads the pattern.
    ///
    /// # Errors
    /// One line that says what was expected: a file name with one `%d` or `%04d`.
    pub fn new(path: &Path) -> Result<Self, String> {
        let wrong = || format!("expected a file name with one %d or %04d in it, found {}", path.display());
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(wrong)?;
        let (before, rest) = name.split_once('%').ok_or_else(wrong)?;
        let (digits, after) = rest.split_once('d').ok_or_else(wrong)?;
        let digits = match digits {
            "" => 1,
            _ => digits.strip_prefix('0').and_then(|n| n.parse().ok()).ok_or_else(wrong)?,
        };
        if after.contains('%') || !(1..=MOST_DIGITS).contains(&digits) {
            return Err(wrong());
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Self { folder, before: before.to_owned(), digits, after: after.to_owned() })
    }

    /// The file of one number.
    pub fn file(&self, number: u64) -> PathBuf {
        self.named(&format!("{number:0digits$}", digits = self.digits))
    }

    /// The file with `text` in the number's place.
    pub fn named(&self, text: &str) -> PathBuf {
        self.folder.join(format!("{}{text}{}", self.before, self.after))
    }

    /// The folder that the files are in; empty for the working folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The file name as printf reads it.
    pub fn pattern(&self) -> String {
        format!("{}%0{}d{}", self.before, self.digits, self.after)
    }

    /// The numbers of the files that are there: how many, the least and the largest.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn found(&self) -> std::io::Result<Option<(u64, u64, u64)>> {
        let here = Path::new(".");
        let folder = if self.folder.as_os_str().is_empty() { here } else { &self.folder };
        let mut found: Option<(u64, u64, u64)> = None;
        for entry in std::fs::read_dir(folder)? {
            let name = entry?.file_name();
            let Some(number) = name.to_str().and_then(|name| self.number(name)) else { continue };
            let (count, least, most) = found.unwrap_or((0, number, number));
            found = Some((count + 1, least.min(number), most.max(number)));
        }
        Ok(found)
    }

    /// The number in a file name of this pattern.
    fn number(&self, name: &str) -> Option<u64> {
        let digits = name.strip_prefix(self.before.as_str())?.strip_suffix(self.after.as_str())?;
        let number = digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse::<u64>().ok())??;
        // Of two ways to write one number only the pattern's own counts.
        (format!("{number:0width$}", width = self.digits) == digits).then_some(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(text: &str) -> NumberedPath {
        NumberedPath::new(Path::new(text)).unwrap()
    }

    #[test]
    fn numbers_are_written_and_read_as_printf_does() {
        let padded = pattern("a/cloth.%04d.bcc");
        assert_eq!(padded.file(7), Path::new("a/cloth.0007.bcc"));
        assert_eq!(padded.file(123_456), Path::new("a/cloth.123456.bcc"));
        assert_eq!(padded.pattern(), "cloth.%04d.bcc");
        for (name, number) in [
            ("cloth.0007.bcc", Some(7)),
            ("cloth.123456.bcc", Some(123_456)),
            ("cloth.7.bcc", None),
            ("cloth.00007.bcc", None),
            ("cloth.-007.bcc", None),
            ("cloth.0007.bccx", None),
            ("cloth..bcc", None),
            ("other.0007.bcc", None),
        ] {
            assert_eq!(padded.number(name), number, "{name}");
        }
        assert_eq!(pattern("%d").number("0"), Some(0));
        assert_eq!(pattern("%d").number("00"), None);
        assert_eq!(pattern("%d.png").file(12), Path::new("12.png"));
    }

    #[test]
    fn other_patterns_are_refused() {
        for bad in ["a", "a%", "a%sd", "%d%d", "%4d", "%0d", "%00d", "%019d", "%-3d", "x%04", "a%04d/b", ""] {
            let error = NumberedPath::new(Path::new(bad)).unwrap_err();
            assert!(error.contains("expected") && error.contains("found"), "{bad}: {error}");
        }
        assert!(NumberedPath::is_meant(Path::new("a%x")) && !NumberedPath::is_meant(Path::new("%d/a")));
    }

    #[test]
    fn files_are_found_by_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = NumberedPath::new(&folder.path().join("f%03d.x")).unwrap();
        assert_eq!(path.found().unwrap(), None);
        for number in [12, 3, 1000] {
            std::fs::write(path.file(number), "").unwrap();
        }
        std::fs::write(folder.path().join("f12.x"), "").unwrap();
        assert_eq!(path.found().unwrap(), Some((3, 3, 1000)));
        assert!(NumberedPath::new(&folder.path().join("none/f%d")).unwrap().found().is_err());
    }
}
