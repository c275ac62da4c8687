//! `hovertone calibrate`: the recorder's clock and the order of the tone against one known speed.

mod clock_words;
mod comparison;

use crate::args::{AnalysisArguments, CalibrateArguments, KnownArguments};
use crate::failure::{Ending, Failure};
use crate::jobs::{ending_of, jobs_of};
use crate::meant::number_meant;
use crate::progress::Progress;
use crate::recording::{Hearing, Job, Requests, line_in_band, records_of};
use crate::settings::config_of;
use crate::terminal::Terminal;
use crate::vehicles::preset;
use comparison::{Comparison, HeardSpeed, Reference, as_json, heard_beside_known, in_words, to_tenths};
use hovertone::calibration::Judgement;
use hovertone::sound::HeardBand;
use hovertone::speed::{Config, NoTone, SpeedAnalysis, Warning};
use hovertone::tones::Discovery;
use hovertone_report::{Notice, SpeedRecord, warning_count};
use hovertone_vehicle::{Order, RotorSpeed, SHAFT_REV_S, check_range};
use std::ops::{Range, RangeInclusive};

const MILLION: f64 = 1e6;
/// Half of the band around a tone of known frequency in which it is searched, as a share.
const BAND_SHARE: f64 = 0.025;
/// Tones of recordings, Hz: up to half the largest sample rate of recorders.
const TRUE_HZ: RangeInclusive<f64> = 1.0..=192_000.0;
/// Status where several speeds are possible.
const AMBIGUOUS: &str = "ambiguous";
/// Status where nothing is compared, because several rotors are heard.
const SEVERAL_ROTORS: &str = "several_rotors";
/// Status where the known speed agrees, but the lines are those of a rotor with other blades.
const OTHER_ROTOR: &str = "other_rotor";
/// Status where the tone of the given order is hardly heard: then other lines told the speed, and nothing is said of the order.
const HARDLY_HEARD: &str = "tone_hardly_heard";
/// The statuses without a judgement: they are no error, and `passes` is null.
const OPEN: [&str; 4] = [SEVERAL_ROTORS, AMBIGUOUS, OTHER_ROTOR, HARDLY_HEARD];
/// Largest difference from the known speed at which a rotor with other blades has that speed.
const SAME_SPEED_SHARE: f64 = 0.02;
const SEVERAL_IN_WORDS: &str =
    "the known speed must be that of one steady rotor, but several rotors are heard, or one rotor whose speed changes";
const RECORD_ONE: &str = "record one rotor that runs alone, at a steady throttle";
const SEE_HELP: &str = "for example `hovertone calibrate --true-hz 1000 tone.wav`; see `hovertone calibrate --help`";
const SEE_HELP_OF_SPEED: &str =
    "for example `hovertone calibrate --tachometer-rpm 3600 --blades 2 rotor.wav`; see `hovertone calibrate --help`";

/// The meaning of the arguments.
struct Plan {
    config: Config,
    discovery: Option<Discovery>,
    reference: Reference,
    /// The band of a tone that is no rotor's: its line alone is measured.
    line_band_hz: Option<Range<f64>>,
    /// What is assumed about the rotors.
    notice: Option<Notice>,
}

/// What a recording holds.
struct Heard {
    speed: Option<HeardSpeed>,
    status: &'static str,
    reason: Option<String>,
    notices: Vec<Notice>,
    /// The record of an analysis of rotors.
    record: Option<SpeedRecord>,
    ending: Ending,
}

