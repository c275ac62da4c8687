//! The report as it grows: headings, paragraphs and tables in Markdown.

/// As the other documents.
const LINE_LENGTH: usize = 150;

/// Markdown, one block after the other.
#[derive(Default)]
pub(crate) struct Document {
    text: String,
}

impl Document {
    pub(crate) fn heading(&mut self, text: &str) {
        self.block(&format!("## {text}"));
    }

    /// Running text, in lines of at most [`LINE_LENGTH`].
    pub(crate) fn paragraph(&mut self, text: &str) {
        let mut lines = vec![String::new()];
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if line.is_empty() => line.push_str(word),
                Some(line) if line.chars().count() + 1 + word.chars().count() <= LINE_LENGTH => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        self.block(&lines.join("\n"));
    }

    /// One sentence for each different text, after the names of all that it is said of.
    pub(crate) fn notes(&mut self, notes: Vec<(String, String)>) {
        let mut sentences: Vec<(Vec<String>, String)> = Vec::new();
        for (name, text) in notes {
            match sentences.iter_mut().find(|(_, said)| *said == text) {
                Some((names, _)) => names.push(name),
                None => sentences.push((vec![name], text)),
            }
        }
        for (names, text) in sentences {
            self.paragraph(&format!("{}: {text}.", names.join("; ")));
        }
    }

    /// A table; cells are text.
    pub(crate) fn table<H: AsRef<str>>(&mut self, heads: &[H], rows: &[Vec<String>]) {
        let line = |cells: Vec<&str>| format!("| {} |\n", cells.join(" | "));
        let mut table = line(heads.iter().map(AsRef::as_ref).collect());
        table += &format!("|{}\n", "---|".repeat(heads.len()));
        for row in rows {
            table += &line(row.iter().map(String::as_str).collect());
        }
        self.block(table.trim_end());
    }

    /// Markdown as it is.
    pub(crate) fn markdown(&mut self, text: &str) {
        self.block(text.trim());
    }

    pub(crate) fn into_text(self) -> String {
        self.text
    }

    fn block(&mut self, text: &str) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.text.push_str(text);
        self.text.push('\n');
    }
}

/// A number with three digits that mean something, or a dash.
pub(crate) fn three_digits(value: Option<f64>) -> String {
    match value {
        Some(value) if value == 0.0 || !value.is_finite() => format!("{value}"),
        Some(value) => format!("{value:.*}", (2 - value.abs().log10().floor() as i32).max(0) as usize),
        None => "–".to_owned(),
    }
}

/// A count as a share of a whole, in percent.
pub(crate) fn percent(count: usize, of: usize) -> String {
    if of == 0 { "–".to_owned() } else { format!("{:.0}", 100.0 * count as f64 / of as f64) }
}

/// A counted share with its own standard uncertainty, in percent: Wilson's half width, which is not 0 where all or none
/// were counted.
pub(crate) fn percent_with_uncertainty(count: usize, of: usize) -> String {
    if of == 0 {
        return "–".to_owned();
    }
    let (share, n) = (count as f64 / of as f64, of as f64);
    let std = (share * (1.0 - share) / n + 1.0 / (4.0 * n * n)).sqrt() / (1.0 + 1.0 / n);
    format!("{:.1} ± {:.1}", 100.0 * share, 100.0 * std)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        let shown = |value: f64| three_digits(Some(value));
        assert_eq!([1.034, 0.051_26, 123.4, 12.34].map(shown), ["1.03", "0.0513", "123", "12.3"]);
        assert_eq!((shown(0.0), three_digits(None)), ("0".to_owned(), "–".to_owned()));
    }

    #[test]
    fn a_share_of_all_is_not_certain() {
        assert_eq!(percent_with_uncertainty(190, 200), "95.0 ± 1.6");
        assert_eq!(percent_with_uncertainty(200, 200), "100.0 ± 0.2");
        assert_eq!((percent_with_uncertainty(0, 0), percent(1, 8)), ("–".to_owned(), "12".to_owned()));
    }

    #[test]
    fn blocks_are_parted_by_a_line() {
        let mut document = Document::default();
        document.heading("A");
        document.table(&["x", "y"], &[vec!["1".to_owned(), "2".to_owned()]]);
        assert_eq!(document.into_text(), "## A\n\n| x | y |\n|---|---|\n| 1 | 2 |\n");
    }

    #[test]
    fn paragraphs_are_wrapped_and_equal_notes_said_once() {
        let mut document = Document::default();
        document.paragraph(&"äöüß ".repeat(60));
        let lengths: Vec<usize> = document.into_text().lines().map(|line| line.chars().count()).collect();
        assert_eq!(lengths, [149, 149]);
        let mut document = Document::default();
        let note = |name: &str, text: &str| (name.to_owned(), text.to_owned());
        document.notes(vec![note("a", "no"), note("b", "yes"), note("c", "no")]);
        assert_eq!(document.into_text(), "a; c: no.\n\nb: yes.\n");
    }
}
