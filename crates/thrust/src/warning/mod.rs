//! Warnings about a thrust constant, each with a hint. They are values; nothing here prints.

mod hints;
mod text;

use crate::drift::Drift;
use crate::force::Force;
use crate::square_law::{ForceLaw, LoadRange};
use crate::warning_words::is_shifted_point;
use hovertone_vehicle::{COVERAGE_FACTOR, Estimate, KNOWN_MASS_SHARES, is_swamped};
use serde::Serialize;

/// A reason to doubt a thrust constant.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum ThrustWarning {
    /// A load disagrees with the others.
    LoadDoesNotFit {
        /// Name of the load, or of the row of a table.
        name: String,
        /// It is a row of a table.
        is_row: bool,
        /// Mass that would agree; absent for a bench run.
        mass_that_fits_kg: Option<f64>,
        /// Standard uncertainty of that mass.
        mass_that_fits_std_kg: Option<f64>,
        /// Off by a factor, and left out of the fit.
        is_left_out: bool,
    },
    /// All loads, or all rows of a table, disagree: there are no others that agree.
    LoadsDisagree {
        /// Names of the loads or rows.
        names: Vec<String>,
        /// They are rows of a table.
        are_rows: bool,
        /// A load has an added mass, which may be that of vehicle and load together by mistake.
        has_added_mass: bool,
        /// Of two loads: the mass of each that would agree with the other. Else empty.
        masses_that_fit_kg: Vec<f64>,
    },
    /// A trial needs another thrust than the others of its load.
    TrialFarFromOthers {
        /// Name of its load.
        load: String,
        /// Name of its recording.
        recording: String,
        /// Its ω² over that of the others, minus 1.
        thrust_share: f64,
    },
    /// The trials of a load lie in groups of speeds, as trials of several masses do.
    TrialsInGroups {
        /// Name of the load.
        load: String,
        /// Mean speed of each group, slowest first.
        groups_rev_s: Vec<f64>,
    },
    /// The constants of loads with one recording each differ by more than any law or weather explains.
    ConstantsDiffer {
        /// The load with the smallest constant.
        least: String,
        /// The load with the largest one.
        most: String,
        /// Largest over smallest constant, minus 1.
        share: f64,
        /// The share that the stated uncertainties of both forces explain, k = 2.
        stated_share: f64,
    },
    /// The few trials of a load need different thrusts.
    TrialsDiffer {
        /// Name of the load.
        load: String,
        /// The recording that needs the least thrust.
        least: String,
        /// The recording that needs the most.
        most: String,
        /// Largest over smallest ω², minus 1.
        thrust_share: f64,
    },
    /// The rotors turned slower under the heavier of two loads.
    HeavierTurnedSlower {
        /// Name of the heavier load, or of its rows.
        heavy: String,
        /// Name of the lighter load, or of its rows.
        light: String,
    },
    /// A load that is far from the mass of the known vehicle.
    MassFarFromKnown {
        /// Name of the load.
        load: String,
        /// Its mass as flown.
        mass_kg: f64,
        /// Mass of the preset or of the model.
        known_kg: f64,
    },
    /// Most recordings say that another rotor sounds than that of the vehicle.
    VehicleDoesNotFit {
        /// Recordings with a speed in which the tone of the vehicle is hardly heard.
        hardly_heard: usize,
        /// Recordings in which the lines of another rotor are heard.
        elsewhere: usize,
        /// All recordings.
        of: usize,
    },
    /// Many rows of a table disagree with the others.
    RowsDoNotFit {
        /// Names of the rows.
        names: Vec<String>,
        /// Off by a factor, and left out of the fit.
        are_left_out: bool,
    },
    /// A trial is off by a factor from all others, and left out of the fit.
    TrialLeftOut {
        /// Name of its load.
        load: String,
        /// Name of its recording.
        recording: String,
    },
    /// Half of the constants or more are off by a factor from the others.
    ConstantsSplit,
    /// One fit has bench runs and hovers.
    MixedBenchAndHover,
    /// There is only one load, and nothing to compare it with.
    SingleLoad,
    /// Every load has one recording: none shows how much the speed differs from flight to flight.
    OneRecordingEach {
        /// Number of loads.
        load_count: usize,
    },
    /// All loads have the same weight.
    EqualLoads {
        /// Number of loads.
        count: usize,
    },
    /// The loads are too similar to show an intercept.
    NarrowLoadRange(LoadRange),
    /// The evidence prefers another law than F = C ω².
    OtherLawPreferred {
        /// The preferred law.
        law: ForceLaw,
        /// Its probability among the three laws.
        probability: f64,
    },
    /// The constant changes over time.
    ConstantDrifts(Drift),
    /// A thrust coefficient that no propeller has.
    ImplausibleThrustCoefficient {
        /// F / (ρ n² D⁴).
        propeller: f64,
    },
    /// A figure of merit that no rotor has.
    ImplausibleFigureOfMerit {
        /// Name of the load or row.
        name: String,
        /// T √(T/(2 ρ A)) / P.
        figure_of_merit: f64,
    },
    /// Some rows of a table have no uncertainty, so the uncertainties of the other rows are not used.
    UncertaintiesIncomplete {
        /// Rows with an uncertainty.
        stated: usize,
        /// All rows.
        of: usize,
    },
    /// The mass comes from a preset or a model, which describes another specimen.
    MassNotWeighed {
        /// The mass that was used.
        mass_kg: f64,
    },
    /// Several rotors run, and one ridge follows the loudest of them.
    LoudestRotor,
    /// The expanded uncertainty (k = 2) of the constant is larger than the constant.
    TooUncertain {
        /// The expanded uncertainty over the constant.
        share: f64,
        /// The constant comes from the rows of a table.
        is_of_rows: bool,
    },
}

