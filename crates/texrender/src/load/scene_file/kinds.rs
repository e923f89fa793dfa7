//! The kinds of tables that a scene file has.

use super::key::{Default, Key, Kind, Value};

const ANY: &[&str] = &[];
const INFINITE: f64 = f64::INFINITY;

const fn key(name: &'static str, value: Value, default: Default, about: &'static str) -> Key {
    of(ANY, name, value, default, about)
}

const fn of(
    of: &'static [&'static str],
    name: &'static str,
    value: Value,
    default: Default,
    about: &'static str,
) -> Key {
    Key {
        name,
        of,
        value,
        default,
        about,
    }
}

const fn number(least: f64, most: f64, unit: &'static str) -> Value {
    Value::Number { least, most, unit }
}

const fn positive(unit: &'static str) -> Value {
    Value::Positive { unit }
}

const fn numbers(count: usize, unit: &'static str) -> Value {
    Value::Numbers { count, unit }
}

const LENGTH: &str = "scene units";
const DEGREES: &str = "degrees";

/// The file as a whole.
#[rustfmt::skip]
pub(super) static SCENE: Kind = Kind {
    name: "scene",
    about: "The file as a whole.",
    tag: None,
    keys: &[
        key("include", Value::Files, Default::Is("nothing"), "Other scene files whose objects, lights, materials, textures and mappings are added. Their output, camera and environment are not."),
        key("output", Value::Table(&OUTPUT), Default::Is("all its defaults"), "The picture to make."),
        key("camera", Value::Table(&CAMERA), Default::Is("the first camera of an included glTF file, or else a view that fits everything"), "Where it is seen from."),
        key("environment", Value::Table(&ENVIRONMENT), Default::Is("a neutral studio"), "Light from afar, and what is behind everything."),
        key("light", Value::List(&LIGHT), Default::Is("none"), "Lights without size."),
        key("texture", Value::Named(&TEXTURE), Default::Is("none"), "Images, solid textures and volumes."),
        key("mapping", Value::Named(&MAPPING), Default::Is("none"), "Where surfaces are on their textures, from their place in space."),
        key("material", Value::Named(&MATERIAL), Default::Is("none"), "What surfaces are made of."),
        key("object", Value::List(&OBJECT), Default::Is("none"), "What there is to see."),
    ],
};

#[rustfmt::skip]
static OUTPUT: Kind = Kind {
    name: "output",
    about: "The picture to make. Options of the command line go before it.",
    tag: None,
    keys: &[
        key("file", Value::File, Default::Is("what the command line says"), "Picture to write: .png, .jpg, .webp, .hdr or .exr."),
        key("size", numbers(2, "pixels"), Default::Numbers(&[1280.0, 720.0]), "Width and height."),
        key("samples", Value::Count { least: 1, most: 64 }, Default::Count(4), "Coverage samples a pixel: 1, 2, 4, 8, 16, 32 or 64."),
        key("filter", Value::Text, Default::Text("aniso:16"), "How textures are filtered: nearest, bilinear, trilinear, aniso:N, ewa, ewa:fast, ewa:best, auto:RMSE or file."),
        key("tonemap", Value::Choice(&["neutral", "aces", "none"]), Default::Text("neutral"), "Curve from radiance to display; EXR and HDR stay linear."),
        key("exposure", number(-64.0, 64.0, "stops"), Default::Number(0.0), "By how much the picture is brightened."),
        key("show", Value::Choice(&["checker", "distortion", "texel-density", "mip", "uv"]), Default::Is("materials"), "What is shown of texture coordinates instead of materials."),
    ],
};

