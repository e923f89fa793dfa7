//! Objects of a scene file: shapes and glTF files, placed.

use glam::{DMat4, DQuat, EulerRot};

use super::patches::patch_meshes;
use super::read::{MappedTo, Reader, turned_over};
use super::shapes;
use super::table::Table;
use crate::error::Error;
use crate::load::load;
use crate::scene::{Coordinates, Instance, Material, MaterialModel, Primitive, Scene, Texture};

/// Adds an object to the scene.
pub(super) fn add_object(reader: &mut Reader<'_>, table: &Table<'_>) -> Result<(), Error> {
    let world = world(table)?;
    let mapped = match table.text("mapping") {
        Some(name) => Some(reader.mapping(table, "mapping", name)?),
        None => None,
    };
    let material = match table.text("material") {
        Some(name) => Some(reader.material(table, name, mapped)?),
        None => None,
    };
    if table.tag() == "gltf" {
        return add_file(reader, table, world, material, mapped);
    }
    let material = match material {
        Some(material) => material,
        None => plain_material(&mut reader.scene),
    };
    let name = table.text("name").unwrap_or(table.tag());
    for mesh in meshes(reader, table)? {
        let primitive = reader.scene.primitives.len();
        reader.scene.primitives.push(Primitive {
            name: name.to_owned(),
            material: Some(material),
            ..mesh
        });
        reader.scene.instances.push(Instance {
            name: name.to_owned(),
            primitive,
            world,
        });
    }
    Ok(())
}

fn world(table: &Table<'_>) -> Result<DMat4, Error> {
    let scale = table.scale("scale");
    if scale.min_element() == 0.0 || scale.to_array().contains(&0.0) {
        return Err(table.error_at("scale", "0 flattens the object; give other numbers"));
    }
    let degrees = table.sure_vec3("rotate");
    let [x, y, z] = degrees.to_array().map(f64::to_radians);
    // About x, then y, then z, of axes that stay.
    let turn = DQuat::from_euler(EulerRot::ZYX, z, y, x);
    Ok(DMat4::from_scale_rotation_translation(
        scale,
        turn,
        table.sure_vec3("translate"),
    ))
}

/// White, not metallic, half rough: of shapes without a material.
fn plain_material(scene: &mut Scene) -> usize {
    let plain = Material {
        name: "plain".to_owned(),
        model: MaterialModel::MetallicRoughness {
            metallic: 0.0,
            roughness: 0.5,
            map: None,
            ior: 1.5,
            specular: 1.0,
            specular_map: None,
            specular_color: glam::Vec3::ONE,
            specular_color_map: None,
        },
        ..Material::default()
    };
    let found = scene.materials.iter().position(|m| *m == plain);
    found.unwrap_or_else(|| {
        scene.materials.push(plain);
        scene.materials.len() - 1
    })
}

/// The shape of a table, in pieces.
fn meshes(reader: &Reader<'_>, table: &Table<'_>) -> Result<Vec<Primitive>, Error> {
    let segments = || table.count("segments");
    let radius = || table.sure_number("radius");
    Ok(vec![match table.tag() {
        "plane" => shapes::plane(table.vec2("size").unwrap_or_default()),
        "box" => shapes::cuboid(table.sure_vec3("size")),
        "sphere" => shapes::sphere(radius(), segments()),
        "cylinder" => {
            let height = table.sure_number("height");
            let caps = if table.flag("caps") == Some(true) {
                shapes::Caps::Closed
            } else {
                shapes::Caps::Open
            };
            shapes::cylinder(radius(), height, segments(), caps)
        }
        "torus" => shapes::torus(
            table.sure_number("ring"),
            table.sure_number("tube"),
            segments(),
        ),
        "icosahedron" => shapes::icosahedron(radius(), table.count("subdivisions")),
        _ => return patch_meshes(reader, table),
    }])
}

/// Adds the scene of a glTF file.
fn add_file(
    reader: &mut Reader<'_>,
    table: &Table<'_>,
    world: DMat4,
    material: Option<usize>,
    mapped: Option<MappedTo>,
) -> Result<(), Error> {
    let path = reader.file(table)?;
    if super::is_scene_file(&path) {
        return Err(table.error_at("file", "it is a scene file; include it instead"));
    }
    let mut file = load(&path, reader.options)?;
    if let Some(mapped) = mapped {
        let is_image: Vec<bool> = file
            .textures
            .iter()
            .map(|texture| matches!(texture, Texture::Image(_)))
            .collect();
        for material in &mut file.materials {
            map_all(material, mapped, &is_image);
        }
    }
    append(&mut reader.scene, file, world, material);
    Ok(())
}

/// Reads all maps of a material of another scene where a mapping says.
fn map_all(material: &mut Material, mapped: MappedTo, is_image: &[bool]) {
    for map in material.uses_mut() {
        map.coordinates = Coordinates::Mapping(mapped.mapping);
        if mapped.flip_t && is_image.get(map.texture) == Some(&true) {
            map.transform = turned_over(map.transform);
        }
    }
}

/// Adds all of a glTF scene, its indices moved behind those that are there.
fn append(scene: &mut Scene, file: Scene, world: DMat4, material: Option<usize>) {
    let (images, textures) = (scene.images.len(), scene.textures.len());
    let (materials, primitives) = (scene.materials.len(), scene.primitives.len());
    scene.images.extend(file.images);
    scene
        .textures
        .extend(file.textures.into_iter().map(|mut texture| {
            if let Texture::Image(texture) = &mut texture {
                texture.image += images;
            }
            texture
        }));
    scene
        .materials
        .extend(file.materials.into_iter().map(|mut own| {
            own.move_textures(textures);
            own
        }));
    scene
        .primitives
        .extend(file.primitives.into_iter().map(|primitive| Primitive {
            material: material.or(primitive.material.map(|own| own + materials)),
            ..primitive
        }));
    scene
        .instances
        .extend(file.instances.into_iter().map(|instance| Instance {
            primitive: instance.primitive + primitives,
            world: world * instance.world,
            ..instance
        }));
    scene
        .cameras
        .extend(file.cameras.into_iter().map(|mut camera| {
            camera.world = world * camera.world;
            camera
        }));
    scene
        .lights
        .extend(file.lights.into_iter().map(|mut light| {
            light.position = world.transform_point3(light.position.as_dvec3()).as_vec3();
            let direction = world.transform_vector3(light.direction.as_dvec3());
            light.direction = direction.normalize_or(light.direction.as_dvec3()).as_vec3();
            light
        }));
    scene.warnings.extend(file.warnings);
}
