//! A simulated experiment compared with the numbers of the paper and with the truth of its sound.

use crate::number::{DASH, PowerOfTen, signed};
use crate::text_table::{Column, TextTable};
use crate::thrust::{CONSTANT_UNIT, constant_cell, grams, speed_cells};
use hovertone_thrust::{LoadThrust, ThrustTable};
use hovertone_vehicle::Estimate;
use std::iter::zip;

/// The unit of the paper's columns with the correct power of ten.
const PAPER_UNIT: PowerOfTen = PowerOfTen::exact(-5);

/// A printed row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedRow {
    /// Propeller speed.
    pub speed_rpm: f64,
    /// Standard deviation of the speed, where it was printed.
    pub spread_rpm: Option<f64>,
    /// Propeller speed in the second printed unit.
    pub speed_rad_s: f64,
    /// Constant of the whole vehicle.
    pub thrust_constant_total_n_s2: f64,
}

/// The truth of the sound of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTruth {
    /// Name of the load.
    pub name: String,
    /// Force that its rotors balance.
    pub force_n: f64,
    /// Number of rotors of the vehicle.
    pub rotor_count: u32,
    /// For each trial, the mean over time of the sum of the squared speeds of the rotors.
    pub mean_sum_of_squares_rad2_s2: Vec<f64>,
}

impl LoadTruth {
    /// Constant of the whole vehicle: the force over the mean of Σω², times the number of rotors.
    pub fn thrust_constant_total_n_s2(&self) -> f64 {
        let squares = &self.mean_sum_of_squares_rad2_s2;
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        f64::from(self.rotor_count) * self.force_n / mean
    }
}

/// The table of one method with the columns of the paper. `printed` has one row for each load.
pub fn comparison_with_paper(table: &ThrustTable, printed: &[PrintedRow]) -> TextTable {
    let mut text = TextTable::new(vec![
        Column::words("load"),
        Column::numbers("mass", "g"),
        Column::numbers("speed", "rpm"),
        Column::numbers("paper", ""),
        Column::numbers("STD", "rpm"),
        Column::numbers("paper", ""),
        Column::numbers("ω", "rad/s"),
        Column::numbers("paper", ""),
        Column::numbers("C_f, vehicle", &PAPER_UNIT.unit(CONSTANT_UNIT)),
        Column::numbers("paper", ""),
    ]);
    for (load, paper) in zip(&table.loads, printed) {
        let [speed_rpm, spread_rpm, speed_rad_s] = speed_cells(load);
        text.push(vec![
            load.name.clone(),
            load.mass_kg.map_or(DASH.to_owned(), grams),
            speed_rpm,
            format!("{:.1}", paper.speed_rpm),
            spread_rpm,
            paper.spread_rpm.map_or(DASH.to_owned(), |spread| format!("{spread:.1}")),
            speed_rad_s,
            format!("{:.2}", paper.speed_rad_s),
            constant_cell(load.thrust_constant_total_n_s2, PAPER_UNIT),
            format!("{:.4}", PAPER_UNIT.scale(paper.thrust_constant_total_n_s2)),
        ]);
    }
    text
}

/// The constant of the whole vehicle from every load by every method, and its deviation from the truth. `truths` has one entry for each
/// load.
pub fn comparison_with_truth(tables: &[ThrustTable], truths: &[LoadTruth]) -> TextTable {
    let mut columns = vec![Column::words("C_f, vehicle"), Column::numbers("truth", &PAPER_UNIT.unit(CONSTANT_UNIT))];
    for table in tables {
        columns.push(Column::numbers(table.title(), &PAPER_UNIT.unit(CONSTANT_UNIT)));
        columns.push(Column::numbers("error", "%"));
    }
    let mut text = TextTable::new(columns);
    for (index, truth) in truths.iter().enumerate() {
        let truth_n_s2 = truth.thrust_constant_total_n_s2();
        let mut cells = vec![truth.name.clone(), format!("{:.4}", PAPER_UNIT.scale(truth_n_s2))];
        for table in tables {
            let constant = table.loads.get(index).and_then(|load: &LoadThrust| load.thrust_constant_total_n_s2);
            cells.push(constant_cell(constant, PAPER_UNIT));
            cells.push(constant.map_or(DASH.to_owned(), |constant| error_percent(constant, truth_n_s2)));
        }
        text.push(cells);
    }
    text
}

fn error_percent(constant: Estimate, truth: f64) -> String {
    signed(100.0 * (constant.value / truth - 1.0), 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Ending;

    #[test]
    fn the_truth_is_the_weight_over_the_mean_of_the_squares() {
        // 4 rotors at 400 rad/s and at 100: means of Σω² of 640,000 and 40,000
        let truth = LoadTruth {
            name: String::new(),
            force_n: 3.4,
            rotor_count: 4,
            mean_sum_of_squares_rad2_s2: vec![640_000.0, 40_000.0],
        };
        assert!((truth.thrust_constant_total_n_s2() - 4.0 * 3.4 / 340_000.0).abs() < 1e-18);
    }

    #[test]
    fn an_error_has_a_sign() {
        let constant = |value| Estimate { value, std_uncertainty: None, ending: Ending::Solved };
        assert_eq!(error_percent(constant(0.995), 1.0), "−0.50");
        assert_eq!(error_percent(constant(1.0012), 1.0), "+0.12");
    }
}
