//! The paper's experiment and its printed results.
//!
//! Pizetta, Brandao, Pizziolo, Sarcinelli-Filho, "Spectrogram Analysis: An Approach to Identify The Quadrotor Thrust
//! Model", preprints201808.0313 v1: an AR.Drone hovers with three loads, five trials of 10 s each.
//!
//! Misprints, as checked by arithmetic. The C_f columns are `m · 9.80 / ω²` of the whole weight, in 1e-5 N s² (the
//! heading has 1e-4); velocities are rpm and rad/s of the propeller (the headings say 10³ rpm, 10² rad/s, motor);
//! the headline 28.5180e-4 and 28.5290e-4 N s² are the plain means of the columns, a hundred times too large; and the
//! masses behind the columns are 413, 444 and 472 g, while the text has 413, 442 and 462 g. With 413, 444 and 462 g
//! the three constants agree within 0.16 %.

use hovertone_vehicle::RotorSpeed;

/// Gravity in the printed constants, m/s². At the authors' places it is 9.785 and 9.787.
pub const GRAVITY_M_S2: f64 = 9.80;
/// Trials of each load.
pub const TRIAL_COUNT: u32 = 5;
/// Length of a trial.
pub const TRIAL_S: f64 = 10.0;
/// Rotors of the AR.Drone.
pub const ROTOR_COUNT: usize = 4;
/// Order of the tone that the paper follows, its `n · r` in eq 6: the 69 teeth of the rotor's gear wheel.
pub const TONE_ORDER: u32 = 69;
/// Mean of table 1's C_f column, N s² for the whole vehicle; printed as 28.5180e-4.
pub const TABLE_1_MEAN_THRUST_CONSTANT_N_S2: f64 = 2.8518e-5;
/// Mean of table 2's C_f column, N s² for the whole vehicle; printed as 28.5290e-4.
pub const TABLE_2_MEAN_THRUST_CONSTANT_N_S2: f64 = 2.8529e-5;

/// One row of one of the paper's tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedRow {
    /// "Propeller Velocity": rpm, printed as 10³ rpm.
    pub speed_rpm: f64,
    /// "STD", rpm; only in table 1.
    pub spread_rpm: Option<f64>,
    /// "Motor Angular Velocity ω": the propeller's, rad/s, printed as 10² rad/s.
    pub speed_rad_s: f64,
    /// C_f of the whole vehicle, N s²: the printed number times 1e-5 (the heading has 1e-4).
    pub thrust_constant_total_n_s2: f64,
}

/// One load of the experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperLoad {
    /// The load.
    pub name: &'static str,
    /// Mass with which the printed speeds give one thrust constant; the simulated mass.
    pub mass_kg: f64,
    /// Mass that the text and the tables print.
    pub printed_mass_kg: f64,
    /// Mass that reproduces the printed C_f column.
    pub column_mass_kg: f64,
    /// Table 1, maximum trace.
    pub table_1: PrintedRow,
    /// Table 2, Gaussian approximation.
    pub table_2: PrintedRow,
}

const fn row_1(speed_rpm: f64, spread_rpm: f64, speed_rad_s: f64, thrust_constant_total_n_s2: f64) -> PrintedRow {
    PrintedRow { speed_rpm, spread_rpm: Some(spread_rpm), speed_rad_s, thrust_constant_total_n_s2 }
}

const fn row_2(speed_rpm: f64, speed_rad_s: f64, thrust_constant_total_n_s2: f64) -> PrintedRow {
    PrintedRow { speed_rpm, spread_rpm: None, speed_rad_s, thrust_constant_total_n_s2 }
}

/// The three loads, lightest first.
pub const LOADS: [PaperLoad; 3] = [
    PaperLoad {
        name: "no hull",
        mass_kg: 0.413,
        printed_mass_kg: 0.413,
        column_mass_kg: 0.413,
        table_1: row_1(3610.3438, 44.4916, 378.07, 2.8315e-5),
        table_2: row_2(3608.1298, 377.8425, 2.8350e-5),
    },
    PaperLoad {
        name: "small hull",
        mass_kg: 0.444,
        printed_mass_kg: 0.442,
        column_mass_kg: 0.444,
        table_1: row_1(3742.0275, 48.3813, 391.86, 2.8336e-5),
        table_2: row_2(3740.0479, 391.6569, 2.8366e-5),
    },
    PaperLoad {
        // The tables say "Bug Hull".
        name: "big hull",
        mass_kg: 0.462,
        printed_mass_kg: 0.462,
        column_mass_kg: 0.472,
        table_1: row_1(3820.1625, 47.7473, 400.05, 2.8903e-5),
        table_2: row_2(3822.284, 400.2686, 2.8871e-5),
    },
];

impl PaperLoad {
    /// Mean shaft speed of the rotors, from table 1.
    pub fn speed(&self) -> RotorSpeed {
        RotorSpeed::from_rpm(self.table_1.speed_rpm)
    }

    /// Thrust constant of the whole vehicle in the simulated trials of this load, N s²: `m g / ω²`.
    pub fn thrust_constant_total_n_s2(&self) -> f64 {
        self.mass_kg * GRAVITY_M_S2 / self.speed().rad_s().powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both tables follow from their own rpm column with the masses that the module's text names.
    #[test]
    fn the_printed_columns_follow_from_the_printed_speeds() {
        for load in LOADS {
            for row in [load.table_1, load.table_2] {
                let speed_rad_s = RotorSpeed::from_rpm(row.speed_rpm).rad_s();
                assert!((speed_rad_s - row.speed_rad_s).abs() < 5e-3, "{}: {speed_rad_s}", load.name);
                let constant = load.column_mass_kg * GRAVITY_M_S2 / speed_rad_s.powi(2);
                assert!((constant - row.thrust_constant_total_n_s2).abs() < 0.5e-9 + 1e-14, "{}", load.name);
            }
        }
        let mean = |row: fn(&PaperLoad) -> PrintedRow| {
            LOADS.iter().map(|load| row(load).thrust_constant_total_n_s2).sum::<f64>() / 3.0
        };
        assert!((mean(|load| load.table_1) - TABLE_1_MEAN_THRUST_CONSTANT_N_S2).abs() < 1e-14);
        assert!((mean(|load| load.table_2) - TABLE_2_MEAN_THRUST_CONSTANT_N_S2).abs() < 1e-14);
    }

    #[test]
    fn the_simulated_masses_give_one_constant_within_0_16_percent() {
        let constants = LOADS.map(|load| load.thrust_constant_total_n_s2());
        for (constant, expected) in constants.into_iter().zip([2.8315e-5, 2.8336e-5, 2.8291e-5]) {
            assert!((constant - expected).abs() < 0.5e-9, "{constant}");
        }
        let (low, high) = (constants[2], constants[1]);
        assert!((high / low - 1.0 - 0.0016).abs() < 0.0001, "{}", high / low - 1.0);
    }
}