#[rustfmt::skip]
static CAMERA: Kind = Kind {
    name: "camera",
    about: "Where the picture is seen from: a camera of a glTF file by `name`, an `eye` that looks at a `target`, or an angle around what is visible.",
    tag: None,
    keys: &[
        key("name", Value::Text, Default::Is("no such camera"), "Camera of a glTF object, by name or index."),
        key("eye", numbers(3, LENGTH), Default::Is("a place around the scene"), "Where the eye is; goes with `target`."),
        key("target", numbers(3, LENGTH), Default::Is("the middle of the scene"), "What it looks at."),
        key("fov", number(0.001, 179.0, DEGREES), Default::Number(30.0), "Vertical field of view."),
        key("azimuth", number(-INFINITE, INFINITE, DEGREES), Default::Is("chosen by the shape of the scene"), "Around the scene, from the front (+Z) toward the right (+X)."),
        key("elevation", number(-90.0, 90.0, DEGREES), Default::Is("chosen by the shape of the scene"), "Above the horizon."),
        key("distance", positive(LENGTH), Default::Is("as near as shows everything"), "From the middle of the scene."),
    ],
};

#[rustfmt::skip]
static ENVIRONMENT: Kind = Kind {
    name: "environment",
    about: "Light from afar, and what is behind everything.",
    tag: None,
    keys: &[
        key("file", Value::File, Default::Is("see `preset`"), "A latitude-longitude picture, .hdr or .exr."),
        key("preset", Value::Choice(&["studio", "none"]), Default::Text("studio"), "A computed studio, or no light from afar."),
        key("rotation", number(-INFINITE, INFINITE, DEGREES), Default::Number(0.0), "Turn about the vertical, counter-clockwise from above."),
        key("background", Value::Text, Default::Text("#333333"), "What is seen where nothing is: #rrggbb, black, white, transparent or env."),
    ],
};

#[rustfmt::skip]
static LIGHT: Kind = Kind {
    name: "light",
    about: "A light without size.",
    tag: Some("kind"),
    keys: &[
        key("kind", Value::Choice(&["directional", "point", "spot"]), Default::Required, "Infinitely far, in all directions from a point, or a cone."),
        key("color", Value::Color, Default::Is("white"), "Its colour."),
        key("intensity", number(0.0, INFINITE, "lux of directional lights, candela of others"), Default::Number(1.0), "Multiplies the colour."),
        of(&["point", "spot"], "position", numbers(3, LENGTH), Default::Required, "Where it is."),
        of(&["directional", "spot"], "direction", numbers(3, ""), Default::Required, "Where the light travels to; any length above 0."),
        of(&["point", "spot"], "range", positive(LENGTH), Default::Is("infinite"), "Distance at which it has faded to nothing."),
        of(&["spot"], "inner", number(0.0, 90.0, DEGREES), Default::Number(0.0), "From the axis to where it begins to fall off; less than `outer`."),
        of(&["spot"], "outer", number(0.001, 90.0, DEGREES), Default::Number(45.0), "From the axis to where it ends."),
    ],
};

const COLOURED: &[&str] = &[
    "checker", "stripes", "grid", "noise", "marble", "wood", "stone", "clouds",
];
const FRACTAL: &[&str] = &["noise", "marble", "wood", "stone", "clouds"];

