//! The grey box of eqs 1 and 2: a table for people.

use crate::motor::torque_constant_text;
use crate::number::{DASH, fixed, significant, with_uncertainty};
use crate::other_hover::OtherHover;
use crate::printable::printable;
use crate::quote::counted;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::typeset::TitledTable;
use hovertone_analysis::OtherRotor;
use hovertone_dynamics::{Advice, Checked, Echoes, GreyBoxFit, Parameter, TorqueConstant};
use hovertone_vehicle::{Axis, COVERAGE_FACTOR, Estimate, RotorSpeed, in_list};

pub(crate) const MS_PER_S: f64 = 1e3;
pub(crate) const PERCENT: f64 = 100.0;
/// Share of the change of the speeds which the model must not leave unexplained.
const UNEXPLAINED_SHARE: f64 = 0.3;
/// Shortest flight to which the tests of the ± apply: they flew a minute.
const TESTED_S: f64 = 50.0;

/// A fitted grey box and what belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyBoxRecord {
    /// The recording, where the speeds were heard.
    pub recording: Option<String>,
    /// The log.
    pub log: String,
    /// The vehicle whose numbers were the start.
    pub vehicle: String,
    /// Whether the log has speeds of the rotors, and these were used.
    pub are_speeds_logged: bool,
    /// Time from the first to the last speed.
    pub length_s: f64,
    /// Median time between two rows of the log.
    pub row_s: f64,
    /// The fit.
    pub fit: GreyBoxFit,
    /// Volts per rad/s of the rotor about hover, by the vehicle's numbers.
    pub slope_v_s_rad: f64,
    /// Names of the rotors' places, in the order of their numbers.
    pub places: [&'static str; 4],
    /// By how much the sound has moved the clock of the log, s.
    pub log_moved_s: f64,
    /// A rotor of another vehicle that fits the sound far better.
    pub better: Option<OtherRotor>,
    /// Another hover speed than that of the vehicle's numbers.
    pub other_hover: Option<OtherHover>,
    /// Loss of likelihood by the best swap of two names, nats; absent for logged speeds.
    pub names_nats: Option<f64>,
    /// The echoes of the place of the flight, which the model does not contain; `None` in the open, and for logged speeds.
    pub echoes: Option<Echoes>,
    /// C_τ, or why not.
    pub torque_constant: TorqueConstant,
    /// What is missing.
    pub advice: Vec<Advice>,
    /// Rms on the flight of the fit.
    pub fitted: Option<Checked>,
    /// Rms on another flight.
    pub other_flight: Option<CheckedFlight>,
}

impl GreyBoxRecord {
    /// Whether two rotors may be exchanged: the sound does not tell them apart at odds of 99 to 1.
    pub fn are_names_doubtful(&self) -> bool {
        self.names_nats.is_some_and(|nats| nats < NAMES_NATS_MIN)
    }

    /// Whether something speaks against the model, so that its numbers may be wrong by more than their ±.
    pub fn is_doubtful(&self) -> bool {
        let has_other = self.better.is_some() || self.other_hover.is_some() || self.unexplained().is_some();
        has_other || self.echoes.is_some() || self.are_names_doubtful() || !self.axes_of_negative_gains().is_empty()
    }

    /// How far the predicted speeds are from those of the fitted flight, where the model leaves much of their change unexplained.
    pub(crate) fn unexplained(&self) -> Option<&Checked> {
        self.fitted.as_ref().filter(|fitted| {
            PERCENT * fitted.change_share >= PERCENT_MIN && fitted.rms_share > UNEXPLAINED_SHARE * fitted.change_share
        })
    }

    /// The loops whose command answers an error in the wrong direction.
    pub(crate) fn axes_of_negative_gains(&self) -> Vec<&'static str> {
        let is_negative = |axis: &Axis| {
            let told = self.fit.estimate(Parameter::Proportional(*axis));
            told.is_some_and(|told| told.value < -COVERAGE_FACTOR * told.std_uncertainty.unwrap_or(0.0))
        };
        Axis::ALL.into_iter().filter(is_negative).map(Axis::in_words).collect()
    }
}

