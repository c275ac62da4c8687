//! What a header says about an uncertainty: that it is one, and its coverage (k = 2, 95 %, ±, 3σ).

use hovertone_vehicle::COVERAGE_FACTOR;
use std::ops::RangeInclusive;

/// Words of uncertainties.
const UNCERTAINTY: [&str; 13] =
    ["std", "stddev", "stdev", "sd", "sigma", "σ", "uncertainty", "unc", "u", "se", "sem", "stderr", "expanded"];
/// Words that say that an uncertainty is a standard uncertainty, or a multiple of it.
const SIGMA: [&str; 9] = ["std", "stddev", "stdev", "sd", "sigma", "σ", "se", "sem", "stderr"];
/// What follows "standard" where it means a standard uncertainty.
const STANDARD: [&str; 3] = ["error", "deviation", "uncertainty"];
/// Words beside a coverage that has no percent sign, as in U95.
const COVERED: [&str; 6] = ["u", "unc", "uncertainty", "expanded", "confidence", "coverage"];
/// Coverage factors that an uncertainty may have.
const COVERAGE_FACTORS: RangeInclusive<f64> = 0.1..=10.0;
/// Numbers beside one of the words `COVERED` that are a coverage in percent.
const COVERAGES: RangeInclusive<f64> = 50.0..=99.99;

/// What a header says about an uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coverage {
    /// The header without a coverage and without the sign ±.
    pub(super) rest: String,
    /// Whether the header names an uncertainty.
    pub(super) is_uncertainty: bool,
    /// Whether it does so by more than the letter u, which is also a voltage.
    pub(super) is_certainly: bool,
    /// Coverage factor: 1 for a standard uncertainty; or the part of the header whose factor is not known.
    pub(super) factor: Result<f64, String>,
    /// The parts of the header that make it another factor than 1.
    pub(super) parts: Vec<String>,
    /// Whether the header still names an uncertainty without these parts.
    pub(super) is_named_without: bool,
}

/// The coverage that a header states.
pub(super) fn coverage_of(header: &str) -> Coverage {
    let tokens = tokens_of(header);
    let statements = statements_in(&tokens);
    let mut rest = header.to_owned();
    for statement in statements.iter().rev() {
        rest.replace_range(statement.from..statement.to, " ");
    }
    let words: Vec<&str> = rest.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let lower: Vec<String> = words.iter().map(|word| word.to_lowercase()).collect();
    let has = |any: &[&str]| lower.iter().any(|word| any.contains(&word.as_str()));
    let is_standard = has(&["standard"]) && has(&STANDARD);
    let is_marked = statements.iter().any(|statement| statement.says.marks());
    let is_uncertainty = is_marked || is_standard || has(&UNCERTAINTY);
    let is_letter = |word: &&str| *word == "U";
    let expanding = |word: &&&str| is_letter(word) || word.eq_ignore_ascii_case("expanded");
    let is_plus_minus = statements.iter().any(|statement| statement.says == Says::PlusMinus);
    let is_sigma = is_standard || has(&SIGMA);
    // "mean ± SD" are standard deviations
    let is_expanded = words.iter().any(|word| expanding(&word)) || is_plus_minus && !is_sigma;
    let text_of = |statement: &Statement| header[statement.from..statement.to].to_owned();
    let deciding = statements.iter().filter(|statement| statement.says.rank() > 0).max_by_key(|of| of.says.rank());
    let factor = match deciding {
        Some(of) => of.says.factor().filter(|k| COVERAGE_FACTORS.contains(k)).ok_or_else(|| text_of(of)),
        None => Ok(if is_expanded { COVERAGE_FACTOR } else { 1.0 }),
    };
    let of_statements = statements.iter().filter(|statement| statement.says.expands(is_sigma));
    let parts = words.iter().filter(expanding).map(|word| (*word).to_owned());
    Coverage {
        parts: parts.chain(of_statements.map(text_of)).collect(),
        is_named_without: is_standard || words.iter().any(|word| !expanding(&word) && is_word_of_uncertainty(word)),
        is_certainly: is_marked || is_standard || lower.iter().any(|word| word != "u" && is_word_of_uncertainty(word)),
        rest,
        is_uncertainty,
        factor,
    }
}