#[rustfmt::skip]
static TEXTURE: Kind = Kind {
    name: "texture",
    about: "A function of texture coordinates. Solid textures are evaluated at (s,t,p), of mappings as of vertices (p = 0), and filtered over the pixel's footprint.",
    tag: Some("kind"),
    keys: &[
        key("kind", Value::Choice(&["image", "volume", "checker", "stripes", "grid", "noise", "marble", "wood", "stone", "clouds"]), Default::Required, "Texels, texels in three dimensions, or a formula."),
        of(&["image", "volume"], "file", Value::File, Default::Required, "PNG, JPEG, WebP, HDR or EXR; of a volume its slices below each other, the first at p = 0."),
        of(&["volume"], "depth", Value::Count { least: 1, most: 16384 }, Default::Required, "Number of slices; it divides the image's height."),
        of(&["image", "volume"], "wrap", Value::Choice(&["repeat", "mirror", "mirror-once", "clamp", "border"]), Default::Text("repeat"), "What lies beyond the border, along all axes; `border` is nothing: transparent black."),
        of(&["image"], "wrap_t", Value::Choice(&["repeat", "mirror", "mirror-once", "clamp", "border"]), Default::Is("as `wrap`"), "The same along t alone."),
        of(&["image"], "magnify", Value::Choice(&["linear", "nearest"]), Default::Text("linear"), "Between texels, where they are larger than pixels."),
        of(COLOURED, "colors", Value::Colors, Default::Is("the pattern's own"), "Of ground and pattern, even and odd cells, low and high values."),
        of(COLOURED, "scale", positive("patterns a unit"), Default::Number(1.0), "Multiplies (s,t,p)."),
        of(&["stripes"], "duty", number(0.0, 1.0, ""), Default::Number(0.5), "The part of a period that is stripe."),
        of(&["grid"], "line", number(0.0, 1.0, ""), Default::Number(0.1), "The part of a period that is line."),
        of(FRACTAL, "octaves", Value::Count { least: 1, most: 32 }, Default::Is("the pattern's own"), "How many scales of noise are added."),
        of(FRACTAL, "gain", number(0.0, 1.0, ""), Default::Is("the pattern's own"), "Amplitude of a scale over that of the next coarser one."),
        of(FRACTAL, "lacunarity", number(1.0, 16.0, ""), Default::Is("the pattern's own"), "Frequency of a scale over that of the next coarser one."),
        of(&["marble", "wood"], "distortion", number(0.0, 100.0, "distances of veins or rings"), Default::Is("the pattern's own"), "How far noise bends veins or rings."),
        of(&["wood"], "rings", positive("rings a unit"), Default::Number(8.0), "Year rings along the radius."),
        of(&["clouds"], "cover", number(0.0, 1.0, ""), Default::Number(0.5), "The part of the sky that is covered."),
        of(&["clouds"], "sharpness", number(0.0, 100.0, ""), Default::Number(4.0), "How quickly clouds thicken."),
    ],
};

const PLACED: &[&str] = &[
    "facets",
    "triplanar",
    "spherical",
    "cylindrical",
    "cube",
    "two-stage",
];
const STAGED: &[&str] = &["two-stage"];

