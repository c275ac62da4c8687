//! From an open recording to its record.

use hovertone::rotors::{
    SpinUp, condition_of_one_rotor, conditions_from_analysis, passes_of_spin_up, speed_after_spin_up,
};
use hovertone::sound::Passes;
use hovertone::speed::{
    Config, Error, Method, NoTone, Outcome, SpeedAnalysis, ToneConfig, Warning, passes_of_speed, speed_from_passes,
};
use hovertone::tones::{Discovery, FoundSpeed, tones_from_passes};
use hovertone_analysis::GivenFacts;
use hovertone_media::{Decoder, MediaWarning, Recording};
use hovertone_report::{Answer, Found, Notice, NoticeKind, RecordingFacts, SpeedRecord, Wording, significant};
use hovertone_vehicle::{AIR_KG_M3, BLADES_MAX, KNOWN_RANGE_MARGIN, Order, THRUST_COEFFICIENT, check_tips};
use serde::Serialize;
use serde_json::Value;

/// What is asked of a recording.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// Name in the output.
    pub name: &'a str,
    /// Settings of the analysis.
    pub config: &'a Config,
    /// The search for the tone, where its order is unknown; the order in `config` is then a placeholder.
    pub discovery: Option<Discovery>,
    /// Analyses of the rotors after the speed.
    pub requests: Requests,
    /// Whether the samples of the hover are used, and with them their warnings.
    pub wants_samples: bool,
}

/// Analyses of the rotors after the speed. Each needs more passes over the sound.
#[derive(Clone, Copy, Debug, Default)]
pub struct Requests {
    /// The condition of each rotor.
    pub condition: bool,
    /// The start of each rotor.
    pub spin_up: bool,
}

/// A recording that was analysed.
#[derive(Debug)]
pub struct Heard {
    /// The result.
    pub record: SpeedRecord,
    /// The settings of the analysis: the settings of the task with the tone that was found.
    pub config: Config,
    /// The start of each rotor, where it was requested.
    pub spin_up: Option<SpinUp>,
}

/// Reason why a recording was not analysed, with its facts where they are known.
#[derive(Debug)]
pub struct NotHeard {
    /// What happened, why, and what to do.
    pub reason: String,
    /// The kind of error in one word of files for programs.
    pub class: &'static str,
    /// Facts about the file.
    pub facts: Option<Box<RecordingFacts>>,
}

impl NotHeard {
    /// A reason before any fact was known.
    pub fn because(class: &'static str, reason: impl ToString) -> Self {
        Self { reason: reason.to_string(), class, facts: None }
    }
}

/// Progress over all passes of a recording.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// Number of the pass, counted from 1.
    pub pass: u32,
    /// Number of planned passes.
    pub pass_count: u32,
    /// Share of all passes that is done, 0 to 1.
    pub done: f64,
}

/// Analyses a recording.
///
/// # Errors
/// Settings that do not fit the recording, and sound that cannot be read to its end.
pub fn hear(
    recording: &mut Recording,
    task: &Task<'_>,
    sha256: Option<String>,
    on_share: impl FnMut(Share),
) -> Result<Heard, NotHeard> {
    let analysed = analysed(recording, task, on_share);
    let spoiled = analysed.as_ref().ok().and_then(|analysed| why_no_tone(recording, analysed));
    let facts = facts_of(recording, sha256);
    let Analysed { analysis, config, found, spin_up } = match analysed {
        Ok(analysed) => analysed,
        Err(error) => {
            return Err(NotHeard { facts: Some(Box::new(facts)), ..NotHeard::because(class_of(&error), error) });
        }
    };
    let record = record_of(task, &config, Answer::Heard(Box::new(analysis)), Some(facts));
    let mut record = SpeedRecord { found, spoiled, ..record };
    // a list of all families of tones follows none of them, and nor does a recording without a rotor, or with several possible speeds
    let is_list = task.discovery.is_some_and(|discovery| discovery.wants_all);
    let follows_a_tone = !is_list && record.tone().is_some() && !record.is_ambiguous();
    let matters = |warning: &&Warning| match warning {
        Warning::HoverShorterThanSample { .. } => task.wants_samples,
        // the others suffice, and nobody has to do anything
        Warning::HarmonicLeftOut { harmonic, .. } if *harmonic > 1 => false,
        other => follows_a_tone || !other.is_about_followed_tone(),
    };
    let all: &[Warning] = record.analysis().map_or(&[], |analysis| &analysis.warnings);
    let of_analysis: Vec<&Warning> =
        all.iter().filter(|warning| matters(warning) && !warning.is_told_by(all)).collect();
    let hints = record.given_facts().hints(&of_analysis);
    let of_analysis = of_analysis
        .into_iter()
        .zip(hints)
        .map(|(warning, hint)| Notice::new(warning.to_string(), hint).of_kind(NoticeKind::of_warning(warning)));
    record.notices = notices_of(recording).into_iter().chain(of_analysis).collect();
    record.notices.extend(notice_of_reading(&record).filter(|_| follows_a_tone));
    record.notices.extend(notice_of_one_tone(&record, &config));
    // an experiment tests the thrust of its constant, and a search leaves such speeds out
    if !task.wants_samples && task.discovery.is_none() {
        record.notices.extend(notice_of_thrust(&record, &config));
    }
    let diameter_m = config.known.diameter_m.or(task.discovery.and_then(|discovery| discovery.known.diameter_m));
    record.notices.extend(notice_of_tips(&record, diameter_m));
    Ok(Heard { record, config, spin_up })
}

