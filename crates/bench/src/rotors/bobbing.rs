//! The paper's hovers with rotors that are not alike: what C_f each method finds of one flight.

use crate::accuracy::drawn;
use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, SpeedEstimate, ToneConfig, speed_from_source};
use hovertone_sim::paper::{LOADS, PaperLoad};
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun, SpreadSection};
use hovertone_vehicle::Order;
use std::collections::BTreeMap;

/// Speeds from rotor to rotor, as shares of their mean.
const SPACINGS: [f64; 3] = [0.0, 0.01, 0.02];
/// Rotors across from each other turn the same way, and both pairs have one mean, or the drone would trim its yaw with their speeds.
const PLACES: [f64; 4] = [-1.5, -0.5, 1.5, 0.5];

/// What was found of one flight by one method: the error of C_f, and its U by the budget of the speed.
struct Found {
    error_share: f64,
    expanded_share: f64,
    is_separated: bool,
}

/// One flight; `None` where no tone was heard.
struct Flight {
    separated: Option<Found>,
    maximum_trace: Option<Found>,
    rotor_count: usize,
}

/// The section of the report.
pub(super) fn section(flights: usize) -> Result<String, String> {
    let mut rows = String::new();
    for spacing_share in SPACINGS {
        let flown = drawn(flights, |number| flight(spacing_share, number))?;
        let row = row_of(spacing_share, &flown);
        print!("{row}");
        rows += &row;
    }
    Ok(HEAD.replace("{flights}", &flights.to_string()) + &rows)
}

const HEAD: &str = "
## Flights that bob

{flights} flights a row as the demo has them (`ScenarioFile::paper_trial`, 10 s in a room, 4 m away, one load after the other), but for
rotors that turn so far apart: their constants differ, in an order that changes from flight to flight. All rotors speed up and slow
down together, 5 % in a second (rms).

- apart: flights with four separated rotors, of those in which a tone was heard. group: flights in which too few were, and their mean is
  given. The rest: three of four, or one ridge that stands for all.
- C_f: error of one flight's constant by hover balance, rms over flights, and the worst, by the mean square of the rotors and by the paper's
  maximum trace. within U: flights within twice the standard uncertainty of the budget of their speed.

| rotors | heard | apart | group | C_f, % | worst, % | within U | maximum trace, % | worst, % | within U |
|---|---|---|---|---|---|---|---|---|---|
";

fn flight(spacing_share: f64, number: usize) -> Result<Flight, String> {
    let loads: &[PaperLoad] = &LOADS;
    let trial = u32::try_from(number / loads.len()).map_err(|error| error.to_string())?;
    let mut file = ScenarioFile::paper_trial(&loads[number % loads.len()], trial, 1);
    let mut places = PLACES;
    places.rotate_left(number % 4);
    // a rotor that turns faster for the same thrust has a smaller constant
    let thrust_shares = places.map(|place| (1.0 + place * spacing_share).powi(-2));
    file.spread = Some(SpreadSection { thrust_shares: Some(thrust_shares), ..SpreadSection::default() });
    let scenario = file.resolve(&BTreeMap::new()).map_err(|error| error.to_string())?;
    let sample_rate_hz = scenario.sound.sample_rate_hz;
    let mut run = ScenarioRun::new(scenario).map_err(|error| error.to_string())?;
    let (mut channels, mut states) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut states).map_err(|error| error.to_string())? {}
    let truth = run.finish(&mut channels).flight.mean_sum_of_squares_rad2_s2 / 4.0;

    let mut tone = ToneConfig::of_order(Order::new(69.0).map_err(|error| error.to_string())?);
    tone.blades = Some(2);
    let mut config = Config::for_tone(tone);
    config.rotors.count = 4;
    config.method = Method::Separated;
    config.all_methods = true;
    let mut signal = Signal::new(channels.swap_remove(0), f64::from(sample_rate_hz));
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).map_err(|error| error.to_string())?;
    let Outcome::Ok(tone) = &analysis.outcome else {
        return Ok(Flight { separated: None, maximum_trace: None, rotor_count: 0 });
    };
    let found = |speed: &SpeedEstimate| {
        let square_rad2_s2 = speed.mean_square_rad2_s2.unwrap_or(speed.speed.rad_s().powi(2));
        let std_rev_s = speed.combined_std_uncertainty_rev_s().unwrap_or(f64::NAN);
        Found {
            error_share: truth / square_rad2_s2 - 1.0,
            // C_f goes with the square of the speed
            expanded_share: 2.0 * 2.0 * std_rev_s / speed.speed.rev_s(),
            is_separated: speed.method == Method::Separated,
        }
    };
    Ok(Flight {
        separated: tone.speed(Method::Separated).map(found),
        maximum_trace: tone.speed(Method::MaximumTrace).map(found),
        rotor_count: tone.rotors.len(),
    })
}

fn row_of(spacing_share: f64, flights: &[Flight]) -> String {
    let errors = |of: &dyn Fn(&Flight) -> Option<&Found>| {
        let found: Vec<&Found> = flights.iter().filter_map(of).collect();
        let count = found.len().max(1) as f64;
        let rms = (found.iter().map(|found| found.error_share.powi(2)).sum::<f64>() / count).sqrt();
        let worst = found.iter().map(|found| found.error_share.abs()).fold(0.0, f64::max);
        let within = found.iter().filter(|found| found.error_share.abs() <= found.expanded_share).count();
        format!("{:.3} | {:.3} | {within} of {}", 100.0 * rms, 100.0 * worst, found.len())
    };
    let heard = flights.iter().filter(|flight| flight.separated.is_some()).count();
    let apart = flights.iter().filter(|flight| flight.rotor_count == PLACES.len()).count();
    let is_group =
        |flight: &&Flight| flight.rotor_count == 0 && flight.separated.as_ref().is_some_and(|found| found.is_separated);
    let name = if spacing_share > 0.0 { format!("{:.0} % apart", 100.0 * spacing_share) } else { "alike".to_owned() };
    format!(
        "| {name} | {heard} of {} | {apart} | {} | {} | {} |\n",
        flights.len(),
        flights.iter().filter(is_group).count(),
        errors(&|flight| flight.separated.as_ref()),
        errors(&|flight| flight.maximum_trace.as_ref()),
    )
}
