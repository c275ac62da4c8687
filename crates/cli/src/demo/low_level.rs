//! `hovertone demo --low-level`: the paper's stated next step, in simulated flight. An AR.Drone flies doublets, is heard and identified; then the
//! identified model flies beside the true one.

use crate::args::DemoArguments;
use crate::failure::{Ending, Failure};
use crate::greybox::{
    FlightFiles, FlownLog, GreyBoxVehicle, OtherFlight, fit_of, record_of, scenario_file, scenario_toml, speeds_of,
};
use crate::identify::page_line;
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::recording::Hearing;
use crate::report_folder::PAGE;
use crate::terminal::Terminal;
use crate::typed::typed_command;
use crate::wav::WavFile;
use hovertone_dynamics::{GreyBoxModel, SpeedPrediction, checked, observations_of_rows};
use hovertone_figures::{DrawnSpeeds, Figure, grey_box_figure};
use hovertone_logs::{ColumnNames, RateAxes};
use hovertone_page::{LowLevelPage, low_level_html};
use hovertone_report::{
    GreyBoxRecord, TitledTable, grey_box_against_truth, grey_box_json, grey_box_notes, grey_box_tables, grey_box_text,
    grey_box_warnings, significant, table_text,
};
use hovertone_sim::FlightState;
use hovertone_sim::scenario::{
    Axis, ControllerSection, DoubletAmounts, GainsSection, Maneuver, ScenarioFile, ScenarioRun, SpreadSection,
    TRUTH_COLUMNS, truth_cells,
};
use hovertone_vehicle::{FlightParameters, GRAVITY_STANDARD_M_S2, LoopGains};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const PRESET: &str = "ardrone";
const DOUBLETS_S: f64 = 60.0;
/// True gains over the preset's, at which the fit starts: so that something is found. *Decision.*
const GAIN_FACTORS: [f64; 4] = [1.25, 0.8, 1.2, 0.85];
/// Spread of C_f and of the motors' gains: the rotors differ by half of it. *Decision.*
const SPREAD_SHARE: f64 = 0.01;
const FIT_FLIGHT: &str = "doublets";
const CHECK_FLIGHT: &str = "check";
const RESULTS: &str = "results.json";
const IDENTIFIED: &str = "identified.toml";
const FIGURES: [&str; 3] = ["figures/fit.svg", "figures/check.svg", "figures/identified.svg"];
const TRUTH_TITLE: &str = "Identified beside the truth";

/// Flies, hears, identifies, flies again, and writes one page.
pub(super) fn run(arguments: &DemoArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let folder = &prepared(&arguments.output, arguments.replace.force)?;
    let [doublets, check] = scenarios(arguments.seed)?;
    let truth = flown(&doublets, FIT_FLIGHT, folder)?;
    flown(&check, CHECK_FLIGHT, folder)?;
    let vehicle = GreyBoxVehicle::find(PRESET, None)?;
    let progress = Progress::new("listening to", 1, !arguments.no_progress);
    let [fit_files, check_files] = [FIT_FLIGHT, CHECK_FLIGHT].map(|name| files_of(folder, name));
    let [mut fit_log, mut check_log] = [read(&fit_files, &vehicle)?, read(&check_files, &vehicle)?];
    let heard = fit_of(&fit_files, &mut fit_log, &vehicle, Hearing::default(), &progress)?;
    let other = speeds_of(&check_files, &mut check_log, &heard, &vehicle, Hearing::default(), &progress)?;
    progress.finish();
    let compared = OtherFlight { files: &check_files, speeds: &other, moved_s: check_log.moved_s };
    let record = record_of(&fit_files, &fit_log, &heard, &vehicle, Some(compared));
    let own = heard.speeds(&fit_log);
    let drawn = |observations, prediction, source, name: &str, title: &str| {
        named_figure(&DrawnSpeeds { observations, prediction, source, places: record.places }, name, title)
    };
    let beside = Beside::fly(
        &check,
        ScenarioFile { maneuvers: check.maneuvers.clone(), ..scenario_file(&heard.fit, &vehicle) },
    )?;
    let figures = [
        drawn(
            &own.observations,
            &own.prediction,
            "heard",
            "fit",
            "The flight that was used for the fit: predicted and heard speeds",
        )?,
        drawn(
            &other.observations,
            &other.prediction,
            "heard",
            "check",
            "A second flight, which the fit did not use: predicted and heard speeds",
        )?,
        drawn(
            &beside.truth,
            &beside.identified,
            "true",
            "identified",
            "The same commands for the identified model (lines) and for the true model (dots)",
        )?,
    ];
    let against_truth = TitledTable::new(TRUTH_TITLE, grey_box_against_truth(&heard.fit, &truth.to_vector()));
    let flown_beside = beside.in_words();
    for (figure, name) in figures.iter().zip(FIGURES) {
        folder.write(name, &figure.svg)?;
    }
    folder.write(RESULTS, grey_box_json(&record, &grey_box_warnings(&record)).map_err(Failure::internal)?)?;
    folder.write(IDENTIFIED, scenario_toml(&heard.fit, &vehicle)?)?;
    folder.write(PAGE, page(&record, &against_truth, &figures, &flown_beside)?)?;
    let width = terminal.fold_width();
    let text = format!(
        "The low-level model of the paper in simulated flight, seed {}\n\n{}\n{TRUTH_TITLE}\n{}\n{flown_beside}\n",
        arguments.seed,
        grey_box_text(&record, width),
        table_text(&against_truth.table, width)
    );
    terminal.text(&text)?;
    terminal.text(&page_line(&folder.place(PAGE)))?;
    Ok(Ending::Done)
}

