//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use texrender::{
    Aov, Background, BitDepth, DEFAULT_FOV_Y_DEGREES, EnvironmentSource, FilterChoice,
    FinishOptions, FragmentMerging, LoadOptions, Orbit, OutsidePaths, Settings, Show, SimdLevel,
    ToneMap, View,
};

use crate::unwrap::UnwrapArgs;
use crate::values;

/// Textured pictures of 3D scenes on a machine without a GPU.
#[derive(Parser)]
#[command(
    version,
    about,
    arg_required_else_help = true,
    args_override_self = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a picture.
    Render(Box<RenderArgs>),
    /// Print what a scene holds, and what a picture of it needs and why.
    Inspect(Box<InspectArgs>),
    /// Print the JSON Schema of scene files, for editors.
    Schema(SchemaArgs),
    /// Measure a texture's seam, make it repeat without one, or make more of it that does not repeat.
    Tile(TileArgs),
    /// Give a model texture coordinates: its triangles laid flat into one atlas.
    Unwrap(Box<UnwrapArgs>),
    /// Measure every texture filter: its speed against its error, as data, plots and one HTML page.
    Frontier(FrontierArgs),
    /// Draw the scenes of other renderers' bench and time the frames as they do.
    Bench(BenchArgs),
}

#[derive(Args)]
pub(crate) struct RenderArgs {
    /// Scene file: .toml, .gltf or .glb. What a .toml file says of the picture holds where an option does not.
    pub scene: PathBuf,
    /// Picture to write: .png, .jpg, .webp, .hdr or .exr. Left out: where the scene file says.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Curve from radiance to display; EXR and HDR stay linear. Left out: neutral.
    #[arg(long, value_name = "neutral|aces|none")]
    pub tonemap: Option<ToneMap>,
    /// Stops by which the picture is brightened. Left out: 0.
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = values::finite)]
    pub exposure: Option<f32>,
    /// Bits a channel of PNG files.
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = values::bit_depth)]
    pub bit_depth: BitDepth,
    /// Also write depth, normal, st, mip or id; to OUTPUT itself if that is an EXR file.
    #[arg(long, value_name = "NAME=FILE", value_parser = values::aov)]
    pub aov: Vec<(Aov, PathBuf)>,
    /// Write times, memory and counts as JSON; '-' for standard output.
    #[arg(long, value_name = "FILE|-")]
    pub stats: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct InspectArgs {
    /// Scene file: .toml, .gltf or .glb.
    pub scene: PathBuf,
    #[command(flatten)]
    pub picture: PictureArgs,
}

#[derive(Args)]
pub(crate) struct SchemaArgs {
    /// Print every table and key in Markdown instead.
    #[arg(long)]
    pub markdown: bool,
}

#[derive(Args)]
pub(crate) struct TileArgs {
    /// Picture to start from: .png, .jpg or .webp.
    pub picture: PathBuf,
    /// Picture to write: .png. The same texture without a seam, unless --repeat or --expand ask for more.
    #[arg(short, long, value_name = "FILE", required_unless_present = "seam")]
    pub output: Option<PathBuf>,
    /// Print how large the step across the wrap is, against steps inside: 1 is no seam.
    #[arg(long)]
    pub seam: bool,
    /// Texels from each border that are blended, at most half a side; a quarter if left out.
    #[arg(long, value_name = "N", requires = "output")]
    pub overlap: Option<u32>,
    /// Write so many copies side by side.
    #[arg(long, value_name = "WxH", requires = "output", value_parser = values::size, conflicts_with = "expand")]
    pub repeat: Option<(u32, u32)>,
    /// Write a texture of so many times the size that does not repeat.
    #[arg(long, value_name = "WxH", requires = "output", value_parser = values::size)]
    pub expand: Option<(u32, u32)>,
    /// Another seed makes another texture.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "expand")]
    pub seed: u64,
}

