//! The truth about a sound at prescribed speeds.

use hovertone_vehicle::RotorSpeed;
use std::f64::consts::TAU;

/// From one instant to another, in seconds from the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Start.
    pub from_s: f64,
    /// End.
    pub to_s: f64,
}

/// One rotor at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorTruth {
    /// Shaft speed at this instant, turns per second.
    pub speed_rev_s: f64,
    /// Turns since the first sample: the integral of the speed as the sound has it, summed over every sample.
    pub turns: f64,
    /// Integral of the squared angular speed since the first sample, rad²/s, summed over every sample.
    pub square_integral_rad2_s: f64,
}

/// All rotors at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthRow {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// The rotors, in the order of the settings.
    pub rotors: Vec<RotorTruth>,
}

/// The rows of a whole sound, and means over any span of it.
///
/// A [`HoverSound`](super::HoverSound) has a row every [`truth_step_s`](super::HoverSettings::truth_step_s), a
/// [`Recording`](super::Recording) one at each node of its sampling; both have a last row at the end.
///
/// Means are exact (sums over the samples as rendered) for spans that begin and end on a row. Between two rows, `h` apart,
/// the speed counts as constant: a mean square over `T` then has the relative standard error `2 √(D h³ / 24) / T` with
/// `D = 2 std² / τ` of an Ornstein-Uhlenbeck wander; 2.5e-6 for 1.2 %, 0.3 s, 10 ms and 5 s.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    rows: Vec<TruthRow>,
}

impl Truth {
    /// From rows in the order of time.
    pub fn from_rows(rows: Vec<TruthRow>) -> Self {
        Self { rows }
    }

    /// The rows, ordered by time.
    pub fn rows(&self) -> &[TruthRow] {
        &self.rows
    }

    /// Mean shaft speed of a rotor over `from_s..to_s`. `None` for an empty span, one that is not within the sound, or a
    /// rotor that is not there.
    pub fn mean_speed(&self, rotor: usize, from_s: f64, to_s: f64) -> Option<RotorSpeed> {
        self.mean(from_s, to_s, |row| Some(row.rotors.get(rotor)?.turns)).map(RotorSpeed::from_rev_s)
    }

    /// Mean shaft speed of a rotor over several spans together. `None` as for [`mean_speed`](Self::mean_speed).
    pub fn mean_speed_over(&self, rotor: usize, spans: &[Span]) -> Option<RotorSpeed> {
        let turns = |row: &TruthRow| Some(row.rotors.get(rotor)?.turns);
        let length_s: f64 = spans.iter().map(|span| span.to_s - span.from_s).sum();
        let turned = |span: &Span| Some(self.at(span.to_s, &turns)? - self.at(span.from_s, &turns)?);
        let turned: f64 = spans.iter().map(turned).sum::<Option<f64>>()?;
        (length_s > 0.0).then(|| RotorSpeed::from_rev_s(turned / length_s))
    }

    /// Shaft speed of each rotor at an instant, turns per second; straight between rows. `None` for an instant that is not
    /// within the sound.
    pub fn speeds_rev_s_at(&self, time_s: f64) -> Option<Vec<f64>> {
        let speed = |rotor: usize| self.at(time_s, &|row: &TruthRow| Some(row.rotors.get(rotor)?.speed_rev_s));
        (0..self.rows.first()?.rotors.len()).map(speed).collect()
    }

    /// Mean of a rotor's squared angular speed, rad²/s². `None` as for [`mean_speed`](Self::mean_speed).
    pub fn mean_square(&self, rotor: usize, from_s: f64, to_s: f64) -> Option<f64> {
        self.mean(from_s, to_s, |row| Some(row.rotors.get(rotor)?.square_integral_rad2_s))
    }

    /// Mean of the sum of the rotors' squared angular speeds, rad²/s²; in hover it is proportional to the weight. `None` for
    /// an empty span and for one that is not within the sound.
    pub fn mean_sum_of_squares(&self, from_s: f64, to_s: f64) -> Option<f64> {
        self.mean(from_s, to_s, |row| Some(row.rotors.iter().map(|rotor| rotor.square_integral_rad2_s).sum()))
    }

    /// Thrust constant of one rotor, N s²: `C = m g / mean(Σ ω_i²)` (the paper's eq 3 with hover balance). `None` as
    /// for [`mean_sum_of_squares`](Self::mean_sum_of_squares), and when no rotor turns.
    pub fn thrust_constant_per_rotor_n_s2(
        &self,
        mass_kg: f64,
        gravity_m_s2: f64,
        from_s: f64,
        to_s: f64,
    ) -> Option<f64> {
        let squares = self.mean_sum_of_squares(from_s, to_s).filter(|&squares| squares > 0.0)?;
        Some(mass_kg * gravity_m_s2 / squares)
    }

    /// Thrust constant of the whole vehicle, N s²: that of one rotor times the number of rotors. The paper's tables print
    /// this one (total weight over ω² of equal rotors).
    pub fn thrust_constant_total_n_s2(&self, mass_kg: f64, gravity_m_s2: f64, from_s: f64, to_s: f64) -> Option<f64> {
        let per_rotor = self.thrust_constant_per_rotor_n_s2(mass_kg, gravity_m_s2, from_s, to_s)?;
        Some(per_rotor * self.rows.first()?.rotors.len() as f64)
    }

    fn mean(&self, from_s: f64, to_s: f64, integral: impl Fn(&TruthRow) -> Option<f64>) -> Option<f64> {
        if to_s <= from_s {
            return None;
        }
        Some((self.at(to_s, &integral)? - self.at(from_s, &integral)?) / (to_s - from_s))
    }

    /// A number of the rows at an instant; straight between rows.
    fn at(&self, time_s: f64, number: &impl Fn(&TruthRow) -> Option<f64>) -> Option<f64> {
        let last = self.rows.last()?;
        // A span computed from seconds may miss the ends by rounding.
        let rounding_s = 1e-9 * last.time_s.max(1.0);
        if !(-rounding_s..=last.time_s + rounding_s).contains(&time_s) {
            return None;
        }
        let above = self.rows.partition_point(|row| row.time_s < time_s).min(self.rows.len() - 1);
        let row = &self.rows[above];
        let after = number(row)?;
        if above == 0 {
            return Some(after);
        }
        let row_before = &self.rows[above - 1];
        let before = number(row_before)?;
        let share = (time_s - row_before.time_s) / (row.time_s - row_before.time_s);
        Some(before + share.min(1.0) * (after - before))
    }
}

impl RotorTruth {
    /// Angular speed at this instant, rad/s.
    pub fn speed_rad_s(&self) -> f64 {
        TAU * self.speed_rev_s
    }
}
