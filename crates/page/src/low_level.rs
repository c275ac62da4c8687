//! The page of the low-level model.

use crate::report::{PageError, SCRIPT, STYLE};
use crate::seal::policy;
use crate::view::PageTable;
use askama::Template;
use hovertone_figures::Figure;
use hovertone_report::{TitledTable, VERSION};

/// Input of the page.
#[derive(Clone, Copy, Debug)]
pub struct LowLevelPage<'a> {
    /// Title.
    pub title: &'a str,
    /// Lines under the title.
    pub lead: &'a [String],
    /// Tables, each with its title.
    pub tables: &'a [TitledTable],
    /// Figures, under the tables.
    pub figures: &'a [Figure],
    /// Remarks, such as what the flight does not tell.
    pub notes: &'a [String],
    /// The command that repeats the run.
    pub command: &'a str,
}

#[derive(Template)]
#[template(path = "low_level.html")]
struct Page<'a> {
    policy: String,
    style: &'static str,
    version: &'static str,
    tables: Vec<PageTable>,
    page: &'a LowLevelPage<'a>,
}

/// The page. It loads nothing: style and pictures are inside.
///
/// # Errors
/// None is known, since the template is compiled in.
pub fn low_level_html(page: &LowLevelPage<'_>) -> Result<String, PageError> {
    let table = |(number, titled): (usize, &TitledTable)| {
        PageTable::new(&format!("table-{number}"), &titled.title, &titled.table)
    };
    let tables = (1..).zip(page.tables).map(table).collect();
    Ok(Page { policy: policy(STYLE, SCRIPT), style: STYLE, version: VERSION, tables, page }.render()?)
}
