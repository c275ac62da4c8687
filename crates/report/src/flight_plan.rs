//! How much flying a wanted uncertainty needs.

use crate::number::significant;
use hovertone_thrust::{BudgetInput, FlightPlan, PlanWish, compared};

/// The plan as text, with the range of loads that would show an intercept.
pub fn flight_plan_text(plan: &FlightPlan, wish: &PlanWish) -> String {
    let steps = plan.load_count - 1;
    let added: Vec<String> = (0..plan.load_count)
        .map(|load| 1e3 * wish.added_mass_kg_max * load as f64 / steps as f64)
        .map(|added_g| if added_g == 0.0 { "nothing".to_owned() } else { significant(added_g, 3) + " g" })
        .collect();
    let range = wish.added_mass_kg_max / wish.vehicle_mass_kg + 1.0;
    let intercept = match plan.force_ratio_for_intercept {
        Some(ratio) if ratio <= range => {
            "These loads also test F = C_f ω²: they show a force at ω = 0 (intercept) of 2 % of the largest.".to_owned()
        }
        Some(ratio) => {
            // rounded up, so that the named mass is enough
            let added_g = (1e3 * wish.vehicle_mass_kg * (ratio - 1.0)).ceil();
            let [ratio, range] = compared([ratio, range]);
            format!(
                "To test F = C_f ω², the vehicle with its heaviest load must weigh {ratio} times the vehicle with its lightest. Yours weighs {range} times.\n\
                 If it can carry {added_g} g, plan with --added-mass-kg {}.",
                added_g / 1e3
            )
        }
        None => "With only these recordings, no range of loads can test F = C_f ω² to 2 % of the force.".to_owned(),
    };
    let separated = match plan.largest {
        BudgetInput::LoudestRotor => {
            "\nThis assumes that the rotors cannot be separated. If `hovertone speed` separates yours, add --rotors-separated."
        }
        _ => "",
    };
    format!(
        "{} loads (add {}), {} trials of each, {:.0} s of hover in each trial: {:.1} minutes of hover\n\
         Expected: C_f ± {} % (k = 2). Most of it: {}.{separated}\n{intercept}\n",
        plan.load_count,
        added.join(", "),
        plan.trials_per_load,
        plan.trial_s,
        plan.hover_s / 60.0,
        significant(100.0 * plan.expanded_share, 2),
        plan.largest.title(),
    )
}