#[rustfmt::skip]
static MAPPING: Kind = Kind {
    name: "mapping",
    about: "Where a surface is on a texture, from its place in space, pixel by pixel.",
    tag: Some("kind"),
    keys: &[
        key("kind", Value::Choice(&["planar", "parallel", "perspective", "facets", "triplanar", "spherical", "cylindrical", "cube", "two-stage"]), Default::Required, "Which function."),
        key("space", Value::Choice(&["object", "world"]), Default::Is("object; of `perspective` world"), "Whether the texture moves with the object, or the object through the texture."),
        key("flip_t", Value::Flag, Default::Is("true where the function counts t upward: planar, perspective, facets, triplanar, cylindrical, `from-bottom` spheres, two-stage planes and cylinders"), "Whether 1 − t is taken of images, whose t counts downward."),
        of(&["planar"], "origin", numbers(3, LENGTH), Default::Numbers(&[0.0, 0.0, 0.0]), "Where (s,t) is (0,0)."),
        of(&["planar"], "s_axis", numbers(3, ""), Default::Numbers(&[1.0, 0.0, 0.0]), "Along which s grows; any length."),
        of(&["planar"], "t_axis", numbers(3, ""), Default::Numbers(&[0.0, 1.0, 0.0]), "Along which t grows; any length."),
        of(&["planar"], "size", numbers(2, LENGTH), Default::Numbers(&[1.0, 1.0]), "Width and height of the texture; both above 0."),
        of(&["parallel", "perspective"], "matrix", Value::Matrix, Default::Is("for `perspective`, from `eye` and what follows"), "(s,t,p) = M·(P,1); of `perspective` four rows, (s,t,p) = (s',t',p')/q."),
        of(&["perspective"], "eye", numbers(3, LENGTH), Default::Numbers(&[0.0, 0.0, 1.0]), "Where the projector stands."),
        of(&["perspective"], "target", numbers(3, LENGTH), Default::Numbers(&[0.0, 0.0, 0.0]), "What it throws the texture's middle at."),
        of(&["perspective"], "up", numbers(3, ""), Default::Numbers(&[0.0, 1.0, 0.0]), "The texture's up."),
        of(&["perspective"], "fov", number(0.001, 179.0, DEGREES), Default::Number(30.0), "Vertical angle that the texture fills."),
        of(&["perspective"], "aspect", positive("width over height"), Default::Number(1.0), "Shape of the texture as it is thrown."),
        of(PLACED, "axis", numbers(3, ""), Default::Is("+y; of cubes and two-stage boxes +z"), "The axis of sphere and cylinder, the z of the others; any length."),
        of(PLACED, "start", numbers(3, ""), Default::Is("−z of spheres, cylinders and two-stage mappings, so that a picture's middle is in front; +x of the others, or where the axis is along z"), "The direction of φ = 0, the x of the others; the part of it across the axis counts."),
        of(PLACED, "center", numbers(3, LENGTH), Default::Numbers(&[0.0, 0.0, 0.0]), "Centre of the mapping."),
        of(PLACED, "scale", Value::Scale, Default::Number(1.0), "Size of the mapping's unit along start, across and axis; 0 is not allowed."),
        of(&["facets", "triplanar"], "backs", Value::Choice(&["mirrored", "readable"]), Default::Text("readable"), "What facets toward the negative axes show."),
        of(&["triplanar"], "sharpness", number(1.0, 1024.0, ""), Default::Number(4.0), "Power of the normal that weights the three planes."),
        of(&["spherical", "cylindrical", "two-stage"], "turn", Value::Choice(&["from-start", "centred", "signed"]), Default::Text("from-start"), "s of the angle φ about the axis: φ/2π in 0 to 1; (π+φ)/2π; φ/2π in −½ to ½."),
        of(&["spherical", "two-stage"], "polar", Value::Choice(&["from-top", "from-bottom"]), Default::Text("from-top"), "t of the angle θ off the axis: θ/π; (π−θ)/π."),
        of(&["cylindrical", "two-stage"], "along", Value::Choice(&["height", "half-height", "unit"]), Default::Text("height"), "t of the place z along the axis: z/height; (1+z/height)/2; z."),
        of(&["cylindrical", "two-stage"], "height", positive("mapping units"), Default::Number(1.0), "Of the cylinder's t."),
        of(STAGED, "surface", Value::Choice(&["plane", "cylinder", "sphere", "box"]), Default::Required, "The intermediate surface that carries the texture."),
        of(STAGED, "through", Value::Choice(&["reflection", "normal", "centroid", "intermediate-normal"]), Default::Required, "How a point of the object finds it: the reflected ray, its normal, the ray from the centre, or the intermediate surface's own normal."),
        of(STAGED, "radius", positive("mapping units"), Default::Number(1.0), "Of the intermediate sphere or cylinder."),
        of(STAGED, "distance", positive("mapping units"), Default::Number(1.0), "Of the intermediate plane along the axis."),
        of(STAGED, "size", numbers(3, "mapping units"), Default::Numbers(&[2.0, 2.0, 2.0]), "Of the intermediate box, or of the plane (its first two)."),
    ],
};

#[rustfmt::skip]
static TEXTURE_USE: Kind = Kind {
    name: "map",
    about: "A texture as a material reads it.",
    tag: None,
    keys: &[
        key("texture", Value::Reference("texture"), Default::Required, "Which texture."),
        key("mapping", Value::Reference("mapping"), Default::Is("the object's, or else the vertices' coordinates"), "Where it is read."),
        key("set", Value::Count { least: 0, most: 15 }, Default::Count(0), "Which set of the vertices' coordinates, where there is no mapping."),
        key("offset", numbers(2, ""), Default::Numbers(&[0.0, 0.0]), "Added to (s,t) at last."),
        key("rotation", number(-INFINITE, INFINITE, DEGREES), Default::Number(0.0), "Turns (s,t), as KHR_texture_transform does."),
        key("scale", numbers(2, ""), Default::Numbers(&[1.0, 1.0]), "Multiplies (s,t) at first."),
    ],
};

