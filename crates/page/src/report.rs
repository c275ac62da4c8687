//! The page, from its input and the template.

use crate::input::{Report, TrialReport};
use crate::seal::policy;
use crate::sound::{SoundClip, sound_share};
use crate::view::{Answer, InputView, MethodView, PageTable, TrialView, Words};
use askama::Template;
use hovertone_analysis::Method;
use hovertone_figures::{Figure, level_colours, method_colour};
use hovertone_report::{
    Identification, LOADS_FOOTNOTE, TitledTable, VERSION, agreement_text, budget_table, counted, laws_table,
    methods_table, preferred_text, thrust_table,
};

const STYLE: &str = include_str!("../templates/report.css");
const SCRIPT: &str = include_str!("../templates/report.js");
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
}

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    policy: String,
    style: &'static str,
    script: &'static str,
    level_colours: String,
    version: &'static str,
    words: Words<'a>,
    answer: Option<Answer>,
    methods: Vec<MethodView>,
    method_constants: PageTable,
    laws: Option<PageTable>,
    agreement: String,
    preferred: String,
    loads_footnote: &'static str,
    budget: Option<PageTable>,
    more_tables: Vec<PageTable>,
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

    /// Number of recordings without cuts.
    fn used_whole(&self) -> usize {
        self.trials.iter().filter(|trial| trial.reason.is_none() && trial.cuts.is_none()).count()
    }

    /// "15 recordings": the same in words.
    fn used_whole_counted(&self) -> String {
        counted(self.used_whole(), "recording")
    }

    /// The tables of one method.
    fn method(&self, name: &str) -> Option<&MethodView> {
        self.methods.iter().find(|method| method.name == name)
    }

    /// The methods that are not from the paper.
    fn our_methods(&self) -> impl Iterator<Item = &MethodView> {
        self.methods.iter().filter(|method| !method.is_papers)
    }
}

/// The page. It loads nothing: style, script, pictures and sound are inside. Equal reports give equal bytes.
///
/// # Errors
/// None is known, since the template is compiled in and all types can be serialised.
pub fn report_html(report: &Report<'_>) -> Result<String, PageError> {
    let identification = report.identification;
    let reported = identification.reported();
    let clips: Vec<&SoundClip> = report.trials.iter().filter_map(|trial| trial.sound).collect();
    let (rate_hz, count) = rate_and_count(&clips, SOUND_BYTES_MAX);
    let mut sounding = 0;
    let trials: Vec<TrialView<'_>> = identification
        .inputs
        .iter()
        .zip(report.trials)
        .map(|(input, trial)| {
            sounding += usize::from(trial.sound.is_some());
            let sound = trial.sound.filter(|_| sounding <= count);
            TrialView::new(input, &TrialReport { sound, ..*trial }, rate_hz)
        })
        .collect();
    let page = Page {
        policy: policy(STYLE, SCRIPT),
        style: STYLE,
        script: SCRIPT,
        level_colours: serde_json::to_string(&level_colours().to_vec())?,
        version: VERSION,
        words: Words::new(identification),
        answer: reported.and_then(|table| Answer::new(table, identification.inputs)),
        methods: identification
            .tables
            .iter()
            .map(|table| {
                let compared = report.compared.iter().find(|(method, _)| *method == table.method);
                let shown = compared.map_or_else(|| thrust_table(table), |(_, compared)| compared.clone());
                MethodView::new(table, &shown, method_colour(table.method), identification.method)
            })
            .collect(),
        method_constants: PageTable::new("", &methods_table(identification.tables, identification.method)),
        laws: reported.and_then(|table| table.fit.as_ref()).map(|fit| PageTable::new("", &laws_table(fit))),
        agreement: reported.and_then(|table| table.fit.as_ref()).map(agreement_text).unwrap_or_default(),
        preferred: reported.and_then(|table| table.fit.as_ref()).map(preferred_text).unwrap_or_default(),
        loads_footnote: LOADS_FOOTNOTE,
        budget: reported.and_then(|table| {
            let (budget, fit) = (table.budget.as_ref()?, table.fit.as_ref()?);
            Some(PageTable::new("", &budget_table(budget, fit.thrust_constant_n_s2.value)))
        }),
        more_tables: report.more_tables.iter().map(|titled| PageTable::new(&titled.title, &titled.table)).collect(),
        mute_count: clips.len() - count,
        sound_rate_hz: trials.iter().any(|trial| trial.sound.is_some()).then_some(rate_hz),
        trials,
        inputs: identification.inputs.iter().map(InputView::new).collect(),
        settings: serde_json::to_string_pretty(identification.experiment.settings)?,
        command: report.command,
        report,
    };
    Ok(page.render()?)
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
    tables
}
