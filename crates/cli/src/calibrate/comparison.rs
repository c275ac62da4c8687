//! A heard speed against the known one, in words and as JSON.

use super::clock_words::clock_in_words;
use super::{BAND_SHARE, MILLION, OPEN, band_around};
use crate::args::CalibrateArguments;
use crate::failure::Failure;
use crate::order_words::{times, times_per_turn};
use crate::vehicles::preset;
use hovertone::calibration::{Judgement, KnownSpeed, Relation, SpeedCheck, check_against};
use hovertone_report::{fixed, printable, with_uncertainty};
use hovertone_vehicle::{BLADES_MAX, CLOCK_CORRECTION_PPM_MAX, COVERAGE_FACTOR, Gear, Order, RotorSpeed};
use serde_json::json;

const SECONDS_PER_MINUTE: f64 = 60.0;
/// Share by which the known speed of one rotor may differ from the mean of several. *Decision.*
const ROTORS_SHARE: f64 = 0.25;
/// A ratio of the heard and the known speed is a whole number if it is this near, as a share.
const SLIP_SHARE: f64 = 0.1;
/// A speed that nobody measured is told to this, rpm.
const ROUNDED_RPM: f64 = 10.0;
/// Millionths in a hundredth.
const PPM_PER_PERCENT: f64 = 1e4;
/// Largest error of a clock.
pub(super) const CLOCK_PERCENT_MAX: f64 = CLOCK_CORRECTION_PPM_MAX / PPM_PER_PERCENT;

/// What is known.
#[derive(Clone, Copy)]
pub(super) enum Reference {
    /// The speed of the shaft.
    Speed { rpm: f64, std_share: f64 },
    /// The frequency of the tone.
    Tone { hz: f64, std_share: f64 },
}

impl Reference {
    /// Standard uncertainty of the number, as a share; 0 where none is given.
    pub(super) fn std_share(self) -> f64 {
        let (Self::Speed { std_share, .. } | Self::Tone { std_share, .. }) = self;
        std_share
    }

    /// What is known, in one word.
    pub(super) fn quantity(self) -> &'static str {
        match self {
            Self::Speed { .. } => "speed",
            Self::Tone { .. } => "frequency",
        }
    }
}

/// What was heard.
#[derive(Clone, Copy)]
pub(super) struct HeardSpeed {
    pub(super) speed: RotorSpeed,
    pub(super) std_rev_s: Option<f64>,
    pub(super) order: Order,
    /// The order of the tone is a claim that the known speed checks.
    pub(super) is_rotor: bool,
}

/// A heard speed, what was known, and their comparison.
pub(super) struct Comparison {
    heard: HeardSpeed,
    pub(super) reference: Reference,
    pub(super) check: SpeedCheck,
}

impl Comparison {
    pub(super) fn of(heard: HeardSpeed, reference: Reference) -> Result<Self, Failure> {
        let known = match reference {
            Reference::Speed { rpm, std_share } => KnownSpeed { speed: RotorSpeed::from_rpm(rpm), std_share },
            Reference::Tone { hz, std_share } => {
                KnownSpeed { speed: RotorSpeed::from_tone_hz(hz, heard.order), std_share }
            }
        };
        let std_share = heard.std_rev_s.unwrap_or(0.0) / heard.speed.rev_s();
        let check = check_against(heard.speed, std_share, heard.order, known).map_err(Failure::internal)?;
        Ok(Self { heard, reference, check })
    }

    /// The known and the heard number in the unit of the known one.
    fn pair(&self) -> (String, String) {
        let in_unit = |factor: f64| {
            let value = self.heard.speed.rev_s() * factor;
            with_uncertainty(value, self.heard.std_rev_s.map(|std| std * factor))
        };
        let known = |value: f64, std_share: f64, unit: &str| match std_share > 0.0 {
            true => format!("{} {unit}", with_uncertainty(value, Some(std_share * value))),
            false => format!("{value} {unit}, taken as exact"),
        };
        match self.reference {
            Reference::Speed { rpm, std_share } => {
                (known(rpm, std_share, "rpm"), format!("{} rpm", in_unit(SECONDS_PER_MINUTE)))
            }
            Reference::Tone { hz, std_share } => {
                (known(hz, std_share, "Hz"), format!("{} Hz", in_unit(self.heard.order.lines_per_turn())))
            }
        }
    }

