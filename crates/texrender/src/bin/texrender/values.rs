//! Values of the command line, from text.

use fearless_simd::Level;
use std::path::PathBuf;

use glam::DVec3;
use texrender::{Aov, BitDepth, EnvironmentSource, FragmentMerging, Show};

pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let parse = || {
        let (width, height) = text.split_once(['x', 'X'])?;
        Some((width.trim().parse().ok()?, height.trim().parse().ok()?))
    };
    parse().ok_or_else(|| "write width x height in pixels, such as 1920x1080".to_owned())
}

pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
    match parts.as_deref() {
        Some(&[x, y, z]) if DVec3::new(x, y, z).is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err("write three finite numbers, such as 1,2.5,-3".to_owned()),
    }
}

pub(crate) fn finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x: &f32| x.is_finite())
        .ok_or_else(|| "write a finite number".to_owned())
}

pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x >= 0.0)
        .ok_or_else(|| "write seconds, 0 or more".to_owned())
}

pub(crate) fn threads(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (1..=1024).contains(n))
        .ok_or_else(|| "write a number of threads, 1 to 1024".to_owned())
}

pub(crate) fn frames(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (1..=100_000).contains(n))
        .ok_or_else(|| "write a number of frames, 1 to 100000".to_owned())
}

/// An instruction set, if the machine has it.
pub(crate) fn simd(text: &str) -> Result<Level, String> {
    let best = Level::new();
    let level = match text {
        "best" => Some(best),
        #[cfg(target_arch = "x86_64")]
        "avx2" => best.as_avx2().map(Level::Avx2),
        #[cfg(target_arch = "x86_64")]
        "sse4.2" => best.as_sse4_2().map(Level::Sse4_2),
        #[cfg(target_arch = "x86_64")]
        "sse2" => best.as_sse2().map(Level::Sse2),
        _ => return Err("choose best, avx2, sse4.2 or sse2".to_owned()),
    };
    level.ok_or_else(|| format!("this machine has no {text}"))
}

pub(crate) fn bit_depth(text: &str) -> Result<BitDepth, String> {
    match text {
        "8" => Ok(BitDepth::Eight),
        "16" => Ok(BitDepth::Sixteen),
        _ => Err("choose 8 or 16".to_owned()),
    }
}

pub(crate) fn merging(text: &str) -> Result<FragmentMerging, String> {
    match text {
        "neighbours" => Ok(FragmentMerging::Neighbours),
        "never" => Ok(FragmentMerging::Never),
        _ => Err("choose neighbours or never".to_owned()),
    }
}

pub(crate) fn show(text: &str) -> Result<Show, String> {
    let found = Show::ALL.into_iter().find(|show| show.name() == text);
    found.ok_or_else(|| format!("choose {}", Show::ALL.map(Show::name).join(", ")))
}

pub(crate) fn aov(text: &str) -> Result<(Aov, PathBuf), String> {
    let names: Vec<&str> = Aov::ALL.iter().map(|a| a.name()).collect();
    let usage = || {
        format!(
            "write NAME=FILE with one of {} as its name",
            names.join(", ")
        )
    };
    let (name, path) = text.split_once('=').ok_or_else(usage)?;
    let aov = Aov::ALL.into_iter().find(|a| a.name() == name);
    match aov {
        Some(aov) if !path.is_empty() => Ok((aov, PathBuf::from(path))),
        _ => Err(usage()),
    }
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "a value parser returns a Result; a wrong file name is found when it is read"
)]
pub(crate) fn environment(text: &str) -> Result<EnvironmentSource, String> {
    Ok(match text {
        "studio" => EnvironmentSource::Studio,
        "none" => EnvironmentSource::None,
        path => EnvironmentSource::File(PathBuf::from(path)),
    })
}

/// A size with an optional unit: bytes, or K, M, G with or without iB.
pub(crate) fn memory(text: &str) -> Result<u64, String> {
    let lower = text.trim().to_ascii_lowercase();
    let number = lower.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let shift = match &lower[number.len()..] {
        "" | "b" => Some(0),
        "k" | "kb" | "kib" => Some(10),
        "m" | "mb" | "mib" => Some(20),
        "g" | "gb" | "gib" => Some(30),
        _ => None,
    };
    let value: Option<u64> = number.trim().parse().ok();
    shift
        .zip(value)
        .and_then(|(shift, value)| value.checked_mul(1 << shift))
        .filter(|&bytes| bytes > 0)
        .ok_or_else(|| "write a size such as 512MiB or 4GiB".to_owned())
}