/// That one tone stands for all rotors where nobody asked to separate them. Where they could not be separated, a warning says it.
fn notice_of_one_tone(record: &SpeedRecord, config: &Config) -> Option<Notice> {
    let rotors = &config.rotors;
    if config.method == Method::Separated || !rotors.is_count_known || rotors.count < 2 {
        return None;
    }
    let share = record.speed()?.rotors_std_share();
    let text = format!(
        "one tone is used for all {} rotors. It may be the tone of one rotor alone, so the ± is larger: hovertone \
        assumes that this rotor differs from the mean of all by {:.1} % (standard deviation)",
        rotors.count,
        100.0 * share
    );
    let hint = match config.method {
        Method::Harmonic => hovertone_report::LEAVE_MEAN_ONLY_OUT,
        _ => hovertone_report::LEAVE_METHOD_OUT,
    };
    (share > 0.0).then(|| Notice::new(text, hint))
}

/// That the vehicle could not hover at the heard speed, where the sound does not show it by itself.
fn notice_of_thrust(record: &SpeedRecord, config: &Config) -> Option<Notice> {
    let speed_rev_s = record.speed().filter(|_| record.contradiction().is_none())?.speed.rev_s();
    let coefficient = config.known.hover_thrust_coefficient(speed_rev_s, AIR_KG_M3)?;
    let (low, high) = (THRUST_COEFFICIENT.start(), THRUST_COEFFICIENT.end());
    // on a bench, one rotor carries nothing
    let is_foreign = config.rotors.count > 1 && !THRUST_COEFFICIENT.contains(&coefficient);
    let text = format!(
        "the vehicle cannot hover at {speed_rev_s:.1} rev/s: with its diameter, mass and number of rotors, its propellers would need a \
         thrust coefficient (thrust for their size and speed) of {}, and propellers have {low} to {high}",
        significant(coefficient, 3)
    );
    let others = GivenFacts { mass: false, ..record.given_facts() }.in_words("and");
    let hint = format!("if it hovers in this recording, check the mass first, then {others}");
    is_foreign.then(|| Notice::new(text, hint).of_kind(NoticeKind::CannotHover))
}

/// That the blade tips would be too fast at the heard speed.
fn notice_of_tips(record: &SpeedRecord, diameter_m: Option<f64>) -> Option<Notice> {
    let contradiction = check_tips(diameter_m?, record.speed()?.speed).err()?;
    let given = record.given_facts();
    let hint = if given.vehicle { format!("check {}", given.in_words("and")) } else { contradiction.hint() };
    Some(Notice::new(contradiction.to_string(), hint).of_kind(NoticeKind::Impossible))
}

/// The record of a recording that could not be heard: its reason stands in place of an answer.
pub fn failed_record(task: &Task<'_>, failure: NotHeard) -> SpeedRecord {
    let NotHeard { reason, facts, .. } = failure;
    record_of(task, task.config, Answer::Failed { reason }, facts.map(|facts| *facts))
}

/// What weakens a recording itself.
pub fn notices_of(recording: &Recording) -> Vec<Notice> {
    recording.warnings().iter().map(|warning| Notice::new(warning.to_string(), warning.hint())).collect()
}

/// What is known of an open recording.
pub fn facts_of(recording: &Recording, sha256: Option<String>) -> RecordingFacts {
    let info = recording.info();
    RecordingFacts {
        sha256,
        container: info.container.to_string(),
        codec: info.codec.clone(),
        decoder: match info.decoder {
            Decoder::Native => "hovertone",
            Decoder::Ffmpeg => "ffmpeg",
            Decoder::Caller => "browser",
            _ => "other",
        }
        .to_owned(),
        sample_rate_hz: info.sample_rate_hz,
        clock_correction_ppm: info.clock_correction_ppm,
        channel_count: info.channel_count,
        channel: info.channel,
        audio_track: info.audio_track,
        audio_track_count: info.audio_track_count,
        is_prefix: recording.is_prefix(),
    }
}

