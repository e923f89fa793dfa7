//! `texrender render`

use std::path::{Path, PathBuf};

use texrender::finish::{check_folder, check_holds};
use texrender::{
    Aov, Document, Error, Film, Plan, Scene, load_document, prepare, render, save, save_aovs,
};

use crate::args::RenderArgs;
use crate::progress::Progress;
use crate::stats::{Stats, Stopwatch, peak_memory_bytes};
use crate::with_threads;

pub(crate) fn run(args: &RenderArgs) -> Result<(), Error> {
    let stats = with_threads(args.picture.threads.unwrap_or(0), || draw(args))?;
    match &args.stats {
        None => Ok(()),
        Some(path) => write_stats(path, &stats),
    }
}

/// Files to write, and which AOVs go into each.
struct Outputs {
    picture: PathBuf,
    /// AOVs stored in the picture's own file.
    layers: Vec<Aov>,
    /// Other files.
    files: Vec<(PathBuf, Vec<Aov>)>,
}

impl Outputs {
    fn new(args: &RenderArgs, document: &Document) -> Result<Self, Error> {
        let picture = args.output.clone().or_else(|| document.output.clone());
        let Some(picture) = picture else {
            return Err(Error::Setting {
                setting: "--output",
                detail: "say where the picture is written: -o FILE".to_owned(),
            });
        };
        let mut outputs = Self {
            picture,
            layers: Vec::new(),
            files: Vec::new(),
        };
        for (aov, path) in &args.aov {
            let list = if *path == outputs.picture {
                &mut outputs.layers
            } else {
                match outputs.files.iter().position(|(p, _)| p == path) {
                    Some(at) => &mut outputs.files[at].1,
                    None => {
                        outputs.files.push((path.clone(), Vec::new()));
                        // Just pushed.
                        &mut outputs.files.last_mut().expect("not empty").1
                    }
                }
            };
            if !list.contains(aov) {
                list.push(*aov);
            }
        }
        check_folder(&outputs.picture)?;
        let background = document.settings.background;
        check_holds(
            &outputs.picture,
            args.picture.background.unwrap_or(background),
            args.bit_depth,
            &outputs.layers,
        )?;
        for (path, aovs) in &outputs.files {
            check_folder(path)?;
            // A picture holds one AOV, as if it were its colour.
            let beside = if aovs.len() > 1 { aovs.as_slice() } else { &[] };
            check_holds(
                path,
                texrender::Background::default(),
                args.bit_depth,
                beside,
            )?;
        }
        if let Some(stats) = args.stats.as_deref().filter(|p| *p != Path::new("-")) {
            check_folder(stats)?;
        }
        Ok(outputs)
    }

    fn aovs(&self) -> Vec<Aov> {
        let mut all: Vec<Aov> = self
            .files
            .iter()
            .flat_map(|(_, aovs)| aovs)
            .chain(&self.layers)
            .copied()
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

fn draw(args: &RenderArgs) -> Result<Stats, Error> {
    let progress = Progress::new();
    let mut watch = Stopwatch::start();
    progress.stage("loading");
    let document = load_document(&args.scene, &args.picture.load_options())?;
    let load = watch.lap();

    // What can be refused at once is refused before more work.
    let outputs = Outputs::new(args, &document)?;
    let settings = args.picture.settings(&document.settings, outputs.aovs());
    settings.validate()?;
    let finish = args.finish_options(&document.finish);
    let scene = document.scene;
    let mut stats = Stats {
        width: settings.width,
        height: settings.height,
        samples: settings.samples,
        threads: rayon::current_num_threads(),
        ..Stats::default()
    };
    stats.milliseconds.load = load;

    progress.stage("planning");
    let plan = Plan::new(&scene, &settings)?;
    stats.milliseconds.plan = watch.lap();

    progress.stage("preparing");
    let resources = prepare(&scene, &plan)?;
    stats.milliseconds.prepare = watch.lap();

    progress.stage("rendering");
    let film = render(&scene, &plan, &resources, &|share| progress.share(share));
    stats.milliseconds.render = watch.lap();

    progress.stage("writing");
    save(&film, &outputs.picture, &finish, &outputs.layers)?;
    for (path, aovs) in &outputs.files {
        save_aovs(&film, aovs, path)?;
    }
    stats.milliseconds.finish = watch.lap();
    progress.finish();

    stats.warnings = report(&scene, &plan, &film);
    stats.milliseconds.total = watch.total();
    stats.peak_memory_bytes = peak_memory_bytes();
    stats.images_listed = scene.images.len();
    stats.prepare = resources.counts;
    stats.render = film.counts;
    stats.instances_culled = plan.culled_instances;
    Ok(stats)
}

/// Says what could not be honoured, and returns it.
fn report(scene: &Scene, plan: &Plan, film: &Film) -> Vec<String> {
    let mut warnings: Vec<String> = scene
        .warnings
        .iter()
        .chain(&plan.warnings)
        .cloned()
        .collect();
    if !film.shows_anything() {
        warnings.push("nothing is visible: the picture shows its background only".to_owned());
    }
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    warnings
}

fn write_stats(path: &Path, stats: &Stats) -> Result<(), Error> {
    let error = |detail: String| Error::Write {
        path: path.to_owned(),
        detail,
    };
    let json = serde_json::to_string_pretty(stats).map_err(|e| error(e.to_string()))?;
    if path == Path::new("-") {
        println!("{json}");
        Ok(())
    } else {
        std::fs::write(path, json + "\n").map_err(|e| error(e.to_string()))
    }
}
