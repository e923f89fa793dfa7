//! What a run cost, as JSON.

use std::time::{Duration, Instant};

use serde::Serialize;
use texrender::prepare::PrepareCounts;
use texrender::render::RenderCounts;

/// Figures of one run.
#[derive(Default, Serialize)]
pub(crate) struct Stats {
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    pub threads: usize,
    pub milliseconds: StageTimes,
    /// Largest resident memory of the process; `null` where the system does not tell.
    pub peak_memory_bytes: Option<u64>,
    /// Images in the scene file.
    pub images_listed: usize,
    pub prepare: PrepareCounts,
    pub render: RenderCounts,
    pub instances_culled: usize,
    pub warnings: Vec<String>,
}

/// Wall time of each stage.
#[derive(Default, Serialize)]
pub(crate) struct StageTimes {
    pub load: f64,
    pub plan: f64,
    pub prepare: f64,
    pub render: f64,
    pub finish: f64,
    pub total: f64,
}

/// Times one stage after another.
pub(crate) struct Stopwatch {
    start: Instant,
    lap: Instant,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        let now = Instant::now();
        Self {
            start: now,
            lap: now,
        }
    }

    /// Milliseconds since the last lap.
    pub(crate) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = milliseconds(now - self.lap);
        self.lap = now;
        lap
    }

    /// Milliseconds since the start.
    pub(crate) fn total(&self) -> f64 {
        milliseconds(self.start.elapsed())
    }
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

/// Largest resident memory of this process so far, from the kernel's own count.
pub(crate) fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib << 10)
}
