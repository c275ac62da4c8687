//! A recording with its truth and with what can be said of its vehicle.

use super::super::answer::{Answer, Status};
use super::super::cases::{Truth, TruthSet};
use super::super::program::Program;
use super::super::semi_real;
use super::super::truth_track::TruthTrack;
use super::comparison::{Compared, SpeedError};
use hovertone_vehicle::find_preset;
use std::path::PathBuf;

/// The vehicle whose single rotors most semi-real recordings are made of.
const SMALL: &str = "crazyflie";
/// Names of the semi-real recordings that are made of one 9450 propeller (`motor-step` of the recordings).
const BIG: [&str; 2] = ["big", "step"];
const BIG_DIAMETER_M: f64 = 9.4 * 0.0254;

/// What is said of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Said {
    Nothing,
    Blades,
    BladesRotors,
    BladesDiameter,
    BladesRotorsDiameter,
    Vehicle,
}

impl Said {
    const ALL: [Self; 6] = [
        Self::Nothing,
        Self::Blades,
        Self::BladesRotors,
        Self::BladesDiameter,
        Self::BladesRotorsDiameter,
        Self::Vehicle,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Blades => "blades",
            Self::BladesRotors => "blades, rotors",
            Self::BladesDiameter => "blades, diameter",
            Self::BladesRotorsDiameter => "blades, rotors, diameter",
            Self::Vehicle => "vehicle",
        }
    }
}

/// What is said without a fact, and with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ways {
    pub(super) less: Said,
    pub(super) more: Said,
}

/// The comparisons: each of `--rotors`, `--diameter-m` and `--vehicle` with and without.
pub(super) const FACTS: [Ways; 6] = [
    Ways { less: Said::Blades, more: Said::BladesRotors },
    Ways { less: Said::BladesDiameter, more: Said::BladesRotorsDiameter },
    Ways { less: Said::Blades, more: Said::BladesDiameter },
    Ways { less: Said::BladesRotors, more: Said::BladesRotorsDiameter },
    Ways { less: Said::Nothing, more: Said::Vehicle },
    Ways { less: Said::Blades, more: Said::Vehicle },
];

/// A recording to hear.
pub(super) struct Subject {
    pub(super) set: &'static str,
    pub(super) name: String,
    pub(super) sound: PathBuf,
    pub(super) track: TruthTrack,
    pub(super) blades: u32,
    pub(super) rotors: usize,
    pub(super) diameter_m: Option<f64>,
    pub(super) preset: Option<&'static str>,
}

impl Subject {
    /// A semi-real recording.
    pub(super) fn semi_real(set: &TruthSet, truth: &Truth) -> Result<Self, String> {
        let csv = truth.truth_csv.as_ref().ok_or_else(|| format!("{}: it has no table of speeds", truth.file))?;
        let is_big = BIG.iter().any(|part| truth.file.contains(part));
        let small = find_preset(SMALL).filter(|_| !is_big);
        let diameter_m = small.and_then(|vehicle| vehicle.propeller_diameter_m).map(|diameter| diameter.value);
        Ok(Self {
            set: semi_real::NAME,
            name: truth.file.clone(),
            sound: set.path(&truth.file),
            track: TruthTrack::read(&set.path(csv))?,
            blades: truth.blades.ok_or_else(|| format!("{}: its blades are not known", truth.file))?,
            rotors: truth.speeds_rev_s.len(),
            diameter_m: if is_big { Some(BIG_DIAMETER_M) } else { diameter_m },
            preset: small.map(|vehicle| vehicle.id),
        })
    }

    /// Hears the recording in all ways, and compares.
    pub(super) fn compared(&self, program: &Program) -> Result<Vec<Compared>, String> {
        let mut heard = Vec::new();
        for said in Said::ALL {
            if let Some(flags) = self.flags(said) {
                heard.push((said, self.error_of(&program.speed(&flags, &self.sound)?)?));
            }
        }
        let of = |said: Said| heard.iter().find(|(one, _)| *one == said).map(|(_, error)| *error);
        let compared = FACTS.into_iter().filter_map(|ways| {
            let (less, more) = (of(ways.less)?, of(ways.more)?);
            Some(Compared { set: self.set, recording: self.name.clone(), ways, less, more })
        });
        Ok(compared.collect())
    }

    /// The flags that say it; `None` where it is not known.
    fn flags(&self, said: Said) -> Option<Vec<String>> {
        let blades = || vec!["--blades".to_owned(), self.blades.to_string()];
        let rotors = || vec!["--rotors".to_owned(), self.rotors.to_string()];
        let diameter = || Some(vec!["--diameter-m".to_owned(), self.diameter_m?.to_string()]);
        let parts = match said {
            Said::Nothing => Vec::new(),
            Said::Blades => vec![blades()],
            Said::BladesRotors => vec![blades(), rotors()],
            Said::BladesDiameter => vec![blades(), diameter()?],
            Said::BladesRotorsDiameter => vec![blades(), rotors(), diameter()?],
            // on a bench, one rotor of the vehicle runs
            Said::Vehicle if self.rotors == 1 => vec![vec!["--vehicle".to_owned(), self.preset?.to_owned()], rotors()],
            Said::Vehicle => vec![vec!["--vehicle".to_owned(), self.preset?.to_owned()]],
        };
        Some(parts.concat())
    }

    /// The error of an answer over its own stretch; absent without a speed.
    fn error_of(&self, answer: &Answer) -> Result<Option<SpeedError>, String> {
        if matches!(answer.status, Status::Error | Status::Timeout) {
            return Err(format!("{}: {}", self.name, answer.reason.as_deref().unwrap_or(answer.status.name())));
        }
        let (Some(speed_rev_s), Some(std_rev_s)) = (answer.speed_rev_s, answer.combined_std_uncertainty_rev_s) else {
            return Ok(None);
        };
        let stretch = self.track.over(answer.from_s.unwrap_or(0.0), answer.to_s.unwrap_or(f64::INFINITY));
        let true_rev_s = stretch.mean_rev_s();
        let (error_share, std_share) = (speed_rev_s / true_rev_s - 1.0, std_rev_s / true_rev_s);
        Ok(Some(SpeedError { error_share, std_share }))
    }
}