const LIT: &[&str] = &["metal-rough", "specular-gloss"];
const CORE: &[&str] = &["metal-rough"];
const GLOSSY: &[&str] = &["specular-gloss"];

#[rustfmt::skip]
static MATERIAL: Kind = Kind {
    name: "material",
    about: "What a surface is made of.",
    tag: Some("kind"),
    keys: &[
        key("kind", Value::Choice(&["metal-rough", "specular-gloss", "unlit"]), Default::Text("metal-rough"), "glTF's core model, its specular-glossiness model, or colour as it is."),
        key("color", Value::Color, Default::Is("white"), "Multiplies the map."),
        key("opacity", number(0.0, 1.0, ""), Default::Number(1.0), "Multiplies the map's alpha."),
        key("color_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Colour, and alpha where `alpha` asks for it."),
        key("alpha", Value::Choice(&["opaque", "mask", "blend"]), Default::Text("opaque"), "Whether alpha is ignored, tested, or blended."),
        key("cutoff", number(0.0, 1.0, ""), Default::Number(0.5), "The least alpha that a mask shows."),
        key("double_sided", Value::Flag, Default::Flag(false), "Whether backs are drawn."),
        of(CORE, "metallic", number(0.0, 1.0, ""), Default::Number(0.0), "Multiplies blue of `metal_rough_map`."),
        of(CORE, "roughness", number(0.0, 1.0, ""), Default::Number(0.5), "Multiplies green of `metal_rough_map`."),
        of(CORE, "metal_rough_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Roughness in green, metalness in blue; linear."),
        of(CORE, "ior", number(1.0, 10.0, ""), Default::Number(1.5), "Index of refraction."),
        of(CORE, "specular", number(0.0, 1.0, ""), Default::Number(1.0), "Strength of the dielectric's reflection."),
        of(GLOSSY, "specular_color", Value::Color, Default::Is("white"), "Multiplies the map."),
        of(GLOSSY, "glossiness", number(0.0, 1.0, ""), Default::Number(1.0), "Multiplies alpha of the map."),
        of(GLOSSY, "specular_gloss_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Specular colour in RGB, glossiness in alpha."),
        of(LIT, "normal_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Directions in tangent space, +y up; linear."),
        of(LIT, "normal_scale", number(-100.0, 100.0, ""), Default::Number(1.0), "Multiplies x and y of the normal map."),
        of(LIT, "occlusion_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Visibility of the surroundings in red; linear."),
        of(LIT, "occlusion_strength", number(0.0, 1.0, ""), Default::Number(1.0), "How much of it counts."),
        of(LIT, "emissive", Value::Color, Default::Is("black"), "Radiance; multiplies the map."),
        of(LIT, "emissive_strength", number(0.0, INFINITE, ""), Default::Number(1.0), "Multiplies it once more."),
        of(LIT, "emissive_map", Value::TextureUse(&TEXTURE_USE), Default::Is("none"), "Emitted colour."),
    ],
};

const ROUND: &[&str] = &["sphere", "cylinder", "torus"];

