//! Loads and their trials → points of force and squared speed with their uncertainties.

mod bootstrap;

pub use bootstrap::TrialBootstrap;
pub(crate) use bootstrap::trial_bootstrap;

use crate::force::Force;
use crate::speeds::{LoadSpeeds, TrialSpeeds};
use crate::square_law::{CONSTANTS_FOR_GROSS, ForcePoint, PointNoise, are_split, gross_points, is_off_by_a_factor};
use crate::statistics::{mean, median, student_factor};
use hovertone_analysis::RotorsHeard;
use hovertone_vehicle::RotorSpeed;

/// Degrees of freedom of an uncertainty from the frames of one trial. The frames of a hover are correlated: about a hundred of them
/// count as this many independent ones. *Decision.*
const FREEDOM_OF_FRAMES: f64 = 20.0;

/// Loads whose forces differ by less than this share count as equal: they show nothing of the law. *Decision.*
pub(crate) const EQUAL_FORCES_SHARE: f64 = 0.005;

/// A load with a speed.
pub(crate) struct HeardLoad<'a> {
    /// Its index among all loads.
    pub(crate) index: usize,
    pub(crate) load: &'a LoadSpeeds,
    /// Mean shaft speed of each of its trials, without trials that are off by a factor.
    pub(crate) trials_rad_s: Vec<f64>,
    /// The recordings of these trials.
    pub(crate) recordings: Vec<&'a str>,
    /// How their rotors are heard.
    pub(crate) rotors_heard: Vec<RotorsHeard>,
    /// Mean over these trials.
    pub(crate) speed_rad_s: f64,
    /// Relative standard uncertainty of that mean …
    pub(crate) speed_std_share: f64,
    /// … and the part of it that the estimator of the speed states.
    pub(crate) estimator_std_share: f64,
    /// Force of the whole vehicle.
    pub(crate) force_n: f64,
    /// Standard uncertainty of the force, without the part that all loads share.
    pub(crate) own_force_std_n: f64,
}

/// All loads with a speed, as points for the fit.
pub(crate) struct Campaign<'a> {
    pub(crate) loads: Vec<HeardLoad<'a>>,
    pub(crate) points: Vec<ForcePoint>,
    pub(crate) noise: PointNoise,
    /// Degrees of freedom of the uncertainty of the speeds.
    pub(crate) speed_freedom: f64,
    /// Trials that are off by a factor.
    pub(crate) gross_trials: Vec<GrossTrial>,
    /// Half of the trials or more are off by a factor from the others.
    pub(crate) are_split: bool,
}

/// A trial that is off by a factor from all others.
pub(crate) struct GrossTrial {
    /// Name of its load.
    pub(crate) load: String,
    /// Name of its recording.
    pub(crate) recording: String,
}

/// Which trials are off by a factor.
struct GrossTrials {
    /// For each load, one entry for each of its trials.
    by_load: Vec<Vec<bool>>,
    /// Half of all trials or more: nothing shows which half is right.
    are_split: bool,
}

impl<'a> Campaign<'a> {
    /// The points are means over trials, since the samples of a trial overlap and share a flight.
    pub(crate) fn of(loads: &'a [LoadSpeeds], rotor_count: u32) -> Self {
        let GrossTrials { by_load: gross, are_split } = gross_trials(loads, rotor_count);
        let mut heard: Vec<HeardLoad<'a>> = loads
            .iter()
            .enumerate()
            .filter_map(|(index, load)| heard_load(index, load, rotor_count, &gross[index]))
            .collect();
        let scatter = flight_scatter(&heard);
        let speed_freedom = settle_speed_std(&mut heard, scatter);
        let points: Vec<ForcePoint> = heard.iter().map(HeardLoad::point).collect();
        let names = gross.iter().zip(loads).flat_map(|(gross, load)| {
            let named = load.trials.iter().zip(gross).filter(|(_, gross)| **gross);
            named.map(|(trial, _)| GrossTrial { load: load.name.clone(), recording: trial.recording.clone() })
        });
        // the forces have more degrees of freedom, but how much of the uncertainty is theirs is known no better than the scatter
        let degrees_of_freedom = speed_freedom;
        let noise = match scatter {
            Some(FlightScatter { is_repeated: true, .. }) => PointNoise::Measured { degrees_of_freedom },
            _ => PointNoise::Unrepeated { degrees_of_freedom },
        };
        Self { points, noise, speed_freedom, gross_trials: names.collect(), are_split, loads: heard }
    }
}

