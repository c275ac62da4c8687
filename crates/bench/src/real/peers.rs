//! Other programs on the same recordings: the scripts beside the repository run them, and the same judgement judges them.

use super::answer::{Answer, Status};
use super::cases::{Mode, Told, Truth, TruthSet};
use super::judgement::{Expected, Verdict};
use super::program::Program;
use super::progress::Progress;
use super::prototype;
use super::rows::Row;
use super::semi_real::{self, python};
use super::truth_track::TruthTrack;
use crate::accuracy::drawn;
use crate::document::Document;
use crate::workspace::{output_of, target};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The programs of `../shared/peers/peers_real.py`, told the blades.
const TOOLS: [&str; 8] = [
    "aubio_yinfft",
    "praat_ac",
    "swift_f0",
    "librosa_yin",
    "librosa_pyin",
    "rota_blade",
    "rota_default",
    "essentia_melodia",
];
/// An estimate counts as an answer where at least this share of the frames has a pitch, as in the script.
const VOICED_SHARE_MIN: f64 = 0.5;

/// The heading of the section, which a run without `--peers` keeps.
const TITLE: &str = "Other programs";

/// Where everything lies.
pub(super) struct Peers<'a> {
    pub(super) root: &'a Path,
    pub(super) data: &'a Path,
    pub(super) semi_real: Option<&'a TruthSet>,
    pub(super) program: &'a Program,
}

/// One answer of a script, by file.
#[derive(Debug, Deserialize, Serialize)]
struct Estimate {
    /// The file.
    id: String,
    #[serde(rename = "est")]
    speed_rev_s: Option<f64>,
    /// Share of the frames that have a pitch.
    voiced: f64,
    #[serde(default)]
    error: Option<String>,
}

impl Estimate {
    fn answer(&self) -> Answer {
        let speed_rev_s = self.speed_rev_s.filter(|_| self.voiced >= VOICED_SHARE_MIN);
        let status = if speed_rev_s.is_some() { Status::Ok } else { Status::NoRotorTone };
        Answer { status, speed_rev_s, combined_std_uncertainty_rev_s: Some(0.0), ..Answer::default() }
    }
}

/// A column: its name and the verdict of each file.
struct Column {
    name: String,
    verdicts: BTreeMap<String, Verdict>,
}

/// The section of the report: for each set and class, the outcomes of every program.
pub(super) fn add_peers(
    document: &mut Document,
    peers: &Peers<'_>,
    sets: &[&TruthSet],
    rows: &[Row],
    made_by: &str,
) -> Result<(), String> {
    document.heading(TITLE);
    document.paragraph(&format!("This section: {made_by}."));
    document.paragraph(
        "Each cell: right / octave / wrong / no speed, of the files whose truth is trusted, over the whole file. The programs are told what \
         `--blades` tells, and the range of speeds (12 to 480 rev/s); they give the median of the frames with a pitch, or no speed where fewer \
         than half of the frames have one. The prototype is `../shared/prototypes/rotor_evidence.py`. Here any speed between the slowest and \
         the fastest rotor is right. An ambiguous answer is no speed. Several channels of one recording count once.",
    );
    for set in sets {
        let mut columns = vec![own_column(rows, set, Told::Blades)];
        for tool in TOOLS {
            match estimates(peers, tool, set) {
                Ok(estimates) => columns.push(column_of_tool(tool, &estimates, set)?),
                Err(error) => {
                    eprintln!("{tool} is left out: {error}");
                    document.paragraph(&format!("Left out on the {} recordings: {tool} ({error}).", set.name));
                }
            }
        }
        for told in [Told::Blades, Told::Known] {
            if told == Told::Known {
                columns.push(own_column(rows, set, told));
            }
            match prototype_column(peers, set, told) {
                Ok(column) => columns.push(column),
                Err(error) => {
                    eprintln!("the prototype is left out: {error}");
                    document.paragraph(&format!("Left out on the {} recordings: the prototype ({error}).", set.name));
                    break;
                }
            }
        }
        document.paragraph(&format!("The {} recordings:", set.name));
        add_columns(document, &columns, set);
    }
    Ok(())
}

/// The section of an earlier report, up to the next heading.
pub(super) fn kept_section(report: &str) -> Option<&str> {
    let from = report.find(&format!("## {TITLE}\n"))?;
    let end = report[from..].find("\n## ").map_or(report.len(), |at| from + at);
    Some(&report[from..end])
}

