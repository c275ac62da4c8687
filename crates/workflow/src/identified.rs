//! An experiment whose recordings were heard: the fits of its loads, and what is said of them.

use hovertone::experiment::Experiment;
use hovertone::speed::{Method, SpeedEstimate};
use hovertone::thrust::{LoadSpeeds, ThrustSettings, ThrustTable, ThrustWarning, TrialSpeeds, thrust_from_loads};
use hovertone_page::names_of;
use hovertone_report::{
    Contradicted, ExperimentFacts, Identification, InputRecord, LOADS_FOOTNOTE, SpeedRecord, Verdict, adequacy_text,
    counted, flight_log_tables, printable, quoted_constants, rotors_heard_text, table_text, thrust_summary,
    thrust_table, tone_of_order, vehicle_model_text, warning_count,
};
use hovertone_vehicle::{Contradiction, check_tips};
use serde_json::Value;

/// An experiment with the records of its recordings and the fits of its loads.
#[derive(Debug)]
pub struct Identified {
    file: String,
    sha256: String,
    experiment: Experiment,
    method: Method,
    inputs: Vec<InputRecord>,
    tables: Vec<ThrustTable>,
    /// The resolved experiment, as written to the results.
    settings: Value,
}

/// Name and hash of the experiment file.
#[derive(Clone, Debug)]
pub struct Titles {
    /// Its file name.
    pub file: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// The diameter of the experiment, with the speed of a heard rotor, makes blade tips faster than any multirotor's.
#[derive(Debug)]
pub struct TipsTooFast {
    /// Name of the recording.
    pub file: String,
    /// The contradiction.
    pub contradiction: Contradiction,
}

impl Identified {
    /// Fits the loads by every method.
    ///
    /// # Errors
    /// [`TipsTooFast`].
    pub fn of_records(
        titles: Titles,
        experiment: Experiment,
        inputs: Vec<InputRecord>,
        method: Method,
    ) -> Result<Self, TipsTooFast> {
        check_tips_of(&experiment, &inputs)?;
        let has_rotors = inputs.iter().filter_map(|input| input.record.speed_by(Method::Separated)).any(is_separated);
        let method = if has_rotors || method != Method::Separated { method } else { Method::Harmonic };
        let has_speed = inputs.iter().any(|input| input.record.speed().is_some());
        // without a constant, the reasons of the recordings say it
        let foreign = vehicle_does_not_fit(&inputs).filter(|_| has_speed);
        let tables = Method::ALL
            .into_iter()
            .filter(|&method| method != Method::Separated || has_rotors)
            .map(|method| {
                let settings = ThrustSettings {
                    follows_loudest: method != Method::Separated,
                    unresolved_std_share: unresolved_std_share(&experiment, &inputs, method),
                    ..experiment.thrust_settings()
                };
                let mut table = thrust_from_loads(&loads_of(&experiment, &inputs, method), method, &settings);
                table.warnings.splice(0..0, foreign.clone());
                table
            })
            .collect();
        // serialisation of settings does not fail
        let settings = serde_json::to_value(&experiment).unwrap_or_default();
        let Titles { file, sha256 } = titles;
        Ok(Self { file, sha256, experiment, method, inputs, tables, settings })
    }

    /// One table for each method.
    pub fn tables(&self) -> &[ThrustTable] {
        &self.tables
    }

    /// The table of the reported method.
    pub fn reported(&self) -> Option<&ThrustTable> {
        self.tables.iter().find(|table| table.method == self.method)
    }

    /// The recordings, load by load.
    pub fn inputs(&self) -> &[InputRecord] {
        &self.inputs
    }

    /// The results as the report takes them.
    pub fn identification(&self) -> Identification<'_> {
        let experiment = &self.experiment;
        Identification {
            file: &self.file,
            sha256: &self.sha256,
            experiment: ExperimentFacts {
                vehicle_name: &experiment.vehicle_name,
                rotor_count: experiment.rotor_count,
                order: experiment.config.tone.order,
                load_count: experiment.loads.len(),
                model: experiment.model.as_ref(),
                settings: &self.settings,
            },
            method: self.method,
            tables: &self.tables,
            inputs: &self.inputs,
        }
    }

    /// The result below the tables.
    pub fn summary(&self, width: Option<usize>) -> String {
        thrust_summary(&self.tables, self.method, width)
            + &self.reported().map_or(String::new(), |table| adequacy_text(table, width))
    }

    /// The simulator's model that the experiment names, beside the result; empty without one.
    pub fn model_in_words(&self) -> String {
        let model = self.reported().zip(self.experiment.model.as_ref());
        model.map_or(String::new(), |(table, model)| vehicle_model_text(model, table))
    }

    /// What was heard, and the number of warnings.
    pub fn headline(&self) -> String {
        let experiment = &self.experiment;
        let heard = self.inputs.iter().filter(|input| input.record.speed().is_some()).count();
        format!(
            "{}: {}, {}; {}, {}, a speed was heard in {}; {}\n",
            printable(&experiment.vehicle_name),
            counted(experiment.rotor_count as usize, "rotor"),
            tone_of_order(experiment.config.tone.order),
            counted(experiment.loads.len(), "load"),
            counted(self.inputs.len(), "recording"),
            heard_in_words(heard, self.inputs.len()),
            self.warnings_counted(),
        )
    }

    /// "2 warnings".
    pub fn warnings_counted(&self) -> String {
        counted(self.warning_count(), "warning")
    }