#[rustfmt::skip]
static OBJECT: Kind = Kind {
    name: "object",
    about: "Something to see. It is scaled, then turned, then moved.",
    tag: Some("shape"),
    keys: &[
        key("shape", Value::Choice(&["gltf", "plane", "box", "sphere", "cylinder", "torus", "icosahedron", "teapot", "patches"]), Default::Required, "A glTF file, or a shape with texture coordinates of its own."),
        key("name", Value::Text, Default::Is("its shape"), "For messages."),
        key("material", Value::Reference("material"), Default::Is("a plain one, or of glTF files their own"), "What it is made of."),
        key("mapping", Value::Reference("mapping"), Default::Is("its own texture coordinates"), "Where all maps of its material are read that do not say otherwise; of glTF files all maps."),
        key("translate", numbers(3, LENGTH), Default::Numbers(&[0.0, 0.0, 0.0]), "Where it is moved to."),
        key("rotate", numbers(3, DEGREES), Default::Numbers(&[0.0, 0.0, 0.0]), "Turns about x, then y, then z, counter-clockwise."),
        key("scale", Value::Scale, Default::Number(1.0), "Size along its axes; negative mirrors, 0 is not allowed."),
        of(&["gltf", "patches"], "file", Value::File, Default::Required, ".gltf or .glb; of patches a patch file."),
        of(&["plane"], "size", numbers(2, LENGTH), Default::Numbers(&[2.0, 2.0]), "Width along x and depth along z; it faces +y."),
        of(&["box"], "size", numbers(3, LENGTH), Default::Numbers(&[2.0, 2.0, 2.0]), "Width, height and depth."),
        of(&["sphere", "cylinder", "icosahedron"], "radius", positive(LENGTH), Default::Number(1.0), "Of the sphere, the cylinder, or the sphere around the icosahedron."),
        of(&["cylinder"], "height", positive(LENGTH), Default::Number(2.0), "Along y."),
        of(&["cylinder"], "caps", Value::Flag, Default::Flag(true), "Whether it is closed."),
        of(&["torus"], "ring", positive(LENGTH), Default::Number(0.75), "Radius of the ring about y."),
        of(&["torus"], "tube", positive(LENGTH), Default::Number(0.25), "Radius of the tube."),
        of(ROUND, "segments", Value::Count { least: 3, most: 4096 }, Default::Count(64), "Facets around the axis; half as many from pole to pole, or around the tube."),
        of(&["icosahedron"], "subdivisions", Value::Count { least: 0, most: 8 }, Default::Count(0), "How often each triangle is cut into four, onto the sphere."),
        of(&["teapot", "patches"], "tolerance", positive(LENGTH), Default::Number(0.001), "Distance from the surface that triangles keep; the teapot is 3.15 high."),
    ],
};

/// A file of parametric patches.
#[rustfmt::skip]
pub(super) static PATCH_FILE: Kind = Kind {
    name: "patch file",
    about: "Parametric surfaces in a file of their own, for objects of shape `patches`. A .bpt file (the number of patches; for each its degrees along v and u and its points) is read too. (u,v) become s = u, t = 1 − v; the front is where ∂u × ∂v points.",
    tag: None,
    keys: &[
        key("bezier", Value::List(&BEZIER), Default::Is("none"), "Bézier patches of any degree."),
        key("nurbs", Value::List(&NURBS), Default::Is("none"), "B-spline and NURBS surfaces."),
    ],
};

#[rustfmt::skip]
static BEZIER: Kind = Kind {
    name: "bezier",
    about: "A Bézier patch; its degrees follow from its net of points.",
    tag: None,
    keys: &[
        key("columns", Value::Count { least: 2, most: 256 }, Default::Required, "Points along u; there are as many rows along v as fill the net."),
        key("points", Value::Points, Default::Required, "Row by row, u fastest."),
        key("weights", Value::NumberList, Default::Is("1 each"), "One a point, above 0: a rational patch."),
    ],
};

#[rustfmt::skip]
static NURBS: Kind = Kind {
    name: "nurbs",
    about: "A B-spline surface, or a NURBS surface where there are weights.",
    tag: None,
    keys: &[
        key("degree_u", Value::Count { least: 1, most: 255 }, Default::Count(3), "Degree along u."),
        key("degree_v", Value::Count { least: 1, most: 255 }, Default::Count(3), "Degree along v."),
        key("knots_u", Value::NumberList, Default::Required, "As many as points along u, plus the degree, plus 1; none less than the one before."),
        key("knots_v", Value::NumberList, Default::Required, "The same along v."),
        key("points", Value::Points, Default::Required, "Row by row, u fastest."),
        key("weights", Value::NumberList, Default::Is("1 each"), "One a point, above 0."),
    ],
};
