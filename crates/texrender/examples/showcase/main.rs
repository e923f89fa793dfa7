//! Writes the showcase, a scene made of nothing but code.
//!
//! ```text
//! cargo run --release -p texrender-rs --example showcase -- assets/showcase.glb
//! ```
//!
//! The file is the same to the byte on every machine: trigonometry is libm's, noise is hashed integers.

mod scene;

use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(path) = std::env::args_os().nth(1) else {
        eprintln!("usage: showcase FILE.glb");
        return ExitCode::from(2);
    };
    match std::fs::write(&path, scene::build()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", path.display());
            ExitCode::FAILURE
        }
    }
}
