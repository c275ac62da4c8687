//! What a program costs: wall time, processor time and peak memory, of the fastest of several runs.

use std::fs;
use std::process::{Child, ExitStatus};
use std::time::{Duration, Instant};

/// Times each measurement is made; the fastest counts.
pub(crate) const REPEATS: u32 = 3;
/// How often a running child is looked at.
const POLL: Duration = Duration::from_millis(2);
/// Clock ticks per second of the times in `/proc`: 100 on every Linux that Rust runs on, whatever the kernel's own.
const TICKS_PER_S: f64 = 100.0;

pub(crate) struct Cost {
    pub(crate) wall_s: f64,
    /// User and system time of all its threads, to 0.01 s; known on Linux only.
    pub(crate) cpu_s: Option<f64>,
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

/// The cost of one run, and how it ended.
pub(crate) fn once(child: std::io::Result<Child>) -> Result<(ExitStatus, Cost), String> {
    let started = Instant::now();
    watched(child.map_err(|error| format!("a measured program could not start: {error}"))?, started)
}

/// Waits for a child. Its processor time is complete once it has ended, and gone once it has been waited for, so it is
/// read in between.
fn watched(mut child: Child, started: Instant) -> Result<(ExitStatus, Cost), String> {
    let (mut peak_mib, mut cpu_s) = (0.0f64, None);
    let status = loop {
        peak_mib = peak_mib.max(peak_memory_mib(child.id()).unwrap_or_default());
        let times = times_of(child.id());
        cpu_s = times.map(|times| times.cpu_s).or(cpu_s);
        let ended = match times {
            Some(times) if times.has_ended => Some(child.wait().map_err(|error| error.to_string())?),
            Some(_) => None,
            None => child.try_wait().map_err(|error| error.to_string())?,
        };
        match ended {
            Some(status) => break status,
            None => std::thread::sleep(POLL),
        }
    };
    Ok((status, Cost { wall_s: started.elapsed().as_secs_f64(), cpu_s, peak_mib }))
}

#[derive(Clone, Copy)]
struct Times {
    has_ended: bool,
    cpu_s: f64,
}

/// State and times of a process (`man 5 proc_pid_stat`: fields 3, 14 and 15).
fn times_of(process: u32) -> Option<Times> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // the second field, the program's name in brackets, may hold blanks and brackets
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3)?.parse::<f64>().ok();
    Some(Times { has_ended: *fields.first()? == "Z", cpu_s: (ticks(14)? + ticks(15)?) / TICKS_PER_S })
}

/// Most memory that a running process has held so far.
fn peak_memory_mib(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib / 1024.0)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};

    #[test]
    fn the_time_of_a_child_is_known_after_its_end() {
        let work = "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done";
        let mut shell = Command::new("sh");
        let child = shell.args(["-c", work]).stdout(Stdio::null()).spawn().unwrap();
        let (status, cost) = watched(child, Instant::now()).unwrap();
        assert!(status.success() && cost.peak_mib > 0.1, "{} MiB", cost.peak_mib);
        // one tick is 0.01 s, and its loop takes several
        assert!(cost.cpu_s.unwrap() >= 0.01 && cost.cpu_s.unwrap() <= cost.wall_s + 0.02, "{:?}", cost.cpu_s);
    }

    #[test]
    fn a_program_that_fails_or_is_not_there_is_no_measurement() {
        assert!(fastest(|| Command::new("false").spawn()).is_err());
        assert!(fastest(|| Command::new("/no/such/program").spawn()).is_err());
    }
}
