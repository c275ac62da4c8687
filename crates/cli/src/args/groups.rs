//! Groups of arguments that several commands share, and the parsers of their values.

use super::units::{length_m, mass_kg};
use crate::files::home_expanded;
use clap::Args;
use clap::builder::{PathBufValueParser, PossibleValuesParser, TypedValueParser};
use hovertone::experiment::time_s_from_text;
use hovertone::speed::Method;
use hovertone_vehicle::{BLADE_COUNT_MAX, CLOCK_CORRECTION_PPM_MAX, Gear};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Which tone")]
pub(crate) struct ToneArguments {
    /// Number of blades of each propeller: without --gear, hovertone follows the tone of the blades (blade pass)
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=BLADE_COUNT_MAX))]
    pub(crate) blades: Option<u32>,
    /// Teeth of the motor's pinion and of the rotor's wheel, or of the wheel alone: hovertone follows the tone of the gear
    #[arg(long, value_name = "P:W", value_parser = gear)]
    pub(crate) gear: Option<Gear>,
    /// Order of the tone: its frequency over the turns of the shaft per second, such as 2 for two blades
    #[arg(long, value_name = "X")]
    pub(crate) order: Option<f64>,
    /// Name of a known vehicle: it tells blades, gear and rotors (see `hovertone vehicles`)
    #[arg(long, value_name = "NAME")]
    pub(crate) vehicle: Option<String>,
    /// Band in which the tone lies, in Hz [default: found in the sound]
    #[arg(long, value_name = "LOW:HIGH", value_parser = band)]
    pub(crate) band: Option<(f64, f64)>,
    /// Number of harmonics (multiples of the tone) to follow; the tone itself is the first [default: 3]
    #[arg(long, value_name = "N", value_parser = whole)]
    pub(crate) harmonics: Option<u32>,
}

#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Known facts about the vehicle")]
pub(crate) struct KnownArguments {
    /// Diameter of a propeller, in m or as 24cm or 8in: it rules out speeds at which the tips are faster than Mach 0.6
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) diameter_m: Option<f64>,
    /// Mass as flown, in kg or as 413g: with --diameter-m and --rotors it rules out speeds that cannot carry the vehicle
    #[arg(long, value_name = "KG", value_parser = mass_kg)]
    pub(crate) mass_kg: Option<f64>,
    /// Number of rotors that carry the vehicle; two or more are separated [default: one, or four if several are heard]
    #[arg(long, value_name = "N", value_parser = whole)]
    pub(crate) rotors: Option<u32>,
}

#[derive(Args, Debug, Default)]
#[command(next_help_heading = "How it is analysed")]
pub(crate) struct AnalysisArguments {
    /// Find only the mean speed, without separating the rotors: this takes less time and gives a larger ±
    #[arg(long, conflicts_with = "method")]
    pub(crate) mean_only: bool,
    /// How the speed is read from the sound [default: separated for several rotors, else harmonic]
    #[arg(long, value_parser = method_parser())]
    pub(crate) method: Option<Method>,
    /// Largest error of the recorder's clock, in millionths [default: 50]
    #[arg(long, value_name = "PPM")]
    pub(crate) clock_ppm: Option<f64>,
    /// Show how strong the tone of each rotor's shaft is beside the tone of its blades: it may come from imbalance or from
    /// unequal blades. It needs --blades, and rotors that can be separated, or --rotors 1
    #[arg(long)]
    pub(crate) condition: bool,
    /// How fast the vehicle may move towards or away from the microphone, in m/s [default: 0]
    #[arg(long, value_name = "M/S")]
    pub(crate) radial_speed_m_s_max: Option<f64>,
    /// How much the distance to the microphone may change during a hover, in m or as 30cm; give 0 for a bench [default: 0.5]
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) drift_m_max: Option<f64>,
    /// Use the recording from this time on, in seconds or as 1:02.5, and leave out nothing after it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s)]
    pub(crate) from: Option<f64>,
    /// Use the recording up to this time, and leave out nothing before it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s)]
    pub(crate) to: Option<f64>,
    /// Length of a frame (a short piece of sound) in s, with --method maximum_trace or gaussian [default: from 0.0125 to 0.4, by the
    /// clearest tone]
    #[arg(long, value_name = "S")]
    pub(crate) window_s: Option<f64>,
    /// Step between frames as a share of their length, with --method maximum_trace or gaussian [default: 0.5]
    #[arg(long, value_name = "SHARE")]
    pub(crate) hop_share: Option<f64>,
    /// With --method gaussian: the part of a peak that the Gaussian is fitted to, from this share of its height upwards [default: 0.8]
    #[arg(long, value_name = "SHARE")]
    pub(crate) gaussian_threshold_share: Option<f64>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Reading files")]
