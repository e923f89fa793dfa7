//! The program: textured pictures of 3D scenes on a machine without a GPU.

mod args;
mod bench;
mod frontier;
mod inspect;
mod progress;
mod render;
mod schema;
mod stats;
mod tile;
mod unwrap;
mod values;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use texrender::Error;

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Tile(args) => tile::run(&args),
        Command::Unwrap(args) => unwrap::run(&args),
        Command::Frontier(args) => frontier::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs `work` on a pool of `threads` threads; all cores for 0.
fn with_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> Result<T, Error> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::Setting {
            setting: "--threads",
            detail: error.to_string(),
        })?
        .install(work)
}
