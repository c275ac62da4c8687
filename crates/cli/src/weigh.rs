//! `hovertone weigh`: the mass of a hovering vehicle from its sound.

use crate::args::WeighArguments;
use crate::copies::{GIVE_ONE, refuse_copies, refuse_equal_speeds, tip_of_circle};
use crate::export::{identified, say_doubts};
use crate::failure::{Ending, Failure};
use crate::foreign_speed::{advise_by_constant, foreign_speed};
use crate::jobs::{ending_of, jobs_of};
use crate::place::{gravity_of, refuse_height_alone};
use crate::progress::Progress;
use crate::recording::{Hearing, Job, Requests, records_of};
use crate::scale_uncertainty::check_stds;
use crate::settings::span_of;
use crate::terminal::Terminal;
use crate::vehicles::{known_vehicles, preset};
use crate::weighed_tone::{tip_of_clock, tip_of_tone, tone_to_hear, warning_of_other_tone};
use crate::wording::IN_HOVER;
use hovertone::speed::{Config, Method, SpeedEstimate, ToneConfig};
use hovertone::thrust::{AcousticScale, Gravity, HeardHover, UncertaintyInputs, WeighError, WeighedHover};
use hovertone_exchange::IdentifiedRotor;
use hovertone_report::{Notice, NoticeKind, SpeedRecord, weighed_json, weighed_text};
use hovertone_vehicle::{
    Ending as EstimateEnding, Estimate, KnownRotor, RotorSpeed, SaidOfVehicle, Vehicle, check_not_negative,
    check_positive, number_in_words,
};
use std::ops::RangeInclusive;

const SEE_HELP: &str = "see `hovertone weigh --help`";
const CHECK_MODEL: &str = "check the name after --vehicle, the thrust constant (of the whole vehicle, in N/(rad/s)²), and the blades or the gear; if all are right, give the mass of the vehicle with --mass-kg";
/// Thrust constants of vehicles, N s²: from one propeller of 10 mm to eight of 3 m, at any thrust coefficient.
const CONSTANT_N_S2: RangeInclusive<f64> = 1e-11..=10.0;
/// Mass by the sound over that of the vehicle, where the constant of one rotor was typed and is corrected.
const OF_ONE_ROTOR: RangeInclusive<f64> = 0.8..=2.0;
/// Standard uncertainty of a kitchen scale that shows whole grams.
const MASS_STD_KG: f64 = 0.0005;

/// The meaning of the arguments.
struct Plan {
    scale: AcousticScale,
    config: Config,
    /// The method of the speeds behind the constant, where the results have it.
    method_of_constant: Option<Method>,
    /// Standard deviation of the difference between the mean of all rotors and the speeds behind the constant, as a share.
    rotors_std_share: f64,
    /// Mass of the vehicle that the arguments name, where they give no other.
    model_kg: Option<f64>,
}

/// What stands in place of a mass where no recording has a speed.
const NO_MASS: &str = "no mass: no speed was heard\n";
const SEVERAL_MASSES: &str = "no mass: several speeds are possible\n";

/// What stands above a mass that no one should use.
const DOUBTFUL_MASS: &str = "do not use this mass: the warnings say that the sound does not fit the rotors with which the constant was measured\n";
const BELOW_VEHICLE: &str = "do not use this mass: it is less than the mass of the vehicle alone\n";
const DOUBTFUL_CONSTANT: &str = "do not use this mass: the warnings say not to use the constant\n";

