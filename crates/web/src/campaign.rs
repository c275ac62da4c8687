//! An experiment of the page: its recordings heard, its loads fitted, and the result as JSON.

use crate::answer::{Answer, NoticeLine};
use crate::experiment::{in_hexadecimal, in_one_line};
use crate::heard_files::{HeardFiles, OnShare};
use hovertone::experiment::{Experiment, ExperimentFile};
use hovertone_figures::recording_figure;
use hovertone_page::SOUND_S_MAX;
use hovertone_report::{
    InputRecord, Notice, Row, TextTable, Verdict, Wording, budget_table, constants_in_units, results_json, thrust_table,
};
use hovertone_workflow::{
    Drawn, Identified, ReportExtras, ReportFigures, Titles, drawing_of, same_recording_text, same_sound, simulators_of,
};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Name of the experiment file in the results and as it is saved.
const EXPERIMENT: &str = "experiment.toml";

/// The last identified experiment.
pub(crate) struct LastIdentified {
    identified: Identified,
    /// The file of each recording, in the order of the inputs.
    numbers: Vec<u32>,
    clock_correction_ppm: f64,
}

/// Hears all recordings of an experiment and fits its loads.
pub(crate) fn identify(
    files_heard: &mut HeardFiles,
    text: &str,
    files: &BTreeMap<String, u32>,
    on_share: OnShare<'_>,
) -> Result<LastIdentified, String> {
    let experiment = experiment_of(text)?;
    let trials = trials_of(&experiment, files)?;
    refuse_copies(files_heard, &trials)?;
    let clock_correction_ppm = experiment.clock_correction_ppm;
    let count = trials.len() as f64;
    let mut inputs = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let load = &experiment.loads[trial.load];
        let config = load.config(&experiment);
        let mut of_all = |share: f64| on_share((index as f64 + share) / count);
        let record = files_heard.record_of_trial(trial.number, &trial.name, &config, clock_correction_ppm, &mut of_all);
        let record = record.worded(Wording::of_experiment(experiment.is_flight()));
        inputs.push(InputRecord { load: load.name.clone(), record, log: None });
    }
    if let Some(names) = same_sound(inputs.iter().map(|input| &input.record)) {
        return Err(take_one_out(names));
    }
    let titles = Titles { file: EXPERIMENT.to_owned(), sha256: in_hexadecimal(&Sha256::digest(text.as_bytes())) };
    let method = experiment.config.method;
    let identified = Identified::of_records(titles, experiment, inputs, method)
        .map_err(|tips| format!("{}: {}; {}", tips.file, tips.contradiction, tips.contradiction.hint()))?;
    let numbers = trials.iter().map(|trial| trial.number).collect();
    Ok(LastIdentified { identified, numbers, clock_correction_ppm })
}

fn experiment_of(text: &str) -> Result<Experiment, String> {
    let file: ExperimentFile = toml::from_str(text).map_err(|error| in_one_line(&error))?;
    if file.vehicle.model.is_some() {
        let what = "the experiment names a simulator's model, which the page does not read";
        return Err(format!("{what}; remove vehicle.model, or use `hovertone identify`"));
    }
    let has_log = |recording: &hovertone::experiment::RecordingSection| recording.log().is_some();
    if file.loads.iter().flat_map(|load| &load.recordings).any(has_log) {
        let what = "the experiment file names logs of flights, which the page does not read";
        let hint = "write \"a.wav\" in place of { file = \"a.wav\", log = \"a.ulg\" }, or use `hovertone identify`";
        return Err(format!("{what}; {hint}"));
    }
    file.resolve(None).map_err(|error| error.to_string())
}

/// A recording of a load.
struct PageTrial {
    load: usize,
    name: String,
    number: u32,
}

fn trials_of(experiment: &Experiment, files: &BTreeMap<String, u32>) -> Result<Vec<PageTrial>, String> {
    let mut trials = Vec::new();
    for (index, load) in experiment.loads.iter().enumerate() {
        for recording in &load.recordings {
            let name = recording.file().to_owned();
            let number = *files.get(&name).ok_or_else(|| {
                format!("{name} of load \"{}\" is missing; add this recording to the page", load.name)
            })?;
            trials.push(PageTrial { load: index, name, number });
        }
    }
    Ok(trials)
}

/// Refuses two recordings with the same content: as two trials they would make the ± too small.
fn refuse_copies(files_heard: &mut HeardFiles, trials: &[PageTrial]) -> Result<(), String> {
    let mut known: BTreeMap<String, &str> = BTreeMap::new();
    for trial in trials {
        // a file that cannot be read is left to the analysis, which says why
        let Ok(sha256) = files_heard.sha256(trial.number) else { continue };
        if let Some(first) = known.insert(sha256, &trial.name) {
            return Err(take_one_out([first, &trial.name]));
        }
    }
    Ok(())
}