/// The check on another flight.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedFlight {
    /// Its recording, where speeds were heard.
    pub recording: Option<String>,
    /// Its log.
    pub log: String,
    /// By how much the sound has moved the clock of its log, s.
    pub log_moved_s: f64,
    /// The result; `None` where no speed was certain enough.
    pub result: Option<Checked>,
}

/// The grey box as text.
pub fn grey_box_text(record: &GreyBoxRecord, width: Option<usize>) -> String {
    let source = record.recording.as_deref().map_or(String::new(), |recording| format!("{}, ", printable(recording)));
    let mut text = format!("{source}{}\n", printable(&record.log));
    text += &format!(
        "{}: the model is fitted at {} to the {} speeds of the rotors\n",
        record.vehicle,
        counted(record.fit.observations, "moment"),
        if record.are_speeds_logged { "logged" } else { "heard" }
    );
    for titled in grey_box_tables(record) {
        text += &format!("\n{}\n{}", titled.title, table_text(&titled.table, width));
    }
    text += "\n";
    for note in grey_box_notes(record) {
        text += &format!("{note}\n");
    }
    text
}

/// The two tables of a grey box: gains of eq 1, and eq 2 with hover.
pub fn grey_box_tables(record: &GreyBoxRecord) -> [TitledTable; 2] {
    let gains =
        TitledTable::new("Gains of the control loops near hover (equation 1 of docs/greybox.md)", gains_table(record));
    [gains, TitledTable::new("Motors and hover (equation 2 of docs/greybox.md)", motor_table(record))]
}

/// How far the ± can be trusted: shares of errors within 2 u in simulated flights (`docs/greybox.md`).
pub(crate) fn trust(record: &GreyBoxRecord) -> String {
    let tested = match record.are_speeds_logged {
        true => {
            "the ± is about right: in simulated flights of a minute, 90 to 100 % of the errors were within it, and 95 % should be"
        }
        false => {
            "the ± is for a flight outdoors, and a little too small: in simulated flights of a minute, 87 to 95 % of the errors were within it, and 95 % should be; compare with another flight (--check)"
        }
    };
    if record.is_doubtful() {
        return "the numbers may be wrong by more than their ±: the warnings name the reason".to_owned();
    }
    if !record.fit.information.correlations.is_empty() {
        return "the ± may be too small, because some of these numbers (named below) have nearly the same effect in this flight".to_owned();
    }
    if record.length_s < TESTED_S {
        return format!(
            "the ± may be too small, because the flight is short: {:.0} s, where the flights that the ± was tested with had 60 s",
            record.length_s
        );
    }
    tested.to_owned()
}

/// Lines beside the tables: what to trust, C_τ, rank, gaps, checks.
pub fn grey_box_notes(record: &GreyBoxRecord) -> Vec<String> {
    let advice = record.advice.iter().map(|advice| format!("{}; {}", advice.what, advice.hint));
    // with loops in the wrong direction, it says nothing of the torque
    let has_torque = record.axes_of_negative_gains().is_empty();
    let torque = has_torque.then(|| torque_line(&record.torque_constant).trim_end().to_owned());
    let checks = check_lines(record);
    let checks = checks.lines().map(str::to_owned);
    let moved = moved_in_words(&record.log, record.log_moved_s);
    let first = std::iter::once(trust(record)).chain(torque);
    first.chain([rank_line(record)]).chain(negative_delay(record)).chain(moved).chain(checks).chain(advice).collect()
}

/// That a delay is below zero by more than its ±, which no delay is; `None` where none is.
fn negative_delay(record: &GreyBoxRecord) -> Option<String> {
    let value_of = |delay: Parameter| {
        let told = record.fit.estimate(delay)?;
        let is_below = told.value + COVERAGE_FACTOR * told.std_uncertainty.unwrap_or(0.0) < 0.0;
        is_below.then_some((delay, told))
    };
    let (delay, told) = [Parameter::CommandDelay, Parameter::MeasuredDelay].into_iter().find_map(value_of)?;
    let least_s = -told.value - COVERAGE_FACTOR * told.std_uncertainty.unwrap_or(0.0);
    let row_ms = significant(1e3 * record.row_s, 2);
    let meaning = match least_s <= record.row_s {
        true => format!(
            "this is no fault: the log has a row every {row_ms} ms, so the time of a command may be wrong by this much"
        ),
        false => {
            format!("it is more than the {row_ms} ms between two rows of the log: the clocks or the model do not fit")
        }
    };
    Some(format!("{} is negative, although no true delay is; {meaning}", delay.in_words()))
}

