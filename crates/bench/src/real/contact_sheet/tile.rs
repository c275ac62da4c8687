//! One recording of the sheet: its spectrogram, our answer and the truth.

use crate::real::answer::Status;
use crate::real::cases::{Mode, SpeedRange, Told, Truth, TruthSet};
use crate::real::hearing::duration_s;
use crate::real::judgement::Verdict;
use crate::real::program::Program;
use crate::real::rows::Row;
use hovertone::sound::SignalSource;
use hovertone::speed::Span;
use hovertone_figures::{PictureConfig, PictureView, Thumbnail, pictures_from_source, thumbnail_uri, whitened};
use hovertone_media::{OpenOptions, Recording};
use std::fs;
use std::path::Path;

/// Pixels of a spectrogram.
pub(super) const WIDTH: usize = 228;
pub(super) const HEIGHT: usize = 118;
/// Orders of the blade pass that are shown, and of the shaft of a bare motor, whose loud lines are its 13th and 14th.
const ORDERS: u32 = 8;
const ORDERS_OF_A_SHAFT: u32 = 16;
/// Space above the highest order.
const HEADROOM_ORDERS: f64 = 0.5;
/// Highest frequency where nothing says where a rotor is.
const HZ_HIGH_OF_NOTHING: f64 = 2000.0;
/// Levels over the floor of white and black.
const LEVEL_DB_LOW: f64 = 4.0;
const LEVEL_DB_HIGH: f64 = 22.0;
/// A line is about 4 bins wide: frames are chosen so that it is this share of the height.
const LINE_SHARE: f64 = 0.02;
const WINDOW_S_MIN: f64 = 0.04;
const WINDOW_S_MAX: f64 = 0.25;
const HOP_SHARE: f64 = 0.25;

/// A point of a track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TrackPoint {
    pub(super) time_s: f64,
    pub(super) speed_rev_s: f64,
}

/// Everything that a tile shows.
pub(super) struct Tile {
    pub(super) name: String,
    pub(super) class: String,
    pub(super) verdict: Verdict,
    /// The answer in words.
    pub(super) answer: String,
    /// A data URI.
    pub(super) picture: String,
    pub(super) shown: Span,
    pub(super) hz_high: f64,
    /// Lines of a turn that the tone has.
    pub(super) lines_per_turn: f64,
    pub(super) order_count: u32,
    pub(super) tracks: Vec<Vec<TrackPoint>>,
    /// Speed of the first reading of an ambiguous answer.
    pub(super) reading_rev_s: Option<f64>,
    pub(super) truths_rev_s: Vec<f64>,
    pub(super) accepted: Option<SpeedRange>,
}

/// The truths of one file that share a tile, each with its flags.
pub(super) struct TileCase<'a> {
    pub(super) truth: &'a Truth,
    pub(super) flags: &'a [String],
}

/// For each file the flags that tell the blades: of the whole file, or of every stretch that has a truth.
pub(super) fn tile_cases(set: &TruthSet) -> Vec<Vec<TileCase<'_>>> {
    let mut tiles: Vec<Vec<TileCase<'_>>> = Vec::new();
    for truth in &set.truths {
        let of_blades = |is_spanned: bool| {
            truth.flags.iter().find(|flags| Mode::of(flags) == Mode { told: Told::Blades, is_spanned })
        };
        let Some(flags) = of_blades(false).or_else(|| of_blades(true)) else { continue };
        let case = TileCase { truth, flags };
        match tiles.iter_mut().find(|tile| tile[0].truth.file == truth.file) {
            // other channels of the same sound look the same
            Some(_) if !Mode::of(flags).is_spanned => {}
            Some(tile) => tile.push(case),
            None => tiles.push(vec![case]),
        }
    }
    tiles
}

