//! How much flying a wanted uncertainty needs.

use crate::counted;
use crate::number::significant;
use hovertone_thrust::{BudgetInput, FlightPlan, PlanWish, compared};
use hovertone_vehicle::in_list;

/// Longer times of hover are told in minutes.
const SECONDS_SHOWN_MAX: f64 = 120.0;

/// The plan as text, with the range of loads that would show an intercept.
pub fn flight_plan_text(plan: &FlightPlan, wish: &PlanWish) -> String {
    let steps = plan.load_count - 1;
    let added: Vec<String> = (0..plan.load_count)
        .map(|load| 1e3 * wish.added_mass_kg_max * load as f64 / steps as f64)
        .map(|added_g| if added_g == 0.0 { "0 g".to_owned() } else { significant(added_g, 3) + " g" })
        .collect();
    let range = wish.added_mass_kg_max / wish.vehicle_mass_kg + 1.0;
    let intercept = match plan.force_ratio_for_intercept {
        Some(ratio) if ratio <= range => {
            "These loads also test the law F = C_f ω²: if the true law has a force at speed zero (intercept), the test finds it where it is 2 % of the largest force or more.".to_owned()
        }
        Some(ratio) => {
            // rounded up, so that the named mass is enough
            let added_g = (1e3 * wish.vehicle_mass_kg * (ratio - 1.0)).ceil();
            let [ratio, range] = compared([ratio, range]);
            format!(
                "If the speeds scatter as this plan assumes, a test of the law F = C_f ω² needs a heaviest flight of {ratio} times the mass of the vehicle alone. In this plan it is {range} times.\n\
                 If the vehicle can carry {added_g} g, plan with --added-mass-kg {}.",
                added_g / 1e3
            )
        }
        None => "These recordings are too few to test the law F = C_f ω² to 2 % of the force, even with the best loads.".to_owned(),
    };
    let advice = match plan.largest {
        BudgetInput::LoudestRotor => {
            "\nThe plan assumes that one tone is used for all rotors. If `hovertone speed` separates your rotors, or hears them \
            as a group with a mean speed, add --rotors-separated: the ± is smaller."
        }
        BudgetInput::Gravity => {
            "\nIf you give the latitude of the place of the flight, this part becomes smaller: plan again with --latitude-deg DEGREES."
        }
        _ => "",
    };
    let hover = match plan.hover_s {
        hover_s if hover_s < SECONDS_SHOWN_MAX => format!("{hover_s:.0} s"),
        hover_s => format!("{:.1} minutes", hover_s / 60.0),
    };
    format!(
        "Plan: {} loads ({} added), {} of each load, {:.0} s of steady hover in each recording: {hover} of steady hover in all\n\
         Wanted (--wanted-share): C_f ± {} % or less (k = 2). Expected: ± {} %. The largest part of this ± comes from: \
         {}.{advice}\n{intercept}\n",
        plan.load_count,
        in_list(&added, "and"),
        counted(plan.trials_per_load, "recording"),
        plan.trial_s,
        significant(100.0 * wish.wanted_share, 2),
        significant(100.0 * plan.expanded_share, 2),
        plan.largest.title(),
    )
}
