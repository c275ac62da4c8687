//! One rotor under one condition: what is drawn, what hovertone answers, and how far off it is.

use super::bound::speed_bound_rev_s;
use super::draws::drawn;
use super::sound::{Colour, Noise, Rotor, SAMPLE_RATE_HZ, Turning, mean_rev_s, rendered, series, tone_power};
use super::track::median;
use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, RotorsConfig, SpeedAnalysis, ToneConfig, speed_from_source};
use hovertone_sim::prescribed::Line;
use hovertone_vehicle::{COVERAGE_FACTOR, Order};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// The methods that hear one rotor.
pub(super) const METHODS: [Method; 3] = [Method::Harmonic, Method::MaximumTrace, Method::Gaussian];
/// Speeds are drawn evenly from this range, so that none is on a grid.
const SPEED_REV_S: std::ops::Range<f64> = 50.0..70.0;
/// An answer further off than this many bounds is an outlier: it found something else.
const OUTLIER_BOUNDS: f64 = 20.0;
/// Median of |x| of a normal x of standard deviation 1.
const MEDIAN_STDS: f64 = 0.674_489_75;
const WANDER: Turning = Turning::Wandering { std_share: 0.004, time_constant_s: 0.8 };

/// Which lines a rotor has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tones {
    GearMesh,
    BladePass,
    Both,
}

impl Tones {
    pub(super) const ALL: [Self; 3] = [Self::GearMesh, Self::BladePass, Self::Both];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::GearMesh => "gear mesh",
            Self::BladePass => "blade pass",
            Self::Both => "mesh and blade pass",
        }
    }

    pub(super) fn description(self) -> &'static str {
        match self {
            Self::GearMesh => "orders 69, 138, 207 at 1, ½, ¼; heard as `--gear 8:69`",
            Self::BladePass => "orders 2, 4 … 40 at 1/h; heard as `--blades 2`",
            Self::Both => "both series, each from level 1; heard as `--gear 8:69 --blades 2`",
        }
    }

    fn lines(self) -> Vec<Line> {
        let mesh = series(69, &[1.0, 0.5, 0.25]);
        let levels: Vec<f64> = (1..=20).map(|number| 1.0 / f64::from(number)).collect();
        let blades = series(2, &levels);
        match self {
            Self::GearMesh => mesh,
            Self::BladePass => blades,
            Self::Both => [mesh, blades].concat(),
        }
    }

    /// What the command line makes of the same flags.
    fn asked(self) -> Result<ToneConfig, String> {
        let (order, blades) = match self {
            Self::GearMesh => (69.0, None),
            Self::BladePass => (2.0, Some(2)),
            Self::Both => (69.0, Some(2)),
        };
        let order = Order::new(order).map_err(|error| error.to_string())?;
        Ok(ToneConfig { blades, ..ToneConfig::of_order(order) })
    }
}

/// One row of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Condition {
    pub(super) tones: Tones,
    pub(super) colour: Colour,
    /// Power of all tones over that of the noise between 0 and 24 kHz.
    pub(super) snr_db: f64,
    pub(super) wanders: bool,
}

struct Answer {
    error_rev_s: f64,
    bound_rev_s: f64,
    std_uncertainty_rev_s: Option<f64>,
}

impl Answer {
    fn bounds_off(&self) -> f64 {
        self.error_rev_s.abs() / self.bound_rev_s
    }

    fn is_covered(&self) -> bool {
        self.std_uncertainty_rev_s.is_some_and(|std| self.error_rev_s.abs() <= COVERAGE_FACTOR * std)
    }
}

/// What one method made of all draws.
pub(super) struct MethodScore {
    pub(super) draws: usize,
    pub(super) answered: usize,
    pub(super) outliers: usize,
    /// Of the answers that are no outliers; `None` where there are none.
    pub(super) rmse_bounds: Option<f64>,
    pub(super) median_bounds: Option<f64>,
    pub(super) covered: usize,
    /// Median of the stated u over the standard deviation that the median |error| means: 1 where u is right, more where
    /// it is too careful.
    pub(super) stated_over_scatter: Option<f64>,
}

impl MethodScore {
    fn of(draws: usize, answers: &[&Answer]) -> Self {
        let mut bounds_off: Vec<f64> = answers.iter().map(|answer| answer.bounds_off()).collect();
        bounds_off.sort_by(f64::total_cmp);
        let inliers = bounds_off.partition_point(|&bounds| bounds <= OUTLIER_BOUNDS);
        let mean_square = bounds_off[..inliers].iter().map(|bounds| bounds * bounds).sum::<f64>() / inliers as f64;
        Self {
            draws,
            answered: answers.len(),
            outliers: answers.len() - inliers,
            rmse_bounds: (inliers > 0).then(|| mean_square.sqrt()),
            median_bounds: median(bounds_off),
            covered: answers.iter().filter(|answer| answer.is_covered()).count(),
            stated_over_scatter: median(answers.iter().filter_map(|answer| answer.std_uncertainty_rev_s).collect())
                .zip(median(answers.iter().map(|answer| answer.error_rev_s.abs()).collect()))
                .map(|(stated, error)| MEDIAN_STDS * stated / error),
        }
    }
}

