//! What a program costs: wall time and peak memory, of the fastest of several runs.

use std::fs;
use std::process::{Child, ExitStatus};
use std::time::{Duration, Instant};

/// Times each measurement is made; the fastest counts.
pub(crate) const REPEATS: u32 = 3;
/// How often a running child is looked at.
const POLL: Duration = Duration::from_millis(2);

pub(crate) struct Cost {
    pub(crate) wall_s: f64,
    /// Known on Linux only; 0 elsewhere.
    pub(crate) peak_mib: f64,
}

/// The cost of the run that took least time.
pub(crate) fn fastest(mut start: impl FnMut() -> std::io::Result<Child>) -> Result<Cost, String> {
    let mut best: Option<Cost> = None;
    for _ in 0..REPEATS {
        let started = Instant::now();
        let child = start().map_err(|error| format!("a measured program could not start: {error}"))?;
        let (status, cost) = watched(child, started)?;
        if !status.success() {
            return Err(format!("a measured program failed: {status}"));
        }
        if best.as_ref().is_none_or(|best| cost.wall_s < best.wall_s) {
            best = Some(cost);
        }
    }
    best.ok_or_else(|| "nothing was measured".to_owned())
}

fn watched(mut child: Child, started: Instant) -> Result<(ExitStatus, Cost), String> {
    let mut peak_mib = 0.0f64;
    let status = loop {
        peak_mib = peak_mib.max(peak_memory_mib(child.id()).unwrap_or_default());
        match child.try_wait().map_err(|error| error.to_string())? {
            Some(status) => break status,
            None => std::thread::sleep(POLL),
        }
    };
    Ok((status, Cost { wall_s: started.elapsed().as_secs_f64(), peak_mib }))
}

/// Most memory that a running process has held so far.
fn peak_memory_mib(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib / 1024.0)
}
