//! Scene files in other folders: paths in them are relative to where they lie.

use super::edit::{get, set, table_of};
use std::path::{Path, PathBuf};
use toml::Value;
use toml_edit::DocumentMut;

/// Makes the paths in a scene file that lay in the folder `from` good for one in `to`: relative ones where there are
/// such, absolute ones otherwise. Absolute paths stay.
///
/// # Errors
/// One line, about a folder that cannot be had or a path that is no UTF-8.
pub fn move_paths(typed: &mut DocumentMut, from: &Path, to: &Path) -> Result<(), String> {
    let [from, to] = [whole(from)?, whole(to)?];
    if from == to {
        return Ok(());
    }
    for key in keys_of_paths(typed)? {
        let Some(old) = get(typed, &key).and_then(|item| item.as_str()) else { continue };
        if old.is_empty() || Path::new(old).is_absolute() {
            continue;
        }
        let place = from.join(old);
        let new = pathdiff::diff_paths(&place, &to).unwrap_or(place);
        let new =
            new.to_str().ok_or_else(|| format!("{key}: expected a UTF-8 path, found {}", new.display()))?;
        set(typed, &key, &Value::String(new.to_owned()))?;
    }
    Ok(())
}

fn whole(folder: &Path) -> Result<PathBuf, String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder.canonicalize().map_err(|e| format!("{}: cannot find the folder: {e}", folder.display()))
}

/// Every key of the scene file that may hold a path.
fn keys_of_paths(typed: &DocumentMut) -> Result<Vec<String>, String> {
    let fabrics = match table_of(typed)?.get("fabric") {
        Some(Value::Array(fabrics)) => fabrics.len(),
        other => usize::from(other.is_some()),
    };
    let of_fabrics = (0..fabrics).flat_map(|i| ["model", "motion"].map(|key| format!("fabric.{i}.{key}")));
    Ok(of_fabrics.chain(["ambient.environment".to_owned()]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_to_the_same_files_from_another_folder() {
        let home = tempfile::tempdir().unwrap();
        let [from, to] = ["scenes/old", "new"].map(|folder| home.path().join(folder));
        for folder in [&from, &to] {
            std::fs::create_dir_all(folder).unwrap();
        }
        let mut typed: DocumentMut =
            "[ambient]\nenvironment = '../sky.exr' # sky\n[[fabric]]\nmodel = 'a.bcc'\n\
                                      motion = 'a.%04d.bcc'\n[[fabric]]\nmodel = '/else/b.bcc'\n"
                .parse()
                .unwrap();
        let before = typed.to_string();
        move_paths(&mut typed, &from, &from).unwrap();
        assert_eq!(typed.to_string(), before);
        move_paths(&mut typed, &from, &to).unwrap();
        let text = typed.to_string();
        for line in [
            "environment = \"../scenes/old/../sky.exr\" # sky",
            "model = \"../scenes/old/a.bcc\"",
            "motion = \"../scenes/old/a.%04d.bcc\"",
            "model = '/else/b.bcc'",
        ] {
            assert!(text.contains(line), "{text}");
        }
        let error = move_paths(&mut typed, &from, &home.path().join("none")).unwrap_err();
        assert!(error.contains("none") && !error.contains('\n'), "{error}");
    }
}