/// Hears the recording and compares.
pub(crate) fn run(arguments: &CalibrateArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    let files = std::slice::from_ref(&arguments.file);
    let jobs = jobs_of(files, &plan.config, plan.discovery, Requests::default())?;
    let [job] = &jobs[..] else {
        let what = format!("the known speed belongs to one recording, but {} files match the name", jobs.len());
        return Err(Failure::usage(what, "give the recording that was made at this speed"));
    };
    let progress = Progress::new("listening to", 1, !arguments.hearing.no_progress);
    let hearing = Hearing::of(&arguments.hearing);
    let heard = match plan.line_band_hz.clone() {
        Some(band_hz) => heard_line(job, hearing, band_hz, &progress)?,
        None => heard_rotor(&jobs, hearing, &plan, &progress),
    };
    progress.finish();
    let comparison = heard.speed.map(|speed| Comparison::of(speed, plan.reference)).transpose()?;
    let judgement = comparison.as_ref().map(|comparison| comparison.check.judgement(arguments.clock_ppm));
    say_notes(&heard, &job.name, plan.notice.as_ref(), terminal);
    if arguments.json {
        let text = as_json(&job.name, heard.status, heard.reason.as_deref(), comparison.as_ref(), arguments);
        terminal.data(&(text + "\n"))?;
    } else if let Some(comparison) = &comparison {
        terminal.text(&in_words(&job.name, comparison, arguments))?;
    }
    terminal.flush()?;
    Ok(if judgement == Some(Judgement::Passes) { heard.ending } else { heard.ending.max(Ending::Incomplete) })
}

fn say_notes(heard: &Heard, name: &str, notice: Option<&Notice>, terminal: &mut Terminal) {
    let records: Vec<&SpeedRecord> = heard.record.iter().collect();
    terminal.warning_count(usize::from(notice.is_some()) + heard.notices.len() + warning_count(&records));
    if let Some(notice) = notice {
        terminal.warning(notice, "");
    }
    heard.notices.iter().for_each(|notice| terminal.warning(notice, ""));
    if !records.is_empty() {
        return terminal.notes(&records);
    }
    if let Some(reason) = &heard.reason {
        // an answer that is open is no error
        if OPEN.contains(&heard.status) {
            return terminal.say(&format!("{name}: {reason}"));
        }
        terminal.error(&Notice::new(format!("{name}: {reason}"), ""));
    }
}

/// The speed of a rotor, as `hovertone speed` hears it.
fn heard_rotor(jobs: &[Job], hearing: Hearing, plan: &Plan, progress: &Progress) -> Heard {
    let reference = plan.reference;
    let mut records = records_of(jobs, hearing, progress);
    let ending = ending_of(&records);
    let record = records.pop();
    let undecided = |status: &'static str, why: String| Heard {
        speed: None,
        status,
        reason: Some(format!("not decided: {why}")),
        notices: Vec::new(),
        record: None,
        ending: ending.max(Ending::Incomplete),
    };
    if record.as_ref().and_then(SpeedRecord::analysis).is_some_and(hears_several) {
        let heard = record.as_ref().and_then(|record| Some(record.speed()?.speed));
        let heard = heard.and_then(|heard| heard_beside_known(reference, heard)).unwrap_or_default();
        return undecided(SEVERAL_ROTORS, format!("{SEVERAL_IN_WORDS}; {RECORD_ONE}{heard}"));
    }
    if let Some(record) = record.as_ref().filter(|record| record.is_ambiguous()) {
        return undecided(
            AMBIGUOUS,
            format!("several rotor speeds explain this sound; {}", settled_by(plan, record.order)),
        );
    }
    let speed = record.as_ref().and_then(|record| {
        let speed = record.speed()?;
        let std_rev_s = speed.combined_std_uncertainty_rev_s().or(speed.std_uncertainty_rev_s);
        Some(HeardSpeed { speed: speed.speed, std_rev_s, order: record.order, is_rotor: true })
    });
    let comparison = speed.and_then(|speed| Comparison::of(speed, reference).ok());
    let agrees = comparison.as_ref().is_some_and(Comparison::agrees);
    let doubt = record.as_ref().and_then(SpeedRecord::analysis).and_then(fits_elsewhere);
    // where these lines have the known speed, another order than theirs would be wrong advice
    let other_agrees = |warning: &&Warning| match (warning, reference) {
        (Warning::FitsElsewhere(other), Reference::Speed { rpm, .. }) => {
            let is_named = comparison.as_ref().is_some_and(|it| it.fits_order(f64::from(other.blades)));
            (RotorSpeed::from_rev_s(other.speed_rev_s).rpm() / rpm - 1.0).abs() < SAME_SPEED_SHARE && !is_named
        }
        _ => false,
    };
    if let Some(warning) = doubt.filter(|warning| agrees || other_agrees(warning)) {
        let hints = record.as_ref().map_or_else(Vec::new, |record| record.given_facts().hints(&[warning]));
        return undecided(OTHER_ROTOR, format!("{warning}; {}", hints.concat()));
    }
    if let Some(why) = record.as_ref().and_then(|record| hardly_heard_in_words(record, plan.config.tone.blades)) {
        return undecided(HARDLY_HEARD, why);
    }
    Heard {
        speed,
        status: record.as_ref().map_or("error", SpeedRecord::status),
        reason: record.as_ref().and_then(SpeedRecord::reason),
        notices: Vec::new(),
        record,
        ending,
    }
}

