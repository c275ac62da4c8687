//! The peers' own test signals: four wandering rotors, heard by hovertone and by the peers.

use super::condition::heard;
use super::draws::drawn;
use super::peers::{PEERS, make_band_passed};
use super::single_rotor::shown;
use super::track::{Score, TrackFrame, TrueTrack, median, score_of_track};
use super::workbench::Workbench;
use crate::document::Document;
use crate::workspace::output_of;
use hovertone::speed::{Method, Outcome, RotorTone, ToneConfig, TrackPoint};
use hovertone_media::{OpenOptions, Recording};
use hovertone_vehicle::Gear;
use std::fs;
use std::path::PathBuf;

/// Writes the truth, kept in numpy's own format, as a table.
const TRUTH_TO_CSV: &str = "import sys, numpy as np; d = np.load(sys.argv[1]); \
    np.savetxt(sys.argv[2], np.column_stack([d['t'], d['rev'].T]), delimiter=',', fmt='%.17g')";

/// Points of a track further apart than this have a gap between them.
const GAP_S: f64 = 0.1;

/// A signal and how the peers' script is told to make it.
struct Case {
    name: &'static str,
    what: &'static str,
    arguments: &'static [&'static str],
}

const CASES: [Case; 5] = [
    Case {
        name: "hover4",
        what: "four rotors at 59.4, 59.9, 60.3 and 60.8 rev/s, each wandering by 0.25 rev/s; tones as strong as the noise",
        arguments: &["--case", "hover", "--rotors", "4"],
    },
    Case {
        name: "noisy4",
        what: "the same, tones 15 dB below the noise",
        arguments: &["--case", "hover", "--rotors", "4", "--snr", "-15"],
    },
    Case {
        name: "loud4",
        what: "the same as hover4, the fastest rotor 6 dB louder",
        arguments: &["--case", "hover", "--rotors", "4", "--loud", "6"],
    },
    Case {
        name: "ramp4",
        what: "from 51 to 68 rev/s with 30 s of hover between, no wander",
        arguments: &["--case", "ramp", "--rotors", "4"],
    },
    Case { name: "steady1", what: "one rotor at 60 rev/s", arguments: &["--case", "steady", "--rotors", "1"] },
];

struct Files {
    wav: PathBuf,
    truth: TrueTrack,
}

/// What came of one program.
enum Came {
    Scored(Score),
    /// It ran and said nothing, and why.
    Silent(String),
    /// It could not be run, and why.
    LeftOut(String),
}

/// One row.
struct Row {
    name: String,
    came: Came,
    /// What is said below the table.
    note: Option<String>,
}

/// Says that it is left out where the peers' scripts are not there, or not what they need to run.
pub(super) fn add_four_rotors(document: &mut Document, workbench: Option<&Workbench>) -> Result<(), String> {
    document.heading("Four rotors, against other programs");
    let Some(workbench) = workbench else {
        document.paragraph("Left out: the peers' scripts are not in `../shared/peers`.");
        return Ok(());
    };
    let cases = match drawn(CASES.len(), |index| CASES[index].files(workbench)) {
        Ok(files) => CASES.iter().zip(files),
        Err(reason) => {
            document
                .paragraph(&format!("Left out: a signal could not be made ({reason}). `--install-peers` may help."));
            return Ok(());
        }
    };
    document.paragraph(
        "60 s at 48 kHz: gear mesh 69, 138, 207, blade pass 2 to 12, pink and white noise (the peers' `make_signal.py`). \
         hovertone with `--gear 8:69 --blades 2`, `--rotors` and nothing else; the others were told the band to look in, as far as they \
         can be. \"Band-passed\" programs cannot, and heard a recording that was filtered to 3450–4830 Hz for them. Scored \
         frame by frame against the mean of the rotors, half a second cut at both ends: share of frames with an answer, \
         median |error|, share of all frames within 1 % and off by more than 20 %, median distance to the nearest rotor, \
         and the error that a thrust constant from the whole file would have.",
    );
    document.paragraph(&format!("Installed here: {}.", workbench.versions()));
    for (case, files) in cases {
        eprintln!("{}", case.name);
        let mut rows = hovertone_rows(&files)?;
        rows.extend(peer_rows(workbench, &files)?);
        document.paragraph(&format!("**{}**: {}.", case.name, case.what));
        let cells: Vec<_> = rows.iter().filter_map(Row::cells).collect();
        let heads = ["", "answered %", "median error %", "within 1 %", "gross %", "nearest rotor %", "C_f error %"];
        document.table(&heads, &cells);
        document.notes(rows.iter().filter_map(|row| Some((row.name.clone(), row.said_below()?))).collect());
    }
    Ok(())
}

impl Row {
    fn cells(&self) -> Option<Vec<String>> {
        let whole = |share: f64| format!("{:.1}", 100.0 * share);
        let mut cells = vec![self.name.clone()];
        match &self.came {
            Came::LeftOut(_) => return None,
            Came::Silent(_) => {
                cells.push(whole(0.0));
                cells.extend(vec!["–".to_owned(); 5]);
            }
            Came::Scored(score) => cells.extend([
                whole(score.answered),
                format!("{:.3}", 100.0 * score.median_error),
                whole(score.within),
                whole(score.gross),
                format!("{:.3}", 100.0 * score.nearest),
                // adding nothing makes a zero of a negative zero
                format!("{:+.2}", (1e4 * score.thrust_constant_error).round() / 100.0 + 0.0),
            ]),
        }
        Some(cells)
    }