/// Analyses all recordings and weighs.
pub(crate) fn run(arguments: &WeighArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let results =
        arguments.constant.as_deref().map(|path| identified(path, arguments.of.group.as_deref())).transpose()?;
    let plan = resolve(arguments, results.as_ref())?;
    if let Some((rotor, path)) = results.as_ref().zip(arguments.constant.as_deref()) {
        say_doubts(rotor, path, terminal);
    }
    let tips = tip_of_tone(&arguments.tone, results.as_ref())?.into_iter();
    tips.chain(tip_of_clock(arguments, results.as_ref())).for_each(|notice| terminal.tip(&notice));
    let of_tone = warning_of_other_tone(&arguments.tone, results.as_ref())?;
    let mut jobs = jobs_of(&arguments.files, &plan.config, None, Requests::default())?;
    refuse_copies(&mut jobs, GIVE_ONE, None)?;
    let behind_sha256 = results.as_ref().map_or(&[][..], |rotor| &rotor.recordings_sha256);
    if let Some(notice) = tip_of_circle(&mut jobs, behind_sha256) {
        terminal.tip(&notice);
    }
    let hearing = Hearing::of(&arguments.hearing);
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let records = plan.records_of(&jobs, hearing, &progress).into_iter();
    let mut records: Vec<SpeedRecord> = records.map(|record| record.worded(IN_HOVER)).collect();
    progress.finish();
    refuse_equal_speeds(&records, GIVE_ONE, None)?;
    // the known mass is that without the payload, which hovers too
    let is_told = |notice: &Notice| notice.kind != NoticeKind::CannotHover;
    records.iter_mut().for_each(|record| record.notices.retain(is_told));
    let tone_of_constant = results.as_ref().and_then(|rotor| rotor.tone.as_ref());
    if let Some(heard) = tone_of_constant {
        records.iter_mut().for_each(|record| advise_by_constant(record, heard, &arguments.tone));
    }
    let (names, hovers): (Vec<&str>, Vec<HeardHover>) =
        records.iter().filter_map(|record| Some((record.file.as_str(), hover_of(record)?))).unzip();
    let scale = plan.scale_for(&records);
    refuse_different_loads(&scale, &hovers, &names)?;
    let weighed = scale.weigh(&hovers);
    if let Some(weighed) = &weighed {
        let without_band = if arguments.tone.band.is_some() { "leave --band out; if the message stays, " } else { "" };
        let vehicle_kg = plan.scale.vehicle_mass_kg.map(|mass_kg| mass_kg.value).or(plan.model_kg);
        let of_one = constant_of_one(arguments, plan.config.rotors.count, weighed, vehicle_kg);
        let refused = |error: WeighError, hint: String| {
            Failure::usage(error.to_string(), of_one.clone().unwrap_or_else(|| format!("{without_band}{hint}")))
        };
        weighed.check().map_err(|error| refused(error, error.hint()))?;
        let of_model = plan.model_kg.map_or(Ok(()), |model_kg| weighed.check_model(model_kg));
        of_model.map_err(|error| refused(error, CHECK_MODEL.to_owned()))?;
    }
    let foreign = tone_of_constant.and_then(|heard| foreign_speed(&records, heard, &arguments.tone));
    let is_sound_doubtful =
        foreign.is_some() || records.iter().any(|record| record.contradiction().is_some() && record.speed().is_some());
    let doubt = match is_sound_doubtful {
        true => Some(DOUBTFUL_MASS),
        false if weighed.as_ref().is_some_and(WeighedHover::is_below_vehicle) => Some(BELOW_VEHICLE),
        false => results.as_ref().filter(|rotor| rotor.forbids_use).map(|_| DOUBTFUL_CONSTANT),
    };
    let of_mass = weighed.iter().filter_map(WeighedHover::warning).map(|warning| Notice::from(&warning));
    let warnings: Vec<Notice> = foreign.into_iter().chain(of_tone).chain(of_mass).collect();
    let about: Vec<&SpeedRecord> = records.iter().collect();
    terminal.counted_notes_and(&warnings, &about);
    if arguments.json {
        let document = weighed_json(weighed.as_ref(), &warnings, &records).map_err(Failure::internal)?;
        terminal.data(&document)?;
    } else {
        let said =
            |weighed: &WeighedHover| format!("{}{}", doubt.unwrap_or_default(), weighed_text(weighed, plan.model_kg));
        let none = if records.iter().any(SpeedRecord::is_ambiguous) { SEVERAL_MASSES } else { NO_MASS };
        terminal.text(&weighed.as_ref().map_or_else(|| none.to_owned(), said))?;
    }
    Ok(ending_of(&records).max(if doubt.is_some() { Ending::Incomplete } else { Ending::Done }))
}

/// The advice where a typed constant seems to be that of one rotor: with that of all rotors, the vehicle weighs about its own mass or somewhat more.
fn constant_of_one(
    arguments: &WeighArguments,
    rotor_count: u32,
    weighed: &WeighedHover,
    vehicle_kg: Option<f64>,
) -> Option<String> {
    let (typed_n_s2, rotors) = (arguments.constant_n_s2.filter(|_| rotor_count > 1)?, f64::from(rotor_count));
    let share = rotors * weighed.mass_kg.value / vehicle_kg?;
    let of_std = arguments.constant_std_n_s2.map_or_else(String::new, |std_n_s2| {
        format!(" and --constant-std-n-s2 {}", number_in_words(rotors * std_n_s2))
    });
    OF_ONE_ROTOR.contains(&share).then(|| {
        format!(
            "--constant-n-s2 needs the constant of the whole vehicle: if {typed_n_s2:e} is the constant of one of {rotor_count} rotors, give \
             --constant-n-s2 {}{of_std}; if not, check --mass-kg, and the blades or the gear",
            number_in_words(rotors * typed_n_s2)
        )
    })
}