    /// Whether this many lines per turn, in place of the given ones, make the known speed.
    pub(super) fn fits_order(&self, lines_per_turn: f64) -> bool {
        matches!(self.check.relation, Relation::OtherOrder(fitting) if fitting.lines_per_turn() == lines_per_turn)
    }

    /// Whether the heard speed is the known one, but for an error that a clock may have.
    pub(super) fn agrees(&self) -> bool {
        self.check.relation == Relation::Agrees
    }

    /// Whether the known number has more of the ± than the heard one.
    pub(super) fn is_known_the_less_exact(&self) -> bool {
        self.reference.std_share() >= self.heard.std_rev_s.unwrap_or(0.0) / self.heard.speed.rev_s()
    }

    /// The smaller of the ± of the known number and that of the heard one, ppm.
    pub(super) fn least_expanded_ppm(&self) -> f64 {
        let heard = self.heard.std_rev_s.unwrap_or(0.0) / self.heard.speed.rev_s();
        COVERAGE_FACTOR * MILLION * heard.min(self.reference.std_share())
    }

    /// The band around the tone that the known speed and the given order mean.
    fn band(&self) -> String {
        let tone_hz = self.heard.speed.tone_hz(self.heard.order) / self.check.heard_over_known;
        band_around(tone_hz)
    }

    /// The known number that was probably meant, where the given one is that of something else: a question, and what to give.
    fn slip(&self, arguments: &CalibrateArguments) -> Option<String> {
        let is_ratio = |ratio: f64| (self.check.heard_over_known / ratio - 1.0).abs() < BAND_SHARE;
        let order = self.heard.order.lines_per_turn();
        match self.reference {
            Reference::Speed { rpm, .. } if is_ratio(SECONDS_PER_MINUTE) => Some(in_turns_per_second(rpm)),
            Reference::Speed { rpm, .. } => {
                let gear = gear_of(arguments).filter(|gear| is_ratio(1.0 / gear.ratio()))?;
                Some(format!(
                    "Is the known speed the speed of the motor? Then give the speed of the rotor, after the gear \
                     {}:{}: --tachometer-rpm {}",
                    gear.pinion,
                    gear.wheel,
                    to_tenths(rpm / gear.ratio())
                ))
            }
            Reference::Tone { hz, .. } if self.heard.is_rotor && order > 1.0 && is_ratio(order) => Some(format!(
                "Does the shaft turn {hz} times per second? Then give --tachometer-rpm {}",
                to_tenths(RotorSpeed::from_rev_s(hz).rpm())
            )),
            Reference::Tone { .. } => None,
        }
    }

    /// The correction for the setting: on top of the one with which the recording was opened.
    pub(super) fn whole_correction_ppm(&self, before_ppm: f64) -> f64 {
        MILLION * ((1.0 + before_ppm / MILLION) * (1.0 + self.check.correction_ppm / MILLION) - 1.0)
    }
}

fn in_turns_per_second(rpm: f64) -> String {
    let right = to_tenths(SECONDS_PER_MINUTE * rpm);
    format!("Does the rotor turn {rpm} times per second, not per minute? Then give --tachometer-rpm {right}")
}

/// What is heard where no speed is measured, and how the known speed may have become another one: in words that follow a sentence.
pub(super) fn heard_beside_known(reference: Reference, heard: RotorSpeed) -> Option<String> {
    let Reference::Speed { rpm, .. } = reference else { return None };
    let ratio = heard.rpm() / rpm;
    let is_near = |of_slip: f64, share: f64| (ratio / of_slip - 1.0).abs() < share;
    if is_near(SECONDS_PER_MINUTE, ROTORS_SHARE) {
        return Some(format!(". But first check the unit. {}", in_turns_per_second(rpm)));
    }
    let about = ROUNDED_RPM * (heard.rpm() / ROUNDED_RPM).round();
    let of_known = |slip: f64| match slip {
        0.5 => "half of the known speed".to_owned(),
        slip => format!("{slip} times the known speed"),
    };
    let slip = [2.0, 3.0, 4.0, 0.5].into_iter().find(|slip| is_near(*slip, SLIP_SHARE));
    let checked = |slip| {
        format!(
            "; on average, the heard speed is about {about} rpm, {}: check the number of blades, also in the settings of the tachometer",
            of_known(slip)
        )
    };
    Some(slip.map_or_else(|| format!("; on average, the heard speed is about {about} rpm"), checked))
}

