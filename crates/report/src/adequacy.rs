//! How well the square law holds, which law the evidence prefers, and the uncertainty budget.

use crate::number::{DASH, PowerOfTen, expanded, significant, spread, with_uncertainty};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::thrust::CONSTANT_UNIT;
use hovertone_thrust::{
    BudgetInput, BudgetLine, ForceLaw, LoadRange, SquareLawFit, ThrustTable, TrialBootstrap, UncertaintyBudget,
    p_value_text, preferred_law,
};
use hovertone_vehicle::Estimate;

/// Contributions below this share of the constant have no line for people; the JSON has all of them.
const NEGLIGIBLE_SHARE: f64 = 1e-6;

/// Forces are not called alike where the largest is this many times the smallest.
const WIDE_FORCE_RATIO: f64 = 2.0;

/// An intercept below this has a power of ten in its unit: its cell would have many zeros.
const SMALL_INTERCEPT_N: f64 = 0.1;

/// Parameters of the largest compared law: more points tell whether it is needed.
const LAW_PARAMETERS: usize = 2;

/// Ratios of the budget and the bootstrap that are usual where few recordings scatter.
const CHECKED_LOW: f64 = 0.4;
const CHECKED_HIGH: f64 = 2.5;

/// Laws and budget of the table of one method; empty without a fit.
pub fn adequacy_text(table: &ThrustTable, width: Option<usize>) -> String {
    let (Some(fit), Some(budget)) = (&table.fit, &table.budget) else { return String::new() };
    let constant_n_s2 = fit.thrust_constant_n_s2.value;
    format!(
        "\n{}\n{}{}",
        laws_text(fit, width),
        table_text(&budget_table(budget, constant_n_s2), width),
        cross_check(table.bootstrap, budget, constant_n_s2),
    )
}

/// How well the square law holds, and the laws beside it with their probabilities.
pub fn laws_text(fit: &SquareLawFit, width: Option<usize>) -> String {
    table_text(&laws_table(fit), width) + &agreement_text(fit) + &preferred_text(fit)
}

/// The unit of an intercept.
fn intercept_unit(intercept_n: Estimate) -> PowerOfTen {
    let numbers = [intercept_n.value, expanded(intercept_n.std_uncertainty).unwrap_or(0.0)];
    let is_small = numbers.iter().all(|number| number.abs() < SMALL_INTERCEPT_N);
    if is_small { PowerOfTen::of(numbers) } else { PowerOfTen::exact(0) }
}

/// A number with its ±, without its unit.
fn in_unit(unit: PowerOfTen, estimate: Estimate) -> String {
    with_uncertainty(unit.scale(estimate.value), estimate.std_uncertainty.map(|std| unit.scale(std)))
}

/// A probability in percent. One that would be rounded to 0 or 100 is no certainty.
fn probability_percent(probability: f64) -> String {
    match format!("{:.1}", 100.0 * probability).as_str() {
        "100.0" => "> 99.9".to_owned(),
        "0.0" => "< 0.1".to_owned(),
        percent => percent.to_owned(),
    }
}

/// The square law and the laws beside it, with their probabilities.
pub fn laws_table(fit: &SquareLawFit) -> TextTable {
    let unit = PowerOfTen::of([fit.thrust_constant_n_s2.value]);
    let force_unit = fit.with_intercept.map_or(PowerOfTen::exact(0), |law| intercept_unit(law.intercept_n));
    let mut text = TextTable::new(vec![
        Column::words("law (± of the fit alone, k = 2)"),
        Column::numbers("C_f", &unit.unit(CONSTANT_UNIT)),
        Column::numbers("F₀", &force_unit.unit("N")),
        Column::numbers("exponent", ""),
        Column::numbers("probability", "%"),
    ]);
    let probability = |law: ForceLaw| {
        let known = fit.laws.iter().find(|known| known.law == law);
        // without other laws there is no preference
        known.filter(|_| fit.laws.len() > 1).map_or(DASH.to_owned(), |known| probability_percent(known.probability))
    };
    let mut row = |law: ForceLaw, cells: [String; 3]| {
        // forces that are too alike to test the square law do not prefer it
        let mark = if (law != ForceLaw::Square || is_tested(fit)) && preferred_law(fit) == Some(law) {
            " (preferred)"
        } else {
            ""
        };
        let [constant, intercept, exponent] = cells;
        text.push(vec![format!("{}{mark}", law.formula()), constant, intercept, exponent, probability(law)]);
    };
    row(ForceLaw::Square, [in_unit(unit, fit.thrust_constant_n_s2), "0".to_owned(), "2".to_owned()]);
    if let Some(law) = fit.with_intercept {
        let cells = [in_unit(unit, law.thrust_constant_n_s2), in_unit(force_unit, law.intercept_n), "2".to_owned()];
        row(ForceLaw::SquareWithIntercept, cells);
    }
    if let Some(law) = fit.power_law {
        let exponent = with_uncertainty(law.exponent.value, law.exponent.std_uncertainty);
        row(ForceLaw::Power, [DASH.to_owned(), "0".to_owned(), exponent]);
    }
    text
}

