//! What comes in from the log: commands and what the controller measures, on an even grid.

use hovertone_signal::statistics::median;
use hovertone_vehicle::Axis;
use hovertone_vehicle::FlightParameters;

/// Limits of the step of the grid on which the model runs, s. *Numeric*: between two points the model is straight, so that gains are off by the
/// square of the step; a tenth of the shortest time constant of a motor makes that 0.1 %, a twentieth 0.02 %.
const STEP_S_MIN: f64 = 0.001;
const STEP_S_MAX: f64 = 0.002;
/// Longest interval between log rows over which a signal is known, s. *Physics*: an attitude changes within that.
const GAP_S_MAX: f64 = 0.5;

/// Commands and measurements of the embedded controller over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlLog {
    /// Times of the log rows, increasing, on the clock of the recording.
    pub time_s: Vec<f64>,
    /// u of each loop, ±1; absent where the log does not have it.
    pub command: [Option<Vec<f64>>; 4],
    /// Roll and pitch angle, rad; yaw rate, rad/s; vertical rate, m/s.
    pub measured: [Option<Vec<f64>>; 4],
    /// Rates of roll and pitch angle, rad/s; differences of the angles where absent.
    pub tilt_rate_rad_s: [Option<Vec<f64>>; 2],
}

/// What is known of the controller without a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlKnowns {
    /// Angle, angle, yaw rate and vertical rate at a command of 1 (remark 1).
    pub scales: [f64; 4],
    /// Time constant of the filter on the derivatives of the two rates.
    pub derivative_filter_s: f64,
    /// The mixer of eq 1: rows are rotors, columns loops.
    pub mixer: [[f64; 4]; 4],
    /// Mean distance of the rotors from the axes of roll and pitch.
    pub lever_m: [f64; 2],
}

impl ControlKnowns {
    /// Those of a vehicle.
    pub fn of(vehicle: &FlightParameters) -> Self {
        let controller = &vehicle.controller;
        let (tilt, layout) = (controller.tilt_rad_max.value, vehicle.layout.value);
        let sign = |value: f64| if value.abs() < 1e-9 { 0.0 } else { value.signum() };
        let (directions, spins) = (layout.hub_directions(), layout.spins());
        let mean_lever_m = |axis: usize| {
            vehicle.arm_length_m.value * directions.iter().map(|direction| direction[axis].abs()).sum::<f64>() / 4.0
        };
        Self {
            scales: [tilt, tilt, controller.yaw_rate_rad_s_max.value, controller.climb_m_s_max.value],
            derivative_filter_s: controller.derivative_filter_s.value,
            mixer: std::array::from_fn(|k| [sign(directions[k][1]), -sign(directions[k][0]), -spins[k], 1.0]),
            lever_m: [mean_lever_m(1), mean_lever_m(0)],
        }
    }
}

/// Wanted and measured values of the loops on an even grid of times.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopInputs {
    /// Time of the first point.
    pub start_s: f64,
    /// Step of the grid.
    pub step_s: f64,
    /// Median interval of the log rows.
    pub row_s: f64,
    /// Wanted value of each loop at each point; zeros for a loop that the log does not have.
    pub wanted: Vec<[f64; 4]>,
    /// Measured value and its rate.
    pub measured: Vec<[f64; 4]>,
    /// Rates of the measured values. The wanted value counts as constant between commands, as on board, so that these alone make e'.
    pub measured_rate: Vec<[f64; 4]>,
    /// Which loops the log has.
    pub has_loop: [bool; 4],
    /// The mixer.
    pub mixer: [[f64; 4]; 4],
    /// As [`ControlKnowns::lever_m`].
    pub lever_m: [f64; 2],
    /// For each point, whether a log row is near.
    pub is_known: Vec<bool>,
}

impl LoopInputs {
    /// The errors; `None` for fewer than two log rows, or times that do not increase.
    pub fn from_log(log: &ControlLog, knowns: &ControlKnowns) -> Option<Self> {
        let intervals_s: Vec<f64> = log.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if intervals_s.iter().any(|interval_s| interval_s.is_nan() || *interval_s <= 0.0) {
            return None;
        }
        let (start_s, end_s) = (*log.time_s.first()?, *log.time_s.last()?);
        let row_s = median(&intervals_s)?;
        // log rows are points of the grid, where they are even
        let step_s = (row_s / (row_s / STEP_S_MAX).ceil()).clamp(STEP_S_MIN, STEP_S_MAX);
        let count = ((end_s - start_s) / step_s).floor() as usize + 1;
        let grid = Grid { time_s: &log.time_s, start_s, step_s, count };
        let mut inputs = Self {
            start_s,
            step_s,
            row_s,
            wanted: vec![[0.0; 4]; count],
            measured: vec![[0.0; 4]; count],
            measured_rate: vec![[0.0; 4]; count],
            has_loop: [false; 4],
            mixer: knowns.mixer,
            lever_m: knowns.lever_m,
            is_known: grid.known(),
        };
        for axis in Axis::ALL {
            let at = axis as usize;
            let (Some(command), Some(measured)) = (&log.command[at], &log.measured[at]) else { continue };
            inputs.has_loop[at] = true;
            let measured = grid.smooth(measured);
            let rate = match log.tilt_rate_rad_s.get(at).and_then(Option::as_ref) {
                Some(rate) => grid.smooth(rate),
                None => filtered_rate(&measured, step_s, if at < 2 { 0.0 } else { knowns.derivative_filter_s }),
            };
            for (point, u) in grid.held(command).into_iter().enumerate() {
                inputs.wanted[point][at] = knowns.scales[at] * u;
                inputs.measured[point][at] = measured[point];
                inputs.measured_rate[point][at] = rate[point];
            }
        }
        Some(inputs)
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.is_known.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.is_known.is_empty()
    }

