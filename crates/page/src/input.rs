//! Input of the page.

use crate::sound::SoundClip;
use hovertone_analysis::Method;
use hovertone_figures::Figure;
use hovertone_report::{Identification, TextTable, TitledTable};

/// An identified experiment with its figures, sounds and additional tables.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The results.
    pub identification: &'a Identification<'a>,
    /// The figures of the experiment.
    pub figures: &'a [Figure],
    /// One entry for each recording of the identification, in its order.
    pub trials: &'a [TrialReport<'a>],
    /// Tables that replace the table of a method, with the columns of the paper beside it.
    pub compared: &'a [(Method, TextTable)],
    /// Additional tables, such as a comparison with a known truth.
    pub more_tables: &'a [TitledTable],
    /// Lines to paste into models of simulators.
    pub simulators: &'a [SimulatorLines],
    /// The command that repeats the run.
    pub command: &'a str,
    /// Day of the run, as 2026-11-26; empty where it is not known.
    pub date: &'a str,
}

/// Lines to paste into the model of a simulator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimulatorLines {
    /// Name of the simulator: letters, digits and hyphens.
    pub name: String,
    /// The lines.
    pub text: String,
}

/// Figure and sound of a recording.
#[derive(Clone, Copy, Debug)]
pub struct TrialReport<'a> {
    /// Its spectrogram.
    pub figure: Option<&'a Figure>,
    /// Its sound.
    pub sound: Option<&'a SoundClip>,
}
