//! Arguments about the labels of the rotors.

use super::groups::{time_s, typed_path};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Largest offset of two clocks, s. *Physics*: no clock counts seconds from before 1970, and this is the year 2286.
const CLOCK_OFFSET_S_MAX: f64 = 1e10;

#[derive(Args, Debug)]
#[command(next_help_heading = "Which rotor is which")]
pub(crate) struct LabelArguments {
    /// Log of the same flight (PX4, ArduPilot, Betaflight or CSV), with speeds or commands of the motors, or body rates
    #[arg(long, value_name = "FILE", value_parser = typed_path(), conflicts_with = "mean_only")]
    pub(crate) log: Option<PathBuf>,
    /// Limits of the offset: the time to add to the log's clock to get that of the recording, -5:5 in seconds or -0:05..0:05 [default:
    /// none]
    #[arg(long, value_name = "LOW:HIGH", value_parser = offsets, allow_hyphen_values = true, requires = "log")]
    pub(crate) log_offset_s: Option<(f64, f64)>,
    /// Axes of the body rates in a CSV; other logs define them
    #[arg(long, value_name = "AXES", requires = "log")]
    pub(crate) log_axes: Option<BodyAxes>,
    /// Sequence in which the motors start, one by one, at the beginning of the recording: front-left,…; or 1,2,…
    #[arg(long, value_name = "ROTOR,ROTOR,…", value_delimiter = ',', conflicts_with_all = ["log", "mean_only"])]
    pub(crate) spin_up: Option<Vec<String>>,
    /// Where the four rotors stand [default: the vehicle's]
    #[arg(long, value_name = "LAYOUT", requires = "log")]
    pub(crate) layout: Option<FrameLayout>,
    /// File with the position of the microphone of each channel: loudness and delay of the sound show which rotor is which
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["log", "spin_up", "mean_only"], value_parser = typed_path())]
    pub(crate) microphones: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum BodyAxes {
    /// x forward, y left, z up
    Flu,
    /// x forward, y right, z down: PX4, ArduPilot
    Frd,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FrameLayout {
    /// front left, rear left, rear right, front right
    X,
    /// front, left, rear, right
    Plus,
}

/// "-5:5", or "-0:05..1:10".
pub(super) fn offsets(text: &str) -> Result<(f64, f64), String> {
    let halves = text.split_once("..").or_else(|| text.split_once(':'));
    let limits = halves.and_then(|(low, high)| Some((clock_offset_s(low).ok()?, clock_offset_s(high).ok()?)));
    match limits {
        Some((low_s, high_s)) if low_s > high_s => {
            Err(format!("the two numbers are exchanged: write the smaller one first, {high_s}:{low_s}"))
        }
        Some(limits) => Ok(limits),
        None => Err("a range is needed: the smallest and the largest offset in seconds, as in -5:5 (from −5 s to 5 s); if you know the offset, give a small range around it"
            .to_owned()),
    }
}

/// The offset of one clock to another: "2.5", or "-0:05".
pub(super) fn clock_offset_s(text: &str) -> Result<f64, String> {
    let offset_s = time_s(text).ok().filter(|offset_s| offset_s.abs() <= CLOCK_OFFSET_S_MAX);
    offset_s.ok_or_else(|| {
        format!("write seconds, such as 2.5, or minutes and seconds, such as -0:05; at most {CLOCK_OFFSET_S_MAX:e} s")
    })
}

#[cfg(test)]
mod tests {
    use super::{clock_offset_s, offsets};

    #[test]
    fn offsets_are_seconds_or_minutes_and_seconds() {
        assert_eq!(clock_offset_s("-1764000000.5"), Ok(-1_764_000_000.5), "a clock that counts from 1970");
        assert!(["nan", "inf", "1e11", "soon"].into_iter().all(|text| clock_offset_s(text).is_err()));
        assert_eq!(offsets("-5:5"), Ok((-5.0, 5.0)));
        assert_eq!(offsets("-0:05..1:10.5"), Ok((-5.0, 70.5)));
        assert_eq!(offsets("-5..5"), Ok((-5.0, 5.0)));
        assert!(
            offsets("5").is_err() && offsets("a:b").is_err() && offsets("1:inf").is_err() && offsets("5:1").is_err()
        );
        assert_eq!(offsets("3:1"), Err("the two numbers are exchanged: write the smaller one first, 1:3".to_owned()));
    }
}