fn prepared(path: &Path, force: bool) -> Result<OutputFolder, Failure> {
    let nothing: [&Path; 0] = [];
    let of_flights = [FIT_FLIGHT, CHECK_FLIGHT]
        .into_iter()
        .flat_map(|name| [".wav", ".csv", ".toml"].map(|end| format!("{name}{end}")));
    let of_flights: Vec<String> = of_flights.collect();
    let others = [RESULTS, IDENTIFIED, PAGE].into_iter().chain(FIGURES);
    let files: Vec<&str> = of_flights.iter().map(String::as_str).chain(others).collect();
    let content = FolderContent { name: "of the same demo", run: "demo --low-level", files: &files };
    OutputFolder::prepare(path, Outputs::beside(nothing, force), &content)
}

/// The flight of doublets, and another one of the same vehicle.
fn scenarios(seed: u64) -> Result<[ScenarioFile; 2], Failure> {
    let preset = GreyBoxVehicle::find(PRESET, None)?.parameters;
    let of = &preset.controller;
    let scaled = |gains: LoopGains, factor: f64| {
        let LoopGains { proportional, derivative, limit_v } = gains;
        Some(GainsSection { proportional: factor * proportional, derivative: factor * derivative, limit_v })
    };
    let controller = ControllerSection {
        roll: scaled(of.roll.value, GAIN_FACTORS[0]),
        pitch: scaled(of.pitch.value, GAIN_FACTORS[1]),
        yaw_rate: scaled(of.yaw_rate.value, GAIN_FACTORS[2]),
        climb: scaled(of.climb.value, GAIN_FACTORS[3]),
        ..ControllerSection::default()
    };
    let doublets = ScenarioFile {
        controller: Some(controller),
        spread: Some(SpreadSection {
            thrust_std_share: SPREAD_SHARE,
            motor_gain_std_share: SPREAD_SHARE,
            ..SpreadSection::default()
        }),
        ..ScenarioFile::doublets(PRESET, seed, DOUBLETS_S, DoubletAmounts::default())
    };
    let step = |axis, amount| Maneuver::Step { axis, amount, duration_s: 0.7 };
    let maneuvers = vec![
        Maneuver::Hover { duration_s: 1.0 },
        Maneuver::Climb { height_m: 0.5, duration_s: 2.0 },
        step(Axis::YawRate, 0.5),
        Maneuver::Hover { duration_s: 1.5 },
        step(Axis::Pitch, 0.5),
        Maneuver::Hover { duration_s: 2.0 },
        step(Axis::Roll, -0.5),
        Maneuver::Hover { duration_s: 2.0 },
        Maneuver::Climb { height_m: -0.5, duration_s: 2.0 },
        step(Axis::YawRate, -0.4),
        Maneuver::Hover { duration_s: 2.0 },
    ];
    let check = ScenarioFile { maneuvers, duration_s: None, ..doublets.clone() };
    Ok([doublets, check])
}

