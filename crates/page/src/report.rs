//! The page, from its input and the template.

use crate::filters;
use crate::input::{Report, TrialReport};
use crate::recordings::{InputView, TrialView, names_of};
use crate::seal::policy;
use crate::sound::{SoundClip, SoundShare, sound_share};
use crate::view::{Answer, MethodView, PageTable, Words};
use crate::warnings::Warnings;
use askama::Template;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hovertone_analysis::Method;
use hovertone_figures::{Figure, level_colours, method_colour};
use hovertone_report::{
    ConstantInUnit, FoldedWarning, Identification, LOADS_FOOTNOTE, SpeedRecord, TitledTable, VERSION, agreement_text,
    budget_table, constants_in_units, flight_log_tables, folded_warnings, laws_table, load_in_words, loads_data,
    methods_table, preferred_text, samples_data, thrust_table,
};
use serde_json::{Map, Value};

pub(crate) const STYLE: &str = concat!(
    include_str!("../templates/style/page.css"),
    include_str!("../templates/style/answer.css"),
    include_str!("../templates/style/figures.css"),
    include_str!("../templates/style/tables.css"),
    include_str!("../templates/style/print.css"),
);
pub(crate) const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../templates/script/values.js"),
    include_str!("../templates/script/picture.js"),
    include_str!("../templates/script/panel.js"),
    include_str!("../templates/script/pointing.js"),
    include_str!("../templates/script/sound.js"),
    include_str!("../templates/script/tables.js"),
    include_str!("../templates/script/page.js"),
    include_str!("../templates/script/print.js"),
    "})();\n",
);
/// Most bytes of all sound as text in the page. With the pictures of 15 trials the page stays below 4 MB.
const SOUND_BYTES_MAX: f64 = 1.5e6;

/// Reason for a missing page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// Error of the template.
    #[error("the page could not be made: {0}")]
    Template(#[from] askama::Error),
    /// The settings could not be serialised.
    #[error("the settings could not be written: {0}")]
    Settings(#[from] serde_json::Error),
    /// A table could not be written as CSV.
    #[error("a table could not be written: {0}")]
    Table(String),
}

/// A file inside the page.
struct PageFile {
    name: String,
    uri: String,
}

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    policy: String,
    style: &'static str,
    script: &'static str,
    level_colours: String,
    load_words: String,
    version: &'static str,
    words: Words<'a>,
    answer: Option<Answer>,
    warnings: Warnings,
    constants: Vec<ConstantInUnit>,
    methods: Vec<MethodView>,
    method_constants: PageTable,
    laws: Option<PageTable>,
    agreement: String,
    preferred: String,
    loads_footnote: &'static str,
    budget: Option<PageTable>,
    more_tables: Vec<PageTable>,
    log_tables: Vec<PageTable>,
    files: Vec<PageFile>,
    trials: Vec<TrialView<'a>>,
    inputs: Vec<InputView<'a>>,
    sound: Option<SoundShare>,
    settings: String,
    command: &'a str,
    report: &'a Report<'a>,
}

impl Page<'_> {
    /// The figure with a name; `None` where it was left out.
    fn figure(&self, name: &str) -> Option<&Figure> {
        self.report.figures.iter().find(|figure| figure.name == name)
    }

    fn reported_method(&self) -> impl Iterator<Item = &MethodView> {
        self.methods.iter().filter(|method| method.is_reported)
    }

    /// A method of the paper.
    fn papers_method(&self, name: &str) -> impl Iterator<Item = &MethodView> {
        self.methods.iter().filter(move |method| method.name == name)
    }

    /// The methods that are neither reported nor of the paper.
    fn other_methods(&self) -> impl Iterator<Item = &MethodView> {
        self.methods.iter().filter(|method| !method.is_papers && !method.is_reported)
    }

    /// The year of the run, where its day is known.
    fn year(&self) -> Option<&str> {
        self.report.date.split_once('-').map(|(year, _)| year)
    }

    fn has_other_methods(&self) -> bool {
        self.other_methods().next().is_some()
    }
}

