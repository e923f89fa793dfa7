//! Draws a scene from all round with one [`Renderer`], and says what a frame costs.
//!
//! ```text
//! cargo run --release -p texrender-rs --example turntable -- assets/showcase.glb 8 [ENV.hdr]
//! ```
//!
//! 1920×1080 with 4 samples. Prints the median frame in milliseconds, and where its time goes: geometry on the wall
//! clock, the rest summed over threads.

use std::path::PathBuf;

use texrender::plan::Viewpoint;
use texrender::{
    EnvironmentSource, Error, LoadOptions, Plan, Renderer, Settings, View, load, prepare,
};

fn main() -> Result<(), Error> {
    let mut arguments = std::env::args_os().skip(1);
    let frames = |text: std::ffi::OsString| text.to_str().and_then(|text| text.parse().ok());
    let (Some(scene), Some(count)) = (arguments.next(), arguments.next().and_then(frames)) else {
        eprintln!("usage: turntable SCENE FRAMES [ENV]");
        std::process::exit(2);
    };
    let mut settings = Settings {
        width: 1920,
        height: 1080,
        view: View::Orbit(orbit(0.0)),
        ..Settings::default()
    };
    if let Some(file) = arguments.next() {
        settings.environment = EnvironmentSource::File(PathBuf::from(file));
    }
    let scene = load(scene, &LoadOptions::default())?;
    let plan = Plan::for_any_view(&scene, &settings)?;
    let resources = prepare(&scene, &plan)?;
    let mut renderer = Renderer::new(&scene, &plan, &resources);
    let mut times = Vec::new();
    for frame in 0..u32::max(count, 1) {
        settings.view = View::Orbit(orbit(360.0 * f64::from(frame) / f64::from(count)));
        times.push(renderer.render(&Viewpoint::of(&scene, &settings)?).times);
    }
    times.sort_by_key(|times| times.total);
    let median = times[times.len() / 2];
    let milliseconds = |time: std::time::Duration| time.as_secs_f64() * 1e3;
    println!(
        "median_frame_ms {:.1} geometry {:.1} visibility {:.1} shading {:.1} resolving {:.1}",
        milliseconds(median.total),
        milliseconds(median.geometry),
        milliseconds(median.visibility),
        milliseconds(median.shading),
        milliseconds(median.resolving),
    );
    Ok(())
}

fn orbit(azimuth_degrees: f64) -> texrender::Orbit {
    texrender::Orbit {
        azimuth_degrees: Some(azimuth_degrees),
        elevation_degrees: Some(0.0),
        ..texrender::Orbit::default()
    }
}
