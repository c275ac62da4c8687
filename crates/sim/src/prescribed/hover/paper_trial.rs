//! The paper's experiment as hovers at prescribed speeds.

use super::settings::{HoverSettings, RotorSound};
use crate::paper::{PaperLoad, ROTOR_COUNT, TRIAL_S};
use crate::seed::{Part, mixed};
use crate::sound::ToneSettings;
use hovertone_vehicle::RotorSpeed;

/// The choices that the paper leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperSimulation {
    /// All random numbers come from this seed.
    pub seed: u64,
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Difference of mean speed between neighbouring rotors, as a share. 0 by default, since the paper gives one speed per
    /// load. Real rotors differ; with 0.01 to 0.02 the loudest rotor biases C_f by the maximum trace by 2 to 4 %.
    pub rotor_spacing_share: f64,
}

impl Default for PaperSimulation {
    fn default() -> Self {
        Self { seed: 1, sample_rate_hz: 48_000, rotor_spacing_share: 0.0 }
    }
}

impl PaperSimulation {
    /// The settings of one trial. `m g = C Σω²` holds exactly over the trial, with one C for all trials of a load,
    /// [`PaperLoad::thrust_constant_total_n_s2`] `/ 4`. Wander, noise, levels and phases differ from trial to trial.
    pub fn trial(&self, load: &PaperLoad, trial: u32) -> HoverSettings {
        let spread = |rotor: usize| 1.0 + self.rotor_spacing_share * (rotor as f64 - (ROTOR_COUNT as f64 - 1.0) / 2.0);
        let mean_square = (0..ROTOR_COUNT).map(|rotor| spread(rotor).powi(2)).sum::<f64>() / ROTOR_COUNT as f64;
        let speed_rad_s = load.speed().rad_s() / mean_square.sqrt();
        let rotor = |rotor| RotorSound::at(RotorSpeed::from_rad_s(speed_rad_s * spread(rotor)));
        // The seed depends on the mass of the load: a trial stays the same when loads are added or reordered.
        let load_seed = mixed(self.seed, Part::Trial, load.mass_kg.to_bits());
        HoverSettings {
            sample_rate_hz: self.sample_rate_hz,
            duration_s: TRIAL_S,
            rotors: (0..ROTOR_COUNT).map(rotor).collect(),
            tones: ToneSettings::default(),
            hold_hover_balance: true,
            seed: mixed(load_seed, Part::Trial, u64::from(trial)),
            ..HoverSettings::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{GRAVITY_M_S2, LOADS};
    use crate::prescribed::HoverSound;

    #[test]
    fn every_trial_hovers_by_the_same_constant() {
        for rotor_spacing_share in [0.0, 0.01] {
            let simulation = PaperSimulation { rotor_spacing_share, ..PaperSimulation::default() };
            for load in &LOADS {
                let mut first_samples = Vec::new();
                for trial in 0..2 {
                    let settings = HoverSettings { duration_s: 2.0, ..simulation.trial(load, trial) };
                    let (samples, truth) = HoverSound::new(settings).unwrap().render_all();
                    let constant = truth.thrust_constant_total_n_s2(load.mass_kg, GRAVITY_M_S2, 0.0, 2.0).unwrap();
                    assert!((constant / load.thrust_constant_total_n_s2() - 1.0).abs() < 1e-12, "{constant}");
                    let speeds: Vec<_> = (0..4).map(|rotor| truth.mean_speed(rotor, 0.0, 2.0).unwrap()).collect();
                    assert!(speeds.windows(2).all(|pair| pair[0] != pair[1]));
                    first_samples.push(samples[0]);
                }
                assert_ne!(first_samples[0], first_samples[1], "trials repeat one another");
            }
        }
    }
}
