//! `results.json`: the result at the top, and below it all data behind it.

use crate::flight_log::{FlightLogLine, FlightLogRecord};
use crate::notice::Notice;
use crate::number::expanded;
use crate::recording::{RecordingFacts, SpeedRecord};
use crate::version::VERSION;
use hovertone_analysis::{Hover, Method, RotorsHeard, RotorsHeardCounts, Verification, Warning};
use hovertone_thrust::{
    Drift, ModelAgainstHeard, SquareLawFit, ThrustCoefficients, ThrustTable, TrialBootstrap, UncertaintyBudget,
    VehicleModel,
};
use hovertone_vehicle::{COVERAGE_FACTOR, Estimate, Order, RotorSpeed};
use serde::{Serialize, Serializer};
use serde_json::Value;

/// An identified experiment.
#[derive(Clone, Copy, Debug)]
pub struct Identification<'a> {
    /// Name of the experiment file.
    pub file: &'a str,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: &'a str,
    /// The resolved experiment.
    pub experiment: ExperimentFacts<'a>,
    /// The method whose constant is reported.
    pub method: Method,
    /// One table for each method.
    pub tables: &'a [ThrustTable],
    /// All recordings, load by load.
    pub inputs: &'a [InputRecord],
}

/// Facts about a resolved experiment.
#[derive(Clone, Copy, Debug)]
pub struct ExperimentFacts<'a> {
    /// Name of the vehicle.
    pub vehicle_name: &'a str,
    /// Number of its rotors.
    pub rotor_count: u32,
    /// Order of the followed tone.
    pub order: Order,
    /// Number of loads.
    pub load_count: usize,
    /// The simulator's model for comparison, if there is one.
    pub model: Option<&'a VehicleModel>,
    /// The whole experiment as JSON.
    pub settings: &'a Value,
}

/// One recording of a load.
#[derive(Clone, Debug)]
pub struct InputRecord {
    /// Name of the load.
    pub load: String,
    /// Record of the recording.
    pub record: SpeedRecord,
    /// The log of its flight, where the experiment names one.
    pub log: Option<FlightLogRecord>,
}

impl Identification<'_> {
    /// The table of the reported method.
    pub fn reported(&self) -> Option<&ThrustTable> {
        self.tables.iter().find(|table| table.method == self.method)
    }

    /// Names of the logs that contradict the order or the clock of their recordings.
    pub fn logs_of_failed_checks(&self) -> Vec<&str> {
        self.logs().filter(|log| log.has_failed_check()).map(|log| log.file.as_str()).collect()
    }

    /// Names of the logs that confirm the order and the clock of their recordings.
    pub fn logs_of_passed_checks(&self) -> Vec<&str> {
        let passes = |log: &&FlightLogRecord| log.verification.as_ref().is_some_and(Verification::passes);
        self.logs().filter(passes).map(|log| log.file.as_str()).collect()
    }

    /// Number of recordings in which some rotors are separated, but not all.
    pub fn partly_separated_count(&self) -> usize {
        let is_partial = |warning: &Warning| matches!(warning, Warning::RotorsNotApart { resolved: 1.., .. });
        let analyses = self.inputs.iter().filter_map(|input| input.record.analysis());
        analyses.filter(|analysis| analysis.warnings.iter().any(is_partial)).count()
    }

    fn logs(&self) -> impl Iterator<Item = &FlightLogRecord> {
        self.inputs.iter().filter_map(|input| input.log.as_ref())
    }
}

/// Version of the layout of `results.json`. It increases when a field is renamed, removed or changes its meaning.
const SCHEMA_VERSION: u32 = 2;

/// The fields of `results.json` with their units, as a JSON Schema (draft 2020-12).
pub const RESULTS_SCHEMA: &str = include_str!("results.schema.json");

#[derive(Serialize)]
struct Results<'a> {
    schema_version: u32,
    thrust_constant_total_n_s2: Option<Estimate>,
    thrust_constant_per_rotor_n_s2: Option<Estimate>,
    coverage_factor: f64,
    expanded_uncertainty_total_n_s2: Option<f64>,
    expanded_uncertainty_per_rotor_n_s2: Option<f64>,
    measured_std_total_n_s2: Option<f64>,
    method: Method,
    rotors_heard: Option<RotorsHeardCounts>,
    partly_separated: usize,
    plain_mean_total_n_s2: Option<Estimate>,
    thrust_coefficients: Option<ThrustCoefficients>,
    uncertainty_budget: Option<&'a UncertaintyBudget>,
    bootstrap: Option<TrialBootstrap>,
    fit: Option<&'a SquareLawFit>,
    drifts: &'a [Drift],
    vehicle_model: Option<ModelAgainstHeard>,
    #[serde(serialize_with = "by_method")]
    methods: &'a [ThrustTable],
    loads: Vec<Load<'a>>,
    forbids_use: bool,
    warnings: Vec<Notice>,
    inputs: Vec<Input<'a>>,
    settings: Settings<'a>,
    version: &'static str,
}

#[derive(Serialize)]
struct MethodResults<'a> {
    thrust_constant_total_n_s2: Option<Estimate>,
    thrust_constant_per_rotor_n_s2: Option<Estimate>,
    measured_std_total_n_s2: Option<f64>,
    plain_mean_total_n_s2: Option<Estimate>,
    expanded_uncertainty_total_n_s2: Option<f64>,
    expanded_uncertainty_per_rotor_n_s2: Option<f64>,
    rotors_heard: RotorsHeardCounts,
    loads: Vec<Load<'a>>,
}