/// Hears the cases of a tile again for their tracks, and draws its spectrogram.
pub(super) fn tile_of(cases: &[TileCase<'_>], set: &TruthSet, program: &Program, rows: &[Row]) -> Result<Tile, String> {
    let truth = cases[0].truth;
    let path = set.path(&truth.file);
    let of_cases: Vec<&Row> = cases
        .iter()
        .filter_map(|case| {
            let flags = case.flags.join(" ");
            rows.iter().find(|row| row.set == set.name && row.file == truth.file && row.flags == flags)
        })
        .collect();
    let worst = of_cases.iter().find(|row| row.verdict != Verdict::Right).or(of_cases.first());
    let row = worst.ok_or_else(|| format!("{}: it was not heard", truth.file))?;
    let (mut tracks, mut reading_rev_s) = (Vec::new(), None);
    for case in cases {
        let table = tempfile::NamedTempFile::new().map_err(|error| error.to_string())?;
        let with_track = ["--track".to_owned(), table.path().display().to_string()];
        let answer = program.speed(&[case.flags, &with_track].concat(), &path)?;
        if answer.status == Status::Ambiguous {
            reading_rev_s = answer.alternatives.first().map(|reading| reading.speed_rev_s);
        }
        tracks.extend(tracks_of(&fs::read_to_string(table.path()).unwrap_or_default()));
    }
    let lines_per_turn = truth.blades.filter(|_| truth.kind != "motor_tone").map_or(1.0, f64::from);
    let is_shaft = truth.kind == "motor_tone";
    let order_count = if is_shaft { ORDERS_OF_A_SHAFT } else { ORDERS };
    let accepted = row.accepted_rev_s;
    let middle_rev_s = accepted.map(|range| f64::midpoint(range.low, range.high)).or(row.speed_rev_s);
    // a recording without a rotor names no blades: the flags tell 2
    let lines_per_turn = if truth.blades.is_none() && !is_shaft { 2.0 } else { lines_per_turn };
    let top_hz = middle_rev_s.map(|speed| speed * lines_per_turn * (f64::from(order_count) + HEADROOM_ORDERS));
    let hz_high = top_hz.unwrap_or(HZ_HIGH_OF_NOTHING);
    let shown = shown_span(&path)?;
    Ok(Tile {
        name: row.file_name().to_owned(),
        class: row.trusted_class(),
        verdict: row.verdict,
        answer: row.answer(),
        picture: picture_uri(&path, shown, hz_high)?,
        shown,
        hz_high,
        lines_per_turn,
        order_count,
        tracks,
        reading_rev_s,
        truths_rev_s: cases.iter().flat_map(|case| case.truth.speeds_rev_s.iter().copied()).collect(),
        accepted: accepted.filter(|_| cases.len() == 1),
    })
}

/// From the first sample to the last.
fn shown_span(path: &Path) -> Result<Span, String> {
    let recording = Recording::open(path, &OpenOptions::default()).map_err(|error| error.to_string())?;
    let from_s = recording.start_s();
    let duration_s = duration_s(path).ok_or_else(|| format!("{}: it cannot be read", path.display()))?;
    Ok(Span { from_s, to_s: from_s + duration_s })
}

fn picture_uri(path: &Path, shown: Span, hz_high: f64) -> Result<String, String> {
    let mut recording = Recording::open(path, &OpenOptions::default()).map_err(|error| error.to_string())?;
    let window_s = (4.0 / (LINE_SHARE * hz_high)).clamp(WINDOW_S_MIN, WINDOW_S_MAX);
    let config = PictureConfig {
        zoom_window_s: window_s,
        hop_share: HOP_SHARE,
        columns_max: WIDTH * 2,
        rows_max: HEIGHT,
        ..PictureConfig::default()
    };
    let view = PictureView { harmonic: None, hz_low: 0.0, hz_high, window_s };
    let pictures = pictures_from_source(&mut recording, shown, &[view], &[], &config);
    let pictures = pictures.map_err(|error| error.to_string())?.pictures;
    let picture = pictures.first().ok_or_else(|| format!("{}: too short for a picture", path.display()))?;
    let thumbnail = Thumbnail {
        hz_high,
        level_db_low: LEVEL_DB_LOW,
        level_db_high: LEVEL_DB_HIGH,
        width_max: WIDTH,
        height_max: HEIGHT,
    };
    thumbnail_uri(&whitened(picture), &thumbnail).map_err(|error| error.to_string())
}

/// The tracks of a table of `--track`: one, or one for each rotor.
fn tracks_of(csv: &str) -> Vec<Vec<TrackPoint>> {
    let mut lines = csv.lines();
    let heads: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &str| heads.iter().position(|head| *head == name);
    let (Some(time), Some(speed)) = (place("time_s"), place("speed_rev_s")) else { return Vec::new() };
    let rotor = place("rotor");
    let mut tracks: Vec<Vec<TrackPoint>> = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells.get(at).and_then(|cell| cell.parse::<f64>().ok());
        let (Some(time_s), Some(speed_rev_s)) = (number(time), number(speed)) else { continue };
        let name = rotor.and_then(|at| cells.get(at)).copied().unwrap_or_default();
        let index = names.iter().position(|known| *known == name).unwrap_or_else(|| {
            names.push(name);
            tracks.push(Vec::new());
            tracks.len() - 1
        });
        tracks[index].push(TrackPoint { time_s, speed_rev_s });
    }
    tracks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracks_are_parted_by_rotor() {
        let one = tracks_of("time_s,tone_hz,speed_rev_s\n0.1,160,80\n0.2,162,81\n");
        assert_eq!(
            one,
            [[TrackPoint { time_s: 0.1, speed_rev_s: 80.0 }, TrackPoint { time_s: 0.2, speed_rev_s: 81.0 }]]
        );
        let two = tracks_of("time_s,speed_rev_s,rotor\n0.1,80,1\n0.1,90,2\n0.2,81,1\n");
        assert_eq!(two.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert!(tracks_of("").is_empty());
    }
}