/// Refuses recordings of different loads: their mean mass is that of none.
fn refuse_different_loads(scale: &AcousticScale, hovers: &[HeardHover], names: &[&str]) -> Result<(), Failure> {
    let Some(different) = scale.different_loads(hovers) else { return Ok(()) };
    let name = |index: usize| names.get(index).copied().unwrap_or_default();
    let what = format!(
        "the recordings are of different loads: by the sound, the vehicle weighs {1:.0} g in {0} and {3:.0} g in {2}",
        name(different.light),
        1e3 * different.light_kg,
        name(different.heavy),
        1e3 * different.heavy_kg
    );
    Err(Failure::usage(what, "run one command for the recordings of each load"))
}

fn hover_of(record: &SpeedRecord) -> Option<HeardHover> {
    let estimate = record.speed()?;
    let segments = record.analysis().map_or(&[][..], |analysis| &analysis.hover.segments);
    Some(HeardHover {
        speed: estimate.speed_of_thrust(),
        // the uncertainty about the rotors is common to all recordings and is added later
        std_uncertainty_rev_s: estimate.combined_std_uncertainty_rev_s().map(|std| {
            let of_rotors = estimate.rotors_std_share() * estimate.speed.rev_s();
            (std * std - of_rotors * of_rotors).max(0.0).sqrt()
        }),
        hover_s: segments.iter().map(|span| span.to_s - span.from_s).sum(),
    })
}

impl Plan {
    /// The records of all recordings. Where several speeds explain the sound, only those are heard at which the vehicle can hover with this constant.
    fn records_of(&self, jobs: &[Job], hearing: Hearing, progress: &Progress) -> Vec<SpeedRecord> {
        let records = records_of(jobs, hearing, progress);
        let tone = &self.config.tone;
        let Some(speeds) = self.scale.hover_speeds().filter(|_| tone.band_hz.is_none()) else { return records };
        let (low, high) = (speeds.start().rad_s().max(tone.speed_min.rad_s()), speeds.end().rad_s());
        let (speed_min, speed_max) =
            (RotorSpeed::from_rad_s(low), RotorSpeed::from_rad_s(high.min(tone.speed_max.rad_s())));
        let again = |(record, job): (SpeedRecord, &Job)| {
            if !record.is_ambiguous() {
                return record;
            }
            let tone = ToneConfig { speed_min, speed_max, ..job.config.tone.clone() };
            let job = Job { config: Config { tone, ..job.config.clone() }, ..job.clone() };
            let heard = records_of(&[job], hearing, progress).pop();
            heard.filter(|heard| heard.speed().is_some()).unwrap_or(record)
        };
        records.into_iter().zip(jobs).map(again).collect()
    }

    /// The error of a single ridge cancels only where constant and hover have the same kind of speed: both the mean of all rotors, or
    /// both the same single ridge.
    fn scale_for(&self, records: &[SpeedRecord]) -> AcousticScale {
        let rotor_count = self.config.rotors.count;
        let speeds: Vec<&SpeedEstimate> =
            records.iter().filter_map(|record| record.speed_by(Method::Separated)).collect();
        let is_apart = rotor_count == 1 || speeds.iter().all(|speed| speed.method == Method::Separated);
        let is_alike = match self.method_of_constant {
            Some(Method::Separated) => is_apart,
            Some(method) => method == self.config.method,
            None => is_apart,
        };
        let loudest = UncertaintyInputs::default().loudest_std_share(rotor_count);
        // with separated rotors: the uncertainty about rotors that were not separated
        let is_by_ridge = self.method_of_constant.is_some_and(|method| method != Method::Separated);
        let unknown = speeds.iter().map(|speed| speed.rotors_std_share()).sum::<f64>() / speeds.len().max(1) as f64;
        let unknown = if is_by_ridge || rotor_count == 1 { 0.0 } else { unknown.hypot(self.rotors_std_share) };
        AcousticScale { loudest_std_share: if is_alike { unknown } else { loudest.max(unknown) }, ..self.scale }
    }
}