fn take_one_out(names: [&str; 2]) -> String {
    format!("{}; take one of them out", same_recording_text(names))
}

impl LastIdentified {
    /// The result as JSON, with the words that the command prints.
    pub(crate) fn answer(&self) -> Result<String, String> {
        let identified = &self.identified;
        let results = results_json(&identified.identification()).map_err(|error| error.to_string())?;
        let reported = identified.reported();
        let budget = reported.and_then(|table| {
            let (budget, fit) = (table.budget.as_ref()?, table.fit.as_ref()?);
            Some(table_json(&budget_table(budget, fit.thrust_constant_n_s2.value)))
        });
        let warnings: Vec<Notice> = identified.warnings().iter().map(Notice::from).collect();
        let drawn = identified.identification();
        let drawn = Drawn::new(&drawn, Vec::new());
        let figures = drawn.experiment_figures(&[]).unwrap_or_default();
        let svg_of = |name: &str| figures.iter().find(|figure| figure.name == name).map(|figure| figure.svg.clone());
        let units: Vec<Value> = reported
            .map(constants_in_units)
            .unwrap_or_default()
            .iter()
            .map(|constant| json!({ "unit": constant.unit, "text": constant.text, "pasted": constant.pasted }))
            .collect();
        let inputs: Vec<Value> = identified
            .inputs()
            .iter()
            .zip(&self.numbers)
            .map(|(input, number)| Ok(json!({ "file": number, "answer": Answer::new(&input.record)? })))
            .collect::<Result<_, serde_json::Error>>()
            .map_err(|error| error.to_string())?;
        Ok(json!({
            "quote": identified.quote(),
            "headline": identified.headline(),
            "holds": reported.map(|table| match Verdict::of(table) {
                Verdict::Holds(_) => "holds",
                Verdict::Fails(_) => "fails",
                Verdict::Untested(_) => "untested",
            }),
            "has_constant": reported.is_some_and(|table| table.thrust_constant_total_n_s2.is_some()),
            "warnings": warnings.iter().map(NoticeLine::from).collect::<Vec<_>>(),
            "loads": reported.map(|table| table_json(&thrust_table(table))),
            "budget": budget,
            "fit_svg": svg_of("fit"),
            "budget_svg": svg_of("budget"),
            "units": units,
            "inputs": inputs,
            "simulators": simulators_of(&results)
                .iter()
                .map(|lines| json!({ "name": lines.name, "text": lines.text }))
                .collect::<Vec<_>>(),
            "results": results,
        })
        .to_string())
    }

    /// The report of a run on this day: the recordings are read again for their pictures and their sound.
    pub(crate) fn report(&self, heard: &HeardFiles, date: &str, on_share: OnShare<'_>) -> Result<String, String> {
        let identification = self.identified.identification();
        let count = self.numbers.len() as f64;
        let mut drawings = Vec::new();
        for (index, (number, input)) in self.numbers.iter().zip(identification.inputs).enumerate() {
            let recording = heard.opened(*number, self.clock_correction_ppm);
            let drawing = recording
                .ok()
                .and_then(|mut recording| drawing_of(&mut recording, &input.record, Some(SOUND_S_MAX)).ok().flatten());
            drawings.push(drawing);
            on_share((index as f64 + 1.0) / count);
        }
        let drawn = Drawn::new(&identification, drawings);
        let trials = drawn.trials();
        let words = |error: &dyn std::fmt::Display| error.to_string();
        let experiment = drawn.experiment_figures(&trials).map_err(|error| words(&error))?;
        let recordings = trials
            .iter()
            .enumerate()
            .map(|(index, trial)| recording_figure(trial, &format!("recording-{}", index + 1)))
            .collect::<Result<_, _>>()
            .map_err(|error| words(&error))?;
        let results = results_json(&identification).map_err(|error| words(&error))?;
        let extras =
            ReportExtras { command: "hovertone identify experiment.toml -o report", date, ..ReportExtras::default() };
        drawn.page(&ReportFigures { experiment, recordings }, &results, &extras).map_err(|error| words(&error))
    }
}

/// A table for people as JSON: heads with units, and rows of cells.
fn table_json(table: &TextTable) -> Value {
    let heads: Vec<Value> = table
        .columns()
        .iter()
        .map(|column| json!({ "title": column.title(), "unit": column.unit(), "is_number": column.is_number() }))
        .collect();
    let rows: Vec<Vec<&str>> = table
        .rows()
        .iter()
        .map(|row| match row {
            Row::Cells(cells) => cells.iter().map(String::as_str).collect(),
            Row::Words(first, words) => vec![first.as_str(), words.as_str()],
        })
        .collect();
    json!({ "heads": heads, "rows": rows })
}