/// That the clock of a log was moved; `None` where it was right.
fn moved_in_words(log: &str, moved_s: f64) -> Option<String> {
    let by = if moved_s < 0.0 { "earlier" } else { "later" };
    let is_moved = moved_s != 0.0;
    is_moved.then(|| {
        format!(
            "the clock of {} was set {:.2} s {by}, where the log fits the sound best",
            printable(log),
            moved_s.abs()
        )
    })
}

/// Volts are by the vehicle's motor: the sound holds a gain times the speed per volt.
fn gains_table(record: &GreyBoxRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("loop"),
        Column::words("gain"),
        Column::numbers("gain as rotor speed", ""),
        Column::words("unit"),
        Column::numbers("gain as voltage", ""),
        Column::words("unit"),
    ]);
    for axis in Axis::ALL {
        for (name, parameter, per) in [
            ("k_p", Parameter::Proportional(axis), in_brackets(axis.unit())),
            ("k_d", Parameter::Derivative(axis), format!("({}/s)", axis.unit())),
        ] {
            let told = record.fit.estimate(parameter);
            shown.push(vec![
                axis.in_words().to_owned(),
                name.to_owned(),
                told.map_or(DASH.to_owned(), shown_estimate),
                format!("rad/s per {per}"),
                told.map_or(DASH.to_owned(), |told| shown_estimate(told.scaled(record.slope_v_s_rad))),
                format!("V per {per}"),
            ]);
        }
    }
    shown
}

/// A unit behind "per": a quotient stands in brackets.
fn in_brackets(unit: &str) -> String {
    if unit.contains('/') { format!("({unit})") } else { unit.to_owned() }
}

fn shown_estimate(estimate: Estimate) -> String {
    with_uncertainty(estimate.value, estimate.std_uncertainty)
}

fn motor_table(record: &GreyBoxRecord) -> TextTable {
    let mut shown =
        TextTable::new(vec![Column::words("quantity"), Column::numbers("value", ""), Column::words("unit")]);
    let mut push = |name: String, parameter: Parameter, scale: f64, unit: &str| {
        let told = record.fit.estimate(parameter).map(|told| told.scaled(scale));
        shown.push(vec![name, told.map_or(DASH.to_owned(), shown_estimate), unit.to_owned()]);
    };
    push("time constant".to_owned(), Parameter::TimeConstant, MS_PER_S, "ms");
    push("square term of the load, b/s".to_owned(), Parameter::Load, MS_PER_S, "ms/rad");
    push("delay of commands".to_owned(), Parameter::CommandDelay, MS_PER_S, "ms");
    push("delay of measured values".to_owned(), Parameter::MeasuredDelay, MS_PER_S, "ms");
    for (rotor, place) in record.places.iter().enumerate() {
        let rev_s = RotorSpeed::from_rad_s(1.0).rev_s();
        push(format!("hover speed {}, {place}", rotor + 1), Parameter::Hover(rotor), rev_s, "rev/s");
    }
    shown
}

fn torque_line(constant: &TorqueConstant) -> String {
    let told = match constant {
        TorqueConstant::Told(told) => Ok((*told, ", if the yaw inertia I_zz of the vehicle is right".to_owned())),
        other => Err(other.reason().unwrap_or_default()),
    };
    torque_constant_text(told)
}