#[derive(Serialize)]
struct Load<'a> {
    name: &'a str,
    mass_kg: Option<f64>,
    force_n: f64,
    rotors_running: u32,
    trial_count: usize,
    speed_rad_s: Option<f64>,
    speed_rpm: Option<f64>,
    std_uncertainty_rad_s: Option<f64>,
    spread_rad_s: Option<f64>,
    thrust_constant_total_n_s2: Option<Estimate>,
    thrust_constant_per_rotor_n_s2: Option<Estimate>,
    fits: Option<bool>,
    p_value: Option<f64>,
    mass_that_fits_kg: Option<f64>,
    mass_that_fits_std_kg: Option<f64>,
    figure_of_merit: Option<f64>,
}

#[derive(Serialize)]
struct Input<'a> {
    load: &'a str,
    file: &'a str,
    status: &'static str,
    reason: Option<String>,
    rotors_heard: Option<RotorsHeard>,
    hover: Option<&'a Hover>,
    window_s: Option<f64>,
    warnings: &'a [Notice],
    recording: Option<&'a RecordingFacts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    log: Option<FlightLogLine<'a>>,
}

#[derive(Serialize)]
struct Settings<'a> {
    file: &'a str,
    sha256: &'a str,
    experiment: &'a Value,
}

/// The ± of a constant.
fn expanded_of(constant: Option<Estimate>) -> Option<f64> {
    expanded(constant?.std_uncertainty)
}

fn by_method<S: Serializer>(tables: &&[ThrustTable], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(tables.iter().map(|table| {
        let results = MethodResults {
            thrust_constant_total_n_s2: table.thrust_constant_total_n_s2,
            thrust_constant_per_rotor_n_s2: table.thrust_constant_per_rotor_n_s2,
            plain_mean_total_n_s2: table.plain_mean_total_n_s2,
            measured_std_total_n_s2: table.measured_std_total_n_s2,
            expanded_uncertainty_total_n_s2: expanded_of(table.thrust_constant_total_n_s2),
            expanded_uncertainty_per_rotor_n_s2: expanded_of(table.thrust_constant_per_rotor_n_s2),
            rotors_heard: table.rotors_heard,
            loads: loads_of(table),
        };
        (table.method.name(), results)
    }))
}

fn loads_of(table: &ThrustTable) -> Vec<Load<'_>> {
    table
        .loads
        .iter()
        .map(|row| Load {
            name: &row.name,
            mass_kg: row.mass_kg,
            force_n: row.force_n,
            rotors_running: row.rotors_running,
            trial_count: row.trials.len(),
            speed_rad_s: row.speed.map(RotorSpeed::rad_s),
            speed_rpm: row.speed.map(RotorSpeed::rpm),
            std_uncertainty_rad_s: row.std_uncertainty_rad_s,
            spread_rad_s: row.spread_rad_s,
            thrust_constant_total_n_s2: row.thrust_constant_total_n_s2,
            thrust_constant_per_rotor_n_s2: row.thrust_constant_per_rotor_n_s2,
            fits: row.fits,
            p_value: row.p_value,
            mass_that_fits_kg: row.mass_that_fits_kg,
            mass_that_fits_std_kg: row.mass_that_fits_std_kg,
            figure_of_merit: row.figure_of_merit,
        })
        .collect()
}

/// `results.json`, ending with a line feed. Equal input gives equal bytes.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn results_json(identification: &Identification<'_>) -> Result<String, serde_json::Error> {
    let Identification { experiment, method, tables, .. } = *identification;
    let reported = identification.reported();
    let total = reported.and_then(|table| table.thrust_constant_total_n_s2);
    let per_rotor = reported.and_then(|table| table.thrust_constant_per_rotor_n_s2);
    let results = Results {
        schema_version: SCHEMA_VERSION,
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: per_rotor,
        coverage_factor: COVERAGE_FACTOR,
        expanded_uncertainty_total_n_s2: expanded_of(total),
        expanded_uncertainty_per_rotor_n_s2: expanded_of(per_rotor),
        measured_std_total_n_s2: reported.and_then(|table| table.measured_std_total_n_s2),
        method,
        rotors_heard: reported.map(|table| table.rotors_heard),
        partly_separated: identification.partly_separated_count(),
        plain_mean_total_n_s2: reported.and_then(|table| table.plain_mean_total_n_s2),
        thrust_coefficients: reported.and_then(|table| table.coefficients),
        uncertainty_budget: reported.and_then(|table| table.budget.as_ref()),
        bootstrap: reported.and_then(|table| table.bootstrap),
        fit: reported.and_then(|table| table.fit.as_ref()),
        drifts: reported.map_or(&[], |table| &table.drifts),
        vehicle_model: reported.and_then(|table| experiment.model?.against(table)),
        methods: tables,
        loads: reported.map(loads_of).unwrap_or_default(),
        forbids_use: reported.is_some_and(ThrustTable::forbids_use),
        warnings: reported.map(|table| table.warnings.iter().map(Notice::from).collect()).unwrap_or_default(),
        inputs: identification.inputs.iter().map(input_of).collect(),
        settings: Settings {
            file: identification.file,
            sha256: identification.sha256,
            experiment: experiment.settings,
        },
        version: VERSION,
    };
    Ok(serde_json::to_string_pretty(&results)? + "\n")
}

fn input_of(input: &InputRecord) -> Input<'_> {
    let record = &input.record;
    Input {
        load: &input.load,
        file: &record.file,
        status: record.status(),
        reason: record.reason(),
        rotors_heard: record.rotors_heard(),
        hover: record.analysis().map(|analysis| &analysis.hover),
        window_s: record.tone().map(|tone| tone.window_s),
        warnings: &record.notices,
        recording: record.recording.as_ref(),
        log: input.log.as_ref().map(FlightLogLine::of),
    }
}