/// The fault of a recording that explains why no tone was found in it, and what to do.
fn why_no_tone(recording: &Recording, analysed: &Analysed) -> Option<String> {
    let Outcome::NoRotorTone { reason } = &analysed.analysis.outcome else { return None };
    let warnings = recording.warnings();
    let is_silent = matches!(reason, NoTone::Silence);
    if is_silent && warnings.iter().any(|warning| matches!(warning, MediaWarning::NonFiniteSamples { .. })) {
        let why = "the audio samples are no numbers (NaN or infinite); check the program that wrote the file";
        return Some(why.to_owned());
    }
    let explains = |warning: &&MediaWarning| {
        matches!(warning, MediaWarning::Overdriven { .. } | MediaWarning::ChannelsCancel { .. })
    };
    if let Some(fault) = warnings.iter().find(explains) {
        return Some(format!("{fault}; {}", fault.hint()));
    }
    // a rotor that is heard by other lines shows that the sample rate is not to blame
    let is_heard = matches!(reason, NoTone::NoSeries { instead: Some(_), .. });
    let may_be_rate = !is_silent && !is_heard && analysed.found.is_none();
    may_be_rate.then(|| why_rate_is_low(&analysed.config.tone, recording.info().sample_rate_hz / 2.0)).flatten()
}

/// A lower tone than that of a gear.
const OR_BLADES: &str = ", or follow the lower tone of the blades: give --blades N alone";

/// That the tone may lie above what the recording holds, and what to do. `None` where it cannot, or where a band says where it lies.
fn why_rate_is_low(tone: &ToneConfig, half_rate_hz: f64) -> Option<String> {
    // the search goes beyond the known speeds of the vehicle by a margin
    let tone_hz = tone.order.lines_per_turn() * tone.speed_max.rev_s() / KNOWN_RANGE_MARGIN;
    if tone.band_hz.is_some() || half_rate_hz >= tone_hz {
        return None;
    }
    let (order, half_rate_khz) = (tone.order, half_rate_hz / 1e3);
    let are_speeds_known = tone.speed_max != ToneConfig::of_order(order).speed_max;
    Some(if are_speeds_known {
        format!(
            "the sample rate is too low: no sound above {half_rate_khz:.1} kHz is recorded, and the tone at {order} \
            times the rotor speed may be as high as {:.1} kHz; record at a higher sample rate{}",
            tone_hz / 1e3,
            if order.lines_per_turn() > BLADES_MAX { OR_BLADES } else { "" }
        )
    } else {
        let blades = if tone.blades.is_none() { "count the blades and give --blades N too, or " } else { "" };
        format!(
            "the tone at {order} times the rotor speed is not heard. The recording has no sound above \
            {half_rate_khz:.1} kHz, so this tone can be heard only up to {:.0} rev/s; {blades}name the vehicle, or \
            give --band LOW:HIGH around the tone",
            half_rate_hz / order.lines_per_turn()
        )
    })
}

/// From the progress of a pass to the progress over all passes of a recording.
pub fn progress_of<F: FnMut(Share)>(
    recording: &Recording,
    mut on_share: F,
) -> impl FnMut(hovertone::sound::Progress) + use<F> {
    let (start_s, declared_s) = (recording.info().start_s, recording.info().declared_duration_s);
    let mut heard_s: f64 = 0.0;
    move |progress: hovertone::sound::Progress| {
        let hovertone::sound::Progress { pass, pass_count, time_s, .. } = progress;
        let time_s = time_s - start_s;
        // after the first pass the length is known exactly; the header only estimates it
        let length_s = if pass == 1 { declared_s } else { Some(heard_s) };
        heard_s = heard_s.max(time_s);
        let of_pass = length_s.filter(|&length_s| length_s > 0.0).map_or(0.0, |length_s| (time_s / length_s).min(1.0));
        on_share(Share { pass, pass_count, done: (f64::from(pass - 1) + of_pass) / f64::from(pass_count) });
    }
}

/// The kind of an error of the analysis: its settings do not fit the recording, or the sound could not be read to its end.
fn class_of(error: &Error) -> &'static str {
    match error {
        Error::Signal(_) => "unreadable",
        _ => "unfit_settings",
    }
}

fn record_of(task: &Task<'_>, config: &Config, answer: Answer, recording: Option<RecordingFacts>) -> SpeedRecord {
    SpeedRecord {
        file: task.name.to_owned(),
        method: config.method,
        order: config.tone.order,
        wants_condition: task.requests.condition,
        settings: written(config),
        recording,
        answer,
        found: None,
        labels: None,
        spoiled: None,
        notices: Vec::new(),
        wording: Wording::default(),
    }
}

