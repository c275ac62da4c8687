//! The words, cells and numbers of the template, which escapes all of them.

use crate::input::TrialReport;
use crate::sound::wav_uri;
use hovertone_analysis::Method;
use hovertone_report::{
    Identification, InputRecord, Notice, RecordingFacts, Row, ScaledNumber, SpeedRecord, TextTable, Verdict, counted,
    cuts_in_words, notice_of_all, notices_of_all, rotors_heard_text, scaled_number, warning_count, with_uncertainty,
};
use hovertone_thrust::{COVERAGE_FACTOR, ThrustTable};
use hovertone_vehicle::Estimate;

/// A unit: "1e-5 N s²" becomes 10⁻⁵ N s².
pub(crate) struct Unit {
    pub(crate) exponent: Option<i32>,
    pub(crate) name: String,
}

impl Unit {
    fn new(text: &str) -> Self {
        let power =
            text.split_once(' ').and_then(|(power, name)| Some((power.strip_prefix("1e")?.parse().ok()?, name)));
        match power {
            Some((exponent, name)) => Self { exponent: Some(exponent), name: name.to_owned() },
            None => Self { exponent: None, name: text.to_owned() },
        }
    }
}

pub(crate) struct Head {
    pub(crate) title: String,
    pub(crate) unit: Unit,
    pub(crate) is_number: bool,
}

pub(crate) struct Cell {
    pub(crate) text: String,
    pub(crate) is_number: bool,
    pub(crate) columns: usize,
}

/// A table as in HTML.
pub(crate) struct PageTable {
    pub(crate) title: String,
    pub(crate) heads: Vec<Head>,
    pub(crate) has_units: bool,
    pub(crate) rows: Vec<Vec<Cell>>,
}

impl PageTable {
    pub(crate) fn new(title: &str, table: &TextTable) -> Self {
        let heads: Vec<Head> = table
            .columns()
            .iter()
            .map(|column| Head {
                title: column.title().to_owned(),
                unit: Unit::new(column.unit()),
                is_number: column.is_number(),
            })
            .collect();
        let cells = |row: &Row| match row {
            Row::Cells(cells) => heads
                .iter()
                .zip(cells)
                .map(|(head, text)| Cell { text: text.clone(), is_number: head.is_number, columns: 1 })
                .collect(),
            Row::Words(first, words) => vec![
                Cell { text: first.clone(), is_number: false, columns: 1 },
                Cell { text: words.clone(), is_number: false, columns: heads.len().saturating_sub(1).max(1) },
            ],
        };
        let rows = table.rows().iter().map(cells).collect();
        Self { title: title.to_owned(), has_units: table.has_units(), rows, heads }
    }
}

/// A number of the result with its ±, k = 2: rounded for people, and exact.
pub(crate) struct Number {
    pub(crate) scaled: ScaledNumber,
    pub(crate) value: f64,
    pub(crate) expanded_uncertainty: Option<f64>,
}

impl Number {
    fn new(Estimate { value, std_uncertainty, .. }: Estimate) -> Self {
        Self {
            scaled: scaled_number(value, std_uncertainty),
            value,
            expanded_uncertainty: std_uncertainty.map(|std| COVERAGE_FACTOR * std),
        }
    }

    /// The number alone, where its uncertainty is that of other numbers.
    fn bare(Estimate { value, .. }: Estimate) -> Self {
        Self { scaled: scaled_number(value, None), value, expanded_uncertainty: None }
    }

    /// The uncertainty in full; empty without one.
    pub(crate) fn exact_uncertainty(&self) -> String {
        self.expanded_uncertainty.map_or(String::new(), |uncertainty| uncertainty.to_string())
    }
}

/// The result at the top.
pub(crate) struct Answer {
    pub(crate) method: String,
    /// The constant of the whole vehicle.
    pub(crate) total: Number,
    /// k of every ±; absent where the uncertainty is unknown.
    pub(crate) coverage: Option<f64>,
    pub(crate) expanded_percent: Option<String>,
    pub(crate) per_rotor: Option<Number>,
    pub(crate) plain_mean: Option<Number>,
    pub(crate) coefficient: Option<String>,
    pub(crate) verdict: Verdict,
    pub(crate) warnings: Vec<Notice>,
    /// "2 warnings".
    pub(crate) warning_count: String,
    /// Whether some of them stand only at their recordings.
    pub(crate) has_others: bool,
}