/// The comparison for people.
pub(super) fn in_words(name: &str, comparison: &Comparison, arguments: &CalibrateArguments) -> String {
    let (known, heard) = comparison.pair();
    let order = if comparison.heard.is_rotor { format!(", order {}", comparison.heard.order) } else { String::new() };
    let what = comparison.reference.quantity();
    let is_rounded = arguments.known_std_ppm.is_none() && comparison.reference.std_share() > 0.0;
    let digit = match is_rounded {
        true => format!("; the ± of the known {what} is its rounding to the last digit that was given"),
        false => String::new(),
    };
    let plus_minus =
        format!("(k = 2; the ± of the heard {what} does not include the error of the recorder's clock{digit})");
    let mut text = format!("{}: known {known}, heard {heard}{order} {plus_minus}\n", printable(name));
    text += &order_in_words(comparison, arguments);
    // of a speed that may be another one, no clock is told
    if comparison.agrees() {
        text += &clock_in_words(comparison, arguments);
    }
    text + &result_in_words(comparison, arguments.clock_ppm)
}

/// The last line: the judgement, and which part of the check it comes from.
fn result_in_words(comparison: &Comparison, clock_ppm: f64) -> String {
    let judgement = comparison.check.judgement(clock_ppm);
    let reason = match (judgement, comparison.check.relation) {
        (Judgement::Passes, _) => "",
        (Judgement::Undecided, _) => " (clock)",
        (Judgement::Fails, Relation::Agrees) => " (clock)",
        (Judgement::Fails, Relation::None) => " (the known value does not fit)",
        (Judgement::Fails, _) if comparison.heard.is_rotor => " (blades or gear)",
        (Judgement::Fails, _) => " (tone)",
    };
    format!("result: {}{reason}\n", word(judgement))
}

pub(super) fn word(judgement: Judgement) -> &'static str {
    match judgement {
        Judgement::Passes => "pass",
        Judgement::Fails => "fail",
        Judgement::Undecided => "not decided",
    }
}

/// A number to be typed, without the digits of binary fractions.
pub(super) fn to_tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// The gear between the motor and the rotor, as given or of the vehicle.
fn gear_of(arguments: &CalibrateArguments) -> Option<Gear> {
    let vehicle = arguments.tone.vehicle.as_deref().and_then(|name| preset(name).ok());
    arguments.tone.gear.or_else(|| vehicle?.gear.map(|gear| gear.value))
}

fn order_in_words(comparison: &Comparison, arguments: &CalibrateArguments) -> String {
    let Comparison { check, heard: HeardSpeed { order, is_rotor, .. }, .. } = comparison;
    let ratio = fixed(check.heard_over_known, 4);
    let what = comparison.reference.quantity();
    // a wrong digit at the end changes a number by a tenth at most
    let is_near = (check.heard_over_known - 1.0).abs() < 0.1;
    let last_digit = if is_near { ", and to the last digit" } else { "" };
    match check.relation {
        Relation::Agrees if !is_rotor => String::new(),
        Relation::Agrees => format!("blades or gear: pass, the tone sounds {}\n", times_per_turn(*order)),
        _ if let Some(slip) = comparison.slip(arguments) => {
            format!("blades or gear: fail. The heard {what} is {ratio} times the known {what}. {slip}\n")
        }
        Relation::OtherOrder(fitting) if *is_rotor => {
            format!(
                "blades or gear: fail. The heard {what} is {ratio} times the known {what}. One of these three is wrong:\n"
            ) + &other_order_in_words(comparison, fitting, arguments)
        }
        _ if !is_rotor => format!(
            "tone: fail. The heard frequency is {ratio} times the known frequency. The clock is not the reason: no \
             clock is off by more than {CLOCK_PERCENT_MAX} %. Check the known frequency, and whether the file was \
             resampled or slowed down.\n"
        ),
        _ => format!(
            "blades or gear: fail. The heard {what} is {ratio} times the known {what}. No other number of blades and no gear gives \
             this ratio, and no clock is off by more than {CLOCK_PERCENT_MAX} %. Check the known {what}: was it read \
             during this recording{last_digit}? If the known {what} is right, another rotor was heard, or \
             the file was resampled or slowed down.\n"
        ),
    }
}