/// Settings as JSON. Serialisation of settings does not fail.
fn written(settings: &impl Serialize) -> Value {
    serde_json::to_value(settings).unwrap_or_default()
}

/// The notice which reading of the tone was used, where the order was not given.
fn notice_of_reading(record: &SpeedRecord) -> Option<Notice> {
    let reading = record.found_reading().filter(|_| record.speed().is_some())?;
    let text = format!("the number of blades is not given; hovertone uses {}: {}", reading.meaning, reading.why);
    Some(Notice::new(
        text,
        "if this is wrong, give --blades N (and --gear PINION:WHEEL for a gear); `hovertone tones` shows all possible speeds",
    ))
}

/// Results of the passes over a recording.
struct Analysed {
    analysis: SpeedAnalysis,
    config: Config,
    found: Option<Found>,
    spin_up: Option<SpinUp>,
}

/// Drops the rotor that may be heard instead where none is heard with its blades: who followed the advice to give them would get no speed.
fn drop_unheard(passes: &mut Passes<'_>, analysed: &mut Analysed) {
    let Outcome::NoRotorTone { reason: NoTone::NoSeries { instead, .. } } = &mut analysed.analysis.outcome else {
        return;
    };
    let Some(Ok(order)) = instead.map(|other| Order::from_blades(other.blades)) else { return };
    let tone = ToneConfig { blades: instead.map(|other| other.blades), ..ToneConfig::of_order(order) };
    let Config { span, rotors, method, .. } = analysed.config;
    let alone = Config { span, rotors, method, ..Config::for_tone(tone) };
    passes.expect_more(passes_of_speed(&alone));
    let heard = speed_from_passes(passes, &alone);
    if !heard.is_ok_and(|analysis| matches!(analysis.outcome, Outcome::Ok(_))) {
        *instead = None;
    }
}

fn analysed(recording: &mut Recording, task: &Task<'_>, on_share: impl FnMut(Share)) -> Result<Analysed, Error> {
    let mut on_progress = progress_of(recording, on_share);
    let Requests { condition, spin_up } = task.requests;
    let config = task.config;
    let speed_passes = match (task.discovery, spin_up) {
        (Some(_), true) => passes_of_speed(config) + passes_of_spin_up(config),
        (None, true) => passes_of_spin_up(config),
        (_, false) => passes_of_speed(config),
    };
    let mut passes = Passes::planned(recording, speed_passes + u32::from(condition), &mut on_progress)?;
    let mut analysed = match task.discovery {
        Some(discovery) => {
            let FoundSpeed { families, rotor, config, analysis, alternatives } =
                tones_from_passes(&mut passes, config, &discovery)?;
            let found = Found { settings: written(&discovery), families, rotor, alternatives };
            Analysed { analysis, config, found: Some(found), spin_up: None }
        }
        None if spin_up => {
            let (analysis, spin_up) = speed_after_spin_up(&mut passes, config)?;
            Analysed { analysis, config: config.clone(), found: None, spin_up: Some(spin_up) }
        }
        None => {
            let analysis = speed_from_passes(&mut passes, config)?;
            Analysed { analysis, config: config.clone(), found: None, spin_up: None }
        }
    };
    drop_unheard(&mut passes, &mut analysed);
    let has_tone = matches!(analysed.analysis.outcome, Outcome::Ok(_));
    if spin_up && analysed.spin_up.is_none() && has_tone {
        let (analysis, spin_up) = speed_after_spin_up(&mut passes, &analysed.config)?;
        analysed = Analysed { analysis, spin_up: Some(spin_up), ..analysed };
    }
    if condition {
        add_conditions(&mut passes, &mut analysed)?;
    }
    Ok(analysed)
}

/// Adds the condition of each separated rotor, or of the only one.
fn add_conditions(passes: &mut Passes<'_>, analysed: &mut Analysed) -> Result<(), Error> {
    let Analysed { analysis, config, .. } = analysed;
    if config.rotors.is_count_known && config.rotors.count == 1 {
        let condition = condition_of_one_rotor(passes, analysis, &config.tone)?;
        if let Outcome::Ok(tone) = &mut analysis.outcome {
            tone.condition = condition;
        }
        return Ok(());
    }
    let conditions = conditions_from_analysis(passes, analysis, &config.tone)?;
    if let Outcome::Ok(tone) = &mut analysis.outcome {
        tone.rotors.iter_mut().zip(conditions).for_each(|(rotor, condition)| rotor.condition = condition);
    }
    Ok(())
}
