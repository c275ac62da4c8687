//! `hovertone weigh`: what hovers, by its sound.

use crate::export::identified;
use crate::failure::{Ending, Failure};
use crate::place::gravity_of;
use crate::progress::Progress;
use crate::recording::{Hearing, hear_all};
use crate::speed::{ending_of, jobs_of, tone_of};
use crate::terminal::Terminal;
use crate::thrust_args::WeighArguments;
use hovertone::{Config, Gravity, HeardHover, ToneConfig, weighed_hover};
use hovertone_exchange::IdentifiedRotor;
use hovertone_report::{weighed_json, weighed_text};
use hovertone_vehicle::{Ending as EstimateEnding, Estimate, Order};

const SEE_HELP: &str = "see `hovertone weigh --help`";

/// What the arguments mean.
struct Plan {
    constant_total_n_s2: Estimate,
    gravity: Gravity,
    vehicle_mass_kg: Option<Estimate>,
    config: Config,
}

/// Hears all recordings and weighs.
pub(crate) fn run(arguments: &WeighArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    let jobs = jobs_of(&arguments.files, &plan.config, None);
    let hearing = Hearing {
        audio_track: arguments.hearing.audio_track,
        channel: arguments.hearing.channel,
        ..Hearing::default()
    };
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let records = hear_all(&jobs, hearing, &progress);
    progress.finish();
    let hover = |estimate: &hovertone::SpeedEstimate| HeardHover {
        speed: estimate.speed,
        std_uncertainty_rev_s: estimate.combined_std_uncertainty_rev_s(),
    };
    let hovers: Vec<HeardHover> = records.iter().filter_map(|record| record.speed().map(hover)).collect();
    let Gravity { m_s2, std_m_s2 } = plan.gravity;
    if let Some(weighed) = weighed_hover(plan.constant_total_n_s2, &hovers, m_s2, std_m_s2, plan.vehicle_mass_kg) {
        let text =
            if arguments.json { weighed_json(&weighed).map_err(Failure::internal)? } else { weighed_text(&weighed) };
        terminal.data(&text)?;
        terminal.flush()?;
    }
    terminal.notes(&records.iter().collect::<Vec<_>>());
    Ok(ending_of(&records))
}

fn resolve(arguments: &WeighArguments) -> Result<Plan, Failure> {
    let results = arguments.constant.as_deref().map(identified).transpose()?;
    let estimate = |value: f64, std_uncertainty| Estimate { value, std_uncertainty, ending: EstimateEnding::Solved };
    let constant = match (&results, arguments.constant_n_s2) {
        (Some(rotor), _) => {
            let total = rotor.thrust_constant_n_s2 * f64::from(rotor.rotor_count);
            estimate(total, rotor.measured_std_total_n_s2)
        }
        (None, Some(constant_n_s2)) => estimate(constant_n_s2, arguments.constant_std_n_s2),
        (None, None) => return Err(Failure::usage("no thrust constant is given", SEE_HELP)),
    };
    for (name, value) in [("thrust constant", constant.value), ("mass_kg", arguments.mass_kg.unwrap_or(1.0))] {
        if !(value.is_finite() && value > 0.0) {
            return Err(Failure::usage(format!("{name} = {value}, must be a number above 0"), SEE_HELP));
        }
    }
    let is_place_said = arguments.place.gravity_m_s2.or(arguments.place.latitude_deg).is_some();
    let gravity = match &results {
        // weighed where the constant was found, gravity cancels
        Some(rotor) if !is_place_said => Gravity { m_s2: rotor.gravity_m_s2, std_m_s2: 0.0 },
        _ => gravity_of(&arguments.place)?,
    };
    let mass_kg = arguments.mass_kg.or_else(|| results.as_ref()?.mass_kg);
    let config = Config::for_tone(tone_to_hear(arguments, results.as_ref())?);
    config.check().map_err(|error| Failure::usage(error.to_string(), SEE_HELP))?;
    Ok(Plan {
        constant_total_n_s2: constant,
        gravity,
        vehicle_mass_kg: mass_kg.map(|mass_kg| estimate(mass_kg, Some(arguments.mass_std_kg))),
        config,
    })
}

/// The tone that was said, else that of the results.
fn tone_to_hear(arguments: &WeighArguments, results: Option<&IdentifiedRotor>) -> Result<ToneConfig, Failure> {
    if let Some(tone) = tone_of(&arguments.tone)? {
        return Ok(tone);
    }
    let order = results.and_then(|rotor| rotor.tone_order).ok_or_else(|| {
        Failure::usage("nothing says which tone is the rotor's", "say --vehicle, --blades, --gear or --order")
    })?;
    let order = Order::new(order).map_err(|error| Failure::usage(error.to_string(), SEE_HELP))?;
    Ok(ToneConfig { band_hz: arguments.tone.band, ..ToneConfig::of_order(order) })
}