impl Answer {
    pub(crate) fn new(table: &ThrustTable, inputs: &[InputRecord]) -> Option<Self> {
        let constant = table.thrust_constant_total_n_s2?;
        let records: Vec<&SpeedRecord> = inputs.iter().map(|input| &input.record).collect();
        let share = constant.std_uncertainty.map(|std| COVERAGE_FACTOR * std / constant.value);
        let of_all = notices_of_all(&records).into_iter().map(|notice| notice_of_all(notice, &records));
        let warnings: Vec<Notice> = table.warnings.iter().map(Notice::from).chain(of_all).collect();
        let count = table.warnings.len() + warning_count(&records);
        Some(Self {
            method: rotors_heard_text(table.rotors_heard).unwrap_or_else(|| table.title().to_owned()),
            total: Number::new(constant),
            coverage: share.map(|_| COVERAGE_FACTOR),
            expanded_percent: share.map(|share| format!("{:.2}", 100.0 * share)),
            per_rotor: table.thrust_constant_per_rotor_n_s2.map(Number::new),
            plain_mean: table.plain_mean_total_n_s2.map(Number::bare),
            coefficient: table
                .coefficients
                .map(|both| format!("{:.4} = T/(ρ n² D⁴), or {:.5} = T/(ρ A (ωR)²)", both.propeller, both.rotorcraft)),
            verdict: Verdict::of(table),
            warning_count: counted(count, "warning"),
            has_others: count > warnings.len(),
            warnings,
        })
    }

    /// Class and mark of the verdict.
    pub(crate) fn verdict_marks(&self) -> (&'static str, &'static str) {
        match self.verdict {
            Verdict::Holds(_) => ("holds", "✓"),
            Verdict::Fails(_) => ("fails", "✗"),
            Verdict::Untested(_) => ("untested", "–"),
        }
    }
}

/// The tables of one method.
pub(crate) struct MethodView {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) colour: String,
    pub(crate) is_papers: bool,
    pub(crate) is_reported: bool,
    pub(crate) table: PageTable,
    pub(crate) plain_mean: Option<Number>,
}

impl MethodView {
    pub(crate) fn new(table: &ThrustTable, shown: &TextTable, colour: String, reported: Method) -> Self {
        Self {
            name: table.method.name(),
            title: table.title(),
            colour,
            is_papers: matches!(table.method, Method::MaximumTrace | Method::Gaussian),
            is_reported: table.method == reported,
            table: PageTable::new("", shown),
            plain_mean: table.plain_mean_total_n_s2.map(Number::bare),
        }
    }
}

/// Subject of the page.
pub(crate) struct Words<'a> {
    pub(crate) vehicle: &'a str,
    pub(crate) experiment: &'a str,
    pub(crate) sha256: &'a str,
    pub(crate) rotor_count: u32,
    pub(crate) order: String,
    pub(crate) load_count: usize,
    pub(crate) recording_count: usize,
    pub(crate) heard_count: usize,
}

impl<'a> Words<'a> {
    pub(crate) fn new(identification: &Identification<'a>) -> Self {
        let experiment = identification.experiment;
        Self {
            vehicle: experiment.vehicle_name,
            experiment: identification.file,
            sha256: identification.sha256,
            rotor_count: experiment.rotor_count,
            order: experiment.order.to_string(),
            load_count: experiment.load_count,
            recording_count: identification.inputs.len(),
            heard_count: identification.inputs.iter().filter(|input| input.record.speed().is_some()).count(),
        }
    }
}

/// A playable sound.
pub(crate) struct SoundView {
    pub(crate) uri: String,
    pub(crate) from_s: f64,
}

/// A recording with its picture and sound.
pub(crate) struct TrialView<'a> {
    pub(crate) load: &'a str,
    pub(crate) file: &'a str,
    pub(crate) speed: Option<String>,
    pub(crate) reason: Option<String>,
    pub(crate) cuts: Option<String>,
    pub(crate) warnings: &'a [Notice],
    pub(crate) svg: Option<&'a str>,
    pub(crate) words: &'a str,
    pub(crate) sound: Option<SoundView>,
}

impl<'a> TrialView<'a> {
    pub(crate) fn new(input: &'a InputRecord, trial: &TrialReport<'a>, sound_rate_hz: u32) -> Self {
        let record = &input.record;
        let sound =
            trial.sound.and_then(|clip| Some(SoundView { uri: wav_uri(clip, sound_rate_hz)?, from_s: clip.from_s }));
        Self {
            load: &input.load,
            file: &record.file,
            speed: record
                .speed()
                .map(|speed| with_uncertainty(speed.speed.rev_s(), speed.combined_std_uncertainty_rev_s())),
            reason: record.reason(),
            cuts: record.analysis().and_then(|analysis| cuts_in_words(&analysis.hover.cuts)),
            warnings: &record.notices,
            svg: trial.figure.map(|figure| figure.svg.as_str()),
            words: trial.figure.map_or("", |figure| figure.description.as_str()),
            sound,
        }
    }
}

/// Facts about the file of a recording.
pub(crate) struct InputView<'a> {
    pub(crate) load: &'a str,
    pub(crate) file: &'a str,
    pub(crate) status: &'static str,
    pub(crate) facts: Option<&'a RecordingFacts>,
}

impl<'a> InputView<'a> {
    pub(crate) fn new(input: &'a InputRecord) -> Self {
        let record = &input.record;
        Self { load: &input.load, file: &record.file, status: record.status(), facts: record.recording.as_ref() }
    }
}
