//! The true speed of each rotor at every instant, where a table has it.

use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::Path;

/// Rows this far outside the stretch still count: more than half the step of the tables.
const MARGIN_S: f64 = 0.03;

/// A table of true speeds.
pub(super) struct TruthTrack {
    rows: Vec<TruthRow>,
}

struct TruthRow {
    time_s: f64,
    /// One for each rotor.
    speeds_rev_s: Vec<f64>,
}

/// What the rotors did over a stretch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TrueSpeeds {
    /// The mean of each rotor.
    pub(super) means_rev_s: Vec<f64>,
    pub(super) slowest_rev_s: f64,
    pub(super) fastest_rev_s: f64,
    /// Over all rotors.
    pub(super) mean_square_rad2_s2: f64,
}

impl TrueSpeeds {
    /// The mean over the rotors.
    pub(super) fn mean_rev_s(&self) -> f64 {
        self.means_rev_s.iter().sum::<f64>() / self.means_rev_s.len() as f64
    }
}

impl TruthTrack {
    /// Reads a table `time_s,rotor1_rev_s,…` with one line of heads.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Self::from_csv(&text).ok_or_else(|| format!("{}: no table of speeds", path.display()))
    }

    /// Reads the truth of a simulated flight, whose columns of speeds are `speed_1_rad_s`, ….
    pub(super) fn read_flight(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Self::from_flight(&text).ok_or_else(|| format!("{}: no table of a flight", path.display()))
    }

    fn from_flight(text: &str) -> Option<Self> {
        let heads: Vec<&str> = text.lines().next()?.split(',').collect();
        let time = heads.iter().position(|head| *head == "time_s")?;
        let is_speed = |head: &str| head.starts_with("speed_") && head.ends_with("_rad_s");
        let speeds: Vec<usize> = (0..heads.len()).filter(|&column| is_speed(heads[column])).collect();
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |column: usize| cells.get(column)?.trim().parse::<f64>().ok();
            let speeds = speeds.iter().map(|&column| Some(RotorSpeed::from_rad_s(number(column)?).rev_s()));
            Some(TruthRow { time_s: number(time)?, speeds_rev_s: speeds.collect::<Option<_>>()? })
        };
        let rows: Vec<TruthRow> = text.lines().skip(1).map(row).collect::<Option<_>>()?;
        (!rows.is_empty() && !speeds.is_empty()).then_some(Self { rows })
    }

    pub(super) fn rotor_count(&self) -> usize {
        self.rows.first().map_or(0, |row| row.speeds_rev_s.len())
    }

    fn from_csv(text: &str) -> Option<Self> {
        let numbers = |line: &str| line.split(',').map(|cell| cell.trim().parse().ok()).collect::<Option<Vec<f64>>>();
        let rows = text.lines().skip(1).map(|line| match numbers(line)?.as_slice() {
            [time_s, speeds @ ..] if !speeds.is_empty() => {
                Some(TruthRow { time_s: *time_s, speeds_rev_s: speeds.to_vec() })
            }
            _ => None,
        });
        let rows: Vec<TruthRow> = rows.collect::<Option<_>>()?;
        let count = rows.first()?.speeds_rev_s.len();
        rows.iter().all(|row| row.speeds_rev_s.len() == count).then_some(Self { rows })
    }

    /// The speeds over a stretch; over the whole table where the stretch holds no row.
    pub(super) fn over(&self, from_s: f64, to_s: f64) -> TrueSpeeds {
        let is_inside = |row: &&TruthRow| (from_s - MARGIN_S..=to_s + MARGIN_S).contains(&row.time_s);
        let mut rows: Vec<&TruthRow> = self.rows.iter().filter(is_inside).collect();
        if rows.is_empty() {
            rows = self.rows.iter().collect();
        }
        let rotors = rows[0].speeds_rev_s.len();
        let all = || rows.iter().flat_map(|row| row.speeds_rev_s.iter().copied());
        let mean_of = |rotor: usize| rows.iter().map(|row| row.speeds_rev_s[rotor]).sum::<f64>() / rows.len() as f64;
        let sum_of_squares: f64 = all().map(|speed| (std::f64::consts::TAU * speed).powi(2)).sum();
        TrueSpeeds {
            means_rev_s: (0..rotors).map(mean_of).collect(),
            slowest_rev_s: all().fold(f64::INFINITY, f64::min),
            fastest_rev_s: all().fold(f64::NEG_INFINITY, f64::max),
            mean_square_rad2_s2: sum_of_squares / (rows.len() * rotors) as f64,
        }
    }

    #[cfg(test)]
    pub(super) fn of_text(text: &str) -> Self {
        Self::from_csv(text).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::TruthTrack;

    const TABLE: &str = "time_s,rotor1_rev_s,rotor2_rev_s\n0,10,20\n1,12,20\n2,14,20\n";

    #[test]
    fn the_stretch_chooses_the_rows() {
        let track = TruthTrack::of_text(TABLE);
        let all = track.over(0.0, 9.0);
        assert_eq!((all.means_rev_s.as_slice(), all.mean_rev_s()), (&[12.0, 20.0][..], 16.0));
        assert_eq!((all.slowest_rev_s, all.fastest_rev_s), (10.0, 20.0));
        assert_eq!(track.over(0.98, 1.5).means_rev_s, [12.0, 20.0]);
        assert_eq!(track.over(1.2, 1.5).means_rev_s, [12.0, 20.0], "no row: all rows");
        let square = track.over(1.0, 1.0).mean_square_rad2_s2 / std::f64::consts::TAU.powi(2);
        assert!((square - 272.0).abs() < 1e-9, "{square}");
    }

    #[test]
    fn the_speeds_of_a_flight_are_found_among_its_columns() {
        let text = "time_s,voltage_1_v,speed_1_rad_s,speed_2_rad_s,x_m\n0,11,6.283185307179586,12.566370614359172,0\n";
        let track = TruthTrack::from_flight(text).unwrap();
        assert_eq!(track.rotor_count(), 2);
        assert!((track.over(0.0, 1.0).mean_rev_s() - 1.5).abs() < 1e-12);
        assert!(TruthTrack::from_flight("time_s,x_m\n0,1\n").is_none());
    }

    #[test]
    fn what_is_no_table_is_refused() {
        for text in ["", "time_s,a\n", "time_s,a\n0,x\n", "time_s\n0\n", "time_s,a\n0,1\n1,2,3\n"] {
            assert!(TruthTrack::from_csv(text).is_none(), "{text}");
        }
    }
}
