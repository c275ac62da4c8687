//! Tables for documents: Markdown and LaTeX.

use crate::text_table::{Row, TextTable};

/// A table with a title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TitledTable {
    /// Title.
    pub title: String,
    /// The table.
    pub table: TextTable,
}

impl TitledTable {
    /// A table under a title.
    pub fn new(title: impl Into<String>, table: TextTable) -> Self {
        Self { title: title.into(), table }
    }
}

/// All tables in Markdown (GitHub's dialect).
pub fn tables_markdown(tables: &[TitledTable]) -> String {
    let sections: Vec<String> = tables
        .iter()
        .map(|titled| format!("### {}\n\n{}", markdown(&titled.title), table_markdown(&titled.table)))
        .collect();
    sections.join("\n")
}

fn table_markdown(table: &TextTable) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let head = |column: &crate::text_table::Column| {
        let unit = if column.unit().is_empty() { String::new() } else { format!(" ({})", markdown(column.unit())) };
        format!("{}{unit}", markdown(column.title()))
    };
    let mut text = line(table.columns().iter().map(head).collect());
    let rule = |column: &crate::text_table::Column| if column.is_number() { "---:" } else { ":---" }.to_owned();
    text += &line(table.columns().iter().map(rule).collect());
    for row in table.rows() {
        text += &line(cells_of(row, table.columns().len()).iter().map(|cell| markdown(cell)).collect());
    }
    text
}

/// One cell for each column; text across all of them stands in the second.
fn cells_of(row: &Row, columns: usize) -> Vec<String> {
    let mut cells = match row {
        Row::Cells(cells) => cells.clone(),
        Row::Words(first, words) => vec![first.clone(), words.clone()],
    };
    cells.resize(columns, String::new());
    cells
}

/// Text with all special characters of Markdown and HTML escaped.
fn markdown(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '~' => escaped.extend(['\\', letter]),
            letter if letter.is_control() => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// All tables in LaTeX: `table` environments with `booktabs` rules, which the preamble must load.
pub fn tables_latex(tables: &[TitledTable]) -> String {
    let head = "% needs \\usepackage{booktabs}; pdfLaTeX, LuaLaTeX and XeLaTeX alike\n";
    tables.iter().fold(head.to_owned(), |text, titled| text + "\n" + &table_latex(titled))
}

fn table_latex(TitledTable { title, table }: &TitledTable) -> String {
    let line = |cells: Vec<String>| format!("    {} \\\\\n", cells.join(" & "));
    let sides: String = table.columns().iter().map(|column| if column.is_number() { 'r' } else { 'l' }).collect();
    let mut text = format!(
        "\\begin{{table}}\n  \\centering\n  \\caption{{{}}}\n  \\begin{{tabular}}{{{sides}}}\n    \\toprule\n",
        latex(title)
    );
    text += &line(table.columns().iter().map(|column| latex(column.title())).collect());
    if table.has_units() {
        text += &line(table.columns().iter().map(|column| latex(column.unit())).collect());
    }
    text += "    \\midrule\n";
    for row in table.rows() {
        text += &match row {
            Row::Cells(cells) => line(cells.iter().map(|cell| latex(cell)).collect()),
            Row::Words(first, words) => {
                let across = table.columns().len().saturating_sub(1).max(1);
                line(vec![latex(first), format!("\\multicolumn{{{across}}}{{l}}{{{}}}", latex(words))])
            }
        };
    }
    text + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n"
}

/// Text with all special characters of LaTeX escaped.
fn latex(text: &str) -> String {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        // "1e-5 N s²" is a power of ten
        let power = word.strip_prefix("1e").and_then(|exponent| exponent.parse::<i32>().ok());
        words.push(power.map_or_else(|| word.chars().map(latex_letter).collect(), |power| format!("$10^{{{power}}}$")));
    }
    words.join(" ")
}

fn latex_letter(letter: char) -> String {
    let special = match letter {
        '\\' => "\\textbackslash{}",
        '~' => "\\textasciitilde{}",
        '^' => "\\textasciicircum{}",
        '<' => "$<$",
        '>' => "$>$",
        '±' => "$\\pm$",
        '−' => "$-$",
        '–' => "--",
        '²' => "$^2$",
        '₀' => "$_0$",
        'ω' => "$\\omega$",
        'ρ' => "$\\rho$",
        'χ' => "$\\chi$",
        'Σ' => "$\\Sigma$",
        '·' => "$\\cdot$",
        '×' => "$\\times$",
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => return format!("\\{letter}"),
        letter if letter.is_control() => " ",
        letter => return letter.to_string(),
    };
    special.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text_table::Column;

    fn table() -> Vec<TitledTable> {
        let mut table = TextTable::new(vec![Column::words("load"), Column::numbers("C_f", "1e-5 N s²")]);
        table.push(vec!["<script>|a_b".to_owned(), "2.83 ± 0.01".to_owned()]);
        table.push_words("100 % & more".to_owned(), "no rotor tone".to_owned());
        vec![TitledTable::new("Table 1", table)]
    }

    #[test]
    fn markdown_has_one_cell_for_each_column_and_no_markup_of_others() {
        let expected = "\
### Table 1

| load | C\\_f (1e-5 N s²) |
| :--- | ---: |
| &lt;script&gt;\\|a\\_b | 2.83 ± 0.01 |
| 100 % &amp; more | no rotor tone |
";
        assert_eq!(tables_markdown(&table()), expected);
    }

    #[test]
    fn latex_is_escaped_and_has_powers_of_ten() {
        let text = tables_latex(&table());
        assert!(text.contains("load & C\\_f \\\\"), "{text}");
        assert!(text.contains(" & $10^{-5}$ N s$^2$ \\\\"), "{text}");
        assert!(text.contains("$<$script$>$|a\\_b & 2.83 $\\pm$ 0.01 \\\\"), "{text}");
        assert!(text.contains("100 \\% \\& more & \\multicolumn{1}{l}{no rotor tone} \\\\"), "{text}");
    }
}
