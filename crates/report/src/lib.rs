//! Results as tables, CSV and JSON. Pure functions from results to text; the caller decides where the text goes.
//!
//! ```text
//! number        digits that follow the uncertainty          notice              a warning with its hint
//! text_table    tables for people                           table_lines         a table, folded to the terminal
//! data_table    tables for programs: CSV, Parquet           typeset             tables for documents: Markdown, LaTeX
//! csv_text      text of a CSV writer                        printable           names without control characters
//! names         short names of recordings                   wording             advice in the words of a command
//! version       version of the program                      folded_warnings     warnings of recordings, folded
//! recording     the record of one recording                 speed               its table row and its JSON
//! track         its speed over time                         cuts                its cuts on one line
//! given         the facts given before it was heard         missing_speed       why it has no speed
//! decision      why this shaft speed, and the second one    condition           shaft lines of the rotors
//! tones         tone families and their readings            tone_line           the line of a tone family
//! thrust        tables like those of the paper              results             results.json and its schema
//! quote         the constant and the verdict to quote       units               the constant in units of programs
//! adequacy      agreement, laws, uncertainty budget         samples             samples and loads as data tables
//! experiment_key  keys of experiment files, and their flags  planned_experiment  what identify would do
//! fitted_table  the fit of a thrust stand's table           flight_plan         flying for a wanted uncertainty
//! models        simulators' models beside the result        weighed             a weighed hover
//! vehicles      the vehicles and their sources              comparison          a simulation beside paper and truth
//! flight        summary of a simulated flight               logged              what a log holds
//! verification  sound against telemetry                     flight_log          the log of a recording's flight
//! flight_log_tables  the same as tables                     motor_record        the motors of a log or a recording
//! motor         their constants, from steps                 motor_map           their speed at each command
//! motor_json    both for programs                           grey_box            the low-level model of eqs 1 and 2
//! grey_box_json the same for programs                       other_hover         a flight at another hover speed
//! ```

mod adequacy;
mod comparison;
mod condition;
mod csv_text;
mod cuts;
mod data_table;
mod decision;
mod experiment_key;
mod fitted_table;
mod flight;
mod flight_log;
mod flight_log_tables;
mod flight_plan;
mod folded_warnings;
mod given;
mod grey_box;
mod grey_box_json;
mod grey_box_warnings;
mod logged;
mod missing_speed;
mod models;
mod motor;
mod motor_json;
mod motor_map;
mod motor_record;
mod names;
mod notice;
mod number;
mod other_hover;
mod planned_experiment;
mod printable;
mod quote;
mod recording;
mod results;
mod samples;
mod speed;
mod table_lines;
mod text_table;
mod thrust;
mod tone_line;
mod tones;
mod track;
mod typeset;
mod units;
mod vehicles;
mod verification;
mod version;
mod weighed;
mod wording;

pub use adequacy::{adequacy_text, agreement_text, budget_table, laws_table, laws_text, preferred_text};
pub use comparison::{LoadTruth, PrintedRow, comparison_with_paper, comparison_with_truth};
pub use condition::condition_table;
pub use cuts::cuts_in_words;
pub use data_table::{DataColumn, DataTable, Values};
pub use decision::{DecisionWords, decision_in_words};
pub use experiment_key::ExperimentKey;
pub use fitted_table::{FittedTable, fitted_table_text, fitted_tables_json};
pub use flight::{SimulatedFlight, SimulatedRotor, simulated_flight_table};
pub use flight_log::FlightLogRecord;
pub use flight_log_tables::flight_log_tables;
pub use flight_plan::flight_plan_text;
pub use folded_warnings::{
    FoldedWarning, distinct_notices, folded_cuts, folded_warnings, own_cuts, own_notices, own_reason, warning_count,
    weaknesses_in_words,
};
pub use grey_box::{
    CheckedFlight, GreyBoxRecord, grey_box_against_truth, grey_box_notes, grey_box_tables, grey_box_text,
};
pub use grey_box_json::grey_box_json;
pub use grey_box_warnings::grey_box_warnings;
pub use logged::{log_json, log_text, signal_headers};
pub use models::{ComparedModel, models_json, models_text, vehicle_model_text};
pub use motor::{BENCH_RUN, motor_text};
pub use motor_json::motor_json;
pub use motor_record::{LoggedMotor, MotorRecord, MotorSound, MotorSource};
pub use names::short_names;
pub use notice::{Notice, NoticeKind};
pub use number::{ScaledNumber, fixed, scaled_number, signed, significant, with_uncertainty};
pub use other_hover::OtherHover;
pub use planned_experiment::{PlannedExperiment, PlannedLoad, PlannedRecording, PlannedSound, planned_experiment_text};
pub use printable::{folded, printable, shared_folder, wrapped};
pub use quote::{Verdict, counted, quoted_constants, rotors_heard_text, tone_of_order};
pub use recording::{Answer, Contradicted, Found, RecordingFacts, SpeedRecord};
pub use results::{ExperimentFacts, Identification, InputRecord, RESULTS_SCHEMA, results_json};
pub use samples::{loads_data, samples_data};
pub use speed::{LiveWords, SpeedWords, live_speed_in_words, speed_in_words, speed_json, speed_table};
pub use table_lines::table_text;
pub use text_table::{Column, Row, TextTable};
pub use thrust::{LOADS_FOOTNOTE, load_in_words, methods_table, thrust_summary, thrust_table};
pub use tones::{tones_json, tones_text};
pub use track::{numbered_tracks, track_csv};
pub use typeset::{TitledTable, tables_latex, tables_markdown};
pub use units::{ConstantInUnit, constants_in_units};
pub use vehicles::{vehicles_json, vehicles_text};
pub use verification::{VerificationRecord, small_plus_minus, verification_json, verification_text};
pub use version::VERSION;
pub use weighed::{weighed_json, weighed_text};
pub use wording::{LEAVE_MEAN_ONLY_OUT, LEAVE_METHOD_OUT, ONE_BAND_FOR_ALL, Wording};
