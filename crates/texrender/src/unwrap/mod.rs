//! Texture coordinates for a glTF file: its triangles laid flat into one atlas, the file written again with them.
//!
//! ```no_run
//! use texrender::unwrap::{UnwrapFile, unwrap_file};
//!
//! let unwrapping = unwrap_file("model.glb", &UnwrapFile::default(), &|_| {})?;
//! unwrapping.save("unwrapped.glb")?;
//! println!("{} charts", unwrapping.report.charts);
//! # Ok::<(), texrender::Error>(())
//! ```
//!
//! All triangles (lists, strips, fans) of all meshes share one image, at one texel density in the scene: each mesh at
//! the largest scale at which a node shows it, in its rest pose. Nodes that show one mesh share its coordinates. Points
//! of different meshes are never welded; those of one mesh are, across its primitives.
//!
//! # Which set
//! A primitive without coordinates gets TEXCOORD_0. Others get the first set that is free, so that their materials read
//! what they did before; [`CoordinateSet::Index`] names a set, and replaces it.
//!
//! # What else changes
//! Vertices are copied along seams, with the bytes of all their attributes and morph targets; vertices that no triangle
//! uses are left out. Strips and fans become lists, sparse accessors dense ones, indices as small as fits. Tangents go
//! where a normal map reads coordinates that were replaced. Compressed copies of the geometry (Draco, meshopt) go.
//! Everything else stays: lines and points, nodes, skins, animations, materials, images, extensions, extras.
//!
//! # Limits
//! One image: a density at which charts take several is refused, for one set of coordinates cannot say which. Shapes are
//! those of the rest pose without morph targets. A file that requires compressed geometry is refused. Extensions keep
//! their buffer views; accessors are renumbered for meshes, skins, animations and instances, and other references to them
//! by number are warned of. Of a .gltf file and its .bin each is replaced in one step, the .bin first.

mod carry;
mod checker;
mod geometry;
mod gltf_file;
mod layout;
mod material;
mod picture;
mod primitive;
mod report;
mod split;
mod storage;

use std::path::Path;

use serde_json::Value;
use texcoord::charts;

use crate::error::Error;
use crate::load::buffers::Buffers;
use crate::load::{File, LoadOptions, OutsidePaths, container, extensions};
use crate::scene::Scene;
use geometry::Geometry;
use layout::Layout;
pub use report::Report;
use split::Split;

/// How a file is unwrapped.
#[derive(Clone, Debug)]
pub struct UnwrapFile {
    /// How triangles are laid flat.
    pub method: Method,
    /// Size, padding and what charts must keep to. [`Method::Pairs`] uses the size and the padding.
    pub charts: charts::UnwrapOptions,
    /// Which set the coordinates become.
    pub set: CoordinateSet,
    /// Whether URIs may leave the file's folder.
    pub outside: OutsidePaths,
    /// Bytes that the file's data, and the work on its triangles, may take in memory.
    pub max_memory: u64,
}

impl Default for UnwrapFile {
    fn default() -> Self {
        Self {
            method: Method::default(),
            charts: charts::UnwrapOptions::default(),
            set: CoordinateSet::default(),
            outside: OutsidePaths::default(),
            max_memory: crate::DEFAULT_MAX_MEMORY,
        }
    }
}

/// How triangles are laid flat.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// In charts as near to isometric as asked for: [`charts::unwrap`].
    #[default]
    Isometric,
    /// Two to a square cell, whatever their shapes: [`charts::triangle_pairs`].
    Pairs,
}

/// Which TEXCOORD the coordinates become.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CoordinateSet {
    /// The first that a primitive does not have.
    #[default]
    FirstFree,
    /// This one, which is replaced where it exists. All sets below it must exist.
    Index(u32),
}

/// A glTF file with coordinates for its triangles.
#[derive(Debug)]
pub struct Unwrapping {
    /// Figures.
    pub report: Report,
    file: File,
    json: Value,
    geometry: Geometry,
    layout: Layout,
    /// Vertices of each part.
    splits: Vec<Split>,
    /// Set of each part.
    sets: Vec<u32>,
}