/// The trusted recordings of a set with their flags of one mode over the whole file, each file once.
fn contests(set: &TruthSet, told: Told) -> Vec<Contest<'_>> {
    let mut found: Vec<Contest<'_>> = Vec::new();
    for truth in set.truths.iter().filter(|truth| !truth.is_low_confidence()) {
        let flags = truth.flags.iter().find(|flags| Mode::of(flags) == Mode { told, is_spanned: false });
        let is_new = !found.iter().any(|contest| contest.truth.file == truth.file);
        found.extend(flags.filter(|_| is_new).map(|flags| Contest { truth, flags }));
    }
    found
}

/// One file that all programs hear.
struct Contest<'a> {
    truth: &'a Truth,
    flags: &'a [String],
}

impl Contest<'_> {
    fn verdict(&self, set: &TruthSet, answer: &Answer) -> Result<Verdict, String> {
        let track = self.truth.truth_csv.as_ref().map(|file| TruthTrack::read(&set.path(file))).transpose()?;
        Ok(Expected::of(self.truth, self.flags, answer, track.as_ref()).verdict(answer))
    }
}

fn own_column(rows: &[Row], set: &TruthSet, told: Told) -> Column {
    let mode = Mode { told, is_spanned: false }.name();
    let verdicts = contests(set, told).into_iter().filter_map(|contest| {
        let flags = contest.flags.join(" ");
        let row =
            rows.iter().find(|row| row.set == set.name && row.file == contest.truth.file && row.flags == flags)?;
        Some((row.file.clone(), row.verdict))
    });
    Column { name: format!("hovertone, {mode}"), verdicts: verdicts.collect() }
}

/// The answers of a tool on a set: those of an earlier run, or by the script. They do not depend on our program.
fn estimates(peers: &Peers<'_>, tool: &str, set: &TruthSet) -> Result<Vec<Estimate>, String> {
    let script = peers.root.join("../shared/peers/peers_real.py");
    let name = name_for_scripts(set);
    let folder = folder(peers.root)?;
    let out = folder.join(format!("{name}.{tool}.json"));
    if let Ok(estimates) = read_estimates(&out) {
        return Ok(estimates);
    }
    eprintln!("{tool} on the {} recordings", set.name);
    let mut command = python(peers.root);
    command.arg(&script).args(["run", tool, name]).env("OUT", &folder).env("HOVERTONE", peers.program.path());
    command.env("RF", absolute(peers.data)?);
    if let Some(set) = peers.semi_real {
        command.env("SEMI", absolute(&set.path("."))?);
    }
    output_of(&mut command)?;
    read_estimates(&out)
}

/// The set, as the scripts name it.
fn name_for_scripts(set: &TruthSet) -> &'static str {
    if set.name == semi_real::NAME { "semi" } else { "real" }
}

/// Where the answers of the other programs are kept; who deletes it has them run anew.
fn folder(root: &Path) -> Result<PathBuf, String> {
    let folder = absolute(&target(root).join("real/peers"))?;
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(folder)
}

/// # Errors
/// No file, or one in which every recording has failed.
fn read_estimates(path: &Path) -> Result<Vec<Estimate>, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let estimates: Vec<Estimate> = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    match estimates.iter().map(|estimate| estimate.error.clone()).collect::<Option<Vec<_>>>() {
        Some(errors) => Err(errors.first().cloned().unwrap_or_else(|| "it heard no file".to_owned())),
        None => Ok(estimates),
    }
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    std::path::absolute(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn column_of_tool(tool: &str, estimates: &[Estimate], set: &TruthSet) -> Result<Column, String> {
    let mut verdicts = BTreeMap::new();
    for contest in contests(set, Told::Blades) {
        if let Some(estimate) = estimates.iter().find(|estimate| estimate.id == contest.truth.file) {
            verdicts.insert(contest.truth.file.clone(), contest.verdict(set, &estimate.answer())?);
        }
    }
    Ok(Column { name: tool.replace('_', " "), verdicts })
}

fn prototype_column(peers: &Peers<'_>, set: &TruthSet, told: Told) -> Result<Column, String> {
    let contests: Vec<Contest<'_>> =
        contests(set, told).into_iter().filter(|contest| prototype::can_hear(contest.flags)).collect();
    let mode = Mode { told, is_spanned: false }.name();
    let kept = folder(peers.root)?.join(format!("{}.prototype_{mode}.json", name_for_scripts(set)));
    let estimates = match read_estimates(&kept) {
        Ok(estimates) => estimates,
        Err(_) => {
            let estimates = prototype_estimates(peers, set, &contests)?;
            let text = serde_json::to_string(&estimates).map_err(|error| error.to_string())?;
            fs::write(&kept, text).map_err(|error| format!("{}: {error}", kept.display()))?;
            estimates
        }
    };
    let mut verdicts = BTreeMap::new();
    for contest in &contests {
        if let Some(estimate) = estimates.iter().find(|estimate| estimate.id == contest.truth.file) {
            verdicts.insert(contest.truth.file.clone(), contest.verdict(set, &estimate.answer())?);
        }
    }
    Ok(Column { name: format!("prototype, {mode}"), verdicts })
}

fn prototype_estimates(peers: &Peers<'_>, set: &TruthSet, contests: &[Contest<'_>]) -> Result<Vec<Estimate>, String> {
    let script = peers.root.join("../shared/prototypes/rotor_evidence.py");
    let progress = Progress::new(&format!("prototype on the {} recordings", set.name), contests.len());
    let lock = std::sync::Mutex::new(());
    drawn(contests.len(), |number| {
        let Contest { truth, flags } = &contests[number];
        // the script decodes such a file into one and the same place
        let _guard = prototype::is_decoded(&truth.file).then(|| lock.lock());
        let speed_rev_s = prototype::heard(python(peers.root), &script, &set.path(&truth.file), flags)?;
        progress.step();
        let voiced = if speed_rev_s.is_some() { 1.0 } else { 0.0 };
        Ok(Estimate { id: truth.file.clone(), speed_rev_s, voiced, error: None })
    })
}

