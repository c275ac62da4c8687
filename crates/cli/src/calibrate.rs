//! `hovertone calibrate`: the recorder's clock and the order of the tone against one known speed.

use crate::args::{AnalysisArguments, CalibrateArguments, KnownArguments};
use crate::failure::{Ending, Failure};
use crate::jobs::{ending_of, jobs_of};
use crate::progress::Progress;
use crate::recording::{Hearing, Requests, records_of};
use crate::settings::config_of;
use crate::terminal::Terminal;
use hovertone::calibration::{KnownSpeed, Relation, SpeedCheck, check_against};
use hovertone::speed::{Config, SpeedEstimate};
use hovertone::tones::Discovery;
use hovertone_report::{SpeedRecord, fixed, printable, signed, with_uncertainty};
use hovertone_vehicle::{CLOCK_CORRECTION_PPM_MAX, Order, RotorSpeed};
use serde_json::json;

const MILLION: f64 = 1e6;
/// Half of the band around a tone of known frequency in which it is searched, as a share.
const BAND_SHARE: f64 = 0.025;
/// Smallest standard uncertainty that is shown, in millionths.
const PPM_SHOWN: f64 = 0.05;
/// What a crystal changes with the warmth of a room, in millionths: a correction is no better.
const WARMTH_PPM: f64 = 5.0;
const SEE_HELP: &str = "see `hovertone calibrate --help`";

/// The meaning of the arguments.
struct Plan {
    config: Config,
    discovery: Option<Discovery>,
    reference: Reference,
}

/// What is known.
#[derive(Clone, Copy)]
enum Reference {
    /// The speed of the shaft.
    Speed { rpm: f64, std_share: f64 },
    /// The frequency of the tone.
    Tone { hz: f64, std_share: f64 },
}

/// Hears the recording and compares.
pub(crate) fn run(arguments: &CalibrateArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    let files = std::slice::from_ref(&arguments.file);
    let jobs = jobs_of(files, &plan.config, plan.discovery, Requests::default())?;
    let [_] = &jobs[..] else {
        let what = format!("one recording is compared with one speed, and {} match", jobs.len());
        return Err(Failure::usage(what, "give the one that was made at this speed"));
    };
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let records = records_of(&jobs, Hearing::of(&arguments.hearing), &progress);
    progress.finish();
    terminal.counted_notes(&records.iter().collect::<Vec<_>>());
    let mut ending = ending_of(&records);
    for record in &records {
        let checked = record.speed().map(|speed| checked(speed, record.order, plan.reference));
        let checked = checked.transpose()?;
        let passes = checked.is_some_and(|checked| checked.check.passes(arguments.clock_ppm));
        if !passes {
            ending = ending.max(Ending::Incomplete);
        }
        if arguments.json {
            terminal.data(&(as_json(record, checked, arguments, passes) + "\n"))?;
        } else if let Some(checked) = checked {
            terminal.text(&in_words(record, checked, arguments, passes))?;
        }
    }
    terminal.flush()?;
    Ok(ending)
}

fn resolve(arguments: &CalibrateArguments) -> Result<Plan, Failure> {
    let reference = reference_of(arguments)?;
    let known = KnownArguments { rotors: Some(arguments.rotors.unwrap_or(1)), ..KnownArguments::default() };
    let names_tone = arguments.tone.blades.is_some()
        || arguments.tone.gear.is_some()
        || arguments.tone.order.is_some()
        || arguments.tone.vehicle.is_some();
    let mut tone = arguments.tone.clone();
    if let Reference::Tone { hz, .. } = reference
        && !names_tone
    {
        tone.order = Some(1.0);
        tone.harmonics = Some(1);
        tone.band = tone.band.or(Some((hz * (1.0 - BAND_SHARE), hz * (1.0 + BAND_SHARE))));
    }
    // the clock is what is sought, and a bench does not move
    let analysis = AnalysisArguments {
        clock_ppm: Some(0.0),
        drift_m_max: Some(0.0),
        from: arguments.from,
        to: arguments.to,
        ..AnalysisArguments::default()
    };
    let (config, discovery) = config_of(&tone, &known, &analysis)?;
    Ok(Plan { config, discovery, reference })
}

