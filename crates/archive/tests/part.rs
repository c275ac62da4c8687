//! The bytes of a part, whole and cut, and the tables that are made of parts.

#![allow(clippy::unwrap_used)]

use hovertone_analysis::{
    Hover, Method, NoTone, Outcome, RotorTone, Span, SpeedAnalysis, SpeedEstimate, TrackPoint, UncertaintySource,
    UncertaintyTerm,
};
use hovertone_archive::{ArchiveRow, Part, RecordingsTable, TracksTable, summaries_of_parquet};
use hovertone_report::{Answer, Notice, RecordingFacts, SpeedRecord, Wording};
use hovertone_vehicle::{Order, RotorSpeed};
use serde_json::json;

fn record(file: &str, answer: Answer) -> SpeedRecord {
    SpeedRecord {
        file: file.to_owned(),
        method: Method::Harmonic,
        order: Order::from_blades(2).unwrap(),
        wants_condition: false,
        settings: json!({}),
        recording: None,
        answer,
        found: None,
        labels: None,
        spoiled: None,
        notices: vec![Notice::new("quiet", "record nearer")],
        wording: Wording::default(),
    }
}

fn heard(file: &str, points: usize) -> ArchiveRow {
    let speed = SpeedEstimate {
        method: Method::Harmonic,
        order: Order::from_blades(2).unwrap(),
        speed: RotorSpeed::from_rev_s(60.0),
        std_uncertainty_rev_s: Some(0.1 + 0.2),
        spread_rev_s: None,
        mean_square_rad2_s2: None,
        frame_count: points,
        harmonics: Vec::new(),
        budget: vec![UncertaintyTerm { source: UncertaintySource::Clock, std_uncertainty_rev_s: 0.25 }],
    };
    let point = |at: usize| TrackPoint {
        time_s: 0.1 * at as f64,
        tone_hz: 120.0,
        speed_rev_s: 60.0,
        std_uncertainty_rev_s: 0.1,
        level_db: -20.0,
    };
    let tone = RotorTone {
        bands: Vec::new(),
        window_s: 0.1,
        ridges: Vec::new(),
        speeds: vec![speed],
        track: (0..points).map(point).collect(),
        rotors: Vec::new(),
        condition: None,
        samples: Vec::new(),
        alternatives: Vec::new(),
        weighed: Vec::new(),
    };
    let span = Span { from_s: 0.0, to_s: 2.0 };
    let analysis =
        SpeedAnalysis { heard: span, hover: Hover::whole(span), outcome: Outcome::Ok(tone), warnings: Vec::new() };
    let facts = RecordingFacts {
        sha256: Some("ab".to_owned()),
        container: "WAV".to_owned(),
        codec: "PCM".to_owned(),
        decoder: "hovertone".to_owned(),
        sample_rate_hz: 44_100.0,
        clock_correction_ppm: 0.0,
        channel_count: 1,
        channel: None,
        audio_track: 1,
        audio_track_count: 1,
        is_prefix: true,
    };
    let record = SpeedRecord { recording: Some(facts), ..record(file, Answer::Heard(Box::new(analysis))) };
    ArchiveRow { record, error_class: None }
}

fn failed(file: &str) -> ArchiveRow {
    let answer = Answer::Failed { reason: "the file is empty".to_owned() };
    ArchiveRow { record: record(file, answer), error_class: Some("empty") }
}

fn silent(file: &str) -> ArchiveRow {
    let span = Span { from_s: 0.0, to_s: 2.0 };
    let outcome = Outcome::NoRotorTone { reason: NoTone::Silence };
    let analysis = SpeedAnalysis { heard: span, hover: Hover::default(), outcome, warnings: Vec::new() };
    ArchiveRow { record: record(file, Answer::Heard(Box::new(analysis))), error_class: None }
}

#[test]
fn a_part_reads_back_and_a_cut_one_is_none() {
    for row in [heard("ω.wav", 3), failed("b"), silent("c")] {
        let part = Part::new(&row, Some("data:image/png;base64,AA".to_owned())).unwrap();
        let bytes = part.to_bytes().unwrap();
        assert_eq!(bytes, part.to_bytes().unwrap());
        assert_eq!(Part::from_bytes(&bytes).unwrap(), part);
        for length in (0..bytes.len()).filter(|length| length % 61 == 0 || length + 200 > bytes.len()) {
            assert!(Part::from_bytes(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
        }
        let zeros = vec![0; bytes.len()];
        assert!(Part::from_bytes(&zeros).is_err());
    }
}

#[test]
fn tables_have_the_rows_of_their_parts_and_equal_bytes() {
    let rows: Vec<ArchiveRow> = (0..1200)
        .map(|number| match number % 3 {
            0 => heard(&format!("{number:04}"), 60),
            1 => failed(&format!("{number:04}")),
            _ => silent(&format!("{number:04}")),
        })
        .collect();
    let parts: Vec<Part> = rows.iter().map(|row| Part::new(row, None).unwrap()).collect();
    let written = |parts: &[Part]| {
        let settings = json!({"order": 2.0});
        let mut recordings = RecordingsTable::begin(Vec::new(), &settings).unwrap();
        let mut tracks = TracksTable::begin(Vec::new(), &settings).unwrap();
        for part in parts {
            recordings.push(part).unwrap();
            tracks.push(part).unwrap();
        }
        (recordings.finish().unwrap(), tracks.finish().unwrap())
    };
    let (recordings, tracks) = written(&parts);
    let reread: Vec<Part> = parts.iter().map(|part| Part::from_bytes(&part.to_bytes().unwrap()).unwrap()).collect();
    assert_eq!(written(&reread), (recordings.clone(), tracks.clone()));
    let summaries = summaries_of_parquet(bytes::Bytes::from(recordings)).unwrap();
    assert_eq!(summaries.len(), 1200);
    for ((number, summary), part) in (0..).zip(&summaries).zip(&parts) {
        assert_eq!((summary.file.as_str(), summary), (format!("{number:04}").as_str(), &part.summary().unwrap()));
    }
    let first = &summaries[0];
    assert_eq!(first.speed.unwrap().std_rev_s, Some(0.25));
    assert_eq!((first.clock_std_rev_s, first.used_s, first.is_prefix), (0.25, Some((0.0, 2.0)), true));
    assert_eq!((summaries[1].status.as_str(), summaries[2].status.as_str()), ("error", "no_rotor_tone"));
    let group = parquet::file::reader::SerializedFileReader::new(bytes::Bytes::from(tracks)).unwrap();
    use parquet::file::reader::FileReader;
    assert_eq!(group.metadata().file_metadata().num_rows(), 400 * 60);
}