    fn said_below(&self) -> Option<String> {
        match &self.came {
            Came::Scored(score) => {
                let each: Vec<String> = score.each_rotor.iter().map(|error| format!("{:.3}", 100.0 * error)).collect();
                let rotors = (!each.is_empty()).then(|| format!("rotor by rotor, median error %, {}", each.join(", ")));
                let said: Vec<String> = self.note.clone().into_iter().chain(rotors).collect();
                (!said.is_empty()).then(|| said.join("; "))
            }
            Came::Silent(reason) => Some(format!("nothing, {reason}")),
            Came::LeftOut(reason) => Some(format!("left out, {reason}")),
        }
    }
}

impl Case {
    /// Makes the recording, its band-passed copy and its truth.
    fn files(&self, workbench: &Workbench) -> Result<Files, String> {
        let folder = workbench.folder("signals")?;
        let script = workbench.script("make_signal.py");
        output_of(
            workbench.python().arg(script).args(["--out", self.name]).args(self.arguments).arg("--dir").arg(&folder),
        )?;
        let wav = folder.join(self.name).with_extension("wav");
        make_band_passed(workbench, &wav)?;
        let kept = folder.join(format!("{}_truth.npz", self.name));
        let table = folder.join(format!("{}_truth.csv", self.name));
        output_of(workbench.python().args(["-c", TRUTH_TO_CSV]).arg(kept).arg(&table))?;
        let text = fs::read_to_string(&table).map_err(|error| format!("{}: {error}", table.display()))?;
        Ok(Files { wav, truth: TrueTrack::from_csv(&text)? })
    }
}

/// hovertone by each method.
fn hovertone_rows(files: &Files) -> Result<Vec<Row>, String> {
    let rotor_count = files.truth.rotor_count() as u32;
    let methods: Vec<Method> =
        Method::ALL.into_iter().filter(|method| rotor_count > 1 || *method != Method::Separated).collect();
    drawn(methods.len(), |index| {
        let method = methods[index];
        let order = Gear { pinion: 8, wheel: 69 }.mesh_order().map_err(|error| error.to_string())?;
        let tone = ToneConfig { blades: Some(2), ..ToneConfig::of_order(order) };
        let mut recording = Recording::open(&files.wav, &OpenOptions::default()).map_err(|error| error.to_string())?;
        let analysis = heard(&mut recording, tone, rotor_count, method)?;
        let name = format!("hovertone, {}", shown(method));
        let tone = match &analysis.outcome {
            Outcome::NoRotorTone { reason } => {
                return Ok(Row { name, came: Came::Silent(reason.to_string()), note: None });
            }
            Outcome::Ok(tone) => tone,
        };
        let note =
            tone.speed(method).zip(files.truth.mean_over(&analysis.hover.segments)).map(|(speed, truth_rev_s)| {
                let u = speed.combined_std_uncertainty_rev_s().map_or("–".to_owned(), |std| format!("{std:.1e}"));
                let error_rev_s = speed.speed.rev_s() - truth_rev_s;
                format!(
                    "mean {:.4} rev/s, stated u with that of the clock {u}, off by {error_rev_s:+.1e}",
                    speed.speed.rev_s()
                )
            });
        let frames = frames_of(tone);
        let steps = frames.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
        let frame_count = median(steps).map(|step_s| files.truth.scored_s() / step_s);
        Ok(Row { name, came: came_of(&frames, &files.truth, frame_count), note })
    })
}

/// The track, with the rotors one by one where they were told apart.
fn frames_of(tone: &RotorTone) -> Vec<TrackFrame> {
    let mut frames: Vec<TrackFrame> = tone.track.iter().map(TrackFrame::from).collect();
    for frame in &mut frames {
        frame.rotors_rev_s = tone.rotors.iter().filter_map(|rotor| speed_at(&rotor.track, frame.time_s)).collect();
        frame.rotors_rev_s.sort_by(f64::total_cmp);
    }
    frames
}

/// Speed at a time between two neighbouring points; none in a gap.
fn speed_at(track: &[TrackPoint], time_s: f64) -> Option<f64> {
    let after = track.partition_point(|point| point.time_s < time_s);
    let (a, b) = (track.get(after.checked_sub(1)?)?, track.get(after)?);
    let share = (time_s - a.time_s) / (b.time_s - a.time_s);
    (b.time_s - a.time_s < GAP_S).then_some(a.speed_rev_s + share * (b.speed_rev_s - a.speed_rev_s))
}

fn came_of(frames: &[TrackFrame], truth: &TrueTrack, frame_count: Option<f64>) -> Came {
    score_of_track(frames, truth, frame_count)
        .map_or_else(|| Came::Silent("no frame has a speed".to_owned()), Came::Scored)
}

fn peer_rows(workbench: &Workbench, files: &Files) -> Result<Vec<Row>, String> {
    let suited: Vec<_> =
        PEERS.iter().filter(|peer| peer.rotor_count.is_none_or(|count| count == files.truth.rotor_count())).collect();
    drawn(suited.len(), |index| {
        let peer = suited[index];
        let came = match peer.track(workbench, &files.wav) {
            Ok(frames) => came_of(&frames, &files.truth, None),
            Err(reason) => Came::LeftOut(reason),
        };
        Ok(Row { name: peer.name.to_owned(), came, note: None })
    })
}