fn reference_of(arguments: &CalibrateArguments) -> Result<Reference, Failure> {
    let positive = |name: &str, value: Option<f64>| {
        let what = format!("{name} must be a number above 0");
        value.filter(|value| value.is_finite() && *value > 0.0).ok_or_else(|| Failure::usage(what, SEE_HELP))
    };
    for (name, value) in [("known_std_ppm", arguments.known_std_ppm), ("clock_ppm", Some(arguments.clock_ppm))] {
        if let Some(value) = value.filter(|value| !(0.0..=MILLION).contains(value)) {
            return Err(Failure::usage(format!("{name} = {value}, must be 0 to {MILLION}"), SEE_HELP));
        }
    }
    let stated = arguments.known_std_ppm.map(|ppm| ppm / MILLION);
    if let Some(typed) = &arguments.tachometer_rpm {
        let rpm = positive("tachometer_rpm", typed.trim().parse().ok())?;
        // the last digit is rounded: half a unit of it is the limit of a rectangular distribution
        let decimals = typed.trim().split_once('.').map_or(0, |(_, decimals)| decimals.len().min(9) as i32);
        let rounded = 0.5 * 10f64.powi(-decimals) / 3f64.sqrt() / rpm;
        return Ok(Reference::Speed { rpm, std_share: stated.unwrap_or(rounded) });
    }
    Ok(Reference::Tone { hz: positive("true_hz", arguments.true_hz)?, std_share: stated.unwrap_or(0.0) })
}

/// A heard speed, what was known, and their comparison.
#[derive(Clone, Copy)]
struct Checked {
    heard: RotorSpeed,
    heard_std_rev_s: Option<f64>,
    order: Order,
    reference: Reference,
    check: SpeedCheck,
}

fn checked(speed: &SpeedEstimate, order: Order, reference: Reference) -> Result<Checked, Failure> {
    let known = match reference {
        Reference::Speed { rpm, std_share } => KnownSpeed { speed: RotorSpeed::from_rpm(rpm), std_share },
        Reference::Tone { hz, std_share } => KnownSpeed { speed: RotorSpeed::from_tone_hz(hz, order), std_share },
    };
    let heard_std_rev_s = speed.combined_std_uncertainty_rev_s().or(speed.std_uncertainty_rev_s);
    let std_share = heard_std_rev_s.unwrap_or(0.0) / speed.speed.rev_s();
    let check = check_against(speed.speed, std_share, order, known).map_err(Failure::internal)?;
    Ok(Checked { heard: speed.speed, heard_std_rev_s, order, reference, check })
}

impl Checked {
    /// The known and the heard number in the unit of the known one.
    fn pair(&self) -> (String, String) {
        let in_unit = |factor: f64| {
            let value = self.heard.rev_s() * factor;
            with_uncertainty(value, self.heard_std_rev_s.map(|std| std * factor))
        };
        match self.reference {
            Reference::Speed { rpm, .. } => (format!("{rpm} rpm"), format!("{} rpm", in_unit(60.0))),
            Reference::Tone { hz, .. } => (format!("{hz} Hz"), format!("{} Hz", in_unit(self.order.lines_per_turn()))),
        }
    }

    /// The band around the tone that the known speed and the given order mean.
    fn band(&self) -> String {
        let tone_hz = self.heard.tone_hz(self.order) / self.check.heard_over_known;
        format!("{:.0}:{:.0}", (1.0 - BAND_SHARE) * tone_hz, (1.0 + BAND_SHARE) * tone_hz)
    }

