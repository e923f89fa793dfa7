//! Writes the showcase, a scene made of nothing but code.
//!
//! ```text
//! cargo run --release -p texrender-rs --example showcase -- assets/showcase.glb
//! cargo run --release -p texrender-rs --example showcase -- heavy.glb heavy
//! ```
//!
//! The second is for timing: 199,680 triangles and 36 textures. It is in no repository.
//!
//! The file is the same to the byte on every machine: trigonometry is libm's, noise is hashed integers.

mod scene;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let (path, bytes) = match arguments.as_slice() {
        [path] => (path, scene::build()),
        [path, kind] if kind == "heavy" => (path, scene::build_heavy(1024)),
        _ => {
            eprintln!("usage: showcase FILE.glb [heavy]");
            return ExitCode::from(2);
        }
    };
    match std::fs::write(path, bytes) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", path.to_string_lossy());
            ExitCode::FAILURE
        }
    }
}
