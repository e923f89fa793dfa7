//! Models to draw, and the picture of one.

use std::path::PathBuf;

use texrender::{
    EnvironmentSource, Film, FinishOptions, LoadOptions, Plan, Resources, Scene, Settings, load,
    prepare, render, save,
};

pub(crate) const WIDTH: u32 = 1920;
pub(crate) const HEIGHT: u32 = 1080;
/// Models under `TEXRENDER_ASSETS`: one with a small image, one with large images, one of many small surfaces.
const SHARED: [(&str, &str); 3] = [
    ("BoxTextured", "gltf/BoxTextured/glTF/BoxTextured.gltf"),
    ("Avocado", "gltf/Avocado/glTF/Avocado.gltf"),
    (
        "NormalTangentTest",
        "gltf/NormalTangentTest/glTF/NormalTangentTest.gltf",
    ),
];

/// The showcase, the shared models if the environment says where they are, and the scene files that
/// `TEXRENDER_MODELS` lists as `PATH` does, by the names of their files.
pub(crate) fn models() -> Vec<(String, PathBuf)> {
    let showcase = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/showcase.glb");
    let mut models = vec![("showcase".to_owned(), PathBuf::from(showcase))];
    match std::env::var_os("TEXRENDER_ASSETS").map(PathBuf::from) {
        Some(folder) => {
            models.extend(SHARED.map(|(name, file)| (name.to_owned(), folder.join(file))));
        }
        None => eprintln!("shared models: skipped, TEXRENDER_ASSETS is not set"),
    }
    let more = std::env::var_os("TEXRENDER_MODELS").unwrap_or_default();
    models.extend(std::env::split_paths(&more).filter_map(|path| {
        let name = path.file_stem()?.to_str()?.to_owned();
        Some((name, path))
    }));
    models.retain(|(name, path)| {
        let there = path.is_file();
        if !there {
            eprintln!("{name}: skipped, {} is not there", path.display());
        }
        there
    });
    models
}

/// A picture to make, lit by the file that `TEXRENDER_ENV` names, or else by the studio.
pub(crate) struct Job {
    path: PathBuf,
    settings: Settings,
    folder: tempfile::TempDir,
}

impl Job {
    pub(crate) fn new(path: PathBuf) -> Self {
        let light = std::env::var_os("TEXRENDER_ENV").map(PathBuf::from);
        Self {
            path,
            settings: Settings {
                width: WIDTH,
                height: HEIGHT,
                environment: light.map_or(EnvironmentSource::Studio, EnvironmentSource::File),
                ..Settings::default()
            },
            folder: tempfile::tempdir().expect("a folder for the picture"),
        }
    }

    pub(crate) fn load(&self) -> Scene {
        load(&self.path, &LoadOptions::default()).expect("the model loads")
    }

    pub(crate) fn plan(&self, scene: &Scene) -> Plan {
        Plan::new(scene, &self.settings).expect("the settings are in range")
    }

    pub(crate) fn prepare(scene: &Scene, plan: &Plan) -> Resources {
        prepare(scene, plan).expect("the images decode")
    }

    /// Writes the picture, and says where it is.
    pub(crate) fn finish(&self, film: &Film) -> PathBuf {
        let picture = self.folder.path().join("picture.png");
        save(film, &picture, &FinishOptions::default(), &[]).expect("the picture is written");
        picture
    }

    pub(crate) fn frame(&self) -> Film {
        let scene = self.load();
        let plan = self.plan(&scene);
        let resources = Self::prepare(&scene, &plan);
        let film = render(&scene, &plan, &resources, &|_| {});
        self.finish(&film);
        film
    }

    /// The finished picture, decoded.
    pub(crate) fn picture(&self, film: &Film) -> image::RgbImage {
        image::open(self.finish(film))
            .expect("the picture decodes")
            .into_rgb8()
    }
}
