//! Changes between two archives as text for people and as JSON.

use super::tail::covering_stds;
use super::{Change, Drift, FALSE_ALARM_CHANCE, Unused};
use hovertone_report::{Column, TextTable, VERSION, counted, fixed, printable, signed, table_text};
use serde_json::json;
use std::collections::BTreeSet;

/// Most recordings that the text names; the JSON has all.
const RECORDINGS_MAX: usize = 20;

/// Most files that a line names; the JSON has all.
const FILES_MAX: usize = 5;

/// What stands in place of a number that is not told.
const NOT_TOLD: &str = "–";

/// All changes as one JSON object, without a line feed.
pub fn drift_json(drift: &Drift) -> String {
    let mut all = json!(drift);
    all["false_alarm_chance"] = json!(FALSE_ALARM_CHANCE);
    all["version"] = json!(VERSION);
    all.to_string()
}

/// The changes of the rotors, and the recordings that have changed.
pub fn drift_text(drift: &Drift, width: Option<usize>) -> String {
    let mut table = TextTable::new(vec![
        Column::words(title_of_rotors(drift)),
        Column::numbers("recordings", ""),
        Column::numbers("change", "%"),
        Column::numbers("± (95 %)", "%"),
        Column::numbers("p-value", ""),
        Column::words("verdict"),
    ]);
    for row in &drift.rotors {
        let count = match row.earlier_count == row.later_count {
            true => row.earlier_count.to_string(),
            false => format!("{}, {}", row.earlier_count, row.later_count),
        };
        let mut cells = vec![rotor_name(row.rotor), count];
        cells.extend(cells_of(&row.change));
        table.push(cells);
    }
    let how = if drift.is_paired {
        "recordings of the same name, one by one"
    } else {
        "all recordings of the earlier archive with all of the later one, because no name is in both"
    };
    format!(
        "compared: {how}\n{}{}{}{}{}{}",
        table_text(&table, width),
        not_single_text(drift),
        p_value_text(),
        not_known_text(drift),
        unused_text(drift),
        recordings_text(drift, width)
    )
}

/// Which recordings are not compared, and why: a line for each archive and reason.
fn unused_text(drift: &Drift) -> String {
    let line = |unused: &[Unused], archive: &str, has_speed: bool, why: &str| {
        let files: Vec<String> =
            unused.iter().filter(|it| it.has_speed == has_speed).map(|it| printable(&it.file)).collect();
        let more = match files.len().saturating_sub(FILES_MAX) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let named = files[..files.len().min(FILES_MAX)].join(", ");
        if files.is_empty() {
            String::new()
        } else {
            format!("not compared, {archive} archive: {named}{more} ({why})\n")
        }
    };
    let of_archive = |unused: &[Unused], archive: &str, other: &str| {
        line(unused, archive, false, "no speed was heard")
            + &line(unused, archive, true, &format!("the {other} archive has no speed of a recording with this name"))
    };
    of_archive(&drift.earlier_unused, "earlier", "later") + &of_archive(&drift.later_unused, "later", "earlier")
}

/// Whether rotors are compared one by one, and not their mean alone.
fn has_single_rotors(drift: &Drift) -> bool {
    drift.rotors.iter().any(|row| row.rotor > 0)
}

/// Why the mean of all rotors stands alone.
fn not_single_text(drift: &Drift) -> &'static str {
    match has_single_rotors(drift) {
        true => "",
        false => {
            "only the mean of all rotors is compared, because the two archives have no separated rotors to compare one by one: either \
            `hovertone batch` ran with --mean-only, or it could not separate the rotors, or one rotor ran alone (then the mean is its speed)\n"
        }
    }
}

fn title_of_rotors(drift: &Drift) -> &'static str {
    match (has_single_rotors(drift), drift.is_labelled) {
        (false, _) => "rotor",
        (true, true) => "rotor, by label",
        (true, false) => "rotor, 1 is the fastest",
    }
}