/// What settles the speed, where several are possible.
fn settled_by(plan: &Plan, order: Order) -> String {
    let tone_hz = match plan.reference {
        // without blades, nothing says how many lines per turn the band would hold
        _ if plan.discovery.is_some_and(|discovery| discovery.known.blade_count.is_none()) => {
            return "count the blades, and give --blades N".to_owned();
        }
        Reference::Speed { rpm, .. } if RotorSpeed::from_rpm(rpm).rev_s() < plan.config.tone.speed_min.rev_s() => {
            let slowest_rpm = plan.config.tone.speed_min.rpm();
            return format!(
                "the known speed, {rpm} rpm, is not one of them, because hovertone hears only rotors of \
                 {slowest_rpm:.0} rpm or more; check the known speed; if it was in turns per second, give \
                 --tachometer-rpm {}",
                to_tenths(60.0 * rpm)
            );
        }
        Reference::Speed { rpm, .. } => RotorSpeed::from_rpm(rpm).tone_hz(order),
        Reference::Tone { hz, .. } => hz,
    };
    format!(
        "if the known frequency or speed is right, the tone lies near {tone_hz:.0} Hz: give --band {}",
        band_around(tone_hz)
    )
}

/// The band around a tone, as it is typed: in whole Hz where it is wide.
fn band_around(tone_hz: f64) -> String {
    let decimals = if BAND_SHARE * tone_hz < 2.0 { 2 } else { 0 };
    format!("{:.decimals$}:{:.decimals$}", (1.0 - BAND_SHARE) * tone_hz, (1.0 + BAND_SHARE) * tone_hz)
}

/// The warning that the lines are those of a rotor with other blades, where there is one: a speed that agrees proves no order then.
fn fits_elsewhere(analysis: &SpeedAnalysis) -> Option<&Warning> {
    analysis.warnings.iter().find(|warning| matches!(warning, Warning::FitsElsewhere(_)))
}

/// What the sound says where the tone of the given order is hardly heard, and what to do. `None` where it is heard.
fn hardly_heard_in_words(record: &SpeedRecord, blades: Option<u32>) -> Option<String> {
    let gap_percent = record.analysis()?.warnings.iter().find_map(|warning| match warning {
        Warning::ManyGaps { gap_share, .. } if warning.is_hardly_heard() => Some(100.0 * gap_share),
        _ => None,
    })?;
    let (order, rpm) = (record.order, record.speed()?.speed.rpm());
    let heard = format!(
        "the tone at {order} times the rotor speed is missing for {gap_percent:.0} % of the time, so it cannot be checked"
    );
    Some(match blades {
        Some(blades) if f64::from(blades) == order.lines_per_turn() => {
            format!("{heard}; move the microphone nearer, or choose a clear part of the recording with --from and --to")
        }
        _ => {
            let number = blades.map_or("N".to_owned(), |blades| blades.to_string());
            format!(
                "{heard}. The speed, {rpm:.0} rpm, comes from other tones, such as the blade pass (the tone of the \
                 blades). If the rotor has {number} blades and no gear, \
                 give --blades {number} alone, in place of {}; if there is a gear, move the microphone nearer",
                record.given_facts().replaced_by_blades()
            )
        }
    })
}

