//! The model that a fit starts from: the numbers of the vehicle, and the mean speed of the flight where that is far from their hover.

use super::flight::GreyBoxVehicle;
use crate::failure::Failure;
use crate::job::{Job, Requests};
use crate::progress::Progress;
use crate::recording::{Hearing, records_of};
use hovertone_dynamics::{GreyBoxModel, SoundConfig, SpeedObservation};
use hovertone_report::OtherHover;
use hovertone_vehicle::{KNOWN_MASS_SHARES, RotorSpeed};
use std::path::Path;

/// The start of a fit.
pub(super) struct Start {
    pub(super) model: GreyBoxModel,
    /// Where the flight is far from the hover of the vehicle's numbers.
    pub(super) other_hover: Option<OtherHover>,
}

impl Start {
    /// The vehicle's numbers; with the mean speed of the flight in place of their hover speed, where the given mass puts this out of reach of the
    /// fit. A speed at which the vehicle flies with no payload that it can carry is that of another vehicle, and no start.
    pub(super) fn near(vehicle: &GreyBoxVehicle, flown: Option<RotorSpeed>) -> Self {
        let model = vehicle.model_of(vehicle.mass_kg);
        let expected = RotorSpeed::from_rad_s(model.mean_hover_rad_s());
        let reach_share = SoundConfig::default().hover_share;
        let is_far = |flown: &RotorSpeed| (flown.rad_s() / expected.rad_s() - 1.0).abs() > reach_share;
        // the weight of a hover is proportional to the squared speed
        let mass_that_hovers_kg = |flown: &RotorSpeed| vehicle.mass_kg * (flown.rad_s() / expected.rad_s()).powi(2);
        let flies_at = |flown: &RotorSpeed| {
            let mass_share = mass_that_hovers_kg(flown) / vehicle.parameters.mass_kg.value;
            let slack = (1.0 + reach_share).powi(2);
            (KNOWN_MASS_SHARES.start() / slack..=KNOWN_MASS_SHARES.end() * slack).contains(&mass_share)
        };
        match flown.filter(is_far).filter(flies_at) {
            None => Self { model, other_hover: None },
            Some(flown) => Self {
                model: vehicle.model_of(mass_that_hovers_kg(&flown)),
                other_hover: Some(OtherHover { flown_rev_s: flown.rev_s(), expected_rev_s: expected.rev_s() }),
            },
        }
    }
}

/// Mean speed of the rotors of a recording, heard without the mass, which may be wrong. `None` where no speed is sure.
pub(super) fn heard_mean(
    recording: &Path,
    vehicle: &GreyBoxVehicle,
    hearing: Hearing,
    progress: &Progress,
) -> Result<Option<RotorSpeed>, Failure> {
    let job = Job {
        name: recording.display().to_string(),
        path: recording.to_owned(),
        config: vehicle.mean_config()?,
        discovery: None,
        requests: Requests::default(),
        sha256: None,
        samples: None,
    };
    let record = records_of(&[job], hearing, progress).pop();
    let is_sure = |record: &hovertone_report::SpeedRecord| record.contradiction().is_none();
    Ok(record.filter(is_sure).and_then(|record| Some(record.speed()?.speed)))
}

/// Mean speed of the rotors over all observations.
pub(super) fn mean_of(observations: &[SpeedObservation]) -> Option<RotorSpeed> {
    let means = || observations.iter().map(|observation| observation.speed_rad_s.mean());
    let mean_rad_s = means().sum::<f64>() / observations.len().max(1) as f64;
    (mean_rad_s > 0.0).then(|| RotorSpeed::from_rad_s(mean_rad_s))
}