/// What the verdict about a rotor that is not known means.
fn not_known_text(drift: &Drift) -> &'static str {
    match drift.rotors.iter().all(|row| row.change.is_rotor_known) {
        true => "",
        false => {
            "\"cannot tell which rotor\": rotors are numbered by their speeds, and these numbers may have changed. The sound does not show \
            which rotor is which, so only the mean of all rotors is tested\n"
        }
    }
}

fn p_value_text() -> String {
    format!(
        "p-value: the chance of a difference this large or larger by accident, if no speed has changed. The more speeds are compared, \
         the more often chance alone makes a large difference: the p-values are corrected for this (method of Holm, 1979). Below {FALSE_ALARM_CHANCE}, the verdict is \"has changed\"\n"
    )
}

fn recordings_text(drift: &Drift, width: Option<usize>) -> String {
    let mut changed: Vec<_> = drift.recordings.iter().filter(|row| row.change.has_changed).collect();
    if !drift.is_paired {
        return String::new();
    }
    let not_known = not_known_recordings_text(drift);
    if changed.is_empty() {
        let of_known = if not_known.is_empty() { "" } else { ", if its rotors are known" };
        return format!("no single recording shows a clear change of speed{of_known}\n{not_known}");
    }
    changed.sort_by(|one, other| other.change.change_share.abs().total_cmp(&one.change.change_share.abs()));
    let mut table = TextTable::new(vec![
        Column::words("recording"),
        Column::words(title_of_rotors(drift)),
        Column::numbers("change", "%"),
        Column::numbers("± (95 %)", "%"),
        Column::numbers("p-value", ""),
        Column::words("verdict"),
    ]);
    for row in changed.iter().take(RECORDINGS_MAX) {
        let mut cells = vec![printable(&row.file), rotor_name(row.rotor)];
        cells.extend(cells_of(&row.change));
        table.push(cells);
    }
    let disagree = match drift.rotors.iter().any(|row| row.change.is_rotor_known && !row.change.has_changed) {
        true => "single recordings show changes that the upper table does not show: use the list too\n",
        false => "",
    };
    let more = match changed.len().saturating_sub(RECORDINGS_MAX) {
        0 => String::new(),
        more => format!("and {more} more changes; --json lists all\n"),
    };
    format!(
        "{disagree}\nrecordings whose speed has changed, largest change first\n{}{more}{not_known}",
        table_text(&table, width)
    )
}

fn not_known_recordings_text(drift: &Drift) -> String {
    let rows = drift.recordings.iter().filter(|row| !row.change.is_rotor_known);
    let files: BTreeSet<&str> = rows.map(|row| row.file.as_str()).collect();
    match files.len() {
        0 => String::new(),
        count => format!("in {}, the sound does not show which rotor is which\n", counted(count, "recording")),
    }
}

fn rotor_name(rotor: usize) -> String {
    if rotor == 0 { "mean of all".to_owned() } else { format!("rotor {rotor}") }
}

fn cells_of(change: &Change) -> Vec<String> {
    if !change.is_rotor_known {
        return [NOT_TOLD, NOT_TOLD, NOT_TOLD, "cannot tell which rotor"].map(str::to_owned).to_vec();
    }
    let expanded = 100.0 * covering_stds(change.degrees_of_freedom) * change.std_uncertainty_share;
    // two digits of the ±, of which the last has a meaning
    let decimals = if expanded > 0.0 { (1.0 - expanded.log10().floor()).clamp(0.0, 4.0) as usize } else { 4 };
    let chance = match change.p_value_holm {
        small if small < 1e-4 => "< 0.0001".to_owned(),
        chance => format!("{chance:.4}"),
    };
    vec![
        signed(100.0 * change.change_share, decimals),
        fixed(expanded, decimals),
        chance,
        if change.has_changed { "has changed" } else { "no change seen" }.to_owned(),
    ]
}
