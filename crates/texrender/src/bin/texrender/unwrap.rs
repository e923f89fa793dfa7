//! `texrender unwrap`

use std::path::PathBuf;

use clap::Args;
use texrender::finish::{check_folder, check_holds, check_holds_texture};
use texrender::texcoord::charts::{
    AtlasSize, Density, Effort, FlattenOptions, PackOptions, Progress as Charts, UnwrapOptions,
    Weld,
};
use texrender::unwrap::{
    CoordinateSet, Method, Report, UnwrapFile, Unwrapping, check_holds_gltf, unwrap_file,
};
use texrender::{
    Background, BitDepth, Error, FinishOptions, OutsidePaths, Plan, Settings, Show, prepare,
    render, save,
};

use crate::progress::Progress;
use crate::{values, with_threads};

#[derive(Args)]
pub(crate) struct UnwrapArgs {
    /// Model to unwrap: .gltf or .glb. All triangles of all its meshes share one atlas.
    pub model: PathBuf,
    /// File to write: .glb, or .gltf with a .bin file beside it. It may be the model itself.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Texels along a side of the atlas, up to 16384. Left out: a power of two that padding takes little of.
    #[arg(long, value_name = "N")]
    pub size: Option<u32>,
    /// Free texels between charts.
    #[arg(long, value_name = "TEXELS", default_value_t = PackOptions::default().padding)]
    pub padding: u32,
    /// Mip level down to which charts stay apart under bilinear filtering: at least 2·2^N free texels.
    #[arg(long, value_name = "N", default_value_t = PackOptions::default().levels)]
    pub levels: u32,
    /// Texels a unit of the scene, instead of as many as fit; more than one image has room for is an error.
    #[arg(
        long,
        value_name = "TEXELS",
        allow_negative_numbers = true,
        conflicts_with = "utilisation"
    )]
    pub density: Option<f64>,
    /// Charts near to isometric, or every two triangles in a square cell of their own.
    #[arg(long, value_name = "isometric|pairs", default_value = "isometric", value_parser = method)]
    pub method: Method,
    /// Largest L² stretch of a chart, above 1; less makes more charts. Left out: 1.02.
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub max_stretch: Option<f64>,
    /// Share of the atlas that charts should cover, 0 to 1; where they do not, more seams are cut. Left out: 0.66.
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub utilisation: Option<f64>,
    /// How much time goes into packing. Left out: thorough.
    #[arg(long, value_name = "quick|thorough", value_parser = effort)]
    pub effort: Option<Effort>,
    /// Which vertices of a mesh are one point: those at one position, or only those of one index.
    #[arg(long, value_name = "position|index", default_value = "position", value_parser = weld)]
    pub weld: Weld,
    /// TEXCOORD_N to write, replaced where it exists. Left out: the first that a primitive does not have.
    #[arg(long, value_name = "N")]
    pub set: Option<u32>,
    /// Write figures as JSON.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Write a picture of the atlas: .png.
    #[arg(long, value_name = "FILE")]
    pub atlas: Option<PathBuf>,
    /// Write a picture of the model with a checkerboard by the new coordinates: .png, .jpg, .webp, .hdr or .exr.
    #[arg(long, value_name = "FILE")]
    pub checker: Option<PathBuf>,
    /// Threads; all cores if left out. The result is the same with any number.
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub threads: Option<usize>,
    /// Memory that the model, and the work on it, may take.
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = values::memory)]
    pub max_memory: u64,
    /// Let the model refer to files outside its folder.
    #[arg(long)]
    pub allow_outside: bool,
}

fn method(text: &str) -> Result<Method, String> {
    match text {
        "isometric" => Ok(Method::Isometric),
        "pairs" => Ok(Method::Pairs),
        _ => Err("choose isometric or pairs".to_owned()),
    }
}

fn effort(text: &str) -> Result<Effort, String> {
    match text {
        "quick" => Ok(Effort::Quick),
        "thorough" => Ok(Effort::Thorough),
        _ => Err("choose quick or thorough".to_owned()),
    }
}

fn weld(text: &str) -> Result<Weld, String> {
    match text {
        "position" => Ok(Weld::ByPosition),
        "index" => Ok(Weld::ByIndex),
        _ => Err("choose position or index".to_owned()),
    }
}

