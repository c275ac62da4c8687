//! The acoustic scale: with a known thrust constant, what hovers weighs C ω²/g.

use crate::statistics::{mean, std};
use hovertone_vehicle::{Ending, Estimate, RotorSpeed};
use serde::Serialize;

/// A hover as it was heard, in one recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeardHover {
    /// Mean shaft speed.
    pub speed: RotorSpeed,
    /// Its standard uncertainty, where the method tells.
    pub std_uncertainty_rev_s: Option<f64>,
}

/// What hovered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeighedHover {
    /// All that hovers.
    pub mass_kg: Estimate,
    /// What it carries beside itself, where the vehicle's own mass is known.
    pub payload_kg: Option<Estimate>,
    /// Mean shaft speed of all recordings.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Recordings in which it was heard.
    pub recording_count: usize,
}

/// Mass of all that hovers: m = C ω²/g, with C the constant of the whole vehicle, and of the payload: that less the vehicle's own.
/// u²(m)/m² = u²(C)/C² + 4 u²(ω)/ω² + u²(g)/g². The speed's uncertainty is the scatter of the recordings or what the method says
/// of them, whichever is larger. `None` where nothing was heard.
///
/// That one ridge follows the loudest rotor cancels as far as the same rotor was loudest when C was found.
pub fn weighed_hover(
    thrust_constant_total_n_s2: Estimate,
    hovers: &[HeardHover],
    gravity_m_s2: f64,
    gravity_std_m_s2: f64,
    vehicle_mass_kg: Option<Estimate>,
) -> Option<WeighedHover> {
    let constant = thrust_constant_total_n_s2;
    let speeds: Vec<f64> = hovers.iter().map(|hover| hover.speed.rad_s()).collect();
    let speed_rad_s = mean(&speeds)?;
    let count = speeds.len() as f64;
    let stds: Vec<f64> =
        hovers.iter().filter_map(|hover| Some(RotorSpeed::from_rev_s(hover.std_uncertainty_rev_s?).rad_s())).collect();
    let speed_std_rad_s =
        [std(&speeds), mean(&stds)].into_iter().flatten().reduce(f64::max).map(|std| std / count.sqrt());
    let value = constant.value * speed_rad_s.powi(2) / gravity_m_s2;
    let ending = if hovers.len() > 1 { Ending::Solved } else { Ending::SingleObservation };
    let share = constant.std_uncertainty.zip(speed_std_rad_s).map(|(constant_std, speed_std)| {
        (constant_std / constant.value).hypot(2.0 * speed_std / speed_rad_s).hypot(gravity_std_m_s2 / gravity_m_s2)
    });
    let mass_kg = Estimate { value, std_uncertainty: share.map(|share| share * value), ending };
    let payload = |vehicle: Estimate| Estimate {
        value: value - vehicle.value,
        std_uncertainty: mass_kg.std_uncertainty.map(|std| std.hypot(vehicle.std_uncertainty.unwrap_or(0.0))),
        ending,
    };
    Some(WeighedHover {
        mass_kg,
        payload_kg: vehicle_mass_kg.map(payload),
        speed: RotorSpeed::from_rad_s(speed_rad_s),
        recording_count: hovers.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, std_uncertainty: f64) -> Estimate {
        Estimate { value, std_uncertainty: Some(std_uncertainty), ending: Ending::Solved }
    }

    /// The paper's hulls by its no-hull row: 443.68 and 462.40 g (table 1), and what they add to 413 g.
    #[test]
    fn the_papers_speeds_weigh_its_hulls() {
        let constant_n_s2 = 0.413 * 9.8 / RotorSpeed::from_rpm(3610.3438).rad_s().powi(2);
        let constant = estimate(constant_n_s2, 0.005 * constant_n_s2);
        for (rpm, expected_kg) in [(3742.0275, 0.44368), (3820.1625, 0.46240)] {
            let speed = RotorSpeed::from_rpm(rpm);
            let hover = HeardHover { speed, std_uncertainty_rev_s: Some(0.0025 * speed.rev_s()) };
            let weighed = weighed_hover(constant, &[hover], 9.8, 0.0, Some(estimate(0.413, 0.0005))).unwrap();
            let mass = weighed.mass_kg;
            assert!((mass.value - expected_kg).abs() < 5e-6, "{mass:?}");
            assert!((mass.std_uncertainty.unwrap() / mass.value - 0.005f64.hypot(0.005)).abs() < 2e-5, "{mass:?}");
            let payload = weighed.payload_kg.unwrap();
            assert!((payload.value - (expected_kg - 0.413)).abs() < 5e-6, "{payload:?}");
            assert!(payload.std_uncertainty.unwrap() > mass.std_uncertainty.unwrap());
        }
    }

    #[test]
    fn recordings_that_disagree_say_so_in_the_uncertainty() {
        let constant = estimate(2.83e-5, 0.0);
        let hover =
            |rev_s: f64| HeardHover { speed: RotorSpeed::from_rev_s(rev_s), std_uncertainty_rev_s: Some(0.001) };
        let apart = weighed_hover(constant, &[hover(60.0), hover(60.6)], 9.8, 0.0, None).unwrap();
        let mass = apart.mass_kg;
        // two speeds 1 % apart: their mean is known to 0.5 %, the mass to 1 %
        assert!((mass.std_uncertainty.unwrap() / mass.value - 0.01).abs() < 2e-4, "{mass:?}");
        assert!(apart.payload_kg.is_none() && weighed_hover(constant, &[], 9.8, 0.0, None).is_none());
    }
}
