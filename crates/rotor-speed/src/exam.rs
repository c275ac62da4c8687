//! What an exam of the evidence wants to see: the lines of a rotor whose speed is known, and the speeds that the evidence compared.

use crate::config::Config;
use crate::error::Error;
use crate::evidence::{LinesNear, RotorLines, lines_near};
use crate::pipeline::survey_from_passes;
use crate::stages::{beliefs_of, passes_of_survey};
use crate::tone::search_range_rev_s;
use hovertone_signal::SignalSource;
use hovertone_signal::passes::Passes;

/// The evidence of a recording, beside a known speed.
#[derive(Clone, Debug, Default)]
pub struct EvidenceNear {
    /// The lines near the known speed, in short frames. `None` without a band.
    pub lines: Option<LinesNear>,
    /// Evidence of the levels near the known speed, of short and long frames together.
    pub levels_nats: Option<f64>,
    /// The speeds that were compared, most probable first; empty where no rotor is heard.
    pub speeds: Vec<ComparedSpeed>,
}

/// A speed that was compared with others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedSpeed {
    /// Mean speed along its path.
    pub speed_rev_s: f64,
    /// Its probability among them.
    pub belief: f64,
}

/// The evidence of a recording, beside a speed that is known: one pass.
///
/// # Errors
/// Settings without a meaning, a source that fails, a band above half the sample rate.
pub fn evidence_near(source: &mut dyn SignalSource, speed_rev_s: f64, config: &Config) -> Result<EvidenceNear, Error> {
    let mut unseen = |_| {};
    let passes = &mut Passes::planned(source, passes_of_survey(), &mut unseen)?;
    let surveyed = survey_from_passes(passes, config)?;
    let (looks, rotor) = (&surveyed.looks, RotorLines::of_tone(&config.tone));
    let range_rev_s = search_range_rev_s(&config.tone, passes.sample_rate_hz())?;
    let beliefs = beliefs_of(&surveyed, range_rev_s, config);
    let compared = beliefs.iter().flat_map(|beliefs| &beliefs.hypotheses);
    let lines = lines_near(&looks.short, speed_rev_s, &rotor, &config.evidence.levels);
    let long = lines_near(&looks.long, speed_rev_s, &rotor, &config.evidence.levels);
    Ok(EvidenceNear {
        levels_nats: lines.as_ref().zip(long).map(|(short, long)| short.levels_nats + long.levels_nats),
        lines,
        speeds: compared.map(|it| ComparedSpeed { speed_rev_s: it.speed_rev_s, belief: it.belief }).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::ToneConfig;
    use hovertone_signal::Signal;
    use hovertone_vehicle::Order;
    use std::f64::consts::TAU;

    /// Lines at orders 2, 4, … of 80 rev/s, 6 dB less with each harmonic, in noise.
    fn rotor() -> Signal {
        let (mut state, rate_hz) = (1_u32, 16_000.0);
        let sample = |n: usize| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
            let line =
                |k: i32| 0.1 * 0.5_f64.powi(k - 1) * (TAU * 2.0 * f64::from(k) * 80.0 * n as f64 / rate_hz).cos();
            (0.05 * noise + (1..6).map(line).sum::<f64>()) as f32
        };
        Signal::new((0..64_000).map(sample).collect(), rate_hz)
    }

    #[test]
    fn the_lines_of_a_known_rotor_have_their_levels() {
        let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
        let seen = evidence_near(&mut rotor(), 81.0, &config).unwrap();
        let lines = seen.lines.unwrap();
        // a bin of 2.5 Hz at the highest audible orders
        assert!((lines.speed_rev_s - 80.0).abs() < 2.5 / 8.0, "{}", lines.speed_rev_s);
        let level = |order: u32| lines.levels.iter().find(|it| it.order == order).unwrap().level_db;
        // white noise has the same floor at all lines; levels are told in steps of 0.36 dB
        for (order, fall_db) in [(2, 6.0), (4, 6.0), (6, 6.0)] {
            let found_db = level(order) - level(order + 2);
            assert!((found_db - fall_db).abs() < 1.5, "{order}: {found_db}");
        }
        assert!(level(3) < level(8) - 6.0 && lines.noise.mean_db < 0.0, "{} {:?}", level(3), lines.noise);
        assert!(lines.votes_nats > config.evidence.votes_nats_min && seen.levels_nats.unwrap() > 10.0);
        assert!((seen.speeds[0].speed_rev_s - 80.0).abs() < 0.5 && seen.speeds[0].belief > 0.5, "{:?}", seen.speeds);
    }
}