    /// Time of the last point.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.step_s * self.len().saturating_sub(1) as f64
    }

    /// Whether the log knows the whole of a span.
    pub fn knows(&self, from_s: f64, to_s: f64) -> bool {
        let (from, to) = ((from_s - self.start_s) / self.step_s, (to_s - self.start_s) / self.step_s);
        from >= 0.0
            && to <= (self.len() as f64 - 1.0)
            && self.is_known[from as usize..=(to as usize)].iter().all(|is_known| *is_known)
    }
}

/// The even grid over the log rows.
struct Grid<'a> {
    time_s: &'a [f64],
    start_s: f64,
    step_s: f64,
    count: usize,
}

impl Grid<'_> {
    /// For each point, the last log row at or before it.
    fn rows(&self) -> impl Iterator<Item = (usize, f64)> {
        let mut row = 0;
        (0..self.count).map(move |point| {
            // a hair later, so that a point on a row takes the row
            let time_s = self.start_s + (point as f64 + 1e-6) * self.step_s;
            while self.time_s.get(row + 1).is_some_and(|next_s| *next_s <= time_s) {
                row += 1;
            }
            (row, time_s)
        })
    }

    fn known(&self) -> Vec<bool> {
        let near = |(row, time_s): (usize, f64)| {
            let next_s = self.time_s.get(row + 1).copied().unwrap_or(time_s);
            next_s - self.time_s[row] <= GAP_S_MAX
        };
        self.rows().map(near).collect()
    }

    fn held(&self, values: &[f64]) -> Vec<f64> {
        self.rows().map(|(row, _)| values[row]).collect()
    }

    /// Values between rows on the cubic whose slopes at the rows are those of parabolas through three rows.
    fn smooth(&self, values: &[f64]) -> Vec<f64> {
        let slope = |from: usize, to: usize| (values[to] - values[from]) / (self.time_s[to] - self.time_s[from]);
        let last = values.len() - 1;
        let slope_at = |row: usize| {
            if row == 0 || row == last {
                return slope(row.saturating_sub(1), (row + 1).min(last));
            }
            let [before_s, behind_s] =
                [self.time_s[row] - self.time_s[row - 1], self.time_s[row + 1] - self.time_s[row]];
            (slope(row - 1, row) * behind_s + slope(row, row + 1) * before_s) / (before_s + behind_s)
        };
        let between = |(row, time_s): (usize, f64)| {
            if row >= last {
                return values[last];
            }
            let (next, length_s) = (row + 1, self.time_s[row + 1] - self.time_s[row]);
            let slopes = [slope_at(row), slope_at(next)];
            let share = (time_s - self.time_s[row]) / length_s;
            let (rest, straight) = (1.0 - share, values[next] - values[row]);
            let bends = [slopes[0] * length_s - straight, straight - slopes[1] * length_s];
            values[row] + share * straight + share * rest * (rest * bends[0] + share * bends[1])
        };
        self.rows().map(between).collect()
    }
}

/// Rate of change through a filter of first order, as on board; 0 at the first point.
fn filtered_rate(values: &[f64], step_s: f64, filter_s: f64) -> Vec<f64> {
    let keep = if filter_s > 0.0 { (-step_s / filter_s).exp() } else { 0.0 };
    let (mut filtered, mut before) = (0.0, values.first().copied().unwrap_or(0.0));
    let rate = |value: &f64| {
        filtered = keep * filtered + (1.0 - keep) * (value - before) / step_s;
        before = *value;
        filtered
    };
    values.iter().map(rate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_rows_a_smooth_signal_is_bent_and_the_rows_are_kept() {
        // uneven rows
        let time_s: Vec<f64> =
            (0..100).map(|row| 0.02 * f64::from(row) + if row % 3 == 0 { 0.004 } else { 0.0 }).collect();
        let at = |time_s: f64| (6.0 * time_s).sin();
        let values: Vec<f64> = time_s.iter().map(|time_s| at(*time_s)).collect();
        let grid = Grid { time_s: &time_s, start_s: time_s[0], step_s: 0.001, count: 1900 };
        // a straight line is off by length² times curvature over 8
        let straight = 0.024_f64.powi(2) * 36.0 / 8.0;
        for (point, value) in grid.smooth(&values).into_iter().enumerate().skip(40) {
            let time_s = time_s[0] + 0.001 * point as f64;
            assert!((value - at(time_s)).abs() < straight / 5.0, "{time_s}: {value} {}", at(time_s));
        }
        // a point on a row is a hair behind it
        assert!((grid.smooth(&values)[0] - values[0]).abs() < 1e-7);
        let two = Grid { time_s: &[0.0, 1.0], start_s: 0.0, step_s: 0.25, count: 6 };
        let line = [0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
        assert!(two.smooth(&[0.0, 4.0]).iter().zip(line).all(|(value, of_line)| (value - of_line).abs() < 1e-5));
    }
}