fn resolve(arguments: &WeighArguments, results: Option<&IdentifiedRotor>) -> Result<Plan, Failure> {
    check(arguments)?;
    let vehicle = arguments.tone.vehicle.as_deref().map(preset).transpose()?;
    vehicle.map_or(Ok(()), |vehicle| check_vehicle(vehicle, arguments, results))?;
    let estimate = |value: f64, std_uncertainty| Estimate { value, std_uncertainty, ending: EstimateEnding::Solved };
    let rotor_count = rotors_of(vehicle, arguments, results)?;
    let constant = match (results, arguments.constant_n_s2) {
        (Some(rotor), _) => {
            let rotors = f64::from(rotor_count.unwrap_or(rotor.rotor_count));
            let std_per_rotor = rotor.measured_std_total_n_s2.map(|std| std / f64::from(rotor.rotor_count));
            estimate(rotor.thrust_constant_n_s2 * rotors, std_per_rotor.map(|std| std * rotors))
        }
        (None, Some(constant_n_s2)) => estimate(constant_n_s2, arguments.constant_std_n_s2),
        (None, None) => return Err(Failure::usage("no thrust constant is given", SEE_HELP)),
    };
    let gravity_of_place = gravity_of(&arguments.place)?;
    let is_place_said = arguments.place.gravity_m_s2.or(arguments.place.latitude_deg).is_some();
    let gravity = match results {
        // gravity cancels where the constant comes from a weight and the hover is at the same place
        Some(rotor) if !is_place_said && rotor.mass_kg.is_some() => Gravity { m_s2: rotor.gravity_m_s2, std_m_s2: 0.0 },
        _ => gravity_of_place,
    };
    let mass_kg = arguments.mass_kg.or_else(|| results?.mass_kg);
    if let (Some(std_kg), None) = (arguments.mass_std_kg, mass_kg) {
        let what = format!("mass_std_kg = {std_kg} is the uncertainty of the vehicle's mass, but no mass is given");
        return Err(Failure::usage(what, "give --mass-kg too, or leave --mass-std-kg out"));
    }
    let mass_std_kg = arguments.mass_std_kg.unwrap_or(MASS_STD_KG);
    let mut config = Config::for_tone(tone_to_hear(arguments, results)?);
    config.span = span_of(arguments.from, arguments.to)?;
    config.rotors.count = rotor_count.unwrap_or(config.rotors.count);
    config.known = known_of(vehicle, arguments, results, rotor_count)?;
    let method_of_constant = results
        .and_then(|rotor| rotor.method.as_deref())
        .and_then(|name| Method::ALL.into_iter().find(|method| method.name() == name));
    config.method = method_of_constant.unwrap_or(Method::for_rotors(config.rotors.count));
    config.check()?;
    let scale = AcousticScale {
        thrust_constant_total_n_s2: constant,
        trial_std_share: results.and_then(|rotor| rotor.trial_std_share),
        gravity_m_s2: gravity.m_s2,
        gravity_std_m_s2: gravity.std_m_s2,
        vehicle_mass_kg: mass_kg.map(|mass_kg| estimate(mass_kg, Some(mass_std_kg))),
        loudest_std_share: 0.0,
    };
    check_stds(&scale, arguments.constant.as_deref())?;
    scale.check_vehicle(config.tone.speed_max).map_err(|error| match (vehicle, arguments.mass_kg) {
        (Some(vehicle), None) => results_contradict(vehicle, &error),
        _ => Failure::usage(error.to_string(), error.hint()),
    })?;
    let rotors_std_share = results.map_or(0.0, |rotor| rotor.rotors_std_share);
    let model_kg = vehicle.and_then(|vehicle| Some(vehicle.mass_kg?.value)).filter(|_| arguments.mass_kg.is_none());
    Ok(Plan { scale, config, method_of_constant, rotors_std_share, model_kg })
}

/// What is known of the rotors. The mass is that without the payload: C_T has a wider range than a payload makes.
fn known_of(
    vehicle: Option<&Vehicle>,
    arguments: &WeighArguments,
    results: Option<&IdentifiedRotor>,
    rotor_count: Option<u32>,
) -> Result<KnownRotor, Failure> {
    let of_vehicle = vehicle.map(KnownRotor::of_vehicle).unwrap_or_default();
    let flown = vehicle_of(results);
    let known = KnownRotor {
        mass_kg: arguments.mass_kg.or_else(|| flown?.mass_kg).or(of_vehicle.mass_kg),
        diameter_m: (arguments.diameter_m)
            .or_else(|| flown.and_then(|rotor| rotor.propeller_diameter_m))
            .or(of_vehicle.diameter_m),
        rotor_count: rotor_count.or(of_vehicle.rotor_count),
        ..of_vehicle
    };
    if arguments.diameter_m.is_some() {
        known.check()?;
        known.check_diameter()?;
        known.check_hover()?;
    }
    Ok(known)
}

