//! Parametric patches: the teapot, and files of Bézier patches and NURBS surfaces.

use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use texcoord::surface::{
    BezierPatch, KnotVector, NurbsSurface, SurfaceError, SurfaceMesh, tessellate,
};
use texcoord::teapot;
use toml::de::DeTable;

use super::kinds::PATCH_FILE;
use super::read::Reader;
use super::table::{Source, Table};
use crate::error::Error;
use crate::scene::Primitive;

/// The triangles of an object made of patches.
pub(super) fn patch_meshes(
    reader: &Reader<'_>,
    table: &Table<'_>,
) -> Result<Vec<Primitive>, Error> {
    let tolerance = table.sure_number("tolerance");
    let failed = |error: SurfaceError| table.error(error.to_string());
    if table.tag() == "teapot" {
        let meshes = tessellate(&teapot::patches(), tolerance, |_| 1.0).map_err(failed)?;
        // Its z is up.
        let upright = |v: Vec3| Vec3::new(v.x, v.z, -v.y);
        return Ok(vec![joined(&meshes, upright)]);
    }
    let path = reader.file(table)?;
    let text = std::fs::read_to_string(&path).map_err(|error| Error::read(&path, error))?;
    let source = Source {
        path: &path,
        text: &text,
    };
    if is_bpt(&path) {
        let patches = bpt(source)?;
        let meshes = tessellate(&patches, tolerance, |_| 1.0).map_err(failed)?;
        return Ok(vec![joined(&meshes, |v| v)]);
    }
    let surfaces = surfaces(source)?;
    let meshes = surfaces.tessellate(tolerance).map_err(failed)?;
    Ok(vec![joined(&meshes, |v| v)])
}

fn is_bpt(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("bpt"))
}

/// What a patch file holds.
#[derive(Default)]
struct Surfaces {
    patches: Vec<BezierPatch>,
    nurbs: Vec<NurbsSurface>,
}

impl Surfaces {
    fn tessellate(&self, tolerance: f64) -> Result<Vec<SurfaceMesh>, SurfaceError> {
        let mut meshes = tessellate(&self.patches, tolerance, |_| 1.0)?;
        for surface in &self.nurbs {
            meshes.extend(surface.tessellate(tolerance, |_| 1.0)?);
        }
        Ok(meshes)
    }
}

/// Meshes as one, s = u and t = 1 − v.
fn joined(meshes: &[SurfaceMesh], place: impl Fn(Vec3) -> Vec3) -> Primitive {
    let mut whole = Primitive::default();
    let (mut normals, mut st) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let first = u32::try_from(whole.positions.len()).unwrap_or(u32::MAX);
        whole
            .positions
            .extend(mesh.positions.iter().map(|&p| place(p)));
        normals.extend(mesh.normals.iter().map(|&n| place(n)));
        st.extend(mesh.uv.iter().map(|uv| Vec2::new(uv.x, 1.0 - uv.y)));
        let moved = |corners: &[u32; 3]| corners.map(|k| k + first);
        whole.indices.extend(mesh.triangles.iter().map(moved));
    }
    whole.normals = Some(normals);
    whole.texcoords = vec![st];
    whole
}

/// The surfaces of a patch file in TOML.
fn surfaces(source: Source<'_>) -> Result<Surfaces, Error> {
    let tree = DeTable::parse(source.text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        source.error(at, error.message())
    })?;
    let file = Table::open(source, &PATCH_FILE, tree.get_ref(), 0)?;
    let mut surfaces = Surfaces::default();
    for table in file.list("bezier")? {
        let columns = table.count("columns") as usize;
        let patch = match table.numbers("weights") {
            Some(weights) => BezierPatch::rational(columns, points(&table), weights),
            None => BezierPatch::new(columns, points(&table)),
        };
        let patch = patch.map_err(|error| table.error(error.to_string()))?;
        surfaces.patches.push(patch);
    }
    for table in file.list("nurbs")? {
        let surface = nurbs(&table).map_err(|error| table.error(error.to_string()))?;
        surfaces.nurbs.push(surface);
    }
    Ok(surfaces)
}

fn nurbs(table: &Table<'_>) -> Result<NurbsSurface, SurfaceError> {
    let knots = |degree: &str, knots: &str| {
        let degree = table.count(degree) as usize;
        KnotVector::new(degree, table.numbers(knots).unwrap_or_default())
    };
    let knots = [knots("degree_u", "knots_u")?, knots("degree_v", "knots_v")?];
    match table.numbers("weights") {
        Some(weights) => NurbsSurface::new(knots, &points(table), &weights),
        None => NurbsSurface::b_spline(knots, &points(table)),
    }
}

/// Rows of three numbers.
fn points(table: &Table<'_>) -> Vec<DVec3> {
    let rows = table.rows("points").unwrap_or_default();
    let point = |row: Vec<f64>| match row[..] {
        [x, y, z] => DVec3::new(x, y, z),
        _ => DVec3::ZERO,
    };
    rows.into_iter().map(point).collect()
}

/// The patch file of the teapot's time: the number of patches; then for each its degrees along v and u and its points,
/// row by row along v.
fn bpt(source: Source<'_>) -> Result<Vec<BezierPatch>, Error> {
    let mut words = Words {
        source,
        words: source.text.split_ascii_whitespace(),
    };
    let count = words.whole("the number of patches", 1 << 20)?;
    let mut patches = Vec::new();
    for _ in 0..count {
        let rows = words.whole("a degree along v", 64)? + 1;
        let columns = words.whole("a degree along u", 64)? + 1;
        let mut points = Vec::new();
        for _ in 0..rows * columns {
            let mut axis = || Ok(words.number("a coordinate")?.0);
            points.push(DVec3::new(axis()?, axis()?, axis()?));
        }
        let patch = BezierPatch::new(columns, points);
        patches.push(patch.map_err(|error| source.error(0, error.to_string()))?);
    }
    Ok(patches)
}

/// Numbers between white space.
struct Words<'a> {
    source: Source<'a>,
    words: std::str::SplitAsciiWhitespace<'a>,
}

impl Words<'_> {
    /// A finite number and where it stands.
    fn number(&mut self, what: &str) -> Result<(f64, usize), Error> {
        let text = self.source.text;
        let Some(word) = self.words.next() else {
            let detail = format!("the file ends where {what} should be");
            return Err(self.source.error(text.len(), detail));
        };
        let at = word.as_ptr().addr() - text.as_ptr().addr();
        let value = word.parse().ok().filter(|value: &f64| value.is_finite());
        let value = value.ok_or_else(|| {
            self.source
                .error(at, format!("expected {what}, found '{word}'"))
        })?;
        Ok((value, at))
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of at least 1 and no more than `most`"
    )]
    fn whole(&mut self, what: &str, most: u32) -> Result<usize, Error> {
        let (value, at) = self.number(what)?;
        if value.fract() != 0.0 || !(1.0..=f64::from(most)).contains(&value) {
            let detail = format!("{what} is {value}; expected a whole number, 1 to {most}");
            return Err(self.source.error(at, detail));
        }
        Ok(value as usize)
    }
}
