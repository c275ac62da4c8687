//! The plan of a campaign: how many flights a wanted uncertainty needs.

use crate::args::FitArguments;
use crate::failure::{Ending, Failure};
use crate::place::refuse_height_alone;
use crate::terminal::Terminal;
use hovertone::thrust::{BudgetInput, Gravity, PLAN_SHARE_MAX, PlanError, PlanWish, ThrustSettings, flight_plan};
use hovertone_report::flight_plan_text;
use hovertone_vehicle::{KnownRotor, QuantityError, check_diameter};

/// Most multirotors safely carry a quarter of their mass.
const ADDED_MASS_SHARE: f64 = 0.25;
/// Number of rotors of most multirotors.
const ROTORS_OF_MOST: u32 = 4;

/// Prints the plan for a vehicle of this mass.
pub(super) fn plan_campaign(
    arguments: &FitArguments,
    mass_kg: f64,
    gravity: Gravity,
    terminal: &mut Terminal,
) -> Result<Ending, Failure> {
    refuse_height_alone(&arguments.place)?;
    let asked = &arguments.plan;
    let rotor_count = arguments.rotors.unwrap_or(ROTORS_OF_MOST);
    let flown = KnownRotor {
        diameter_m: arguments.air.diameter_m,
        mass_kg: Some(mass_kg),
        rotor_count: Some(rotor_count),
        ..KnownRotor::default()
    };
    let diameter_m = arguments.air.diameter_m;
    diameter_m.map_or(Ok(()), |diameter_m| check_diameter("diameter_m", diameter_m))?;
    flown.check_hover()?;
    let wish = PlanWish {
        wanted_share: asked.wanted_share,
        vehicle_mass_kg: mass_kg,
        added_mass_kg_max: asked.added_mass_kg.unwrap_or(ADDED_MASS_SHARE * mass_kg),
        mass_std_kg: asked.mass_std_kg,
        gravity_m_s2: gravity.m_s2,
        gravity_std_m_s2: gravity.std_m_s2,
        speed_spread_share: asked.speed_spread_share,
        correlation_time_s: asked.correlation_s,
        settings: ThrustSettings {
            follows_loudest: !asked.rotors_separated,
            propeller_diameter_m: arguments.air.diameter_m,
            ..ThrustSettings::for_rotors(rotor_count)
        },
    };
    let plan = flight_plan(&wish).map_err(|error| {
        let hint = match &error {
            PlanError::OutOfReach { largest, best_share } if *best_share > PLAN_SHARE_MAX => {
                hint_against(*largest).unwrap_or("check the masses and the uncertainties that you gave").to_owned()
            }
            PlanError::OutOfReach { largest, .. } => match hint_against(*largest) {
                Some(hint) => format!("give a larger --wanted-share; or {hint}"),
                None => "give a larger --wanted-share".to_owned(),
            },
            PlanError::Quantity(QuantityError { name: "wanted_share", value, .. }) if *value >= PLAN_SHARE_MAX => {
                format!("for {value} % give --wanted-share {}", value / 100.0)
            }
            PlanError::Quantity(QuantityError { name: "mass_std_kg", value, .. }) if *value > 0.0 => {
                "give the uncertainty in kilograms: for 0.5 g write 0.0005".to_owned()
            }
            _ => "see `hovertone fit --help`".to_owned(),
        };
        Failure::usage(error.to_string(), hint)
    })?;
    if arguments.json {
        terminal.data(&(serde_json::to_string_pretty(&plan).map_err(Failure::internal)? + "\n"))?;
    } else {
        terminal.text(&flight_plan_text(&plan, &wish))?;
    }
    Ok(Ending::Done)
}

/// What makes the largest part of an uncertainty smaller.
fn hint_against(largest: BudgetInput) -> Option<&'static str> {
    match largest {
        BudgetInput::VehicleMass | BudgetInput::AddedMass | BudgetInput::Scale => {
            Some("weigh more exactly, and plan again with --mass-std-kg")
        }
        BudgetInput::Gravity => {
            Some("plan again with the place of the flight (--latitude-deg), which gives the local gravity")
        }
        BudgetInput::LoudestRotor => Some(
            "record so near the vehicle that `hovertone speed` separates the rotors or hears them as a group, and plan \
             again with --rotors-separated",
        ),
        _ => None,
    }
}