/// Right / octave / wrong / no speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    right: usize,
    octave: usize,
    wrong: usize,
    no_speed: usize,
}

impl Tally {
    fn add(&mut self, verdict: Verdict) {
        match verdict {
            // these programs give one rotor, and not the mean of several
            Verdict::Right | Verdict::MeanOff => self.right += 1,
            Verdict::Octave => self.octave += 1,
            Verdict::Wrong => self.wrong += 1,
            Verdict::First | Verdict::Listed | Verdict::Missing | Verdict::Silent => self.no_speed += 1,
        }
    }

    fn cell(self) -> String {
        let Self { right, octave, wrong, no_speed } = self;
        if right + octave + wrong + no_speed == 0 {
            "–".to_owned()
        } else {
            format!("{right} / {octave} / {wrong} / {no_speed}")
        }
    }
}

fn add_columns(document: &mut Document, columns: &[Column], set: &TruthSet) {
    let mut classes: Vec<&str> = Vec::new();
    for truth in set.truths.iter().filter(|truth| !truth.is_low_confidence()) {
        if !classes.contains(&truth.class.as_str()) {
            classes.push(&truth.class);
        }
    }
    let tally = |column: &Column, class: Option<&str>| {
        let mut tally = Tally::default();
        let mut files: Vec<&str> = Vec::new();
        for truth in set.truths.iter().filter(|truth| class.is_none_or(|class| class == truth.class)) {
            if let Some(verdict) = column.verdicts.get(&truth.file).filter(|_| !files.contains(&truth.file.as_str())) {
                tally.add(*verdict);
                files.push(&truth.file);
            }
        }
        tally.cell()
    };
    let line = |class: Option<&str>| {
        let cells = columns.iter().map(|column| tally(column, class));
        [class.unwrap_or("**all**").to_owned()].into_iter().chain(cells).collect::<Vec<String>>()
    };
    let lines: Vec<Vec<String>> = classes.iter().map(|class| line(Some(class))).chain([line(None)]).collect();
    let lines: Vec<Vec<String>> =
        lines.into_iter().filter(|line| line.iter().skip(1).any(|cell| cell != "–")).collect();
    let heads: Vec<&str> = ["class"].into_iter().chain(columns.iter().map(|column| column.name.as_str())).collect();
    document.table(&heads, &lines);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_of_few_frames_is_no_answer() {
        let text = r#"[{"id":"a.wav","est":80.5,"voiced":0.7,"cpu":1},{"id":"b.wav","est":80.5,"voiced":0.2},
                       {"id":"c.wav","est":null,"voiced":0,"error":"no module"}]"#;
        let estimates: Vec<Estimate> = serde_json::from_str(text).unwrap();
        let statuses: Vec<Status> = estimates.iter().map(|estimate| estimate.answer().status).collect();
        assert_eq!(statuses, [Status::Ok, Status::NoRotorTone, Status::NoRotorTone]);
        assert_eq!(estimates[0].answer().speed_rev_s, Some(80.5));
    }

    #[test]
    fn the_section_of_an_earlier_report_is_kept() {
        let report = "# A\n\n## Other programs\n\nold\n\n## B\n\nlast\n";
        assert_eq!(kept_section(report), Some("## Other programs\n\nold\n"));
        assert_eq!(kept_section("# A\n"), None);
    }

    #[test]
    fn tallies_have_four_numbers() {
        let mut tally = Tally::default();
        assert_eq!(tally.cell(), "–");
        [Verdict::Right, Verdict::MeanOff, Verdict::First, Verdict::Silent].into_iter().for_each(|one| tally.add(one));
        assert_eq!(tally.cell(), "2 / 0 / 0 / 2");
    }
}