/// A condition with what each method made of it.
pub(super) struct Scored {
    pub(super) condition: Condition,
    /// Mean of the bound over the draws, as a share of the speed.
    pub(super) bound_share: f64,
    pub(super) methods: Vec<MethodScore>,
}

struct Draw {
    bound_share: f64,
    /// One for each method; `None` where no rotor tone was found.
    answers: Vec<Option<Answer>>,
}

/// Draws a condition and scores it by some methods. `number` tells conditions apart: each has draws of its own.
pub(super) fn scored(
    condition: Condition,
    number: usize,
    draw_count: usize,
    methods: &[Method],
) -> Result<Scored, String> {
    let draws = drawn(draw_count, |draw| {
        condition.draw(&mut Pcg64::seed_from_u64((number as u64) << 32 | draw as u64), methods)
    })?;
    let answers_by =
        |index: usize| -> Vec<&Answer> { draws.iter().filter_map(|draw| draw.answers.get(index)?.as_ref()).collect() };
    Ok(Scored {
        condition,
        bound_share: draws.iter().map(|draw| draw.bound_share).sum::<f64>() / draws.len().max(1) as f64,
        methods: (0..methods.len()).map(|index| MethodScore::of(draws.len(), &answers_by(index))).collect(),
    })
}

impl Condition {
    fn draw(&self, random: &mut Pcg64, methods: &[Method]) -> Result<Draw, String> {
        let lines = self.tones.lines();
        let noise = Noise { colour: self.colour, power: tone_power(&lines) / 10_f64.powf(self.snr_db / 10.0) };
        let speed_rev_s = random.random_range(SPEED_REV_S);
        let turning = if self.wanders { WANDER } else { Turning::Steady };
        let rotor = Rotor { mean_rev_s: speed_rev_s, turning, lines, noise };
        let bound_rev_s = speed_bound_rev_s(&rotor.lines, &rotor.noise, speed_rev_s);
        let sound = rendered(&rotor, random);
        let mut signal = Signal::new(sound.samples_f32(), SAMPLE_RATE_HZ);
        let mut answers = Vec::new();
        for &method in methods {
            let analysis = heard(&mut signal, self.tones.asked()?, 1, method)?;
            let speed = match &analysis.outcome {
                Outcome::Ok(tone) => tone.speed(method),
                Outcome::NoRotorTone { .. } => None,
            };
            let truth_rev_s = mean_rev_s(&sound, &analysis.hover.segments);
            answers.push(speed.zip(truth_rev_s).map(|(speed, truth_rev_s)| Answer {
                error_rev_s: speed.speed.rev_s() - truth_rev_s,
                bound_rev_s,
                std_uncertainty_rev_s: speed.std_uncertainty_rev_s,
            }));
        }
        Ok(Draw { bound_share: bound_rev_s / speed_rev_s, answers })
    }
}

/// What hovertone says with the recommended settings but for the method.
pub(super) fn heard(
    source: &mut dyn hovertone::sound::SignalSource,
    tone: ToneConfig,
    rotor_count: u32,
    method: Method,
) -> Result<SpeedAnalysis, String> {
    source.rewind().map_err(|error| error.to_string())?;
    let rotors = RotorsConfig { count: rotor_count, ..RotorsConfig::default() };
    let config = Config { method, rotors, ..Config::for_tone(tone) };
    speed_from_source(source, &config, &mut |_| {}).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(error_rev_s: f64, std_uncertainty_rev_s: Option<f64>) -> Answer {
        Answer { error_rev_s, bound_rev_s: 0.1, std_uncertainty_rev_s }
    }

    #[test]
    fn outliers_and_missing_uncertainties_are_counted() {
        let answers = [answer(0.3, Some(0.15)), answer(-0.4, Some(0.19)), answer(2.1, None)];
        let score = MethodScore::of(4, &answers.iter().collect::<Vec<_>>());
        assert_eq!((score.draws, score.answered, score.outliers, score.covered), (4, 3, 1, 1));
        assert!((score.rmse_bounds.unwrap() - 12.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(score.median_bounds, Some(4.0));
        assert!((score.stated_over_scatter.unwrap() - MEDIAN_STDS * 0.17 / 0.4).abs() < 1e-12);
        assert_eq!(MethodScore::of(4, &[]).rmse_bounds, None);
    }

    /// A loud steady rotor is found by every method, near its speed.
    #[test]
    fn a_loud_rotor_is_found() {
        for tones in Tones::ALL {
            let condition = Condition { tones, colour: Colour::White, snr_db: 20.0, wanders: false };
            let draw = condition.draw(&mut Pcg64::seed_from_u64(9), &METHODS).unwrap();
            assert_eq!(draw.answers.len(), METHODS.len());
            for (answer, method) in draw.answers.iter().zip(METHODS) {
                let error_rev_s = answer.as_ref().unwrap().error_rev_s;
                assert!(error_rev_s.abs() < 0.1, "{tones:?} by {}: {error_rev_s} rev/s", method.name());
            }
        }
    }
}