/// Whether other rotors are heard beside the one that is measured.
fn hears_several(analysis: &SpeedAnalysis) -> bool {
    analysis.warnings.iter().any(|warning| matches!(warning, Warning::OtherRotorsHeard { .. }))
}

/// The frequency of a line, as the speed of a shaft with one line per turn.
fn heard_line(job: &Job, hearing: Hearing, band_hz: Range<f64>, progress: &Progress) -> Result<Heard, Failure> {
    let order = Order::new(1.0).map_err(Failure::internal)?;
    let (HeardBand { line, is_silent }, notices) = match line_in_band(job, hearing, band_hz.clone(), progress) {
        Ok(found) => found,
        Err(reason) => {
            let ending = Ending::FilesFailed;
            return Ok(Heard {
                speed: None,
                status: "error",
                reason: Some(reason),
                notices: vec![],
                record: None,
                ending,
            });
        }
    };
    let speed = line.map(|line| HeardSpeed {
        speed: RotorSpeed::from_tone_hz(line.hz, order),
        std_rev_s: Some(RotorSpeed::from_tone_hz(line.std_uncertainty_hz, order).rev_s()),
        order,
        is_rotor: false,
    });
    let (status, reason, ending) = match speed {
        Some(_) => ("ok", None, Ending::Done),
        None if is_silent => ("no_line", Some(NoTone::Silence.to_string()), Ending::Incomplete),
        None => {
            let reason = format!(
                "no clear tone that lasts 2 s or more is heard between {:.1} and {:.1} Hz; check the frequency, \
                 record the tone louder, longer and without other sound, or give another range with --band LOW:HIGH; if a rotor makes the tone, \
                 also give its number of blades, as in --blades 2",
                band_hz.start, band_hz.end
            );
            ("no_line", Some(reason), Ending::Incomplete)
        }
    };
    Ok(Heard { speed, status, reason, notices, record: None, ending })
}

fn resolve(arguments: &CalibrateArguments) -> Result<Plan, Failure> {
    let reference = reference_of(arguments)?;
    if let Some(several) = arguments.rotors.filter(|count| *count > 1) {
        let what =
            format!("--rotors {several}: each rotor has its own speed, but the known speed belongs to one rotor");
        return Err(Failure::usage(what, "record one rotor that runs alone, and give --rotors 1"));
    }
    let known = KnownArguments { rotors: Some(1), ..KnownArguments::default() };
    let tone = &arguments.tone;
    let names_tone = tone.blades.is_some() || tone.gear.is_some() || tone.order.is_some() || tone.vehicle.is_some();
    let line_band_hz = match reference {
        Reference::Tone { hz, .. } if !names_tone => Some(
            tone.band.map_or(hz * (1.0 - BAND_SHARE)..hz * (1.0 + BAND_SHARE), |(low_hz, high_hz)| low_hz..high_hz),
        ),
        _ => None,
    };
    if let Some(count) = tone.harmonics.filter(|_| line_band_hz.is_some()) {
        let what =
            format!("--harmonics {count} changes nothing: --true-hz compares only one tone, the tone of a generator");
        return Err(Failure::usage(
            what,
            "leave --harmonics out; if a rotor makes the tone, also give its number of blades, as in --blades 2",
        ));
    }
    // the clock is what is sought, and a bench does not move
    let analysis = AnalysisArguments {
        clock_ppm: Some(0.0),
        drift_m_max: Some(0.0),
        from: arguments.from,
        to: arguments.to,
        ..AnalysisArguments::default()
    };
    let (config, discovery) = config_of(tone, &known, &analysis)?;
    let notice = assumed_rotors(arguments)?;
    Ok(Plan { config, discovery, reference, line_band_hz, notice })
}