impl ThrustWarning {
    /// Whether the answer is incomplete: the constant must not be used, or the loads contradict each other and nothing shows which is right.
    pub fn makes_incomplete(&self) -> bool {
        self.forbids_use() || matches!(self, Self::LoadsDisagree { .. })
    }

    /// Whether its hint says not to use the constant: it is of no vehicle, of none of the loads, or nothing was measured.
    pub fn forbids_use(&self) -> bool {
        matches!(
            self,
            Self::HeavierTurnedSlower { .. }
                | Self::ConstantsDiffer { .. }
                | Self::ConstantsSplit
                | Self::TooUncertain { .. }
        ) || self.is_of_other_vehicle()
    }

    /// The warning that a constant is smaller than its own ±.
    pub(crate) fn of_uncertainty(constant: Estimate, is_of_rows: bool) -> Option<Self> {
        let std = constant.std_uncertainty.filter(|std| is_swamped(constant.value, *std))?;
        Some(Self::TooUncertain { share: COVERAGE_FACTOR * std / constant.value, is_of_rows })
    }

    /// Whether the sound is not that of the vehicle, or a mass is ten times too light or too heavy for it: then the constant is of no vehicle.
    pub fn is_of_other_vehicle(&self) -> bool {
        match self {
            Self::VehicleDoesNotFit { .. } => true,
            Self::MassFarFromKnown { mass_kg, known_kg, .. } => is_shifted_point(mass_kg / known_kg),
            _ => false,
        }
    }

    /// The warning about the load that is farthest from the mass of the known vehicle, where one is outside of [`KNOWN_MASS_SHARES`].
    pub fn of_masses<'a>(loads: impl IntoIterator<Item = (&'a str, Force)>, known_kg: f64) -> Option<Self> {
        let masses = loads.into_iter().filter_map(|(name, force)| Some((name, force.mass_kg()?)));
        let distance = |mass_kg: f64| (mass_kg / known_kg).ln().abs();
        let far = masses.filter(|(_, mass_kg)| !KNOWN_MASS_SHARES.contains(&(mass_kg / known_kg)));
        let (name, mass_kg) = far.max_by(|(_, a_kg), (_, b_kg)| distance(*a_kg).total_cmp(&distance(*b_kg)))?;
        Some(Self::MassFarFromKnown { load: name.to_owned(), mass_kg, known_kg })
    }

    /// Whether trials or masses seem to stand at the wrong load.
    pub(crate) fn is_of_misfiled(&self) -> bool {
        matches!(
            self,
            Self::LoadsDisagree { .. }
                | Self::TrialFarFromOthers { .. }
                | Self::TrialsDiffer { .. }
                | Self::ConstantsDiffer { .. }
                | Self::TrialsInGroups { .. }
                | Self::HeavierTurnedSlower { .. }
        )
    }
}
