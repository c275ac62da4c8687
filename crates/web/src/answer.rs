//! The record of a recording as JSON for the page: numbers with the digits that the command prints, and the tracks to draw.

use hovertone_report::{
    Notice, RecordingFacts, SpeedRecord, SpeedWords, cuts_in_words, decision_in_words, speed_in_words, speed_json,
};
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Answer<'a> {
    status: &'static str,
    reason: Option<String>,
    speed: Option<SpeedWords>,
    /// Lines per turn of the followed tone, where it is settled.
    order: Option<f64>,
    rotors: Vec<Rotor>,
    track: Vec<[f64; 2]>,
    readings: Vec<PossibleReading>,
    why: Option<String>,
    cuts: Option<String>,
    /// Used stretches.
    hover_s: Vec<[f64; 2]>,
    /// The part of the recording that was heard.
    heard_s: Option<[f64; 2]>,
    bands_hz: Vec<[f64; 2]>,
    notices: Vec<NoticeLine<'a>>,
    facts: Option<&'a RecordingFacts>,
    /// The line of `hovertone speed --json`.
    json: String,
}

#[derive(Serialize)]
struct Rotor {
    speed: SpeedWords,
    track: Vec<[f64; 2]>,
}

/// One of several readings of the tone, and what to say where it is right.
#[derive(Serialize)]
struct PossibleReading {
    meaning: String,
    speed_rev_s: f64,
    speed_rpm: f64,
    plausibility: f64,
    order: f64,
    blades: Option<u32>,
    gear_wheel: Option<u32>,
}

/// A warning with its hint.
#[derive(Serialize)]
pub(crate) struct NoticeLine<'a> {
    text: &'a str,
    hint: &'a str,
}

impl<'a> From<&'a Notice> for NoticeLine<'a> {
    fn from(notice: &'a Notice) -> Self {
        Self { text: &notice.text, hint: &notice.hint }
    }
}

impl<'a> Answer<'a> {
    pub(crate) fn new(record: &'a SpeedRecord) -> Result<Self, serde_json::Error> {
        let analysis = record.analysis();
        let tone = record.tone();
        let points = |track: &[hovertone::speed::TrackPoint]| track.iter().map(|p| [p.time_s, p.speed_rev_s]).collect();
        let is_settled = record.speed().is_some();
        Ok(Self {
            status: record.status(),
            reason: record.reason(),
            speed: record.speed().map(speed_in_words),
            order: is_settled.then(|| record.order.lines_per_turn()),
            rotors: record
                .rotors()
                .iter()
                .map(|rotor| Rotor { speed: speed_in_words(&rotor.speed), track: points(&rotor.track) })
                .collect(),
            track: tone.filter(|_| is_settled).map(|tone| points(&tone.track)).unwrap_or_default(),
            readings: record
                .alternatives()
                .iter()
                .map(|reading| PossibleReading {
                    meaning: reading.meaning.to_string(),
                    speed_rev_s: reading.speed.rev_s(),
                    speed_rpm: reading.speed.rpm(),
                    plausibility: reading.plausibility,
                    order: reading.order.lines_per_turn(),
                    blades: reading.meaning.blades(),
                    gear_wheel: reading.meaning.gear().map(|gear| gear.wheel),
                })
                .collect(),
            why: decision_in_words(record).map(|words| words.odds),
            cuts: analysis.and_then(|analysis| cuts_in_words(&analysis.hover.cuts)),
            hover_s: analysis
                .map(|a| a.hover.segments.iter().map(|s| [s.from_s, s.to_s]).collect())
                .unwrap_or_default(),
            heard_s: analysis.map(|analysis| [analysis.heard.from_s, analysis.heard.to_s]),
            bands_hz: tone
                .map(|t| t.bands.iter().map(|b| [b.band_hz_low, b.band_hz_high]).collect())
                .unwrap_or_default(),
            notices: record.notices.iter().map(NoticeLine::from).collect(),
            facts: record.recording.as_ref(),
            json: speed_json(record)?,
        })
    }
}
