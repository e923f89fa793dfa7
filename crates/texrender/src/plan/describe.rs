//! A plan in words, for people.

use std::fmt::{self, Write};

use super::{Coverage, Plan, PyramidNeed, TextureNeed};
use crate::scene::{AlphaMode, Scene};
use crate::settings::EnvironmentSource;

/// Which levels of a texture are kept.
fn levels(need: &TextureNeed) -> String {
    match (need.pyramid, need.finest, need.levels()) {
        (PyramidNeed::None, ..) => "no mip levels (its filter uses none)".to_owned(),
        (PyramidNeed::Full, 0, all) => format!("with {all} mip levels"),
        (PyramidNeed::Full, finest, all) => {
            format!("with mip levels {finest}.. of {all} (the view touches no finer)")
        }
    }
}

/// What a scene holds, in a few lines.
#[must_use]
pub fn scene_summary(scene: &Scene) -> String {
    let elements: usize = scene.primitives.iter().map(|p| p.indices.len()).sum();
    let drawn: usize = scene
        .instances
        .iter()
        .map(|i| scene.primitives[i.primitive].indices.len())
        .sum();
    let blended = scene
        .materials
        .iter()
        .filter(|m| m.alpha_mode == AlphaMode::Blend)
        .count();
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        // Writing to a String does not fail.
        let _ = writeln!(text, "  {what:<12}{value}");
    };
    line(
        "instances",
        format!(
            "{} of {} primitives, {drawn} triangles, lines and points ({elements} stored)",
            scene.instances.len(),
            scene.primitives.len()
        ),
    );
    line(
        "materials",
        format!("{} ({blended} blended)", scene.materials.len()),
    );
    line(
        "textures",
        format!("{} of {} images", scene.textures.len(), scene.images.len()),
    );
    let cameras: Vec<String> = scene
        .cameras
        .iter()
        .enumerate()
        .map(|(i, c)| format!("{i} '{}'", c.name))
        .collect();
    line(
        "cameras",
        format!("{} {}", scene.cameras.len(), cameras.join(", ")),
    );
    line("lights", scene.lights.len().to_string());
    text
}

impl Plan {
    /// What the picture needs and why, in lines for people. `scene` is the one the plan was made for.
    #[must_use]
    pub fn describe(&self, scene: &Scene) -> String {
        let mut text = String::new();
        // Writing to a String does not fail.
        let _ = self.write_description(scene, &mut text);
        text
    }

    fn write_description(&self, scene: &Scene, out: &mut String) -> fmt::Result {
        writeln!(
            out,
            "  view        {}x{}, {} samples a pixel, eye at {:.3}",
            self.settings.width, self.settings.height, self.settings.samples, self.viewpoint.eye
        )?;
        let count = |wanted: fn(&Coverage) -> bool| {
            self.draws
                .iter()
                .filter(|d| wanted(&self.kernels[d.kernel].coverage))
                .count()
        };
        writeln!(
            out,
            "  draws       {} opaque, {} masked, {} blended; {} instances outside the view",
            count(|c| *c == Coverage::Opaque),
            count(|c| matches!(c, Coverage::Mask { .. })),
            count(|c| *c == Coverage::Blend),
            self.culled_instances
        )?;
        self.write_textures(scene, out)?;
        for need in &self.tangents {
            writeln!(
                out,
                "  tangents    generated for '{}' from TEXCOORD_{}: a normal map, and no tangents in the file",
                scene.primitives[need.primitive].name, need.texcoord
            )?;
        }
        self.write_light(out)?;
        writeln!(
            out,
            "  memory      {:.1} MiB of textures and film",
            self.estimated_bytes() as f64 / f64::from(1 << 20)
        )?;
        for warning in scene.warnings.iter().chain(&self.warnings) {
            writeln!(out, "  warning     {warning}")?;
        }
        Ok(())
    }

    fn write_textures(&self, scene: &Scene, out: &mut String) -> fmt::Result {
        for need in &self.textures {
            writeln!(
                out,
                "  image       {} {}x{} as {:?}, {}: {}",
                scene.images[need.image].name,
                need.size.x,
                need.size.y,
                need.role,
                levels(need),
                need.reasons.join(", ")
            )?;
        }
        for need in &self.volumes {
            writeln!(
                out,
                "  volume      {} {}x{}x{} as {:?}: {}",
                scene.images[need.image].name,
                need.size.x,
                need.size.y,
                need.size.z,
                need.role,
                need.reasons.join(", ")
            )?;
        }
        let read = |i: usize| {
            let image = self.textures.iter().any(|need| need.image == i);
            image || self.volumes.iter().any(|need| need.image == i)
        };
        let unused: Vec<&str> = (0..scene.images.len())
            .filter(|&i| !read(i))
            .map(|i| scene.images[i].name.as_str())
            .collect();
        if !unused.is_empty() {
            writeln!(
                out,
                "  not opened  {}: no visible surface shows them",
                unused.join(", ")
            )?;
        }
        Ok(())
    }

    fn write_light(&self, out: &mut String) -> fmt::Result {
        match &self.environment {
            None => writeln!(
                out,
                "  environment none: no visible surface is lit by it and the background does not show it"
            )?,
            Some(need) => {
                let source = match &need.source {
                    EnvironmentSource::File(path) => path.display().to_string(),
                    EnvironmentSource::Studio | EnvironmentSource::None => "studio".to_owned(),
                };
                let levels: Vec<String> =
                    need.roughness_levels.iter().map(f32::to_string).collect();
                writeln!(
                    out,
                    "  environment {source}: {}{}",
                    if need.lights_surfaces {
                        format!("irradiance, reflections at roughness {}", levels.join(", "))
                    } else {
                        "no tables, nothing visible is lit".to_owned()
                    },
                    if need.background {
                        "; seen as the background"
                    } else {
                        ""
                    }
                )?;
            }
        }
        writeln!(out, "  lights      {} punctual", self.lights.len())
    }
}