/// Flies a scenario; writes its sound, its log and itself. Returns the true model.
fn flown(file: &ScenarioFile, name: &str, folder: &OutputFolder) -> Result<GreyBoxModel, Failure> {
    folder.write(&format!("{name}.toml"), toml::to_string(file).map_err(Failure::internal)?)?;
    let scenario = file.resolve(&BTreeMap::new()).map_err(Failure::internal)?;
    let vehicle: FlightParameters = scenario.flight.vehicle.clone();
    let (microphones, rate_hz) = (scenario.sound.microphones.len(), scenario.sound.sample_rate_hz);
    let format = scenario.sample_format;
    let mut wav = WavFile::create(folder.create(&format!("{name}.wav"))?, microphones, rate_hz, format)?;
    let mut run = ScenarioRun::new(scenario).map_err(Failure::internal)?;
    let (mut channels, mut rows) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut rows).map_err(Failure::internal)? {
        wav.drain(&mut channels)?;
    }
    let truth = run.finish(&mut channels);
    wav.drain(&mut channels)?;
    wav.finish()?;
    folder.write_csv(&format!("{name}.csv"), |writer| {
        writer.write_record(TRUTH_COLUMNS)?;
        rows.iter().try_for_each(|state| writer.write_record(truth_cells(state).map(|cell| cell.to_string())))
    })?;
    let model = GreyBoxModel::of(&vehicle, vehicle.mass_kg.value, GRAVITY_STANDARD_M_S2);
    Ok(GreyBoxModel { hover_rad_s: truth.trim_speed_rad_s, ..model })
}

fn files_of(folder: &OutputFolder, name: &str) -> FlightFiles {
    let place = |end: &str| -> PathBuf { folder.place(&format!("{name}{end}")) };
    FlightFiles { recording: Some(place(".wav")), log: place(".csv") }
}

fn read(files: &FlightFiles, vehicle: &GreyBoxVehicle) -> Result<FlownLog, Failure> {
    FlownLog::read(&files.log, &ColumnNames::default(), RateAxes::ForwardLeftUp, 0.0, vehicle)
}

/// The true vehicle and the identified one, each flown through the same manoeuvres by the same pilot.
struct Beside {
    truth: Vec<hovertone_dynamics::SpeedObservation>,
    identified: SpeedPrediction,
}

impl Beside {
    fn fly(truth: &ScenarioFile, identified: ScenarioFile) -> Result<Self, Failure> {
        let identified = ScenarioFile { truth_rate_hz: truth.truth_rate_hz, ..identified };
        let (truth, identified) = (states_of(truth)?, states_of(&identified)?);
        let time_s: Vec<f64> = truth.iter().map(|state| state.time_s).collect();
        let speeds: [Vec<f64>; 4] =
            std::array::from_fn(|rotor| truth.iter().map(|state| state.speed_rad_s[rotor]).collect());
        let speeds = std::array::from_fn(|rotor| speeds[rotor].as_slice());
        let step_s = time_s.get(1).copied().unwrap_or(1.0);
        let speed_rad_s = identified.iter().map(|state| state.speed_rad_s).collect();
        Ok(Self {
            truth: observations_of_rows(&time_s, speeds, 1e-3),
            identified: SpeedPrediction { start_s: 0.0, step_s, speed_rad_s },
        })
    }

    fn in_words(&self) -> String {
        checked(&self.truth, &self.identified).map_or(String::new(), |checked| {
            format!(
                "in another flight, the speeds of the identified model differ from the true speeds by {} % (rms); the speeds themselves change by {} % (rms)",
                significant(100.0 * checked.rms_share, 2),
                significant(100.0 * checked.change_share, 2)
            )
        })
    }
}

fn states_of(file: &ScenarioFile) -> Result<Vec<FlightState>, Failure> {
    let scenario = file.resolve(&BTreeMap::new()).map_err(Failure::internal)?;
    let mut run = ScenarioRun::silent(scenario).map_err(Failure::internal)?;
    let (mut silence, mut states) = (Vec::new(), Vec::new());
    while run.advance(&mut silence, &mut states).map_err(Failure::internal)? {}
    Ok(states)
}

fn named_figure(drawn: &DrawnSpeeds<'_>, name: &str, title: &str) -> Result<Figure, Failure> {
    let figure = grey_box_figure(drawn).map_err(Failure::internal)?;
    Ok(Figure { name: name.to_owned(), title: title.to_owned(), ..figure })
}

fn page(
    record: &GreyBoxRecord,
    against_truth: &TitledTable,
    figures: &[Figure],
    flown_beside: &str,
) -> Result<String, Failure> {
    let mut tables = vec![against_truth.clone()];
    tables.extend(grey_box_tables(record));
    let lead = [
        "A simulated AR.Drone flies doublets (the stick to one side, then to the other) for a minute outdoors. One \
         microphone hears its four rotors. The model of the paper's equations 1 and 2 predicts the tones, and is \
         fitted to the heard tones. The fit starts at the numbers of the preset; the true gains differ from the \
         preset by 15 to 25 %."
            .to_owned(),
        flown_beside.to_owned(),
    ];
    let notes = grey_box_notes(record);
    let command = typed_command();
    let page = LowLevelPage {
        title: "The low-level model of the AR.Drone, from its sound",
        lead: &lead,
        tables: &tables,
        figures,
        notes: &notes,
        command: &command,
    };
    low_level_html(&page).map_err(Failure::internal)
}
