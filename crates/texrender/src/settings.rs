//! What the user wants of a picture.

use std::path::PathBuf;

use fearless_simd::Level;
use glam::{DVec3, Vec3};
use mipmap::{EwaTier, Tolerance};

use crate::error::Error;

/// Everything about a picture that is not in the scene.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Width in pixels, 1 to [`raster::MAX_DIMENSION`].
    pub width: u32,
    /// Height in pixels, 1 to [`raster::MAX_DIMENSION`].
    pub height: u32,
    /// Where it is seen from.
    pub view: View,
    /// What lights it from afar.
    pub environment: EnvironmentSource,
    /// Degrees by which the environment is turned about Y, counter-clockwise from above.
    pub environment_rotation: f32,
    /// What is seen where nothing is.
    pub background: Background,
    /// How textures are filtered.
    pub filter: FilterChoice,
    /// Coverage samples a pixel: 1, 2, 4, 8, 16, 32 or 64.
    pub samples: u32,
    /// Which values beside the colour are kept.
    pub aovs: Vec<Aov>,
    /// What is shown of all surfaces instead of their materials.
    pub show: Option<Show>,
    /// Bytes that textures and pictures may take.
    pub max_memory: u64,
    /// In which order tiles are drawn. It never changes the picture.
    pub tile_order: TileOrder,
    /// What is shaded where a pixel sees several triangles of one surface.
    pub fragments: FragmentMerging,
    /// Instructions that packets are made of; by default the best that the machine has. They never change the
    /// picture.
    pub simd: Level,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            view: View::default(),
            environment: EnvironmentSource::Studio,
            environment_rotation: 0.0,
            background: Background::default(),
            filter: FilterChoice::default(),
            samples: 4,
            aovs: Vec::new(),
            show: None,
            max_memory: crate::DEFAULT_MAX_MEMORY,
            tile_order: TileOrder::Rows,
            fragments: FragmentMerging::Neighbours,
            simd: Level::new(),
        }
    }
}

/// Where a picture is seen from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum View {
    /// The scene's first camera; without cameras, [`View::Orbit`] with its defaults.
    #[default]
    Default,
    /// A camera of the scene, by name or index.
    Camera(String),
    /// From a point, toward a point.
    LookAt {
        /// Where the eye is.
        eye: DVec3,
        /// What it looks at.
        target: DVec3,
        /// Vertical field of view, degrees, in 0..180.
        fov_y_degrees: f64,
    },
    /// Around what is visible.
    Orbit(Orbit),
}

/// A view from around the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Degrees around Y from +Z toward +X; chosen by the shape of the scene if `None`.
    pub azimuth_degrees: Option<f64>,
    /// Degrees above the horizon, −90..=90; chosen by the shape of the scene if `None`.
    pub elevation_degrees: Option<f64>,
    /// From the centre of the bounds, in scene units; as near as shows everything if `None`.
    pub distance: Option<f64>,
    /// Vertical field of view, degrees, in 0..180.
    pub fov_y_degrees: f64,
}

/// Vertical field of view where nobody says otherwise, degrees.
pub const DEFAULT_FOV_Y_DEGREES: f64 = 30.0;

impl Default for Orbit {
    fn default() -> Self {
        Self {
            azimuth_degrees: None,
            elevation_degrees: None,
            distance: None,
            fov_y_degrees: DEFAULT_FOV_Y_DEGREES,
        }
    }
}

/// What lights a scene from afar.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum EnvironmentSource {
    /// A neutral studio, computed.
    #[default]
    Studio,
    /// A latitude-longitude picture, `.hdr` or `.exr`.
    File(PathBuf),
    /// Nothing.
    None,
}

/// What is seen where nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// A colour of the finished picture, linear: neither exposed nor tone-mapped.
    Color(Vec3),
    /// Nothing: alpha 0.
    Transparent,
    /// The environment.
    Environment,
}

impl Default for Background {
    /// A dark grey, #333333.
    fn default() -> Self {
        Self::Color(Vec3::splat(sampler::transfer::srgb_to_linear(0.2)))
    }
}

/// How textures are filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterChoice {
    /// The nearest texel of the image.
    Nearest,
    /// Bilinear in the image, no mip levels.
    Bilinear,
    /// Bilinear in the two nearest mip levels.
    Trilinear,
    /// Trilinear along the footprint, up to this ratio of its axes. A texture whose author asks for
    /// nearest magnification keeps it.
    Anisotropic(f32),
    /// The elliptical weighted average, for a Gaussian pixel: softer and steadier than probes, several times as
    /// slow. A texture whose author asks for nearest magnification is filtered as by `Anisotropic(16)`.
    Elliptic(EwaTier),
    /// The cheapest filter whose RMSE against a box pixel is below this, as [`mipmap::automatic`] chooses it. A
    /// texture whose author asks for nearest magnification is filtered as by `Anisotropic(16)`.
    Automatic(Tolerance),
    /// As the author asks.
    File,
}

impl Default for FilterChoice {
    fn default() -> Self {
        Self::Anisotropic(16.0)
    }
}

/// A value beside the colour, one a pixel: that of the opaque surface that covers most samples of
/// the pixel, or else of the nearest blended one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Aov {
    /// Distance along the view axis, scene units; +∞ where nothing is.
    Depth,
    /// Shading normal in the world; 0 where nothing is.
    Normal,
    /// Texture coordinate of the base-colour map, or of set 0; 0 where nothing is.
    TextureCoordinate,
    /// Mip level of the base-colour map; 0 where there is none.
    MipLevel,
    /// Index of the instance plus 1; 0 where nothing is.
    SurfaceId,
}

