//! Scenes from files.

use super::*;

fn load(text: &str, sets: &[&str]) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join("yarn.obj"), "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n").unwrap();
    Scene::load(&path, &sets.iter().map(|s| s.to_string()).collect::<Vec<_>>())
}

const GOOD: &str = "[fabric]\nmodel = 'yarn.obj'\nmm_per_unit = 10.0\n";

#[test]
fn loads_with_defaults_and_overrides() {
    let scene =
        load(GOOD, &["yarn.fibers_per_ply=7", "camera.yaw_deg=30", "ambient.radiance=[0,0,0]"]).unwrap();
    assert_eq!(scene.fabrics[0].yarn.fibers_per_ply, 7);
    assert_eq!((scene.file.camera.yaw_deg, scene.file.camera.fov_y_deg), (30.0, 35.0));
    assert_eq!(scene.fabrics[0].strands.pieces.len(), 2);
}

#[test]
fn several_fabrics_and_one_are_both_understood() {
    let two =
        "[[fabric]]\nmodel = 'yarn.obj'\n[[fabric]]\nmodel = 'yarn.obj'\n[fabric.yarn]\nply_count = 2\n";
    let scene = load(two, &[]).unwrap();
    assert_eq!(scene.fabrics.iter().map(|f| f.yarn.ply_count).collect::<Vec<_>>(), [3, 2]);
}

#[test]
fn bad_scenes_are_one_line_that_names_file_and_place() {
    for (text, sets, expected) in [
        ("[fabric\n", &[][..], "line 1"),
        ("[fabric]\nmodel = 'yarn.obj'\n[camera]\nyaw = 3\n", &[], "line 4: unknown field `yaw`"),
        ("[camera]\nyaw_dge = 3\n", &[], "line 2: unknown field `yaw_dge`, expected one of `yaw_deg`"),
        ("[camera]\nyaw_dge = 3\n", &[], "; did you mean `yaw_deg`?"),
        ("[camera]\n\nfov_y_deg = 500\n", &[], "line 3: camera.fov_y_deg = 500: allowed is 1 to 170"),
        ("[fabric.fiber]\ndiffuse = [2, 0, 0]\n", &[], "line 2: fiber.diffuse = [2.0, 0.0, 0.0]"),
        ("[camera]\nyaw_deg = '3'\n", &[], "line 2: invalid type"),
        (
            "[yarn]\npreset = 'silk1'\nply_cuont = 3\n",
            &[],
            "line 3: yarn.ply_cuont: unknown key; did you mean `ply_count`?",
        ),
        (
            "[yarn]\npreset = 'silk_1'\n",
            &[],
            "line 2: yarn.preset = \"silk_1\": no such preset; did you mean `silk1`?",
        ),
        ("[yarn]\nply_count = 'two'\n", &[], "line 2: yarn.ply_count = \"two\": expected a whole number"),
        ("[yarn]\nmigration_min = 1\nmigration_max = 0.5\n", &[], "line 3: yarn.migration_max = 0.5"),
        (
            "[yarn]\nmigration_max = 0.1\n",
            &[],
            "line 2: yarn.migration_max = 0.1: allowed is at least migration_min",
        ),
        (
            "seed = 1\n[yarn]\nfibers_per_ply = 2000\n[fabric]\n[fabric.yarn]\nply_count = 0\n",
            &[],
            "line 6: yarn.ply_count = 0",
        ),
        (
            "[[fabric]]\n[[fabric]]\nyarn = {hair_tapir = 1}\n",
            &[],
            "line 3: yarn.hair_tapir: unknown key; did you mean `hair_taper`?",
        ),
        (
            "[[light]]\n[[light]]\nkind = 'point'\nposition_mm = [0, 0, 9]\nirradiance = [1, 1, 1]\n",
            &[],
            "line 5: light.1.irradiance: a point light has no such key",
        ),
        ("seed = 1\n\n[[light]]\nkind = 'spot'\n", &[], "line 3: light.0.position_mm: expected where the"),
        ("light = [{}, {direction = [0, 0, 0]}]\n", &[], "line 1: light.1.direction = [0.0, 0.0, 0.0]"),
        ("[[light]]\nkind = 'pont'\n", &[], "line 2: unknown variant `pont`"),
        ("[[light]]\ncolour = 'red'\n", &[], "line 2: unknown field `colour`"),
        (
            "[ambient]\nradiance = [0, 0, 0]\nenvironment = 'a.exr'\n",
            &[],
            "line 3: ambient.environment: expected this or ambient.radiance, found both",
        ),
        ("[ambient]\nenvironment_scale = -1\n", &[], "line 2: ambient.environment_scale = -1"),
        ("[display]\ntone = 'filmik'\n", &[], "; did you mean `filmic`?"),
        (GOOD, &["ambient.environment=none.exr"], "none.exr: cannot read"),
        (GOOD, &["ambient.environment=yarn.obj"], "yarn.obj: expected an environment whose name ends in"),
        (GOOD, &["light=[{kind='point'}]"], "light.0.position_mm: expected where the point light is"),
        ("yarn = 3\n", &[], "line 1: invalid type"),
        ("[fabric]\nmodel = 'none.bcc'\n", &[], "none.bcc"),
        ("", &[], "expected a [fabric]"),
        (GOOD, &["camera.fov_y_deg=500"], "camera.fov_y_deg = 500: allowed is 1 to 170"),
        (GOOD, &["yarn.density_beta=-1"], "yarn.density_beta = -1"),
        (GOOD, &["yarn.preset=wool"], "worsted_3ply"),
        (GOOD, &["yarn.ply_cuont=2"], "yarn.ply_cuont: unknown key; did you mean `ply_count`?"),
        (
            GOOD,
            &["fabric.yarn.ply_count=nan"],
            "yarn.ply_count = NaN: expected a whole number, allowed is 1 to 8",
        ),
        (GOOD, &["yarn=3"], "yarn: invalid type: integer `3`"),
        (GOOD, &["camera.yaw_deg=left"], "camera.yaw_deg: invalid type: string \"left\""),
        (GOOD, &["camera.yaw_dge=1"], "did you mean `yaw_deg`?"),
        (GOOD, &["shading.model=simpel"], "did you mean `simple`?"),
        (GOOD, &["light=[{direction=[0,0,0]}]"], "light.0.direction"),
        (GOOD, &["fiber.diffuse=[nan,0,0]"], "fiber.diffuse"),
        (GOOD, &["fabric.mm_per_unit=0"], "mm_per_unit"),
    ] {
        let error = load(text, sets).unwrap_err().to_string();
        let named = ["scene.toml", "none.", "yarn.obj"].iter().any(|name| error.contains(name));
        assert!(named && error.contains(expected) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn an_environment_is_read_beside_the_scene_file_if_it_gives_light() {
    use crate::io::picture::{LinearImage, write_exr};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("[ambient]\nenvironment = 'sky.exr'\n{GOOD}")).unwrap();
    std::fs::write(folder.path().join("yarn.obj"), "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n").unwrap();
    let picture = LinearImage::filled(4, 2, [0.5, 0.25, 0.125, 1.0]);
    write_exr(&folder.path().join("sky.exr"), &picture).unwrap();
    assert_eq!(Scene::load(&path, &[]).unwrap().environment.as_deref(), Some(&picture));
    let off = Scene::load(&path, &["ambient.environment_scale=0".into()]).unwrap();
    assert_eq!(off.environment, None);
    // `null` gives the default back.
    let plain = Scene::load(&path, &["ambient.environment=null".into()]).unwrap();
    assert_eq!((plain.environment, plain.file.ambient.radiance().x), (None, 0.2));
}
