//! A state as a row of a table.

use crate::flight::FlightState;

/// Columns of `truth.csv`.
const COUNT: usize = 42;

/// Names of the cells of [`truth_cells`], with their units. Rotors are in the order of the vehicle's layout.
pub const TRUTH_COLUMNS: [&str; COUNT] = [
    "time_s",
    "command_roll",
    "command_pitch",
    "command_yaw_rate",
    "command_climb",
    "voltage_1_v",
    "voltage_2_v",
    "voltage_3_v",
    "voltage_4_v",
    "speed_1_rad_s",
    "speed_2_rad_s",
    "speed_3_rad_s",
    "speed_4_rad_s",
    "thrust_1_n",
    "thrust_2_n",
    "thrust_3_n",
    "thrust_4_n",
    "torque_1_n_m",
    "torque_2_n_m",
    "torque_3_n_m",
    "torque_4_n_m",
    "x_m",
    "y_m",
    "z_m",
    "velocity_x_m_s",
    "velocity_y_m_s",
    "velocity_z_m_s",
    "attitude_w",
    "attitude_x",
    "attitude_y",
    "attitude_z",
    "roll_deg",
    "pitch_deg",
    "yaw_deg",
    "roll_rate_rad_s",
    "pitch_rate_rad_s",
    "yaw_rate_rad_s",
    "battery_v",
    "wind_x_m_s",
    "wind_y_m_s",
    "wind_z_m_s",
    "total_thrust_n",
];

/// The cells of one row, in the order of [`TRUTH_COLUMNS`].
pub fn truth_cells(state: &FlightState) -> [f64; COUNT] {
    let euler = state.euler();
    let degrees = [euler.roll_rad, euler.pitch_rad, euler.yaw_rad].map(f64::to_degrees);
    let groups: [&[f64]; 14] = [
        &[state.time_s],
        &state.command.to_array(),
        &state.voltage_v,
        &state.speed_rad_s,
        &state.thrust_n,
        &state.torque_n_m,
        &state.position_m,
        &state.velocity_m_s,
        &state.attitude,
        &degrees,
        &state.rates_rad_s,
        &[state.battery_v],
        &state.wind_m_s,
        &[state.thrust_n.iter().sum()],
    ];
    let mut cells = [0.0; COUNT];
    for (cell, value) in cells.iter_mut().zip(groups.concat()) {
        *cell = value;
    }
    cells
}
