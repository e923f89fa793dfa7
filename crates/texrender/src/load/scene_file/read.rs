//! From the text of scene files to a scene.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use glam::Vec2;
use texcoord::TextureTransform;
use toml::de::DeTable;

use super::kinds::SCENE;
use super::mappings::mapping;
use super::materials::material;
use super::objects::add_object;
use super::table::{Source, Table};
use super::textures::texture;
use super::value::nearest;
use super::{Document, lights, view};
use crate::error::Error;
use crate::load::LoadOptions;
use crate::load::uri::local_file;
use crate::scene::{Coordinates, ImageData, ImageSource, Scene, Texture, TextureUse};

/// A file and its text.
struct File {
    path: PathBuf,
    text: String,
}

/// A mapping of the scene, and whether images are turned over on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct MappedTo {
    pub mapping: usize,
    pub flip_t: bool,
}

/// A scene that is being read: what its files name, and what came of it.
pub(super) struct Reader<'a> {
    pub options: &'a LoadOptions,
    pub scene: Scene,
    textures: BTreeMap<&'a str, usize>,
    mappings: BTreeMap<&'a str, MappedTo>,
    materials: BTreeMap<&'a str, Table<'a>>,
    /// Materials of the scene by name and by where their maps are read.
    made: HashMap<(&'a str, Option<MappedTo>), usize>,
    images: HashMap<PathBuf, usize>,
}

/// Reads a scene file and those that it includes.
pub(super) fn read(path: &Path, options: &LoadOptions) -> Result<Document, Error> {
    let mut files = Vec::new();
    collect(path, options, &mut Vec::new(), &mut files)?;
    let mut trees = Vec::new();
    for file in &files {
        trees.push((Source::of(file), parsed(Source::of(file))?));
    }
    let mut tables = Vec::new();
    for (source, tree) in &trees {
        tables.push(Table::open(*source, &SCENE, tree, 0)?);
    }
    let mut reader = Reader {
        options,
        scene: Scene {
            path: path.to_owned(),
            ..Scene::default()
        },
        textures: BTreeMap::new(),
        mappings: BTreeMap::new(),
        materials: BTreeMap::new(),
        made: HashMap::new(),
        images: HashMap::new(),
    };
    // Names first: files may use each other's.
    for table in &tables {
        reader.add_names(table)?;
    }
    reader.check_materials()?;
    for table in &tables {
        for light in table.list("light")? {
            reader.scene.lights.push(lights::light(&light)?);
        }
        for object in table.list("object")? {
            add_object(&mut reader, &object)?;
        }
    }
    // The file itself comes last, after what it includes.
    let Some(own) = tables.last() else {
        return Err(Error::scene(path, "scene", "no file was read"));
    };
    view::document(reader.scene, own, options)
}

impl<'a> Source<'a> {
    fn of(file: &'a File) -> Self {
        Self {
            path: &file.path,
            text: &file.text,
        }
    }
}

fn parsed<'a>(source: Source<'a>) -> Result<DeTable<'a>, Error> {
    match DeTable::parse(source.text) {
        Ok(tree) => Ok(tree.into_inner()),
        Err(error) => {
            let at = error.span().map_or(0, |span| span.start);
            Err(source.error(at, error.message()))
        }
    }
}

/// Reads the text of a file after those that it includes. `open`: the files that include it.
fn collect(
    path: &Path,
    options: &LoadOptions,
    open: &mut Vec<PathBuf>,
    files: &mut Vec<File>,
) -> Result<(), Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::read(path, error))?;
    let source = Source { path, text: &text };
    let tree = parsed(source)?;
    let table = Table::open(source, &SCENE, &tree, 0)?;
    let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    };
    open.push(path.to_owned());
    for name in table.texts("include") {
        let included = local_file(path, name, options.outside)
            .map_err(|detail| table.error_at("include", detail))?;
        if open.iter().any(|file| same(file, &included)) {
            let chain: Vec<String> = open.iter().map(|file| file.display().to_string()).collect();
            let detail = format!(
                "'{name}' includes itself, by way of {}; remove one of the includes",
                chain.join(" → ")
            );
            return Err(table.error_at("include", detail));
        }
        // A file that two others include is read once.
        if !files.iter().any(|file| same(&file.path, &included)) {
            collect(&included, options, open, files)?;
        }
    }
    open.pop();
    files.push(File {
        path: path.to_owned(),
        text,
    });
    Ok(())
}

impl<'a> Reader<'a> {
    /// Lists the textures, mappings and materials of a file.
    fn add_names(&mut self, file: &Table<'a>) -> Result<(), Error> {
        for (name, table) in file.named("texture")? {
            check_new(&table, "texture", name, &self.textures)?;
            let texture = texture(self, &table)?;
            self.textures.insert(name, self.scene.textures.len());
            self.scene.textures.push(texture);
        }
        for (name, table) in file.named("mapping")? {
            check_new(&table, "mapping", name, &self.mappings)?;
            let made = mapping(&table)?;
            let (mapping, flip_t) = (self.scene.mappings.len(), made.flip_t);
            self.mappings.insert(name, MappedTo { mapping, flip_t });
            self.scene.mappings.push(made.mapping);
        }
        for (name, table) in file.named("material")? {
            check_new(&table, "material", name, &self.materials)?;
            self.materials.insert(name, table);
        }
        Ok(())
    }

