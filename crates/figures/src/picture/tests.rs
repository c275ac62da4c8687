//! Pictures of tones with known frequency, level and time.

use super::*;
use hovertone_signal::Signal;
use std::f64::consts::TAU;

const ALL: Span = Span { from_s: f64::MIN, to_s: f64::INFINITY };
const RATE_HZ: f64 = 8000.0;

fn view(hz_low: f64, hz_high: f64) -> PictureView {
    PictureView { harmonic: None, hz_low, hz_high, window_s: 0.1 }
}

/// A tone of amplitude 0.1 at `tone_hz`. At `loud_s` follows a click of 0.02 s at full scale with another frequency.
fn sound(length_s: f64, tone_hz: f64, loud_s: f64, loud_hz: f64) -> Signal {
    let samples = (0..(length_s * RATE_HZ) as usize).map(|n| {
        let time_s = n as f64 / RATE_HZ;
        let is_loud = (loud_s..loud_s + 0.02).contains(&time_s);
        let loud = if is_loud { (TAU * loud_hz * time_s).sin() } else { 0.0 };
        (0.1 * (TAU * tone_hz * time_s).sin() + 0.9 * loud) as f32
    });
    Signal::new(samples.collect(), RATE_HZ)
}

fn loudest_row(picture: &Picture, column: usize) -> (f64, f32) {
    let levels = picture.column(column);
    let row = (0..levels.len()).max_by(|&a, &b| levels[a].total_cmp(&levels[b])).unwrap();
    let row_hz = (picture.hz_high - picture.hz_low) / picture.row_count as f64;
    (picture.hz_low + (row as f64 + 0.5) * row_hz, levels[row])
}

#[test]
fn a_tone_is_in_its_row_at_its_level() {
    let mut source = sound(3.0, 1000.0, 99.0, 0.0).with_start_s(5.0);
    let config = PictureConfig::default();
    let pictures =
        pictures_from_source(&mut source, ALL, &[view(0.0, 4000.0), view(900.0, 1100.0)], &[], &config).unwrap();
    assert_eq!(pictures.pictures.len(), 2);
    assert!(pictures.spectrum.is_none());
    for picture in &pictures.pictures {
        assert_eq!(picture.level_db.len(), picture.row_count * picture.column_count);
        assert!(picture.span.from_s >= 5.0 && picture.span.to_s <= 8.0 && picture.span.length_s() > 2.8);
        assert!(picture.column_count > 50);
        let row_hz = (picture.hz_high - picture.hz_low) / picture.row_count as f64;
        for column in 0..picture.column_count {
            let (hz, level_db) = loudest_row(picture, column);
            assert!((hz - 1000.0).abs() <= row_hz / 2.0 + 1e-9, "{hz}");
            assert!((level_db + 20.0).abs() < 0.01, "{level_db}");
        }
    }
}

#[test]
fn long_recordings_have_bounded_pictures_in_which_nothing_loud_is_lost() {
    let config = PictureConfig { columns_max: 16, rows_max: 20, ..PictureConfig::default() };
    for (length_s, loud_s) in [(0.9, 0.31), (7.3, 6.6), (60.0, 41.0)] {
        let mut source = sound(length_s, 1000.0, loud_s, 3000.0);
        let pictures = pictures_from_source(&mut source, ALL, &[view(0.0, 4000.0)], &[], &config).unwrap();
        let picture = &pictures.pictures[0];
        assert!((8..=16).contains(&picture.column_count) && picture.row_count == 20, "{}", picture.column_count);
        let column_s = picture.span.length_s() / picture.column_count as f64;
        let loud: Vec<usize> = (0..picture.column_count)
            .filter(|&column| (loudest_row(picture, column).0 - 3000.0).abs() < 250.0)
            .collect();
        assert!(!loud.is_empty(), "{length_s} s");
        for column in loud {
            let middle_s = picture.span.from_s + (column as f64 + 0.5) * column_s;
            assert!((middle_s - loud_s).abs() <= column_s / 2.0 + 0.1, "{middle_s} for {loud_s} of {length_s} s");
        }
    }
}

#[test]
fn a_part_can_be_shown() {
    let part = Span { from_s: 1.0, to_s: 2.0 };
    let mut source = sound(3.0, 1000.0, 99.0, 0.0);
    let pictures =
        pictures_from_source(&mut source, part, &[view(0.0, 4000.0)], &[], &PictureConfig::default()).unwrap();
    let span = pictures.pictures[0].span;
    assert!(span.from_s >= 1.0 && span.to_s <= 2.0 && span.length_s() > 0.9, "{span:?}");
}

#[test]
fn the_mean_spectrum_is_that_of_the_hover_alone() {
    let config = PictureConfig::default();
    let mut source = sound(4.0, 1000.0, 3.5, 3000.0);
    let hover = [Span { from_s: 0.5, to_s: 3.0 }];
    let spectrum = pictures_from_source(&mut source, ALL, &[], &hover, &config).unwrap().spectrum.unwrap();
    let at = |hz: f64| spectrum.level_db[(hz / spectrum.bin_hz).round() as usize];
    assert!((at(1000.0) + 20.0).abs() < 0.01, "{}", at(1000.0));
    assert!(at(3000.0) < -80.0, "the click outside the hover is in it: {}", at(3000.0));
    assert_eq!(spectrum.frame_count, (2.5 / 0.05) as usize - 1);
}

#[test]
fn a_recording_shorter_than_a_frame_has_no_picture() {
    let mut source = sound(0.05, 1000.0, 99.0, 0.0);
    let pictures =
        pictures_from_source(&mut source, ALL, &[view(0.0, 4000.0)], &[], &PictureConfig::default()).unwrap();
    assert!(pictures.pictures.is_empty() && pictures.spectrum.is_none());
    let mut source = sound(1.0, 1000.0, 99.0, 0.0);
    let nowhere =
        pictures_from_source(&mut source, ALL, &[view(9000.0, 9100.0)], &[], &PictureConfig::default()).unwrap();
    assert!(nowhere.pictures.is_empty());
    let bad = PictureConfig { hop_share: 0.0, ..PictureConfig::default() };
    assert!(pictures_from_source(&mut source, ALL, &[], &[], &bad).is_err());
}