    /// The correction for the setting: on top of the one with which the recording was opened.
    fn whole_correction_ppm(&self, before_ppm: f64) -> f64 {
        MILLION * ((1.0 + before_ppm / MILLION) * (1.0 + self.check.correction_ppm / MILLION) - 1.0)
    }
}

fn in_words(record: &SpeedRecord, checked: Checked, arguments: &CalibrateArguments, passes: bool) -> String {
    let Checked { check, order, .. } = checked;
    let (known, heard) = checked.pair();
    let mut text = format!("{}: known {known}, heard {heard} (± is k = 2), order {order}\n", printable(&record.file));
    text += &match check.relation {
        Relation::Agrees => format!("order: pass, {order} fits\n"),
        Relation::OtherOrder(fitting) => format!(
            "order: fail, heard / known is {}: order {fitting} fits, not {order}. Use --order {fitting} (--blades {fitting} for \
             a blade pass), or [tone] order = {fitting} in an experiment file; if {order} is known to be right, --band {} holds its tone\n",
            fixed(check.heard_over_known, 4),
            checked.band()
        ),
        Relation::None => format!(
            "order: fail, heard / known is {}, which no order explains, nor a clock: they are off by {CLOCK_CORRECTION_PPM_MAX} \
             millionths at most. Was another rotor heard, or the file resampled or slowed down?\n",
            fixed(check.heard_over_known, 4)
        ),
    };
    if check.relation != Relation::None {
        let before_ppm = arguments.hearing.clock_correction_ppm.unwrap_or(0.0);
        let is_within = check.correction_ppm.abs() <= arguments.clock_ppm + check.expanded_ppm();
        text += &format!(
            "clock: {}, it runs {} by {} millionths (k = 2), at most {} are expected\n",
            if is_within { "pass" } else { "fail" },
            if check.correction_ppm > 0.0 { "slow" } else { "fast" },
            with_uncertainty(check.correction_ppm.abs(), Some(check.correction_std_ppm.max(PPM_SHOWN))),
            arguments.clock_ppm,
        );
        text += &if check.is_significant() {
            let ppm = signed(checked.whole_correction_ppm(before_ppm), 1).replace('−', "-").replace('+', "");
            format!(
                "correction: --clock-correction-ppm {ppm}, or in an experiment file\n  [recorder]\n  clock_correction_ppm = {ppm}\n  \
                 clock_ppm = {}\n",
                fixed(check.expanded_ppm().max(WARMTH_PPM), 1)
            )
        } else {
            "correction: none, the difference is within its ±\n".to_owned()
        };
    }
    text + if passes { "pass\n" } else { "fail\n" }
}

fn as_json(record: &SpeedRecord, checked: Option<Checked>, arguments: &CalibrateArguments, passes: bool) -> String {
    let before_ppm = arguments.hearing.clock_correction_ppm.unwrap_or(0.0);
    let status = if checked.is_none() { record.status() } else { "ok" };
    json!({
        "file": record.file,
        "status": status,
        "passes": passes,
        "order": checked.map(|checked| checked.order.lines_per_turn()),
        "order_that_fits": checked.and_then(|checked| match checked.check.relation {
            Relation::Agrees => Some(checked.order.lines_per_turn()),
            Relation::OtherOrder(order) => Some(order.lines_per_turn()),
            Relation::None => None,
        }),
        "heard_speed_rev_s": checked.map(|checked| checked.heard.rev_s()),
        "heard_std_uncertainty_rev_s": checked.and_then(|checked| checked.heard_std_rev_s),
        "heard_over_known": checked.map(|checked| checked.check.heard_over_known),
        "clock_correction_ppm": checked
            .filter(|checked| checked.check.relation != Relation::None)
            .map(|checked| checked.whole_correction_ppm(before_ppm)),
        "clock_correction_std_ppm": checked.map(|checked| checked.check.correction_std_ppm),
        "clock_ppm": arguments.clock_ppm,
        "reason": record.reason(),
        "version": env!("CARGO_PKG_VERSION"),
    })
    .to_string()
}