/// What may be wrong where another order fits, and what to give then: one line each.
fn other_order_in_words(comparison: &Comparison, fitting: Order, arguments: &CalibrateArguments) -> String {
    let order = comparison.heard.order;
    let known = match comparison.reference {
        Reference::Speed { rpm, .. } => format!(
            "  the known speed: a tachometer with a wrong number of blades in its settings shows a wrong speed. If this \
             is so, give --tachometer-rpm {}\n",
            to_tenths(rpm * fitting.lines_per_turn() / order.lines_per_turn())
        ),
        Reference::Tone { .. } => "  the known frequency: it may belong to another harmonic of the tone\n".to_owned(),
    };
    let without_vehicle = if arguments.tone.vehicle.is_some() { "leave --vehicle out and " } else { "" };
    let as_blades = if fitting.lines_per_turn() <= BLADES_MAX && fitting.lines_per_turn().fract() == 0.0 {
        format!(" (for the tone of the blades, --blades {fitting})")
    } else {
        String::new()
    };
    format!(
        "{known}  the blades or the gear: the tone may sound {}, not {}. If so, {without_vehicle}give --order \
         {fitting}{as_blades}; in an experiment file, write order = {fitting} under [tone]\n  the tone that was heard: \
         to hear only the tone at the known speed, give --band {}\n",
        times_per_turn(fitting),
        times(order),
        comparison.band()
    )
}

/// One JSON object. `passes` is null where the ± leaves it open.
pub(super) fn as_json(
    name: &str,
    status: &str,
    reason: Option<&str>,
    comparison: Option<&Comparison>,
    arguments: &CalibrateArguments,
) -> String {
    let before_ppm = arguments.hearing.clock_correction_ppm.unwrap_or(0.0);
    let of_check = |of: &dyn Fn(&SpeedCheck) -> f64| comparison.map(|comparison| of(&comparison.check));
    let heard = comparison.map(|comparison| comparison.heard);
    let judgement = comparison.map(|comparison| comparison.check.judgement(arguments.clock_ppm));
    json!({
        "file": name,
        "status": status,
        "passes": match judgement {
            Some(Judgement::Passes) => Some(true),
            Some(Judgement::Undecided) => None,
            None if OPEN.contains(&status) => None,
            Some(Judgement::Fails) | None => Some(false),
        },
        "order": heard.map(|heard| heard.order.lines_per_turn()),
        "order_that_fits": comparison.and_then(|comparison| match comparison.check.relation {
            Relation::Agrees => Some(comparison.heard.order.lines_per_turn()),
            Relation::OtherOrder(order) => Some(order.lines_per_turn()),
            Relation::None => None,
        }),
        "heard_speed_rev_s": heard.map(|heard| heard.speed.rev_s()),
        "heard_std_uncertainty_rev_s": heard.and_then(|heard| heard.std_rev_s),
        "heard_over_known": of_check(&|check| check.heard_over_known),
        "clock_correction_ppm": comparison
            .filter(|comparison| comparison.check.relation != Relation::None)
            .map(|comparison| comparison.whole_correction_ppm(before_ppm)),
        "clock_correction_std_ppm": of_check(&|check| check.correction_std_ppm),
        "clock_ppm": arguments.clock_ppm,
        "reason": reason,
        "version": env!("CARGO_PKG_VERSION"),
    })
    .to_string()
}