/// The preferred law with all its numbers, ready for use, where it is not the square law; that no law is preferred, or compared; else empty.
/// The forces are those of the fit: of all rotors that share a force.
pub fn preferred_text(fit: &SquareLawFit) -> String {
    match (preferred_law(fit), fit.with_intercept, fit.power_law) {
        (None, ..) if fit.laws.len() > 1 => {
            format!(
                "no law is clearly the most probable, so none is preferred; C_f is the constant of the law {}\n",
                ForceLaw::Square.formula()
            )
        }
        (Some(ForceLaw::SquareWithIntercept), Some(law), _) => {
            let constant = law.thrust_constant_n_s2;
            let (force_unit, unit) = (intercept_unit(law.intercept_n), PowerOfTen::of([constant.value]));
            format!(
                "preferred law: F = F₀ + C ω², F₀ = ({}) {}, C = ({}) {}, ω in rad/s\n",
                in_unit(force_unit, law.intercept_n),
                force_unit.unit("N"),
                in_unit(unit, constant),
                unit.unit(CONSTANT_UNIT),
            )
        }
        (Some(ForceLaw::Power), _, Some(law)) => format!(
            "preferred law: F = F_ref (ω/ω_ref)^p, F_ref = {} N, ω_ref = {} rad/s, p = {}\n",
            significant(law.reference_force_n, 5),
            significant(law.reference_rad_s, 5),
            with_uncertainty(law.exponent.value, law.exponent.std_uncertainty),
        ),
        (Some(ForceLaw::Square), ..) if !is_tested(fit) => {
            format!(
                "the forces are too alike to choose between laws, so none is preferred; C_f is the constant of the law {}\n",
                ForceLaw::Square.formula()
            )
        }
        _ if fit.laws.len() <= 1 && fit.points.len() == LAW_PARAMETERS => {
            "the laws have no probabilities, because comparing them needs three different forces or more\n".to_owned()
        }
        _ if fit.laws.len() <= 1 && fit.points.len() > LAW_PARAMETERS => {
            format!("the laws have no probabilities, because {}\n", why_one_law(fit.range, has_misfits(fit)))
        }
        _ => String::new(),
    }
}

/// Whether the forces are far enough apart to test the square law.
fn is_tested(fit: &SquareLawFit) -> bool {
    fit.range.is_none_or(|range| range.shows_intercept)
}

/// Whether a point that the fit uses does not fit the others.
fn has_misfits(fit: &SquareLawFit) -> bool {
    fit.points.iter().any(|point| point.fits == Some(false) && !point.is_gross)
}

/// Why the points tell nothing of other laws: forces that differ widely are not too alike, and a point that does not fit hides the law.
fn why_one_law(range: Option<LoadRange>, has_misfits: bool) -> &'static str {
    let is_wide = |range: LoadRange| range.force_ratio_needed.is_none() || range.force_ratio >= WIDE_FORCE_RATIO;
    if has_misfits {
        "the forces do not fit each other well enough to choose between laws"
    } else if range.is_some_and(is_wide) {
        "the forces and speeds are too uncertain to choose between laws (their stated uncertainties, or their scatter, are too large)"
    } else {
        "the forces are too alike to choose between laws"
    }
}

/// How well the square law holds, on one line; empty where there is nothing to compare.
pub fn agreement_text(fit: &SquareLawFit) -> String {
    match fit.agreement {
        Some(agreement) => format!(
            "the forces differ from F = C ω² by {:.2} % of the largest force (root mean square). {}: if this law and the uncertainties of the \
            forces and speeds are right, the probability of differences this large, or larger, is {} (χ² = {}, {} degree{} of freedom){}\n",
            100.0 * fit.residual_rms_share,
            if agreement.is_disagreement() { "Chance alone hardly explains this" } else { "Chance alone explains this" },
            p_value_text(agreement.p_value),
            significant(agreement.chi_square, 3),
            agreement.degrees_of_freedom,
            if agreement.degrees_of_freedom == 1 { "" } else { "s" },
            fit.widening().map_or(String::new(), |factor| {
                format!(
                    ". So the points scatter more than their stated uncertainties, and the ± of C_f is made {} times as large",
                    significant(factor, 2)
                )
            })
        ),
        None if fit.points.len() > 1 => {
            format!(
                "the forces differ from F = C ω² by {:.2} % of the largest force (root mean square)\n",
                100.0 * fit.residual_rms_share
            )
        }
        None => String::new(),
    }
}

