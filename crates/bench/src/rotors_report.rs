//! `docs/rotors.md`, which two benches write: one its first part, the other its section on labels.

/// Where it stands.
pub(crate) const REPORT: &str = "docs/rotors.md";

/// The first line of the section on labels.
pub(crate) const LABELS_TITLE: &str = "\n## Which rotor is which\n";

/// The section on labels of a report; empty where there is none.
pub(crate) fn labels_section(report: &str) -> &str {
    report.find(LABELS_TITLE).map_or("", |at| &report[at..])
}
