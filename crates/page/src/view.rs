//! The words, cells and numbers of the template, which escapes all of them.

use hovertone_analysis::Method;
use hovertone_report::{
    Identification, Row, ScaledNumber, TextTable, Verdict, counted, rotors_heard_text, scaled_number, tone_of_order,
};
use hovertone_thrust::ThrustTable;
use hovertone_vehicle::{COVERAGE_FACTOR, Estimate};

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

    pub(crate) fn is_empty(&self) -> bool {
        self.name.is_empty()
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

/// Columns from which a table has smaller letters.
const WIDE_COLUMNS: usize = 9;
/// Rows from which a table may be parted in print.
const LONG_ROWS: usize = 25;

/// A table as in HTML.
pub(crate) struct PageTable {
    /// Name of its CSV file.
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) heads: Vec<Head>,
    pub(crate) rows: Vec<Vec<Cell>>,
    /// Whether the last row is the sum of the others, and stays the last.
    pub(crate) has_sum: bool,
}

impl PageTable {
    pub(crate) fn new(name: &str, title: &str, table: &TextTable) -> Self {
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
        Self { name: name.to_owned(), title: title.to_owned(), rows, heads, has_sum: false }
    }

    /// The same, with a sum as its last row.
    pub(crate) fn with_sum(self) -> Self {
        Self { has_sum: true, ..self }
    }

    pub(crate) fn is_wide(&self) -> bool {
        self.heads.len() >= WIDE_COLUMNS
    }

    pub(crate) fn is_long(&self) -> bool {
        self.rows.len() > LONG_ROWS
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
}

impl Answer {
    pub(crate) fn new(table: &ThrustTable, partly_separated: usize) -> Option<Self> {
        let constant = table.thrust_constant_total_n_s2?;
        let share = constant.std_uncertainty.map(|std| COVERAGE_FACTOR * std / constant.value);
        Some(Self {
            method: rotors_heard_text(table.rotors_heard, partly_separated).unwrap_or_else(|| table.title().to_owned()),
            total: Number::new(constant),
            coverage: share.map(|_| COVERAGE_FACTOR),
            expanded_percent: share.map(|share| format!("{:.2}", 100.0 * share)),
            per_rotor: table.thrust_constant_per_rotor_n_s2.map(Number::new),
            plain_mean: table.plain_mean_total_n_s2.map(Number::bare),
            coefficient: table
                .coefficients
                .map(|both| format!("{:.4} = F/(ρ n² D⁴), or {:.5} = F/(ρ A (ωR)²)", both.propeller, both.rotorcraft)),
            verdict: Verdict::of(table),
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
            table: PageTable::new(table.method.name(), "", shown),
            plain_mean: table.plain_mean_total_n_s2.map(Number::bare),
        }
    }
}

/// Subject of the page.
pub(crate) struct Words<'a> {
    pub(crate) vehicle: &'a str,
    pub(crate) experiment: &'a str,
    pub(crate) sha256: &'a str,
    /// "4 rotors".
    pub(crate) rotors: String,
    /// "tone at 2 times the rotor speed".
    pub(crate) tone: String,
    /// "3 loads".
    pub(crate) loads: String,
    /// "15 recordings".
    pub(crate) recordings: String,
    pub(crate) heard_count: usize,
}

impl<'a> Words<'a> {
    pub(crate) fn new(identification: &Identification<'a>) -> Self {
        let experiment = identification.experiment;
        Self {
            vehicle: experiment.vehicle_name,
            experiment: identification.file,
            sha256: identification.sha256,
            rotors: counted(experiment.rotor_count as usize, "rotor"),
            tone: tone_of_order(experiment.order),
            loads: counted(experiment.load_count, "load"),
            recordings: counted(identification.inputs.len(), "recording"),
            heard_count: identification.inputs.iter().filter(|input| input.record.speed().is_some()).count(),
        }
    }
}
