//! The text before the frames of a log: which values a frame has, how they are written and predicted, and the units of some.

use super::encoding::FrameLayout;
use super::main_frames::Prediction;
use crate::electrical::{HUNDREDS_RPM, USUAL_POLES, rev_s_of_electrical_rpm};
use crate::table::{SignalRole, TableSignal};
use crate::{LogError, LogFormat};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Version of the format that is read.
const VERSION: &str = "2";
/// Values that a header leaves out (`blackbox-tools`, `parser.c`).
const MIN_THROTTLE: i32 = 1150;
const BATTERY_REFERENCE: i32 = 4095;
/// Factor of gyro values in logs of high resolution.
const HIGH_RESOLUTION: f64 = 10.0;

/// A signal of the main frames.
pub(super) struct MainSignal {
    pub(super) signal: TableSignal,
    /// Number of the value in the frame.
    pub(super) field: usize,
    pub(super) is_signed: bool,
    /// Unit of the signal per unit of the value.
    pub(super) factor: f64,
}

/// The lines of a header, by their names.
pub(super) struct Header {
    lines: HashMap<String, String>,
}

impl Header {
    /// The lines from the first one, and the number of their bytes.
    pub(super) fn parse(bytes: &[u8]) -> (Self, usize) {
        let mut lines = HashMap::new();
        let mut at = 0;
        while let Some(line) = bytes[at..].strip_prefix(b"H ") {
            let Some(length) = line.iter().position(|byte| *byte == b'\n') else { break };
            let text = String::from_utf8_lossy(&line[..length]);
            if let Some((name, value)) = text.split_once(':') {
                lines.insert(name.to_owned(), value.trim().to_owned());
            }
            at += 2 + length + 1;
        }
        (Self { lines }, at)
    }

    /// # Errors
    /// Another version of the format.
    pub(super) fn check_version(&self) -> Result<(), LogError> {
        match self.lines.get("Data version") {
            Some(version) if version != VERSION => {
                Err(LogError::OtherVersion { format: LogFormat::Blackbox, version: version.clone(), known: VERSION })
            }
            _ => Ok(()),
        }
    }

    fn number(&self, name: &str) -> Option<i32> {
        self.lines.get(name)?.split(',').next()?.trim().parse().ok()
    }

    fn list(&self, name: &str) -> Option<Vec<&str>> {
        self.lines.get(name).map(|line| line.split(',').map(str::trim).collect())
    }

    fn numbers(&self, name: &str) -> Option<Vec<u32>> {
        self.list(name)?.into_iter().map(|number| number.parse().ok()).collect()
    }

    /// How the values of a kind of frames are written.
    pub(super) fn layout(&self, letter: &str) -> Option<FrameLayout> {
        FrameLayout::of(&self.numbers(&format!("Field {letter} encoding"))?)
    }

    /// Names of the values of a main frame.
    pub(super) fn names(&self) -> Option<Vec<&str>> {
        self.list("Field I name")
    }

    /// Whether the values of a main frame have signs.
    pub(super) fn signs(&self) -> Option<Vec<bool>> {
        Some(self.list("Field I signed")?.into_iter().map(|sign| sign != "0").collect())
    }

    /// How the values of a kind of main frames are predicted; `None` for an unknown prediction.
    pub(super) fn predictions(&self, letter: &str) -> Option<Vec<Prediction>> {
        let names = self.names()?;
        let first_motor = names.iter().position(|name| *name == "motor[0]");
        let numbers = self.numbers(&format!("Field {letter} predictor"))?;
        let signs = self.signs().filter(|signs| signs.len() == numbers.len())?;
        let prediction = |(number, is_signed): (u32, bool)| {
            Some(match number {
                0 => Prediction::Constant(0),
                1 => Prediction::Previous,
                2 => Prediction::StraightLine,
                3 => Prediction::Average { is_signed },
                4 => Prediction::Constant(self.number("minthrottle").unwrap_or(MIN_THROTTLE)),
                5 => Prediction::Field(first_motor?),
                6 => Prediction::Increment,
                8 => Prediction::Constant(1500),
                9 => Prediction::Constant(self.number("vbatref").unwrap_or(BATTERY_REFERENCE)),
                11 => Prediction::Constant(self.number("motorOutput").unwrap_or(0)),
                _ => return None,
            })
        };
        numbers.into_iter().zip(signs).map(prediction).collect()
    }

    /// Of each `I interval` loops the first is written as a whole; of the others, numerator of denominator are written.
    pub(super) fn intervals(&self) -> [u32; 3] {
        let positive = |number: &str| number.trim().parse().ok().filter(|number| *number > 0);
        let whole = self.lines.get("I interval").and_then(|text| positive(text)).unwrap_or(1);
        let text = self.lines.get("P interval").map_or("1", String::as_str);
        let (numerator, denominator) = text.split_once('/').unwrap_or(("1", text));
        [whole, positive(numerator).unwrap_or(1), positive(denominator).unwrap_or(1)]
    }

    /// The values of a main frame but its number and its time.
    pub(super) fn main_signals(&self) -> Vec<MainSignal> {
        let names = self.names().unwrap_or_default();
        let signs = self.signs().unwrap_or_default();
        let is_signal = |name: &&&str| !["loopIteration", "time"].contains(*name);
        let fields = names.iter().enumerate().filter(|(_, name)| is_signal(name));
        fields
            .map(|(field, name)| {
                let (signal, factor) = self.signal(name);
                MainSignal { signal, field, is_signed: signs.get(field).copied().unwrap_or(true), factor }
            })
            .collect()
    }

    fn signal(&self, name: &str) -> (TableSignal, f64) {
        let index = |field: &str| -> Option<u32> {
            name.strip_prefix(field)?.strip_prefix('[')?.strip_suffix(']')?.parse().ok()
        };
        let with_role = |role: SignalRole, factor: f64| (TableSignal::with_role(name.to_owned(), role), factor);
        if let Some(motor) = index("motor") {
            return with_role(SignalRole::Command(motor + 1), 1.0);
        }
        if let Some(motor) = index("eRPM") {
            let poles = self.lines.get("motor_poles").and_then(|poles| poles.parse().ok());
            let poles = poles.filter(|poles: &f64| *poles >= 2.0).unwrap_or(USUAL_POLES);
            return with_role(SignalRole::RotorSpeed(motor + 1), HUNDREDS_RPM * rev_s_of_electrical_rpm(poles));
        }
        match (index("gyroADC").filter(|axis| *axis < 3), self.gyro_rad_s()) {
            (Some(axis), Some(factor)) => with_role(SignalRole::BodyRate(axis as usize), factor),
            _ => (TableSignal::plain(name.to_owned()), 1.0),
        }
    }

    /// Body rate of one unit of a gyro value. Its scale is in degrees, but in Baseflight in radians per microsecond.
    fn gyro_rad_s(&self) -> Option<f64> {
        let scale = self.lines.get("gyro_scale").or_else(|| self.lines.get("gyro.scale"))?;
        let bits = u32::from_str_radix(scale.strip_prefix("0x")?, 16).ok()?;
        let scale = Some(f64::from(f32::from_bits(bits))).filter(|scale| scale.is_finite() && *scale > 0.0)?;
        let is_baseflight = self.lines.get("Firmware type").is_some_and(|firmware| firmware == "Baseflight");
        let scale_rad_s = if is_baseflight { 1e6 * scale } else { scale * TAU / 360.0 };
        let is_high = self.lines.get("blackbox_high_resolution").is_some_and(|text| text == "1");
        Some(if is_high { scale_rad_s / HIGH_RESOLUTION } else { scale_rad_s })
    }
}