    /// Reads each material once, so that one that no object uses is still checked.
    fn check_materials(&self) -> Result<(), Error> {
        let mut all = self.materials.iter();
        all.try_for_each(|(name, table)| material(self, name, table, None).map(|_| ()))
    }

    /// The image that a texture's `file` names.
    pub(super) fn image(&mut self, table: &Table<'_>) -> Result<usize, Error> {
        let path = self.file(table)?;
        if !path.is_file() {
            let detail = format!("{} does not exist", path.display());
            return Err(table.error_at("file", detail));
        }
        if let Some(&image) = self.images.get(&path) {
            return Ok(image);
        }
        let image = self.scene.images.len();
        self.scene.images.push(ImageSource {
            name: table.text("file").unwrap_or_default().to_owned(),
            data: ImageData::File(path.clone()),
        });
        self.images.insert(path, image);
        Ok(image)
    }

    /// The file at the key `file`.
    pub(super) fn file(&self, table: &Table<'_>) -> Result<PathBuf, Error> {
        let name = table.text("file").unwrap_or_default();
        local_file(table.source.path, name, self.options.outside)
            .map_err(|detail| table.error_at("file", detail))
    }

    pub(super) fn texture(&self, table: &Table<'_>, key: &str, name: &str) -> Result<usize, Error> {
        let found = self.textures.get(name).copied();
        found.ok_or_else(|| no_such(table, key, "texture", name, self.textures.keys()))
    }

    pub(super) fn mapping(
        &self,
        table: &Table<'_>,
        key: &str,
        name: &str,
    ) -> Result<MappedTo, Error> {
        let found = self.mappings.get(name).copied();
        found.ok_or_else(|| no_such(table, key, "mapping", name, self.mappings.keys()))
    }

    /// The scene's material of a name with its maps read at `mapped`.
    pub(super) fn material(
        &mut self,
        object: &Table<'_>,
        name: &str,
        mapped: Option<MappedTo>,
    ) -> Result<usize, Error> {
        let Some((&name, table)) = self.materials.get_key_value(name) else {
            return Err(no_such(
                object,
                "material",
                "material",
                name,
                self.materials.keys(),
            ));
        };
        if let Some(&made) = self.made.get(&(name, mapped)) {
            return Ok(made);
        }
        let material = material(self, name, table, mapped)?;
        self.scene.materials.push(material);
        let made = self.scene.materials.len() - 1;
        self.made.insert((name, mapped), made);
        Ok(made)
    }

    /// A use of a texture by a mapping, or by a set of the vertices' coordinates.
    pub(super) fn placed(
        &self,
        texture: usize,
        mapped: Option<MappedTo>,
        set: usize,
        transform: TextureTransform,
    ) -> TextureUse {
        let is_image = matches!(self.scene.textures.get(texture), Some(Texture::Image(_)));
        TextureUse {
            texture,
            coordinates: mapped.map_or(Coordinates::Set(set), |m| Coordinates::Mapping(m.mapping)),
            transform: if is_image && mapped.is_some_and(|m| m.flip_t) {
                turned_over(transform)
            } else {
                transform
            },
        }
    }
}

/// The transform after (s,t) ↦ (s, 1 − t).
pub(super) fn turned_over(transform: TextureTransform) -> TextureTransform {
    let affine = transform.affine().matrix;
    TextureTransform {
        offset: affine.transform_point2(glam::DVec2::Y).as_vec2(),
        scale: transform.scale * Vec2::new(1.0, -1.0),
        ..transform
    }
}

fn check_new<T>(
    table: &Table<'_>,
    kind: &str,
    name: &str,
    known: &BTreeMap<&str, T>,
) -> Result<(), Error> {
    if known.contains_key(name) {
        let detail = format!("there is another {kind} '{name}'; give it another name");
        return Err(table.error(detail));
    }
    Ok(())
}

fn no_such<'n>(
    table: &Table<'_>,
    key: &str,
    kind: &str,
    name: &str,
    known: impl Iterator<Item = &'n &'n str> + Clone,
) -> Error {
    let hint = match nearest(name, known.clone().copied()) {
        Some(near) => format!("did you mean '{near}'?"),
        None if known.clone().next().is_none() => format!("the file has no {kind}s"),
        None => format!(
            "there are {}",
            known.copied().collect::<Vec<_>>().join(", ")
        ),
    };
    table.error_at(key, format!("there is no {kind} '{name}'; {hint}"))
}