impl Aov {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Depth,
        Self::Normal,
        Self::TextureCoordinate,
        Self::MipLevel,
        Self::SurfaceId,
    ];

    /// Its name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::TextureCoordinate => "st",
            Self::MipLevel => "mip",
            Self::SurfaceId => "id",
        }
    }

    /// Names of its channels, as EXR files spell them.
    #[must_use]
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Depth => &["Z"],
            Self::Normal => &["X", "Y", "Z"],
            Self::TextureCoordinate => &["U", "V"],
            Self::MipLevel => &["level"],
            Self::SurfaceId => &["id"],
        }
    }
}

/// What can be shown of a surface's texture coordinates: those of its base-colour map, or else of another map, or
/// else its set 0. Surfaces without any are dark grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Show {
    /// A checkerboard of eight cells a unit, lit; redder toward growing s, greener toward growing t.
    Checker,
    /// How much shapes are stretched: white where they are kept, yellow at √2, orange at 2, dark red at 4 times; of
    /// surfaces that show the texture mirrored white, violet, blue.
    Distortion,
    /// Texels along a unit of the scene, from blue at 1/2 by two octaves a colour to white, a dark line an octave.
    TexelDensity,
    /// The mip level that a trilinear filter reads: blue where the texture is magnified, green at level 0, yellow at 2,
    /// red at 4, white at 6.
    MipLevel,
    /// s as red, t as green.
    Coordinates,
}

impl Show {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Checker,
        Self::Distortion,
        Self::TexelDensity,
        Self::MipLevel,
        Self::Coordinates,
    ];

    /// Its name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Checker => "checker",
            Self::Distortion => "distortion",
            Self::TexelDensity => "texel-density",
            Self::MipLevel => "mip",
            Self::Coordinates => "uv",
        }
    }
}

/// What is shaded where a pixel sees several triangles of one surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FragmentMerging {
    /// Neighbours are shaded once, at the one of most samples, where what shading reads goes on over their common edge:
    /// smooth normals, the same vertices, the same side seen. (Fatahalian et al., "Reducing Shading on GPUs using
    /// Quad-Fragment Merging", 2010.)
    #[default]
    Neighbours,
    /// Every triangle for itself.
    Never,
}

/// In which order tiles are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TileOrder {
    /// Row by row.
    #[default]
    Rows,
    /// Shuffled from a seed.
    Shuffled(u64),
}

impl Settings {
    /// Checks every value that has a range.
    ///
    /// # Errors
    /// [`Error::Size`], or [`Error::Setting`] naming the setting and its range.
    pub fn validate(&self) -> Result<(), Error> {
        let (width, height) = (self.width, self.height);
        let range = 1..=raster::MAX_DIMENSION;
        if !range.contains(&width) || !range.contains(&height) {
            return Err(Error::Size { width, height });
        }
        raster::SamplePattern::standard(self.samples).map_err(|error| Error::Setting {
            setting: "--samples",
            detail: error.to_string(),
        })?;
        if let FilterChoice::Anisotropic(n) = self.filter
            && !(1.0..=64.0).contains(&n)
        {
            return Err(Error::Setting {
                setting: "--filter",
                detail: format!("an anisotropy of {n}; it must be 1 to 64"),
            });
        }
        if !self.environment_rotation.is_finite() {
            return Err(Error::Setting {
                setting: "--env-rotation",
                detail: "it must be a finite angle in degrees".to_owned(),
            });
        }
        if self.background == Background::Environment && self.environment == EnvironmentSource::None
        {
            return Err(Error::Setting {
                setting: "--background",
                detail: "'env' shows the environment, and --env none leaves none".to_owned(),
            });
        }
        self.view.validate()
    }
}

impl View {
    fn validate(&self) -> Result<(), Error> {
        let error = |setting, detail: String| Err(Error::Setting { setting, detail });
        let fov = match self {
            Self::LookAt { fov_y_degrees, .. } => *fov_y_degrees,
            Self::Orbit(orbit) => orbit.fov_y_degrees,
            Self::Default | Self::Camera(_) => DEFAULT_FOV_Y_DEGREES,
        };
        if !(fov > 0.0 && fov < 180.0) {
            return error(
                "--fov",
                format!("{fov} degrees; it must lie between 0 and 180"),
            );
        }
        match self {
            Self::LookAt { eye, target, .. } => {
                if !(eye.is_finite() && target.is_finite() && eye != target) {
                    return error(
                        "--eye",
                        "eye and target must be finite and different points".to_owned(),
                    );
                }
            }
            Self::Orbit(orbit) => {
                if let Some(degrees) = orbit.elevation_degrees
                    && !(-90.0..=90.0).contains(&degrees)
                {
                    return error(
                        "--elevation",
                        format!("{degrees} degrees; it must be −90 to 90"),
                    );
                }
                if orbit.azimuth_degrees.is_some_and(|a| !a.is_finite()) {
                    return error("--azimuth", "it must be finite".to_owned());
                }
                if orbit.distance.is_some_and(|d| !(d > 0.0 && d.is_finite())) {
                    return error("--distance", "it must be above 0".to_owned());
                }
            }
            Self::Default | Self::Camera(_) => {}
        }
        Ok(())
    }
}