#[derive(Args)]
pub(crate) struct FrontierArgs {
    /// Folder to write frontier.csv, plots, crops and index.html to; made if it is not there.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// A minute or two instead of several: all scenes but fill_min4, at most two computed textures each, a ninth of
    /// the pixels (plane and fills against the box: all), a quarter of the samples, fewer frames.
    #[arg(long)]
    pub quick: bool,
    /// Scene to measure: plane, grazing, floor, floor_rotated, fill_mag, fill_min4, fill_min3, or all.
    #[arg(long, value_name = "all|NAME", default_value = "all")]
    pub scene: String,
    /// A texture beside the computed ones: a picture, or NAME.rgba with 1024x1024 texels of 4 bytes. Its codes are
    /// taken as linear.
    #[arg(long, value_name = "FILE")]
    pub texture: Option<PathBuf>,
    /// What other renderers were measured at, to be laid beside: CSV with the columns peer, scene, filter, texture,
    /// threads, ms_median and rmse.
    #[arg(long, value_name = "FILE")]
    pub peers: Option<PathBuf>,
    /// Threads that frames are drawn on; all cores if left out.
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub threads: Option<usize>,
}

#[derive(Args)]
pub(crate) struct BenchArgs {
    /// Scene to draw: plane, spheres, heightfield, overdraw_b2f, overdraw_f2b, fill_mag, fill_min4, fill_min3,
    /// normalmapped, or all with the filters and textures that the others are measured with.
    #[arg(long, value_name = "all|NAME", default_value = "all")]
    pub scene: String,
    /// This filter alone: nearest, bilinear, bilinear_mip, trilinear, aniso2, aniso4, aniso8 or aniso16.
    #[arg(long, value_name = "NAME")]
    pub filter: Option<String>,
    /// This texture alone: checker, zone or natural.
    #[arg(long, value_name = "NAME")]
    pub texture: Option<String>,
    /// Folder with natural.rgba, normal.rgba and spec.rgba: 1024x1024 texels of 4 bytes each.
    #[arg(long, value_name = "DIR")]
    pub textures: Option<PathBuf>,
    /// Frames to time; the median counts.
    #[arg(long, value_name = "N", default_value = "21", value_parser = values::frames)]
    pub frames: usize,
    /// Threads that frames are drawn on; all cores if left out.
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub threads: Option<usize>,
    /// Print a table with the columns peer, scene, filter, texture, threads, ms_median, mpix_per_s, rmse and maxerr.
    #[arg(long)]
    pub csv: bool,
    /// Folder to write each picture to, as raw RGBA8.
    #[arg(long, value_name = "DIR")]
    pub dump: Option<PathBuf>,
    /// Instruction set, at most the best that the machine has. The pictures are the same on all.
    #[arg(long, value_name = "best|avx2|sse4.2|sse2", default_value = "best", value_parser = values::simd)]
    pub simd: fearless_simd::Level,
}