/// A notice where the vehicle has several rotors and nobody said that one turns alone.
fn assumed_rotors(arguments: &CalibrateArguments) -> Result<Option<Notice>, Failure> {
    let vehicle = arguments.tone.vehicle.as_deref().map(preset).transpose()?;
    let count = vehicle.map_or(1, |vehicle| vehicle.rotor_count.value);
    let is_assumed = arguments.rotors.is_none() && count > 1;
    let text = format!(
        "the vehicle has {count} rotors, but the known speed belongs to one rotor: hovertone assumes that only one \
         rotor runs in this recording"
    );
    Ok(is_assumed
        .then(|| Notice::new(text, "if only one rotor runs, add --rotors 1; if not, record one rotor that runs alone")))
}

fn reference_of(arguments: &CalibrateArguments) -> Result<Reference, Failure> {
    for (name, value) in [("known_std_ppm", arguments.known_std_ppm), ("clock_ppm", Some(arguments.clock_ppm))] {
        value.map_or(Ok(()), |value| check_range(name, value, 0.0, MILLION))?;
    }
    let stated = arguments.known_std_ppm.map(|ppm| ppm / MILLION);
    if let Some(typed) = &arguments.tachometer_rpm {
        let rpm = typed.trim().parse().map_err(|_| {
            let meant = number_meant(typed).map(|(why, hint)| (why.to_owned(), hint));
            let (why, hint) =
                meant.unwrap_or(("a number is needed, such as 3600".to_owned(), SEE_HELP_OF_SPEED.to_owned()));
            Failure::usage(format!("--tachometer-rpm {typed}: {why}"), hint)
        })?;
        let [slowest_rpm, fastest_rpm] =
            [SHAFT_REV_S.start(), SHAFT_REV_S.end()].map(|rev_s| RotorSpeed::from_rev_s(*rev_s).rpm());
        check_known("tachometer_rpm", rpm, slowest_rpm..=fastest_rpm)?;
        // the last digit is rounded: half a unit of it is the limit of a rectangular distribution
        let decimals = typed.trim().split_once('.').map_or(0, |(_, decimals)| decimals.len().min(9) as i32);
        let rounded = 0.5 * 10f64.powi(-decimals) / 3f64.sqrt() / rpm;
        return Ok(Reference::Speed { rpm, std_share: stated.unwrap_or(rounded) });
    }
    let hz = arguments.true_hz.ok_or_else(|| Failure::usage("no known speed is given", SEE_HELP))?;
    check_known("true_hz", hz, TRUE_HZ)?;
    Ok(Reference::Tone { hz, std_share: stated.unwrap_or(0.0) })
}

fn check_known(name: &'static str, value: f64, allowed: RangeInclusive<f64>) -> Result<(), Failure> {
    check_range(name, value, *allowed.start(), *allowed.end()).map_err(|error| {
        Failure::usage(error.to_string(), "check the unit: --tachometer-rpm is in turns per minute (60 times the turns per second), --true-hz is in Hz")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band that is advised must not be refused.
    #[test]
    fn an_advised_band_has_an_upper_edge_above_its_lower_edge() {
        for tone_hz in [1.0, 3.3, 9.7, 40.0, 200.0, 4100.0] {
            let band = band_around(tone_hz);
            let edges: Vec<f64> = band.split(':').filter_map(|edge| edge.parse().ok()).collect();
            assert!(edges[0] < tone_hz && tone_hz < edges[1], "{band}");
        }
        assert_eq!(band_around(200.0), "195:205");
    }
}