pub(crate) struct HearingArguments {
    /// Audio track to hear, counted from 1 [default: the first that is not silent]
    #[arg(long, value_name = "N", value_parser = from_one)]
    pub(crate) audio_track: Option<usize>,
    /// Channel to hear, counted from 1 [default: the mean of all]
    #[arg(long, value_name = "N", value_parser = from_one)]
    pub(crate) channel: Option<usize>,
    /// Correction of the recorder's clock in millionths, as `hovertone calibrate` prints it [default: 0]
    #[arg(long, value_name = "PPM", value_parser = clock_correction)]
    pub(crate) clock_correction_ppm: Option<f64>,
    /// Show no progress bar; there is none anyway if stderr is no terminal
    #[arg(long)]
    pub(crate) no_progress: bool,
}

#[derive(Args, Debug)]
pub(crate) struct ReplaceArguments {
    /// Replace files that exist already; a file that the command reads is never replaced
    #[arg(long, help_heading = "Output")]
    pub(crate) force: bool,
}

pub(crate) fn method_parser() -> impl TypedValueParser<Value = Method> {
    let named = |name: String| Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method");
    PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(named)
}

/// A path whose leading `~` is the home folder, also behind a `=`.
pub(crate) fn typed_path() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().map(|path| home_expanded(&path))
}

/// Seconds, or minutes and seconds.
pub(crate) fn time_s(text: &str) -> Result<f64, String> {
    time_s_from_text(text).ok_or_else(|| {
        let known = "write seconds, such as 62.5, or minutes and seconds, such as 1:02.5";
        time_meant(text.trim()).unwrap_or_else(|| known.to_owned())
    })
}

/// What to write in place of a time with a unit, or with 60 seconds and more behind its minutes.
fn time_meant(text: &str) -> Option<String> {
    if let Some((minutes, seconds)) = text.split_once(':') {
        let (minutes, seconds): (u32, f64) = (minutes.parse().ok()?, seconds.parse().ok()?);
        let meant_s = 60.0 * f64::from(minutes) + seconds;
        let fault = "the seconds behind the minutes must be below 60";
        return (seconds >= 60.0).then(|| format!("{fault}; if you mean {meant_s} seconds, write {meant_s}"));
    }
    let number = text.trim_end_matches(char::is_alphabetic).trim_end();
    let value: f64 = number.parse().ok()?;
    match text.strip_prefix(number)?.trim() {
        "s" | "sec" | "seconds" => Some(format!("a time has no unit; write {number}")),
        "m" | "min" | "minutes" => Some(format!("a time has no unit, and is in seconds; write {}", 60.0 * value)),
        _ => None,
    }
}

/// A whole number in a range.
pub(crate) fn whole_number<T: FromStr + Display + PartialOrd + Clone>(
    allowed: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| allowed.contains(number));
        number.ok_or_else(|| format!("must be a whole number from {} to {}", allowed.start(), allowed.end()))
    }
}

fn clock_correction(text: &str) -> Result<f64, String> {
    let limit = CLOCK_CORRECTION_PPM_MAX;
    let ppm = finite(text).filter(|ppm| ppm.abs() <= limit);
    ppm.ok_or_else(|| format!("must be a number from -{limit} to {limit}: no clock is further off"))
}

/// A whole number, whose range the analysis checks.
fn whole(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "must be a whole number, 1 or more".to_owned())
}

fn from_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("must be 1 or more: it is counted from 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("must be a whole number, counted from 1".to_owned()),
    }
}

/// "8:69", or the wheel alone. A pinion that was not said makes no difference to the tone; it is taken as 1.
pub(crate) fn gear(text: &str) -> Result<Gear, String> {
    let teeth = |text: &str| match text.trim().parse::<u32>() {
        Ok(teeth @ 1..=1000) => Ok(teeth),
        _ => Err("write the teeth as PINION:WHEEL, such as 8:69, or the wheel's alone".to_owned()),
    };
    match text.split_once(':') {
        Some((pinion, wheel)) => Ok(Gear { pinion: teeth(pinion)?, wheel: teeth(wheel)? }),
        None => Ok(Gear { pinion: 1, wheel: teeth(text)? }),
    }
}

/// "100:200".
pub(crate) fn band(text: &str) -> Result<(f64, f64), String> {
    let edges = text.split_once(':').and_then(|(low, high)| Some((finite(low)?, finite(high)?)));
    edges.ok_or_else(|| "write the band as LOW:HIGH in Hz, such as 4000:4300".to_owned())
}

pub(crate) fn finite(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gears_and_bands_are_read() {
        assert_eq!(gear("8:69"), Ok(Gear { pinion: 8, wheel: 69 }));
        assert_eq!(gear("69").map(|gear| gear.wheel), Ok(69));
        assert!(gear("8:").is_err() && gear("0").is_err() && gear("8:69:1").is_err());
        assert_eq!(band("4000:4300.5"), Ok((4000.0, 4300.5)));
        assert!(band("4000").is_err() && band("a:b").is_err() && band("1:inf").is_err());
    }
}