/// Whether a word names an uncertainty.
pub(super) fn is_word_of_uncertainty(word: &str) -> bool {
    UNCERTAINTY.contains(&word.to_lowercase().as_str())
}

/// A part of a header that says something about an uncertainty.
struct Statement {
    from: usize,
    to: usize,
    says: Says,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Says {
    /// "k=3"; without the sign = it may be something else, where no other word names an uncertainty.
    Factor { k: f64, has_sign: bool },
    /// "3" in "3 sigma".
    Sigmas(f64),
    /// "95 %".
    Coverage(f64),
    /// "±".
    PlusMinus,
    /// "±0.5 %": what the measured values are worth, in a header that may be theirs.
    Accuracy,
}

impl Says {
    /// Whether it says alone that the numbers are uncertainties.
    fn marks(&self) -> bool {
        matches!(self, Self::PlusMinus | Self::Sigmas(_) | Self::Factor { has_sign: true, .. })
    }

    /// Whether it makes the coverage factor another one than 1.
    fn expands(&self, is_sigma: bool) -> bool {
        match self {
            Self::PlusMinus => !is_sigma,
            Self::Accuracy => false,
            Self::Factor { k, .. } | Self::Sigmas(k) => (k - 1.0).abs() > 0.0,
            Self::Coverage(percent) => factor_of_coverage(*percent) != Some(1.0),
        }
    }

    /// Of several statements the highest one decides; those with 0 say no factor.
    fn rank(&self) -> u8 {
        match self {
            Self::Factor { .. } => 3,
            Self::Sigmas(_) => 2,
            Self::Coverage(_) => 1,
            Self::PlusMinus | Self::Accuracy => 0,
        }
    }

    fn factor(&self) -> Option<f64> {
        match self {
            Self::Factor { k, .. } | Self::Sigmas(k) => Some(*k),
            Self::Coverage(percent) => factor_of_coverage(*percent),
            Self::PlusMinus | Self::Accuracy => None,
        }
    }
}

/// The coverage factor of a coverage in percent, for the usual ones of a normal distribution.
fn factor_of_coverage(percent: f64) -> Option<f64> {
    match percent {
        68.0..=68.3 => Some(1.0),
        95.0..=95.5 => Some(COVERAGE_FACTOR),
        99.7..=99.8 => Some(3.0),
        _ => None,
    }
}

/// All statements, from left to right.
fn statements_in(tokens: &[Token]) -> Vec<Statement> {
    let is_uncertain = |token: &Token| match &token.is {
        Is::Word(word) => is_word_of_uncertainty(word),
        Is::PlusMinus => true,
        Is::Number(_) | Is::Percent | Is::Equals => false,
    };
    let is_uncertain = tokens.iter().any(is_uncertain);
    let mut statements: Vec<Statement> = Vec::new();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        let found = match &token.is {
            Is::Word(word) if word == "k" => factor_at(tokens, at, is_uncertain),
            Is::PlusMinus => Some(plus_minus_at(tokens, at)),
            Is::Number(number) => coverage_at(tokens, at, *number, is_uncertain),
            _ => None,
        };
        let (says, count) = found.unwrap_or((Says::Accuracy, 0));
        if let Some(last) = tokens[at..].iter().take(count).next_back() {
            statements.push(Statement { from: token.from, to: last.to, says });
        }
        at += count.max(1);
    }
    statements
}

/// "k=3", "k = 3", "k3": what it says, and its number of tokens.
fn factor_at(tokens: &[Token], at: usize, is_uncertain: bool) -> Option<(Says, usize)> {
    let has_sign = tokens.get(at + 1)?.is == Is::Equals;
    let count = if has_sign { 3 } else { 2 };
    let Is::Number(k) = tokens.get(at + count - 1)?.is else { return None };
    (has_sign || is_uncertain).then_some((Says::Factor { k, has_sign }, count))
}

