//! All warnings of the page: one line each in the answer, linked to the place where the advice stands.

use crate::head::{LETTERS_MAX, head_of};
use hovertone_figures::shortened;
use hovertone_report::{
    FlightLogRecord, FoldedWarning, InputRecord, Notice, SpeedRecord, counted, distinct_notices, own_notices,
    own_reason, warning_count,
};
use hovertone_thrust::{ThrustTable, ThrustWarning};

/// Most lines in the answer; the others are counted.
const LINES_MAX: usize = 8;
/// Most letters of a load or a recording before its warning.
const NAME_LETTERS: usize = 22;

/// A line of the answer: the head of a warning.
pub(crate) struct WarningLine {
    pub(crate) text: String,
    /// The element with the whole warning.
    pub(crate) target: String,
}

/// A warning with its advice, in the section that it concerns.
pub(crate) struct PlacedNotice {
    pub(crate) id: String,
    section: &'static str,
    head: String,
    pub(crate) text: String,
    pub(crate) hint: String,
}

/// The warnings of an experiment.
pub(crate) struct Warnings {
    /// "2 warnings".
    pub(crate) counted: String,
    pub(crate) lines: Vec<WarningLine>,
    /// Number of warnings without a line.
    pub(crate) more: usize,
    notices: Vec<PlacedNotice>,
}

impl Warnings {
    /// The warnings about the constant, about several recordings, and about single recordings, whose names for people are `names`.
    pub(crate) fn new(
        table: Option<&ThrustTable>,
        inputs: &[InputRecord],
        names: &[String],
        folded: &[FoldedWarning],
    ) -> Self {
        let records: Vec<&SpeedRecord> = inputs.iter().map(|input| &input.record).collect();
        let of_constant = table.into_iter().flat_map(|table| &table.warnings);
        let of_constant = of_constant.map(|warning| {
            let notice = Notice::from(warning);
            (section_of(warning), head_of("", &notice.text, ""), notice)
        });
        let of_several = folded.iter().map(|kind| {
            let whole = &kind.notice.text;
            // the names of the recordings stand where the line leads to, if there is no room for them
            let head = match whole.chars().count() {
                0..=LETTERS_MAX => whole.clone(),
                _ => head_of("", &kind.what, &format!(" (in {})", kind.counted)),
            };
            ("recordings", head, kind.notice.clone())
        });
        let notices: Vec<PlacedNotice> = (1..)
            .zip(of_constant.chain(of_several))
            .map(|(number, (section, head, notice))| PlacedNotice {
                id: format!("warning-{number}"),
                section,
                head,
                text: notice.text,
                hint: notice.hint,
            })
            .collect();
        let mut lines: Vec<WarningLine> =
            notices.iter().map(|notice| WarningLine { text: notice.head.clone(), target: notice.id.clone() }).collect();
        // a missing speed, or one that the log contradicts, weighs more than any warning about another recording
        let is_worse = |input: &InputRecord| {
            input.record.reason().is_some() || input.log.as_ref().is_some_and(FlightLogRecord::has_failed_check)
        };
        let (missing, told): (Vec<_>, Vec<_>) =
            inputs.iter().zip(names).enumerate().partition(|(_, (input, _))| is_worse(input));
        for (index, (input, name)) in missing.into_iter().chain(told) {
            lines.extend(lines_of(input, name, index, folded));
        }
        let failed = records.iter().filter(|record| record.has_failed()).count();
        let count = table.map_or(0, |table| table.warnings.len()) + warning_count(&records) + failed;
        lines.truncate(LINES_MAX);
        Self { counted: counted(count, "warning"), more: count.saturating_sub(lines.len()), lines, notices }
    }

    /// The warnings of a section.
    pub(crate) fn of<'a>(&'a self, section: &'a str) -> impl Iterator<Item = &'a PlacedNotice> {
        self.notices.iter().filter(move |notice| notice.section == section)
    }
}

/// The element of a recording.
pub(crate) fn recording_id(index: usize) -> String {
    format!("recording-{}", index + 1)
}

/// The lines of one recording: its warnings, and a missing speed, without those that are folded.
fn lines_of(input: &InputRecord, name: &str, index: usize, folded: &[FoldedWarning]) -> Vec<WarningLine> {
    let (record, id) = (&input.record, recording_id(index));
    let before = format!("{} · {}: ", shortened(&input.load, NAME_LETTERS), shortened(name, NAME_LETTERS));
    let words = |text: &str| head_of(&before, text, "");
    let why_none = own_reason(record, folded).map(|reason| WarningLine { text: words(&reason), target: id.clone() });
    let own = own_notices(record, folded);
    let notices = (1..)
        .zip(distinct_notices(record, folded))
        .filter(|(_, notice)| own.contains(notice))
        .map(|(number, notice)| WarningLine { text: words(&notice.text), target: format!("{id}-warning-{number}") });
    why_none.into_iter().chain(notices).collect()
}

/// The section of the page that a warning concerns.
fn section_of(warning: &ThrustWarning) -> &'static str {
    match warning {
        ThrustWarning::ConstantDrifts(_)
        | ThrustWarning::TrialLeftOut { .. }
        | ThrustWarning::TrialFarFromOthers { .. }
        | ThrustWarning::TrialsDiffer { .. }
        | ThrustWarning::TrialsInGroups { .. }
        | ThrustWarning::MassFarFromKnown { .. }
        | ThrustWarning::ImplausibleFigureOfMerit { .. } => "loads",
        ThrustWarning::MassNotWeighed { .. }
        | ThrustWarning::LoudestRotor
        | ThrustWarning::UncertaintiesIncomplete { .. } => "budget",
        _ => "fit",
    }
}