impl Campaign<'_> {
    /// Student's factor on the uncertainty of the speeds.
    pub(crate) fn student_factor(&self) -> f64 {
        student_factor(self.speed_freedom)
    }
}

impl HeardLoad<'_> {
    /// The load as a point for the fit.
    pub(crate) fn point(&self) -> ForcePoint {
        let square = self.speed_rad_s.powi(2);
        ForcePoint {
            name: self.load.name.clone(),
            speed_square_rad2_s2: square,
            speed_square_std_rad2_s2: 2.0 * square * self.speed_std_share,
            force_n: self.force_n,
            force_std_n: self.own_force_std_n,
        }
    }

    /// Whether the whole vehicle flies, in contrast to a bench run.
    pub(crate) fn is_hover(&self) -> bool {
        matches!(self.load.force, Force::Weight { .. })
    }

    /// Mean length of the hovers of its trials.
    pub(crate) fn trial_s(&self) -> Option<f64> {
        mean(&self.load.trials.iter().map(|trial| trial.hover_s).collect::<Vec<_>>())
    }
}

/// Factor from the force of the running rotors to the force of the whole vehicle: 1 in a hover.
pub(crate) fn whole_vehicle_factor(rotors_running: u32, rotor_count: u32) -> f64 {
    f64::from(rotor_count) / f64::from(rotors_running.max(1))
}

fn trial_rad_s(trial: &TrialSpeeds) -> Option<f64> {
    mean(&trial.counted().iter().map(|sample| sample.speed.rad_s()).collect::<Vec<_>>())
}

/// For each load, which of its trials are off by a factor from the median constant. If all trials of a load are, none is marked: the
/// load is judged as a whole later. If half of all trials are, none is marked either.
fn gross_trials(loads: &[LoadSpeeds], rotor_count: u32) -> GrossTrials {
    let constants: Vec<Vec<Option<f64>>> = loads
        .iter()
        .map(|load| {
            let force_n = load.force.newtons() * whole_vehicle_factor(load.rotors_running, rotor_count);
            load.trials.iter().map(|trial| Some(force_n / trial_rad_s(trial)?.powi(2))).collect()
        })
        .collect();
    let known: Vec<f64> = constants.iter().flatten().flatten().copied().collect();
    let are_split = are_split(&known);
    let middle = median(&known).filter(|_| known.len() >= CONSTANTS_FOR_GROSS && !are_split);
    let is_gross = |constant: &Option<f64>| match (constant, middle) {
        (Some(constant), Some(middle)) => is_off_by_a_factor(*constant, middle),
        _ => false,
    };
    let of_load = |trials: &Vec<Option<f64>>| {
        let gross: Vec<bool> = trials.iter().map(is_gross).collect();
        let has_sound_one = trials.iter().zip(&gross).any(|(constant, gross)| constant.is_some() && !gross);
        if has_sound_one { gross } else { vec![false; trials.len()] }
    };
    GrossTrials { by_load: constants.iter().map(of_load).collect(), are_split }
}

fn heard_load<'a>(index: usize, load: &'a LoadSpeeds, rotor_count: u32, gross: &[bool]) -> Option<HeardLoad<'a>> {
    let kept = || load.trials.iter().zip(gross).filter(|(_, gross)| !**gross).map(|(trial, _)| trial);
    let speed_of = |trial: &'a TrialSpeeds| Some((trial.recording.as_str(), trial_rad_s(trial)?));
    let (recordings, trials_rad_s): (Vec<&str>, Vec<f64>) = kept().filter_map(speed_of).unzip();
    let speed_rad_s = mean(&trials_rad_s)?;
    let with_speed = kept().filter(|trial| trial_rad_s(trial).is_some());
    let within: Vec<f64> = kept()
        .flat_map(TrialSpeeds::counted)
        .filter_map(|sample| Some(RotorSpeed::from_rev_s(sample.std_uncertainty_rev_s?).rad_s()))
        .collect();
    let estimator = mean(&within).map_or(0.0, |std| std / (trials_rad_s.len() as f64).sqrt());
    let factor = whole_vehicle_factor(load.rotors_running, rotor_count);
    let force_n = load.force.newtons() * factor;
    Some(HeardLoad {
        index,
        load,
        trials_rad_s,
        recordings,
        rotors_heard: with_speed.filter_map(|trial| trial.rotors_heard).collect(),
        speed_rad_s,
        speed_std_share: estimator / speed_rad_s,
        estimator_std_share: estimator / speed_rad_s,
        force_n,
        own_force_std_n: force_n * load.force.relative_std().own,
    })
}