/// What decides which picture it is.
#[derive(Args)]
pub(crate) struct PictureArgs {
    /// Size of the picture in pixels. Left out: 1280x720.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub size: Option<(u32, u32)>,
    /// Camera of the scene, by name or index. Without any view option: the first one, or else a view that fits
    /// everything.
    #[arg(long, value_name = "NAME|INDEX", conflicts_with_all = ["eye", "fov", "azimuth", "elevation", "distance"])]
    pub camera: Option<String>,
    /// Where the eye is.
    #[arg(long, value_name = "X,Y,Z", requires = "target", allow_hyphen_values = true, value_parser = values::point,
          conflicts_with_all = ["azimuth", "elevation", "distance"])]
    pub eye: Option<glam::DVec3>,
    /// What the eye looks at.
    #[arg(long, value_name = "X,Y,Z", requires = "eye", allow_hyphen_values = true, value_parser = values::point)]
    pub target: Option<glam::DVec3>,
    /// Vertical field of view.
    #[arg(long, value_name = "DEGREES")]
    pub fov: Option<f64>,
    /// Angle around the scene, from the front (+Z) toward the right (+X). Left out: 0 for a panel that faces the
    /// front, 30 otherwise.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub azimuth: Option<f64>,
    /// Angle above the horizon. Left out: 0 for a panel that faces the front, 50 for one that lies flat, 20 otherwise.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub elevation: Option<f64>,
    /// Distance from the centre; as near as shows everything if left out.
    #[arg(long, value_name = "LENGTH")]
    pub distance: Option<f64>,
    /// Light from afar: a latitude-longitude .hdr or .exr file, or none. Left out: studio.
    #[arg(long, value_name = "FILE|studio|none", value_parser = values::environment)]
    pub env: Option<EnvironmentSource>,
    /// Turn of the environment about the vertical. Left out: 0.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub env_rotation: Option<f32>,
    /// What is behind the scene: #rrggbb, transparent, or the environment. Left out: #333333.
    #[arg(long, value_name = "COLOR|transparent|env")]
    pub background: Option<Background>,
    /// How textures are filtered. Left out: aniso:16.
    #[arg(
        long,
        value_name = "nearest|bilinear|trilinear|aniso[:N]|ewa[:fast|:best]|auto:RMSE|file"
    )]
    pub filter: Option<FilterChoice>,
    /// Coverage samples a pixel: 1, 2, 4, 8, 16, 32 or 64. Left out: 4.
    #[arg(long, value_name = "N")]
    pub samples: Option<u32>,
    /// Shade triangles of one smooth surface that a pixel sees once, as one of the neighbours, or each for itself: slower
    /// on fine meshes.
    #[arg(long, value_name = "neighbours|never", default_value = "neighbours", value_parser = values::merging)]
    pub merge: FragmentMerging,
    /// Show texture coordinates instead of materials: a checkerboard, how they stretch the surface, texels a unit, the
    /// mip level that they read, or themselves.
    #[arg(long, value_name = "checker|distortion|texel-density|mip|uv", value_parser = values::show)]
    pub show: Option<Show>,
    /// Seconds into an animation; the rest pose if left out.
    #[arg(long, value_name = "SECONDS", value_parser = values::seconds)]
    pub time: Option<f64>,
    /// Animation that --time refers to, by name or index; the first if left out.
    #[arg(long, value_name = "NAME|INDEX", requires = "time")]
    pub animation: Option<String>,
    /// Threads; all cores if left out.
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub threads: Option<usize>,
    /// Instructions that packets are made of; the picture is the same with all.
    #[arg(long, value_name = "best|avx2|sse4.2|sse2", default_value = "best", value_parser = values::simd)]
    pub simd: SimdLevel,
    /// Memory that the scene, its textures and the picture may take.
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = values::memory)]
    pub max_memory: u64,
    /// Let the scene refer to files outside its folder.
    #[arg(long)]
    pub allow_outside: bool,
}

impl PictureArgs {
    pub(crate) fn load_options(&self) -> LoadOptions {
        LoadOptions {
            time: self.time,
            animation: self.animation.clone(),
            outside: if self.allow_outside {
                OutsidePaths::Allowed
            } else {
                OutsidePaths::Refused
            },
            max_memory: self.max_memory,
        }
    }

    /// What the scene file asks for, with what the options change of it.
    pub(crate) fn settings(&self, file: &Settings, aovs: Vec<Aov>) -> Settings {
        let (width, height) = self.size.unwrap_or((file.width, file.height));
        let environment = self.env.clone();
        Settings {
            width,
            height,
            view: self.view(file),
            environment: environment.unwrap_or_else(|| file.environment.clone()),
            environment_rotation: self.env_rotation.unwrap_or(file.environment_rotation),
            background: self.background.unwrap_or(file.background),
            filter: self.filter.unwrap_or(file.filter),
            samples: self.samples.unwrap_or(file.samples),
            show: self.show.or(file.show),
            aovs,
            max_memory: self.max_memory,
            simd: self.simd,
            tile_order: file.tile_order,
            fragments: self.merge,
        }
    }

    fn view(&self, file: &Settings) -> View {
        let fov_y_degrees = self.fov.unwrap_or(DEFAULT_FOV_Y_DEGREES);
        if let Some(camera) = &self.camera {
            return View::Camera(camera.clone());
        }
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            return View::LookAt {
                eye,
                target,
                fov_y_degrees,
            };
        }
        let asked = [self.azimuth, self.elevation, self.distance, self.fov];
        if asked.iter().all(Option::is_none) {
            return file.view.clone();
        }
        View::Orbit(Orbit {
            azimuth_degrees: self.azimuth,
            elevation_degrees: self.elevation,
            distance: self.distance,
            fov_y_degrees,
        })
    }
}

impl RenderArgs {
    /// What the scene file asks for, with what the options change of it.
    pub(crate) fn finish_options(&self, file: &FinishOptions) -> FinishOptions {
        FinishOptions {
            tonemap: self.tonemap.unwrap_or(file.tonemap),
            exposure: self.exposure.unwrap_or(file.exposure),
            bit_depth: self.bit_depth,
        }
    }
}