/// "±" before the quantity, or "±0.5 %" beside it.
fn plus_minus_at(tokens: &[Token], at: usize) -> (Says, usize) {
    let next = |number: usize| tokens.get(at + number).map(|token| &token.is);
    let Some(Is::Number(number)) = next(1) else { return (Says::PlusMinus, 1) };
    match coverage_at(tokens, at + 1, *number, true) {
        Some((Says::Coverage(percent), _)) if factor_of_coverage(percent).is_none() => (Says::Accuracy, 3),
        Some(_) => (Says::PlusMinus, 1),
        None => (Says::Accuracy, 2),
    }
}

/// A number that is a coverage in percent or a multiple of sigma.
fn coverage_at(tokens: &[Token], at: usize, number: f64, is_uncertain: bool) -> Option<(Says, usize)> {
    let [before, next] = [at.checked_sub(1), Some(at + 1)].map(|place| tokens.get(place?));
    let token = &tokens[at];
    let is_attached = next.is_some_and(|next| next.from == token.to);
    let is_one_of = |other: Option<&Token>, any: &[&str]| {
        other.is_some_and(|other| matches!(&other.is, Is::Word(word) if any.contains(&word.as_str())))
    };
    if is_one_of(next, &["sigma", "σ"]) || is_attached && is_one_of(next, &SIGMA) {
        return Some((Says::Sigmas(number), 1));
    }
    // in U95_percent the percent is the unit
    let follows_word = before.is_some_and(|before| before.to == token.from && matches!(before.is, Is::Word(_)));
    let is_percent = next.is_some_and(|next| next.is == Is::Percent) || is_one_of(next, &["percent", "pct"]);
    if is_uncertain && is_percent && (is_attached || !follows_word) {
        return Some((Says::Coverage(number), 2));
    }
    let is_covered = COVERAGES.contains(&number) && (is_one_of(before, &COVERED) || is_one_of(next, &COVERED));
    (is_uncertain && is_covered).then_some((Says::Coverage(number), 1))
}

/// A piece of a header, with its place in it.
struct Token {
    from: usize,
    to: usize,
    is: Is,
}

#[derive(PartialEq)]
enum Is {
    /// Letters, in lower case.
    Word(String),
    Number(f64),
    Percent,
    Equals,
    PlusMinus,
}

fn tokens_of(header: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut from = 0;
    while let Some(first) = header[from..].chars().next() {
        let text = &header[from..];
        let run = |is_part: &dyn Fn(char) -> bool| text.find(|c: char| !is_part(c)).unwrap_or(text.len());
        let (length, is) = match first {
            letter if letter.is_alphabetic() => {
                let length = run(&char::is_alphabetic);
                (length, Some(Is::Word(text[..length].to_lowercase())))
            }
            digit if digit.is_ascii_digit() => {
                let length = number_length(text);
                (length, text[..length].replace(',', ".").parse().ok().map(Is::Number))
            }
            '%' => (1, Some(Is::Percent)),
            '=' => (1, Some(Is::Equals)),
            '±' => ('±'.len_utf8(), Some(Is::PlusMinus)),
            '+' if text.starts_with("+/-") => (3, Some(Is::PlusMinus)),
            '+' if text.starts_with("+-") => (2, Some(Is::PlusMinus)),
            other => (other.len_utf8(), None),
        };
        tokens.extend(is.map(|is| Token { from, to: from + length, is }));
        from += length;
    }
    tokens
}

