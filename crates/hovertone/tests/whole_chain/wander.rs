//! Many hovers of one rotor that wanders: the mean by the harmonic likelihood, and whether its ± holds.
use crate::testkit::{analyse, config, recording, rotor, tone};
use hovertone::speed::Config;
use hovertone_sim::Span;
use hovertone_sim::prescribed::SineWander;
use rand::{RngExt, SeedableRng};

const DRAWS: u64 = 15;
const LENGTH_S: f64 = 5.0;
/// Standard deviation of the wander as a share, and the number and frequencies of its sines.
const WANDER_STD_SHARE: f64 = 0.004;
const SWINGS: usize = 4;
const SWING_HZ: std::ops::Range<f64> = 0.05..1.2;

#[test]
fn the_mean_of_a_wandering_rotor_is_known_to_a_few_millionths_and_its_uncertainty_holds() {
    let mesh: Vec<(f64, f64)> = vec![(69.0, 0.05), (138.0, 0.025), (207.0, 0.0125)];
    let blade_pass: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), 0.05 / f64::from(k))).collect();
    for (name, order, lines, rms_share_max) in [("mesh", 69.0, mesh, 4e-6), ("blade pass", 2.0, blade_pass, 15e-6)] {
        let config = Config { all_methods: false, ..config(order) };
        let (mut covered, mut squares) = (0, 0.0);
        for seed in 0..DRAWS {
            let mut random = rand_pcg::Pcg64::seed_from_u64(1000 + seed);
            let mean_rev_s = random.random_range(50.0..70.0);
            let wander = SineWander::drawn(WANDER_STD_SHARE, SWINGS, SWING_HZ, &mut random);
            let rotor = rotor(|time_s| mean_rev_s * (1.0 + wander.at(time_s)), &lines);
            let recording = recording(&[rotor], LENGTH_S, 0.05, seed);
            let analysis = analyse(recording.samples_f32(), &config);
            let got = &tone(&analysis).speeds[0];
            let heard: Vec<Span> =
                analysis.hover.segments.iter().map(|span| Span { from_s: span.from_s, to_s: span.to_s }).collect();
            let truth = recording.truth().mean_speed_over(0, &heard).expect("a hover within the recording");
            let error_rev_s = got.speed.rev_s() - truth.rev_s();
            let std_rev_s = got.std_uncertainty_rev_s.expect("an uncertainty");
            assert!(error_rev_s.abs() < 6.0 * std_rev_s, "{name} {seed}: off by {error_rev_s}, u {std_rev_s}");
            covered += u32::from(error_rev_s.abs() <= 2.0 * std_rev_s);
            squares += (error_rev_s / mean_rev_s).powi(2);
        }
        let rms_share = (squares / DRAWS as f64).sqrt();
        assert!(rms_share < rms_share_max, "{name}: rms error {rms_share:e}");
        // of 15 at 95 %, 11 or fewer are covered once in two hundred times
        assert!(covered >= 12, "{name}: {covered} of {DRAWS} within 2 u");
    }
}