/// How much the mean speed of a recording differs from flight to flight.
#[derive(Clone, Copy)]
struct FlightScatter {
    /// Relative standard deviation of the speed of one trial.
    std_share: f64,
    degrees_of_freedom: f64,
    /// It comes from repeated trials of a load; else from the loads themselves, one recording each.
    is_repeated: bool,
}

/// The scatter of all trials about the means of their loads, pooled over the loads, because the standard deviation of five trials alone
/// has an uncertainty of a third. Where every load has one trial, the loads themselves are the repeated observations: the scatter of
/// their speeds about one square law. `None` with a single recording.
fn flight_scatter(loads: &[HeardLoad<'_>]) -> Option<FlightScatter> {
    let repeats: usize = loads.iter().map(|load| load.trials_rad_s.len() - 1).sum();
    let is_repeated = repeats > 0;
    let (squares, degrees_of_freedom): (f64, usize) = if is_repeated {
        let of_load = |load: &HeardLoad<'_>| relative_squares(&load.trials_rad_s);
        (loads.iter().map(of_load).sum(), repeats)
    } else {
        let gross = gross_points(&loads.iter().map(HeardLoad::point).collect::<Vec<_>>());
        let sound = loads.iter().zip(gross).filter(|(_, gross)| !gross);
        let per_root_force: Vec<f64> = sound.map(|(load, _)| load.speed_rad_s / load.force_n.sqrt()).collect();
        (relative_squares(&per_root_force), per_root_force.len().saturating_sub(1))
    };
    (degrees_of_freedom > 0).then(|| FlightScatter {
        std_share: (squares / degrees_of_freedom as f64).sqrt(),
        degrees_of_freedom: degrees_of_freedom as f64,
        is_repeated,
    })
}

/// Sum of the squared deviations from the mean, as shares of the mean.
fn relative_squares(values: &[f64]) -> f64 {
    mean(values).map_or(0.0, |middle| values.iter().map(|value| (value / middle - 1.0).powi(2)).sum())
}

/// Sets the uncertainty of the speed of every load, and returns its degrees of freedom. Two evaluations exist: the statement of the
/// estimator, and the scatter from flight to flight. The one with the larger expanded uncertainty counts: few flights can agree by
/// chance, and the estimator does not know of other flights. No load counts as better known than the scatter of repeated flights, also
/// where the estimator knows another load worse than that: else one load alone would decide.
fn settle_speed_std(loads: &mut [HeardLoad<'_>], scatter: Option<FlightScatter>) -> f64 {
    let by_frames = |load: &HeardLoad<'_>| load.estimator_std_share.powi(2);
    let trials = |load: &HeardLoad<'_>| load.trials_rad_s.len() as f64;
    let of_frames = loads.iter().map(by_frames).sum::<f64>().sqrt() * student_factor(FREEDOM_OF_FRAMES);
    let trial_parts = loads.iter().map(|load| trials(load).recip()).sum::<f64>().sqrt();
    let is_larger = |scatter: &FlightScatter| {
        scatter.std_share * trial_parts * student_factor(scatter.degrees_of_freedom) >= of_frames
    };
    let Some(scatter) = scatter.filter(|scatter| scatter.is_repeated || is_larger(scatter)) else {
        return FREEDOM_OF_FRAMES;
    };
    let counts_alone = is_larger(&scatter);
    for load in loads {
        let of_flights = scatter.std_share / trials(load).sqrt();
        load.speed_std_share = if counts_alone { of_flights } else { load.estimator_std_share.max(of_flights) };
        load.estimator_std_share = load.estimator_std_share.min(load.speed_std_share);
    }
    if counts_alone { scatter.degrees_of_freedom } else { FREEDOM_OF_FRAMES }
}