/// Length of the number at the beginning of a text, with a decimal point or a decimal comma between digits.
fn number_length(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let whole = digits(text);
    match text[whole..].strip_prefix(['.', ',']).map(digits) {
        Some(decimals) if decimals > 0 => whole + 1 + decimals,
        _ => whole,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_and_coverages_as_people_write_them() {
        for (header, factor, rest) in [
            ("thrust_std_n", Some(1.0), "thrust_std_n"),
            ("thrust_uncertainty_k=3_n", Some(3.0), "thrust_uncertainty_ _n"),
            ("thrust_uncertainty_k2_g", Some(2.0), "thrust_uncertainty_ _g"),
            ("U(thrust) (k = 1.96) [N]", Some(1.96), "U(thrust) ( ) [N]"),
            ("u_thrust_n (k=1)", Some(1.0), "u_thrust_n ( )"),
            ("U thrust (k=2,13; 95 %) N", Some(2.13), "U thrust ( ;  ) N"),
            ("thrust_uncertainty_95%_n", Some(2.0), "thrust_uncertainty_ _n"),
            ("thrust uncertainty 95 % (N)", Some(2.0), "thrust uncertainty   (N)"),
            ("thrust_uncertainty_95pct_n", Some(2.0), "thrust_uncertainty_ _n"),
            ("thrust_unc_68%_n", Some(1.0), "thrust_unc_ _n"),
            ("thrust_unc_99.7%_n", Some(3.0), "thrust_unc_ _n"),
            ("thrust_U95_n", Some(2.0), "thrust_U _n"),
            ("thrust_u95_percent", Some(2.0), "thrust_u _percent"),
            ("thrust_unc_90%_n", None, "thrust_unc_ _n"),
            ("thrust_unc_k=0_n", None, "thrust_unc_ _n"),
            ("±thrust_n", Some(2.0), " thrust_n"),
            ("+-thrust_n", Some(2.0), " thrust_n"),
            ("Thrust +/- (N)", Some(2.0), "Thrust   (N)"),
            ("thrust ± SD (N)", Some(1.0), "thrust   SD (N)"),
            ("thrust_3sigma_n", Some(3.0), "thrust_ sigma_n"),
            ("2σ thrust (N)", Some(2.0), " σ thrust (N)"),
            ("thrust_standard_error_n", Some(1.0), "thrust_standard_error_n"),
        ] {
            let coverage = coverage_of(header);
            assert_eq!((coverage.factor.ok(), coverage.rest.as_str()), (factor, rest), "{header}");
            assert!(coverage.is_uncertainty, "{header}");
        }
    }

    #[test]
    fn headers_of_measured_values_stay_as_they_are() {
        for header in ["thrust_n", "Thrust at 95% (N)", "thrust_g_4rotors", "k2_rpm", "Thrust (%)", "kv=920 rpm"] {
            let coverage = coverage_of(header);
            assert_eq!((coverage.rest.as_str(), coverage.is_uncertainty), (header, false));
            assert!(coverage.parts.is_empty() && coverage.factor == Ok(1.0), "{header}");
        }
        // what a value is worth is no column of uncertainties
        let accuracy = coverage_of("Thrust (N) ±0.5 %");
        assert_eq!((accuracy.rest.as_str(), accuracy.is_uncertainty), ("Thrust (N)  ", false));
        assert!(!coverage_of("Voltage U (V)").is_certainly && coverage_of("±current_A").is_certainly);
    }

    #[test]
    fn the_parts_that_expand_are_known() {
        for (header, parts, is_named_without) in [
            ("thrust_std_n (k=2)", &["k=2"][..], true),
            ("thrust_uncertainty_95%_n", &["95%"], true),
            ("U_thrust (k=2) [N]", &["U", "k=2"], false),
            ("thrust_expanded_k=3_n", &["expanded", "k=3"], false),
            ("±thrust_n", &["±"], false),
            ("thrust_std_n", &[], true),
        ] {
            let coverage = coverage_of(header);
            assert_eq!(
                (coverage.parts.as_slice(), coverage.is_named_without),
                (owned(parts).as_slice(), is_named_without)
            );
        }
    }

    fn owned(parts: &[&str]) -> Vec<String> {
        parts.iter().map(|part| (*part).to_owned()).collect()
    }
}