    /// The number of warnings.
    pub fn warning_count(&self) -> usize {
        self.warnings().len() + warning_count(&self.records())
    }

    /// The tables of all methods, the laws and the budget.
    pub fn tables_in_words(&self, width: Option<usize>) -> String {
        let mut text = String::new();
        for table in &self.tables {
            text += &format!("\nMethod: {}\n{}", table.title(), table_text(&thrust_table(table), width));
        }
        text += &format!("{LOADS_FOOTNOTE}\n\n{}\n", self.summary(width));
        for titled in flight_log_tables(&self.inputs, &names_of(&self.inputs)) {
            text += &format!("{}\n{}\n", titled.title, table_text(&titled.table, width));
        }
        text
    }

    /// The lines to quote: the constants with their ±, the verdict, how the rotors were heard, and logs that do not fit.
    pub fn quote(&self) -> String {
        match self.reported().and_then(|table| Some((table, quoted_constants(table)?))) {
            Some((table, constants)) => {
                let identification = self.identification();
                let heard = rotors_heard_text(table.rotors_heard, identification.partly_separated_count());
                let heard = heard.map_or(String::new(), |heard| heard + "\n");
                let in_logs = |logs: Vec<&str>, verb: &str| match logs.as_slice() {
                    [] => String::new(),
                    [log] => format!("the speeds in {} {verb} the sound\n", printable(log)),
                    _ => format!("the speeds in {} logs {verb} the sound\n", logs.len()),
                };
                let of_logs = in_logs(identification.logs_of_failed_checks(), "do not fit")
                    + &in_logs(identification.logs_of_passed_checks(), "fit");
                let verdict = format!("verdict: {}", printable(Verdict::of(table).words()));
                let first = match table.forbids_use() {
                    true => format!("{verdict}\ndo not use this constant: {constants}\n"),
                    false => format!("{constants}\n{verdict}\n"),
                };
                first + &heard + &of_logs
            }
            None => "C_f: none, since no recording has a speed\nverdict: nothing is identified\n".to_owned(),
        }
    }

    /// The records of all recordings.
    pub fn records(&self) -> Vec<&SpeedRecord> {
        self.inputs.iter().map(|input| &input.record).collect()
    }

    /// The warnings about the constant.
    pub fn warnings(&self) -> &[ThrustWarning] {
        self.reported().map_or(&[], |table| &table.warnings)
    }
}

/// "each", "none", "3 of them".
fn heard_in_words(heard: usize, recordings: usize) -> String {
    match heard {
        0 => "none".to_owned(),
        1 if recordings == 1 => "it".to_owned(),
        all if all == recordings => "each".to_owned(),
        some => format!("{some} of them"),
    }
}

/// The warning that most recordings say that another rotor sounds than that of the vehicle.
fn vehicle_does_not_fit(inputs: &[InputRecord]) -> Option<ThrustWarning> {
    let count = |meant| inputs.iter().filter(|input| input.record.contradiction() == Some(meant)).count();
    let (hardly_heard, elsewhere) = (count(Contradicted::HardlyHeard), count(Contradicted::ByAnotherRotor));
    let of = inputs.iter().filter(|input| input.record.analysis().is_some()).count();
    (2 * (hardly_heard + elsewhere) > of).then_some(ThrustWarning::VehicleDoesNotFit { hardly_heard, elsewhere, of })
}

/// Refuses the diameter of the experiment where the blade tips of a heard rotor would be faster than any multirotor's.
fn check_tips_of(experiment: &Experiment, inputs: &[InputRecord]) -> Result<(), TipsTooFast> {
    let Some(diameter_m) = experiment.propeller_diameter_m else { return Ok(()) };
    for record in inputs.iter().map(|input| &input.record) {
        let tips = record.speed().map(|estimate| check_tips(diameter_m, estimate.speed));
        tips.transpose().map_err(|contradiction| TipsTooFast { file: record.file.clone(), contradiction })?;
    }
    Ok(())
}

/// Standard deviation of the difference between the mean of all rotors and the speed by a method, as a share. It is the mean over all
/// recordings, since the rotors are the same in each of them.
fn unresolved_std_share(experiment: &Experiment, inputs: &[InputRecord], method: Method) -> f64 {
    let running = |input: &InputRecord| {
        let load = experiment.loads.iter().find(|load| load.name == input.load);
        load.map_or(1, |load| load.rotors_running)
    };
    let speeds = inputs.iter().filter(|input| running(input) > 1).filter_map(|input| input.record.speed_by(method));
    let shares: Vec<f64> = speeds.map(SpeedEstimate::rotors_std_share).collect();
    shares.iter().sum::<f64>() / shares.len().max(1) as f64
}

fn is_separated(speed: &SpeedEstimate) -> bool {
    speed.method == Method::Separated
}

/// The speeds of all loads by one method. A recording without a rotor tone, or with several possible speeds, is no trial.
fn loads_of(experiment: &Experiment, inputs: &[InputRecord], method: Method) -> Vec<LoadSpeeds> {
    experiment
        .loads
        .iter()
        .map(|load| LoadSpeeds {
            name: load.name.clone(),
            force: load.force,
            rotors_running: load.rotors_running,
            power_w: load.power_w,
            trials: inputs
                .iter()
                .filter(|input| input.load == load.name)
                .filter_map(|input| {
                    TrialSpeeds::from_analysis(&input.record.file, input.record.unambiguous_analysis()?, method)
                })
                .collect(),
        })
        .collect()
}
