//! `texrender bench`

use texrender::Error;
use texrender::bench::{COLUMNS, Configuration, Effort, Row, Textures, run as measure};

use crate::args::BenchArgs;
use crate::with_threads;

/// Frames that are drawn before any is timed.
const WARM_UP: usize = 3;

pub(crate) fn run(args: &BenchArgs) -> Result<(), Error> {
    let configurations =
        Configuration::chosen(&args.scene, args.filter.as_deref(), args.texture.as_deref())?;
    let textures = Textures::load(&configurations, args.textures.as_deref())?;
    if let Some(folder) = &args.dump {
        std::fs::create_dir_all(folder).map_err(|error| Error::Write {
            path: folder.clone(),
            detail: error.to_string(),
        })?;
    }
    let effort = Effort {
        warm_up: WARM_UP,
        frames: args.frames,
        level: args.simd,
    };
    if args.csv {
        println!("{COLUMNS}");
    }
    with_threads(args.threads.unwrap_or(0), || {
        measure(
            &configurations,
            &textures,
            &effort,
            args.dump.as_deref(),
            |row| {
                if args.csv {
                    println!("{}", row.csv());
                } else {
                    println!("{}", described(row));
                }
            },
        )
    })
}

fn described(row: &Row) -> String {
    let Configuration {
        scene,
        filter,
        texture,
    } = row.configuration;
    format!(
        "{scene:<13} {:<12} {texture:<8} {} threads {:8.2} ms (least {:.2}) {:8.1} Mpix/s, {} pixels",
        filter.name(),
        row.threads,
        row.median_ms,
        row.least_ms,
        row.megapixels_per_second,
        row.covered
    )
}