fn rank_line(record: &GreyBoxRecord) -> String {
    let information = &record.fit.information;
    let told = record.fit.std_uncertainty.iter().flatten().count();
    let count = information.parameters;
    let not_shown: Vec<String> = numbers_not_shown(record).iter().map(|number| number.in_words()).collect();
    let of_all = match not_shown.len() {
        _ if told >= count => format!("the flight shows all {count} numbers of the model"),
        1..=NUMBERS_NAMED_MAX => {
            format!(
                "the flight shows {told} of the {count} numbers of the model, all but {}",
                in_list(&not_shown, "and")
            )
        }
        _ => format!(
            "the flight shows {told} of the {count} numbers of the model; the tables have – in place of the others"
        ),
    };
    match information.rank {
        rank if rank < count => {
            format!("{of_all}; {rank} of the {count} numbers could be found independently of each other")
        }
        _ => of_all,
    }
}

/// Most numbers that a line names.
const NUMBERS_NAMED_MAX: usize = 4;

/// The numbers of the model that the flight does not show, without the loops that the model leaves out; empty where loops of both kinds look alike.
fn numbers_not_shown(record: &GreyBoxRecord) -> Vec<Parameter> {
    let not_shown = || Parameter::all().into_iter().filter(|number| record.fit.estimate(*number).is_none());
    let of_axis = |axis: Axis| not_shown().filter(|number| number.axis() == Some(axis)).count();
    let per_loop = Parameter::all().iter().filter(|number| number.axis() == Some(Axis::ALL[0])).count();
    let unseen: Vec<Axis> = Axis::ALL.into_iter().filter(|axis| of_axis(*axis) == per_loop).collect();
    let is_of_model = |number: &Parameter| number.axis().is_none_or(|axis| !unseen.contains(&axis));
    let left_out = Parameter::all().len() - record.fit.information.parameters;
    if left_out == per_loop * unseen.len() { not_shown().filter(is_of_model).collect() } else { Vec::new() }
}

/// Odds of 99 to 1.
const NAMES_NATS_MIN: f64 = 4.6;

/// Smallest change of the speeds that is worth a comparison, in per cent.
const PERCENT_MIN: f64 = 0.001;

fn check_lines(record: &GreyBoxRecord) -> String {
    let line = |of: &Checked, is_heard: bool| match PERCENT * of.change_share {
        ..PERCENT_MIN => "the speeds do not change, so nothing is compared".to_owned(),
        percent => format!(
            "the predicted speeds differ from the {} ones by {} % (rms); the speeds themselves change by {} % (rms)",
            if is_heard { "heard" } else { "logged" },
            significant(PERCENT * of.rms_share, 2),
            significant(percent, 2)
        ),
    };
    let mut text = record
        .fitted
        .as_ref()
        .map_or(String::new(), |fitted| format!("on this flight: {}\n", line(fitted, !record.are_speeds_logged)));
    if let Some(other) = &record.other_flight {
        text += &moved_in_words(&other.log, other.log_moved_s).map_or(String::new(), |words| words + "\n");
        let name = printable(other.recording.as_deref().unwrap_or(&other.log));
        text += &match &other.result {
            Some(result) => format!("on {name}, not used for the fit: {}\n", line(result, other.recording.is_some())),
            None => format!("on {name}: no rotor could be separated from the others, so nothing is compared\n"),
        };
    }
    text
}

/// The gains beside a truth that is known, for simulated flights: parameter, identified, true, difference.
pub fn grey_box_against_truth(fit: &GreyBoxFit, truth: &[f64]) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("parameter"),
        Column::numbers("identified", ""),
        Column::numbers("true", ""),
        Column::numbers("off by", "%"),
    ]);
    for (parameter, &truth) in Parameter::all().into_iter().zip(truth) {
        let is_hidden = matches!(
            parameter,
            Parameter::CommandDelay | Parameter::MeasuredDelay | Parameter::Limit(_) | Parameter::MotorGain(_)
        );
        let Some(told) = fit.estimate(parameter).filter(|_| !is_hidden) else { continue };
        let off = if truth == 0.0 { DASH.to_owned() } else { fixed(PERCENT * (told.value / truth - 1.0), 2) };
        shown.push(vec![parameter.in_words(), shown_estimate(told), significant(truth, 4), off]);
    }
    shown
}