/// The page. It loads nothing: style, script, pictures and sound are inside. Equal reports give equal bytes.
///
/// # Errors
/// None is known, since the template is compiled in and all types can be serialised.
pub fn report_html(report: &Report<'_>) -> Result<String, PageError> {
    let identification = report.identification;
    let (reported, inputs) = (identification.reported(), identification.inputs);
    let fit = reported.and_then(|table| table.fit.as_ref());
    let names = names_of(inputs);
    let folded = folded_warnings(&inputs.iter().map(|input| &input.record).collect::<Vec<&SpeedRecord>>());
    let (trials, share) = trial_views(report, &names, &folded);
    let has_sound = trials.iter().any(|trial| trial.sound.is_some());
    let page = Page {
        policy: policy(STYLE, SCRIPT),
        style: STYLE,
        script: SCRIPT,
        level_colours: serde_json::to_string(&level_colours().to_vec())?,
        load_words: load_words(identification)?,
        version: VERSION,
        words: Words::new(identification),
        answer: reported.and_then(|table| Answer::new(table, identification.partly_separated_count())),
        warnings: Warnings::new(reported, inputs, &names, &folded),
        constants: reported.map(constants_in_units).unwrap_or_default(),
        methods: method_views(report),
        method_constants: PageTable::new("methods", "", &methods_table(identification.tables, identification.method)),
        laws: fit.map(|fit| PageTable::new("laws", "", &laws_table(fit))),
        agreement: fit.map(agreement_text).unwrap_or_default(),
        preferred: fit.map(preferred_text).unwrap_or_default(),
        loads_footnote: LOADS_FOOTNOTE,
        budget: reported.and_then(|table| {
            let (budget, fit) = (table.budget.as_ref()?, table.fit.as_ref()?);
            let table = budget_table(budget, fit.thrust_constant_n_s2.value);
            Some(PageTable::new("budget", "", &table).with_sum())
        }),
        more_tables: (1..)
            .zip(report.more_tables)
            .map(|(number, titled)| PageTable::new(&format!("table-{number}"), &titled.title, &titled.table))
            .collect(),
        log_tables: (1..)
            .zip(flight_log_tables(inputs, &names))
            .map(|(number, titled)| PageTable::new(&format!("logs-{number}"), &titled.title, &titled.table))
            .collect(),
        files: files_of(identification)?,
        sound: has_sound.then_some(share),
        trials,
        inputs: inputs.iter().map(InputView::new).collect(),
        settings: serde_json::to_string_pretty(identification.experiment.settings)?,
        command: report.command,
        report,
    };
    Ok(page.render()?)
}

fn method_views(report: &Report<'_>) -> Vec<MethodView> {
    let Identification { tables, method: reported, .. } = *report.identification;
    tables
        .iter()
        .map(|table| {
            let compared = report.compared.iter().find(|(method, _)| *method == table.method);
            let shown = compared.map_or_else(|| thrust_table(table), |(_, compared)| compared.clone());
            MethodView::new(table, &shown, method_colour(table.method), reported)
        })
        .collect()
}

/// The recordings, and how their sound shares the page.
fn trial_views<'a>(
    report: &Report<'a>,
    names: &[String],
    folded: &[FoldedWarning],
) -> (Vec<TrialView<'a>>, SoundShare) {
    let inputs = report.identification.inputs;
    let clips: Vec<&SoundClip> = report.trials.iter().filter_map(|trial| trial.sound).collect();
    let share = sound_share(&clips, SOUND_BYTES_MAX);
    let view = |((index, input), (name, trial)): (_, (&String, &TrialReport<'a>))| {
        TrialView::new(index, input, name, trial, share, folded)
    };
    (inputs.iter().enumerate().zip(names.iter().zip(report.trials)).map(view).collect(), share)
}

/// The words of each load by each method, by the keys of the points in the figure of the fit.
fn load_words(identification: &Identification<'_>) -> Result<String, PageError> {
    let mut words = Map::new();
    for table in identification.tables {
        for (index, load) in table.loads.iter().enumerate() {
            let key = format!("{}-{index}", table.method.name());
            words.insert(key, Value::String(load_in_words(table, load)));
        }
    }
    // inside of a script element no name may end it
    Ok(serde_json::to_string(&words)?.replace('<', "\\u003c"))
}

/// The tables with all digits.
fn files_of(identification: &Identification<'_>) -> Result<Vec<PageFile>, PageError> {
    [loads_data(identification.tables), samples_data(identification.tables)]
        .into_iter()
        .map(|table| {
            let csv = table.csv().map_err(|error| PageError::Table(error.to_string()))?;
            let uri = format!("data:text/csv;base64,{}", STANDARD.encode(csv));
            Ok(PageFile { name: format!("{}.csv", table.name), uri })
        })
        .collect()
}

/// The tables of the page for documents, beginning with the two of the paper.
pub fn experiment_tables(identification: &Identification<'_>) -> Vec<TitledTable> {
    let number = |method: Method| match method {
        Method::MaximumTrace => "Table 1: ",
        Method::Gaussian => "Table 2: ",
        _ => "",
    };
    let mut tables: Vec<TitledTable> = identification
        .tables
        .iter()
        .map(|table| TitledTable::new(format!("{}{}", number(table.method), table.title()), thrust_table(table)))
        .collect();
    tables.sort_by_key(|titled| !titled.title.starts_with("Table"));
    tables.push(TitledTable::new("Thrust constant", methods_table(identification.tables, identification.method)));
    if let Some(table) = identification.reported()
        && let (Some(fit), Some(budget)) = (&table.fit, &table.budget)
    {
        tables.push(TitledTable::new("Laws", laws_table(fit)));
        tables.push(TitledTable::new("Uncertainty budget", budget_table(budget, fit.thrust_constant_n_s2.value)));
    }
    tables.extend(flight_log_tables(identification.inputs, &names_of(identification.inputs)));
    tables
}