impl UnwrapArgs {
    fn options(&self) -> UnwrapFile {
        let usual = UnwrapOptions::default();
        UnwrapFile {
            method: self.method,
            charts: UnwrapOptions {
                weld: self.weld,
                flatten: FlattenOptions {
                    max_stretch: self.max_stretch.unwrap_or(usual.flatten.max_stretch),
                },
                pack: PackOptions {
                    size: self.size.map_or(AtlasSize::Automatic, AtlasSize::Texels),
                    density: self.density.map_or(Density::Fit, Density::TexelsPerUnit),
                    padding: self.padding,
                    levels: self.levels,
                    effort: self.effort.unwrap_or(usual.pack.effort),
                },
                min_utilisation: self.utilisation.unwrap_or(usual.min_utilisation),
            },
            set: self
                .set
                .map_or(CoordinateSet::FirstFree, CoordinateSet::Index),
            outside: if self.allow_outside {
                OutsidePaths::Allowed
            } else {
                OutsidePaths::Refused
            },
            max_memory: self.max_memory,
        }
    }

    /// Refuses options that pairs would ignore.
    fn check_method(&self) -> Result<(), Error> {
        let of_charts = [
            ("--max-stretch", self.max_stretch.is_some()),
            ("--utilisation", self.utilisation.is_some()),
            ("--effort", self.effort.is_some()),
            ("--density", self.density.is_some()),
        ];
        match of_charts.iter().find(|(_, given)| *given) {
            Some(&(setting, _)) if self.method == Method::Pairs => Err(Error::Setting {
                setting,
                detail: "it is about charts, and --method pairs makes none; drop one of the two"
                    .to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// Refuses at once what cannot be written in the end.
    fn check_outputs(&self) -> Result<(), Error> {
        check_holds_gltf(&self.output)?;
        if let Some(report) = &self.report {
            check_folder(report)?;
        }
        if let Some(atlas) = &self.atlas {
            check_holds_texture(atlas)?;
        }
        if let Some(checker) = &self.checker {
            check_folder(checker)?;
            check_holds(checker, Background::default(), BitDepth::Eight, &[])?;
        }
        Ok(())
    }
}

pub(crate) fn run(args: &UnwrapArgs) -> Result<(), Error> {
    args.check_method()?;
    args.check_outputs()?;
    let report = with_threads(args.threads.unwrap_or(0), || unwrap(args))?;
    for warning in &report.warnings {
        eprintln!("warning: {warning}");
    }
    print_summary(args, &report);
    Ok(())
}

fn unwrap(args: &UnwrapArgs) -> Result<Report, Error> {
    let progress = Progress::new();
    progress.stage("reading");
    let unwrapping = unwrap_file(&args.model, &args.options(), &|at| match at {
        Charts::Segmenting => progress.stage("dividing"),
        Charts::Flattened { faces, of } => {
            progress.stage("flattening");
            progress.share(faces as f32 / of.max(1) as f32);
        }
        Charts::Packing { charts } => progress.stage(format!("packing {charts} charts")),
        _ => {}
    })?;
    progress.stage("writing");
    unwrapping.save(&args.output)?;
    if let Some(atlas) = &args.atlas {
        unwrapping.save_atlas(atlas)?;
    }
    if let Some(report) = &args.report {
        unwrapping.report.save(report)?;
    }
    if let Some(checker) = &args.checker {
        progress.stage("rendering");
        draw(&unwrapping, args, checker, &progress)?;
    }
    progress.finish();
    Ok(unwrapping.report)
}

/// The checkered model.
fn draw(
    unwrapping: &Unwrapping,
    args: &UnwrapArgs,
    path: &std::path::Path,
    progress: &Progress,
) -> Result<(), Error> {
    let scene = unwrapping.checker_scene()?;
    let settings = Settings {
        show: Some(Show::Checker),
        max_memory: args.max_memory,
        ..Settings::default()
    };
    let plan = Plan::new(&scene, &settings)?;
    let resources = prepare(&scene, &plan)?;
    let film = render(&scene, &plan, &resources, &|share| progress.share(share));
    save(&film, path, &FinishOptions::default(), &[])
}

fn print_summary(args: &UnwrapArgs, report: &Report) {
    println!(
        "{}: {} triangles in {} charts on {} x {} texels, {:.1} % used, {:.2} s",
        args.output.display(),
        report.triangles,
        report.charts,
        report.size,
        report.size,
        100.0 * report.utilisation,
        report.seconds
    );
    println!(
        "stretch L2 {:.4}, Linf {:.3}; angles {:.4}, areas {:.4}; seams {:.1} times the root of the area",
        report.l2_stretch,
        report.linf_stretch,
        report.conformal,
        report.area,
        report.relative_seam_length
    );
    let sets: Vec<String> = report
        .sets
        .iter()
        .map(|set| format!("TEXCOORD_{set}"))
        .collect();
    println!(
        "{} flips, {} mirrored, {} overlaps; {} vertices became {}; written as {}",
        report.flips,
        report.mirrored,
        report.overlaps,
        report.vertices_in,
        report.vertices_out,
        sets.join(" and ")
    );
    if report.faulty_faces > 0 {
        println!(
            "{} triangles are in no chart: without area, repeated, or with a corner that is not finite",
            report.faulty_faces
        );
    }
}