/// The budget, largest contribution first. Inputs that contribute nothing are only in the JSON.
pub fn budget_table(budget: &UncertaintyBudget, constant_n_s2: f64) -> TextTable {
    let mut lines: Vec<&BudgetLine> =
        budget.lines.iter().filter(|line| line.contribution_n_s2 > NEGLIGIBLE_SHARE * constant_n_s2).collect();
    lines.sort_by(|a, b| b.contribution_n_s2.total_cmp(&a.contribution_n_s2));
    let mut text = TextTable::new(vec![
        Column::words("uncertainty budget"),
        Column::numbers("value", ""),
        Column::numbers("u (k = 1)", ""),
        Column::words("unit"),
        Column::numbers("effect on C_f", "%"),
        Column::numbers("share", "%"),
    ]);
    for line in lines {
        text.push(vec![
            line.input.title().to_owned(),
            if line.value == 0.0 { "0".to_owned() } else { significant(line.value, 5) },
            spread(Some(line.std_uncertainty)),
            line.unit.to_owned(),
            significant(100.0 * line.contribution_n_s2 / constant_n_s2, 2),
            format!("{:.1}", 100.0 * line.share),
        ]);
    }
    let combined = 100.0 * budget.combined_std_uncertainty_n_s2 / constant_n_s2;
    text.push(vec![
        "combined".to_owned(),
        String::new(),
        String::new(),
        String::new(),
        significant(combined, 2),
        "100.0".to_owned(),
    ]);
    text
}

fn cross_check(bootstrap: Option<TrialBootstrap>, budget: &UncertaintyBudget, constant_n_s2: f64) -> String {
    let is_of_speed = |input| matches!(input, BudgetInput::SpeedStatistics | BudgetInput::SpeedEstimator);
    let by_budget = budget.std_of_inputs(is_of_speed);
    let percent = |std_n_s2: f64| significant(100.0 * std_n_s2 / constant_n_s2, 2);
    bootstrap.map_or(String::new(), |drawn| {
        format!(
            "check (bootstrap): hovertone repeated the fit {} times, each time with recordings chosen at random. C_f of these fits scatters by \
            {} % (standard deviation, from the speeds alone). The two rows \"speed\" of the budget give {} % (root of the sum of their squares). {}\n",
            drawn.draws,
            percent(drawn.std_uncertainty_n_s2),
            percent(by_budget),
            match by_budget / drawn.std_uncertainty_n_s2 {
                CHECKED_LOW..=CHECKED_HIGH => "The two numbers agree: with few recordings, even a factor of 2 between them is usual",
                _ => "The two numbers differ by more than usual: record more flights",
            },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Ending;

    /// The forces of a small propeller: seven zeros in a cell hide the number.
    #[test]
    fn a_small_intercept_has_a_power_of_ten_in_its_unit() {
        let said = |value: f64, std_uncertainty: Option<f64>| {
            let intercept_n = Estimate { value, std_uncertainty, ending: Ending::Solved };
            let unit = intercept_unit(intercept_n);
            (in_unit(unit, intercept_n), unit.unit("N"))
        };
        assert_eq!(said(-2e-8, Some(2.3e-7)), ("−0.2 ± 4.6".to_owned(), "1e-7 N".to_owned()));
        assert_eq!(said(-0.0117, Some(0.0027)), ("−1.17 ± 0.54".to_owned(), "1e-2 N".to_owned()));
        assert_eq!(said(-0.04, Some(0.23)), ("−0.04 ± 0.46".to_owned(), "N".to_owned()));
        assert_eq!(said(0.5, None).1, "N");
        assert_eq!(said(0.0, None), ("0.00000".to_owned(), "N".to_owned()));
    }

    #[test]
    fn forces_that_differ_widely_are_not_called_alike() {
        let of_range = |range: Option<LoadRange>| why_one_law(range, false);
        let why = |force_ratio: f64, force_ratio_needed: Option<f64>| {
            of_range(Some(LoadRange {
                force_ratio,
                intercept_std_share: 0.1,
                shows_intercept: false,
                force_ratio_needed,
            }))
        };
        assert!(of_range(None).contains("too alike") && why(1.1, Some(1.4)).contains("too alike"));
        for wide in [why(1.1, None), why(4.0, Some(6.0))] {
            assert!(wide.contains("too uncertain") && !wide.contains("alike"), "{wide}");
        }
        assert!(why_one_law(None, true).contains("do not fit each other"));
    }
}