/// Reads a .gltf or .glb file and unwraps all of its triangles.
///
/// Faces with a corner that is not finite or without area get (0, 0) and are counted in the report.
/// `progress` is told how far the charts are, from the threads that work: rayon's current pool. The result does not
/// depend on their number.
///
/// # Errors
/// Those of [`load`](fn@crate::load) for the file; [`Error::Scene`] when it has no triangle with area, a set that cannot be
/// asked for, or an attribute with too few elements; [`Error::Setting`] for options out of range, charts that do not fit,
/// or more images than one; [`Error::Memory`].
pub fn unwrap_file(
    path: impl AsRef<Path>,
    options: &UnwrapFile,
    progress: &(dyn Fn(charts::Progress) + Sync),
) -> Result<Unwrapping, Error> {
    layout::validate(options)?;
    let (file, json, mut warnings) = read(path.as_ref(), options)?;
    let geometry = Geometry::of(&file, options.charts.weld)?;
    geometry.check_memory(&file)?;
    let sets = material::sets(&file, &json, &geometry, options.set)?;
    let layout = Layout::of(&file, &geometry, options, progress)?;
    let splits: Vec<Split> = geometry
        .parts
        .iter()
        .map(|part| Split::of(part, &layout.corners[part.faces()]))
        .collect();
    warnings.extend(material::warnings(&json, &geometry, &sets));
    let report = report::report(&geometry, &layout, &splits, &sets, warnings);
    Ok(Unwrapping {
        report,
        file,
        json,
        geometry,
        layout,
        splits,
        sets,
    })
}

impl Unwrapping {
    /// Writes the file, binary or as JSON with a .bin file beside it as its extension asks.
    ///
    /// Images in files of their own stay there if `path` is in the folder that the original is in; else they are
    /// embedded. Each file appears whole or not at all; the original may be among them.
    ///
    /// # Errors
    /// [`Error::Write`] for another extension than .glb or .gltf, a folder that does not exist or cannot be written, or a
    /// file of 4 GiB and more; those of reading what is embedded.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        gltf_file::save(self, path.as_ref())
    }

    /// Writes a picture of the atlas, at its size, to a PNG file: charts in colours, triangles faintly outlined.
    ///
    /// # Errors
    /// [`Error::Write`] as for any picture; [`Error::Memory`] if the picture is larger than memory may be.
    pub fn save_atlas(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        picture::save(self, path.as_ref())
    }

    /// The file's scene, in its rest pose, with bare materials and the new coordinates as set 0, to be shown by
    /// [`Show::Checker`](crate::Show).
    ///
    /// Coordinates are multiplied by a power of two, 1 to 4096, so that about sixteen cells of the checkerboard lie along
    /// the median primitive.
    ///
    /// # Errors
    /// As [`load`](fn@crate::load).
    pub fn checker_scene(&self) -> Result<Scene, Error> {
        checker::scene(self)
    }
}

/// Checks that `path` can be saved to, before any work is done for it.
///
/// # Errors
/// [`Error::Write`] for another extension than .glb or .gltf, or a folder that does not exist.
pub fn check_holds_gltf(path: impl AsRef<Path>) -> Result<(), Error> {
    gltf_file::Container::of(path.as_ref()).map(drop)
}

/// The file, its JSON and what its reader met.
fn read(path: &Path, options: &UnwrapFile) -> Result<(File, Value, Vec<String>), Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    let container = container::parse(path, bytes)?;
    extensions::check_geometry(path, &container.root)?;
    let json: Value = serde_json::from_slice(&container.text)
        .map_err(|error| container::json_error(path, &error))?;
    let mut warnings = container.warnings;
    let document = container::validated(path, container.root, &mut warnings)?;
    let load = LoadOptions {
        outside: options.outside,
        max_memory: options.max_memory,
        ..LoadOptions::default()
    };
    let file = File {
        path: path.to_owned(),
        buffers: Buffers::new(path, options.outside, container.blob, &document),
        options: load,
        document,
    };
    Ok((file, json, warnings))
}
