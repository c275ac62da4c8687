//! One rotor with exact truth: how near each method comes to the Cramér-Rao bound, and whether its ± holds.

use super::condition::{Condition, METHODS, MethodScore, Scored, Tones, scored};
use super::sound::Colour;
use crate::document::{Document, percent, percent_with_uncertainty, three_digits};
use hovertone::speed::Method;

const SNRS_DB: [f64; 5] = [-20.0, -10.0, 0.0, 10.0, 20.0];
/// Conditions of the table of coverage are numbered from here, so that they have draws of their own.
const COVERAGE_FROM: usize = 1000;

/// Of the draws for a steady rotor, a wandering one has this part.
const WANDERING_PART: usize = 4;

/// The steady rotor at every tone set, colour and ratio.
pub(super) fn add_bounds(document: &mut Document, draws: usize) -> Result<(), String> {
    document.heading("One steady rotor against the Cramér-Rao bound");
    document.paragraph(&format!(
        "5 s at 48 kHz, speed drawn evenly from 50 to 70 rev/s, phases and noise drawn, {draws} draws for each line. SNR: \
         power of all tones over power of the noise between 0 and 24 kHz. White noise, or noise that falls by 6 dB per \
         octave above 20 Hz (the bound then counts each line against the noise around it). Bound: smallest standard \
         deviation possible, as a share of the speed in 10⁻⁶. Error: root mean square of the answers within 20 bounds; the \
         others are outliers (\"out\"), counted as share of the answers, and where most are, the median of all is given. \
         Covered: share of answers with |error| ≤ 2 u, u as stated, ± its \
         binomial standard uncertainty."
    ));
    let mut number = 0;
    for tones in Tones::ALL {
        document.paragraph(&format!("**{}**: {}.", capitalised(tones.name()), tones.description()));
        let mut rows = Vec::new();
        for colour in [Colour::White, Colour::Falling] {
            for snr_db in SNRS_DB {
                let colour_name = name_of(colour);
                eprintln!("{}, {colour_name}, {snr_db} dB", tones.name());
                let scored = scored(Condition { tones, colour, snr_db, wanders: false }, number, draws, &METHODS)?;
                rows.push(row_of_bounds(colour_name, &scored));
                number += 1;
            }
        }
        let mut heads: Vec<String> = ["noise", "SNR dB", "bound", "answered %"].map(str::to_owned).into();
        for method in METHODS {
            heads.extend(["error / bound", "covered %"].map(|column| format!("{}: {column}", shown(method))));
        }
        document.table(&heads, &rows);
    }
    Ok(())
}

/// Coverage with more draws, steady and wandering.
pub(super) fn add_coverage(document: &mut Document, draws: usize) -> Result<(), String> {
    document.heading("Is the stated ± true?");
    document.paragraph(&format!(
        "Share of answers with |error| ≤ 2 u (95.4 % where errors are normal and u is their standard deviation), {draws} \
         draws for each line ({} where it wanders), by the harmonic likelihood, otherwise as above. Wandering: the speed of the rotor is a smooth random process, standard \
         deviation 0.4 %, correlation time 0.8 s, and the truth is its exact mean over the stretches that were used. \
         u / scatter: median u over the standard deviation that the median |error| means; above 1, u is wider than it need be.",
        draws.div_ceil(WANDERING_PART)
    ));
    let mut rows = Vec::new();
    for (number, condition) in (COVERAGE_FROM..).zip(coverage_conditions()) {
        let turning = if condition.wanders { "wandering" } else { "steady" };
        let colour_name = name_of(condition.colour);
        eprintln!("coverage: {turning}, {}, {colour_name}, {} dB", condition.tones.name(), condition.snr_db);
        let draws = if condition.wanders { draws.div_ceil(WANDERING_PART) } else { draws };
        let scored = scored(condition, number, draws, &[Method::Harmonic])?;
        let snr = format!("{:+.0}", condition.snr_db);
        let mut row: Vec<String> = [turning, condition.tones.name(), colour_name, &snr].map(str::to_owned).into();
        row.push(answered(&scored));
        for score in &scored.methods {
            row.push(percent_with_uncertainty(score.covered, score.answered));
            row.push(three_digits(score.stated_over_scatter));
        }
        rows.push(row);
    }
    document.table(&["rotor", "tones", "noise", "SNR dB", "answered %", "covered %", "u / scatter"], &rows);
    Ok(())
}

fn row_of_bounds(colour_name: &str, scored: &Scored) -> Vec<String> {
    let mut row = vec![
        colour_name.to_owned(),
        format!("{:+.0}", scored.condition.snr_db),
        three_digits(Some(1e6 * scored.bound_share)),
        answered(scored),
    ];
    for score in &scored.methods {
        row.extend([error_cell(score), percent_with_uncertainty(score.covered, score.answered)]);
    }
    row
}

/// Root mean square of what is no outlier, and the share of outliers; the median where most are outliers.
fn error_cell(score: &MethodScore) -> String {
    let outliers = percent(score.outliers, score.answered);
    if score.answered == 0 {
        "–".to_owned()
    } else if score.outliers == 0 {
        three_digits(score.rmse_bounds)
    } else if 2 * score.outliers <= score.answered {
        format!("{}, {outliers} % out", three_digits(score.rmse_bounds))
    } else {
        format!("median {}, {outliers} % out", three_digits(score.median_bounds))
    }
}

/// Both kinds of rotor, each series of lines and both colours, at every ratio; the one that wanders from where it is heard in half a
/// second.
fn coverage_conditions() -> Vec<Condition> {
    let mut conditions = Vec::new();
    for (wanders, snrs_db) in [(false, &SNRS_DB[..]), (true, &SNRS_DB[1..])] {
        for &snr_db in snrs_db {
            let at = |tones, colour| Condition { tones, colour, snr_db, wanders };
            conditions.extend(Tones::ALL.map(|tones| at(tones, Colour::White)));
            conditions.push(at(Tones::Both, Colour::Falling));
        }
    }
    conditions
}

fn name_of(colour: Colour) -> &'static str {
    match colour {
        Colour::White => "white",
        Colour::Falling => "−6 dB/octave",
    }
}

/// Share of the draws that were answered, once where it is the same for all methods.
fn answered(scored: &Scored) -> String {
    let mut shares: Vec<String> = scored.methods.iter().map(|score| percent(score.answered, score.draws)).collect();
    shares.dedup();
    shares.join(" / ")
}

/// A method's name as people write it.
pub(super) fn shown(method: Method) -> String {
    method.name().replace('_', " ")
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
