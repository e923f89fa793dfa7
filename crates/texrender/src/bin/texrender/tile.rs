//! `texrender tile`

use std::path::Path;

use glam::UVec2;
use texrender::finish::{check_holds_texture, save_texture};
use texrender::load::load_texture;
use texrender::sampler::tile::{
    Seam, SeamStep, StochasticTiling, TileOptions, make_tileable, repeated, seam,
};
use texrender::sampler::{Error as TextureError, Texture, Transfer};
use texrender::{DEFAULT_MAX_MEMORY, Error};

use crate::args::TileArgs;

pub(crate) fn run(args: &TileArgs) -> Result<(), Error> {
    if let Some(output) = &args.output {
        check_holds_texture(output)?;
    }
    let picture = load_texture(&args.picture, Transfer::Srgb, DEFAULT_MAX_MEMORY)?;
    if args.seam {
        print_seam(&args.picture, seam(&picture));
    }
    let Some(output) = &args.output else {
        return Ok(());
    };
    let made = tiled(&picture, args)?;
    save_texture(&made, output)?;
    if args.seam && args.expand.is_none() && args.repeat.is_none() {
        print_seam(output, seam(&made));
    }
    Ok(())
}

fn tiled(picture: &Texture, args: &TileArgs) -> Result<Texture, Error> {
    let options = TileOptions {
        overlap: args.overlap,
    };
    let failed = |setting| {
        move |error: TextureError| Error::Setting {
            setting,
            detail: error.to_string(),
        }
    };
    if let Some(tiles) = args.expand {
        let size = room(picture, tiles, "--expand")?;
        return StochasticTiling::new(picture, options, args.seed)
            .map_err(failed("--overlap"))?
            .expand(size)
            .map_err(failed("--expand"));
    }
    let tile = make_tileable(picture, options).map_err(failed("--overlap"))?;
    match args.repeat {
        None => Ok(tile),
        Some(copies) => {
            room(picture, copies, "--repeat")?;
            repeated(&tile, copies.into()).map_err(failed("--repeat"))
        }
    }
}

/// The size of so many tiles, if memory may hold them.
fn room(picture: &Texture, tiles: (u32, u32), setting: &'static str) -> Result<UVec2, Error> {
    let (across, down) = tiles;
    let size = picture.size();
    let (Some(width), Some(height)) = (size.x.checked_mul(across), size.y.checked_mul(down)) else {
        return Err(Error::Setting {
            setting,
            detail: format!("{across}x{down} tiles are too many; ask for fewer"),
        });
    };
    if width == 0 || height == 0 {
        return Err(Error::Setting {
            setting,
            detail: format!("{across}x{down} tiles are none; ask for 1x1 or more"),
        });
    }
    // Linear components beside stored ones.
    let bytes = u64::from(width) * u64::from(height) * u64::from(picture.channels()) * 8;
    if bytes > DEFAULT_MAX_MEMORY {
        return Err(Error::Memory {
            what: format!("{across}x{down} tiles of {}x{} texels", size.x, size.y),
            needed: bytes >> 20,
            available: DEFAULT_MAX_MEMORY >> 20,
        });
    }
    Ok(UVec2::new(width, height))
}

fn print_seam(path: &Path, seam: Seam) {
    let said = |step: SeamStep| {
        format!(
            "{} {:.2} ({:.4} across, {:.4} inside, {:.4} at most)",
            if step.shows() {
                "shows"
            } else {
                "does not show"
            },
            step.ratio(),
            step.across,
            step.within,
            step.greatest
        )
    };
    println!(
        "{}: seam in s {}; in t {}",
        path.display(),
        said(seam.s),
        said(seam.t)
    );
}
