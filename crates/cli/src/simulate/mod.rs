//! `hovertone simulate`: a flight from a scenario file, its sound and its truth.

mod scenario_file;
mod truth_json;

use crate::args::SimulateArguments;
use crate::failure::{Ending, Failure};
use crate::output_folder::{FolderContent, OutputFolder, cannot_write_csv};
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::terminal::Terminal;
use crate::wav::WavFile;
use hovertone_report::{SimulatedFlight, SimulatedRotor, printable, simulated_flight_table};
use hovertone_sim::scenario::{ScenarioRun, ScenarioTruth, TRUTH_COLUMNS, truth_cells};
use hovertone_sim::{FlightState, Surroundings, scenario::ScenarioError};
use hovertone_vehicle::RotorSpeed;
use scenario_file::ScenarioSource;
use std::fs::File;
use std::iter::zip;

/// Steps between two updates of the progress bar, and between two writes.
const STEPS_AT_ONCE: usize = 100;
const SOUND: &str = "sound.wav";
const TABLE: &str = "truth.csv";

/// Simulates, writes the files, and prints a summary of the hovers.
pub(crate) fn run(arguments: &SimulateArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let source = ScenarioSource::read(&arguments.scenario, arguments.seed)?;
    let flown = ScenarioRun::new(source.scenario.clone()).map_err(|error| source.failure(&error))?;
    let outputs = Outputs::beside(source.inputs(), arguments.replace.force);
    let run = format!("simulate {}", source.sha256);
    let content =
        FolderContent { name: "of the same scenario file", run: &run, files: &[SOUND, TABLE, truth_json::NAME] };
    let folder = OutputFolder::prepare(&arguments.output, outputs, &content)?;
    let truth = write(flown, &source, &folder, !arguments.no_progress)?;
    truth_json::write(&folder, &source, &truth)?;
    terminal.text(&simulated_flight_table(&summary_of(&source, &truth), terminal.fold_width()))?;
    terminal.flush()?;
    let place = printable(&folder.path().display().to_string());
    terminal.say(&format!("written into the folder {place}: {SOUND}, {TABLE}, {}", truth_json::NAME));
    Ok(Ending::Done)
}

/// Runs the scenario and writes sound and table.
fn write(
    mut flown: ScenarioRun,
    source: &ScenarioSource,
    folder: &OutputFolder,
    shows_progress: bool,
) -> Result<ScenarioTruth, Failure> {
    let scenario = &source.scenario;
    let (microphones, rate_hz) = (scenario.sound.microphones.len(), scenario.sound.sample_rate_hz);
    let mut sound = WavFile::create(folder.create(SOUND)?, microphones, rate_hz, scenario.sample_format)?;
    let output = folder.create(TABLE)?;
    let cannot_write = |error: csv::Error| cannot_write_csv(&error, output.place());
    let mut table = csv::Writer::from_writer(output.handle()?);
    table.write_record(TRUTH_COLUMNS).map_err(cannot_write)?;
    let progress = Progress::new("simulating", 1, shows_progress);
    let mut share = progress.recording();
    let (mut channels, mut rows, mut goes_on) = (Vec::new(), Vec::new(), true);
    while goes_on {
        for _ in 0..STEPS_AT_ONCE {
            goes_on = flown.advance(&mut channels, &mut rows).map_err(|error| stopped(&error, &flown, source))?;
            if !goes_on {
                break;
            }
        }
        sound.drain(&mut channels)?;
        write_rows(&mut table, &mut rows).map_err(cannot_write)?;
        share.set(flown.share_done());
    }
    let truth = flown.finish(&mut channels);
    sound.drain(&mut channels)?;
    sound.finish()?;
    table.flush().map_err(|error| Failure::cannot_write(&error, output.place()))?;
    output.keep()?;
    drop(share);
    progress.finish();
    Ok(truth)
}

fn write_rows(table: &mut csv::Writer<File>, rows: &mut Vec<FlightState>) -> Result<(), csv::Error> {
    for state in rows.drain(..) {
        table.write_record(truth_cells(&state).map(|cell| cell.to_string()))?;
    }
    Ok(())
}

/// The failure for a flight that leaves the range of the sound model.
fn stopped(error: &ScenarioError, flown: &ScenarioRun, source: &ScenarioSource) -> Failure {
    let what = format!("the simulated flight stopped after {:.2} s: {error}", flown.time_s());
    let hint = match source.scenario.sound.surroundings {
        Surroundings::Room(_) => {
            "keep the flight within the room and near the microphones, or remove [room] from the scenario"
        }
        Surroundings::Ground { .. } => "keep the flight above the ground and near the microphones",
        Surroundings::FreeField => "keep the flight near the microphones",
    };
    Failure::Failed { what, hint: hint.to_owned(), path: Some(source.path.clone()) }
}

fn summary_of(source: &ScenarioSource, truth: &ScenarioTruth) -> SimulatedFlight {
    let (scenario, span) = (&source.scenario, truth.hover.as_ref().unwrap_or(&truth.flight));
    let speeds = zip(span.mean_speed_rad_s, span.std_speed_rad_s);
    SimulatedFlight {
        vehicle: scenario.flight.vehicle.id.to_owned(),
        mass_kg: truth.mass_kg,
        gravity_m_s2: truth.gravity_m_s2,
        duration_s: truth.flight.to_s,
        microphone_count: scenario.sound.microphones.len(),
        seed: scenario.flight.seed,
        hover_s: truth.hover.map(|hover| hover.duration_s),
        rotors: zip(speeds, truth.rotor_thrust_constants_n_s2)
            .map(|((mean_rad_s, std_rad_s), thrust_constant_n_s2)| SimulatedRotor {
                speed: RotorSpeed::from_rad_s(mean_rad_s),
                spread: RotorSpeed::from_rad_s(std_rad_s),
                thrust_constant_n_s2,
            })
            .collect(),
        thrust_constant_total_n_s2: truth.hover.map(|hover| hover.thrust_constant_total_n_s2),
    }
}