/// Number of rotors of the weighed vehicle. The constant of a single rotor on a stand does not contain it. All rotors of a vehicle carry it
/// in a hover, so that two numbers must be equal.
fn rotors_of(
    vehicle: Option<&Vehicle>,
    arguments: &WeighArguments,
    results: Option<&IdentifiedRotor>,
) -> Result<Option<u32>, Failure> {
    let of_vehicle = vehicle.map(|vehicle| vehicle.rotor_count.value);
    let of_results = vehicle_of(results).map(|rotor| rotor.rotor_count);
    let said = arguments.rotors.map(|said| (said, "--rotors")).or(of_vehicle.map(|said| (said, "--vehicle")));
    if let (Some((said, flag)), Some(known)) = (said, of_results)
        && said != known
    {
        let what = format!("the constant was measured with {known} rotors, but {flag} says {said}");
        return Err(Failure::usage(
            what,
            format!("leave {flag} out, or give --constant with the results of the right vehicle"),
        ));
    }
    let rotor_count = said.map(|(said, _)| said).or(of_results);
    if rotor_count.is_none() && results.is_some() {
        let what = "the constant belongs to one rotor, but the number of rotors is not given";
        return Err(Failure::usage(what, "give the number of rotors, as in --rotors 4, or give --vehicle NAME"));
    }
    Ok(rotor_count)
}

/// Results that are those of a vehicle, not of a single rotor on a stand.
fn vehicle_of(results: Option<&IdentifiedRotor>) -> Option<&IdentifiedRotor> {
    results.filter(|rotor| rotor.rotor_count > 1 || rotor.mass_kg.is_some())
}

/// Compares the vehicle that the arguments name with their own numbers and with the vehicle of the results.
fn check_vehicle(said: &Vehicle, arguments: &WeighArguments, results: Option<&IdentifiedRotor>) -> Result<(), Failure> {
    let flown = SaidOfVehicle {
        rotors: arguments.rotors,
        is_hovering: true,
        mass_kg: arguments.mass_kg,
        ..SaidOfVehicle::default()
    };
    said.check_said(&flown)?;
    let all = known_vehicles()?;
    let measured = results.and_then(|rotor| all.iter().find(|vehicle| vehicle.name == rotor.vehicle_name));
    match measured.filter(|measured| measured.id != said.id) {
        Some(measured) => {
            let what = format!(
                "the constant was measured with the vehicle \"{}\", but --vehicle is \"{}\"",
                measured.id, said.id
            );
            Err(Failure::usage(what, "leave --vehicle out, or give --constant with the results of this vehicle"))
        }
        None => Ok(()),
    }
}

/// The failure for results whose vehicle the named one cannot be.
fn results_contradict(said: &Vehicle, error: &WeighError) -> Failure {
    let WeighError::TooHeavyToHover { vehicle_kg, rev_s, fastest_rev_s } = error else {
        return Failure::usage(error.to_string(), error.hint());
    };
    let what = format!(
        "--vehicle {} contradicts the results: the measured vehicle weighs {vehicle_kg} kg and hovers at {rev_s:.0} \
         rev/s or more, but the rotors of \"{}\" turn at no more than {fastest_rev_s:.0} rev/s",
        said.id, said.id
    );
    Failure::usage(what, "leave --vehicle out, or give --constant with the results of this vehicle")
}

/// Checks the numbers of the arguments.
fn check(arguments: &WeighArguments) -> Result<(), Failure> {
    for (name, value) in [("constant_n_s2", arguments.constant_n_s2), ("mass_kg", arguments.mass_kg)] {
        value.map_or(Ok(()), |value| check_positive(name, value))?;
    }
    if let Some(constant_n_s2) = arguments.constant_n_s2.filter(|constant_n_s2| !CONSTANT_N_S2.contains(constant_n_s2))
    {
        let what = format!(
            "constant_n_s2 = {}, but the constants of all multirotors are between 1e-11 and 10 N s²",
            number_in_words(constant_n_s2)
        );
        return Err(Failure::usage(
            what,
            "give the constant of the whole vehicle in N/(rad/s)²; the AR.Drone has 2.83e-5",
        ));
    }
    let of_mass = KnownRotor { mass_kg: arguments.mass_kg, ..KnownRotor::default() };
    of_mass.check().map_err(|error| Failure::usage(error.to_string(), "masses are in kilograms"))?;
    refuse_height_alone(&arguments.place)?;
    let stds = [("constant_std_n_s2", arguments.constant_std_n_s2), ("mass_std_kg", arguments.mass_std_kg)];
    for (name, value) in stds {
        value.map_or(Ok(()), |value| check_not_negative(name, value))?;
    }
    Ok(())
}
