//! The maneuvers in time: setpoint and commands at every instant.

use super::ScenarioError;
use super::command_table::CommandTable;
use super::maneuver::Maneuver;
use crate::control::Setpoint;
use hovertone_vehicle::Axis;
use std::collections::BTreeMap;

/// Length of a flight without maneuvers: the paper's trial.
const HOVER_S: f64 = 10.0;

/// Setpoint and commands at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instruction {
    /// The pilot's setpoint.
    pub setpoint: Setpoint,
    /// Commands that replace the pilot's: roll, pitch, yaw rate, climb.
    pub driven: [Option<f64>; 4],
    /// Whether the motors run.
    pub motors_on: bool,
    /// Whether this counts as hovering.
    pub is_hover: bool,
}

/// All maneuvers in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    legs: Vec<Leg>,
    /// After the last leg.
    rest: Instruction,
}

#[derive(Clone, Debug, PartialEq)]
struct Leg {
    from_s: f64,
    to_s: f64,
    from: Setpoint,
    to: Setpoint,
    motors_on: bool,
    drive: Drive,
    is_hover: bool,
}

#[derive(Clone, Debug, PartialEq)]
enum Drive {
    Nothing,
    Axis(Axis, f64),
    Table(CommandTable),
}

impl Schedule {
    /// Places the maneuvers in time, beginning at `start`; `tables` has the text of every command file.
    pub(super) fn new(
        maneuvers: &[Maneuver],
        start: Setpoint,
        on_ground: bool,
        tables: &BTreeMap<String, String>,
    ) -> Result<Self, ScenarioError> {
        let mut layout = Layout { legs: Vec::new(), now_s: 0.0, at: start, motors_on: !on_ground };
        for maneuver in maneuvers {
            layout.add(maneuver, tables)?;
        }
        let Layout { legs, at, motors_on, .. } = layout;
        let rest = Instruction { setpoint: at, driven: [None; 4], motors_on, is_hover: motors_on };
        Ok(Self { legs, rest })
    }

    /// End of the last maneuver; the length of a trial without maneuvers.
    pub fn end_s(&self) -> f64 {
        self.legs.last().map_or(HOVER_S, |leg| leg.to_s)
    }

    /// Setpoint and commands at a time.
    pub fn at(&self, time_s: f64) -> Instruction {
        let index = self.legs.partition_point(|leg| leg.to_s <= time_s);
        let Some(leg) = self.legs.get(index) else { return self.rest };
        let share = ((time_s - leg.from_s) / (leg.to_s - leg.from_s)).clamp(0.0, 1.0);
        let between = |from: f64, to: f64| from + share * (to - from);
        let setpoint = Setpoint {
            position_m: std::array::from_fn(|axis| between(leg.from.position_m[axis], leg.to.position_m[axis])),
            yaw_rad: between(leg.from.yaw_rad, leg.to.yaw_rad),
        };
        let driven = match &leg.drive {
            Drive::Nothing => [None; 4],
            Drive::Axis(axis, amount) => Axis::ALL.map(|known| (known == *axis).then_some(*amount)),
            Drive::Table(table) => table.at(time_s - leg.from_s),
        };
        Instruction { setpoint, driven, motors_on: leg.motors_on, is_hover: leg.is_hover }
    }
}

/// A schedule under construction.
struct Layout {
    legs: Vec<Leg>,
    now_s: f64,
    at: Setpoint,
    motors_on: bool,
}

impl Layout {
    fn add(&mut self, maneuver: &Maneuver, tables: &BTreeMap<String, String>) -> Result<(), ScenarioError> {
        let flies = self.motors_on || matches!(maneuver, Maneuver::Hover { .. } | Maneuver::TakeOff { .. });
        if !flies {
            return Err(ScenarioError::Contradiction {
                what: "a maneuver needs a flying vehicle, but the vehicle stands on the ground".to_owned(),
                hint: "write a [[maneuver]] with kind = \"take_off\" before it",
            });
        }
        match maneuver {
            Maneuver::Hover { duration_s } => {
                let is_hover = self.motors_on;
                self.leg("hover duration_s", *duration_s, self.at, Drive::Nothing, is_hover)?;
            }
            Maneuver::Step { axis, amount, duration_s } => {
                self.leg("step duration_s", *duration_s, self.at, Drive::Axis(*axis, command(*amount)?), false)?;
            }
            Maneuver::Doublet { axis, amount, half_s, repeat, pause_s } => {
                let amount = command(*amount)?;
                if *repeat == 0 {
                    return Err(ScenarioError::out_of_range("doublet repeat", 0.0, "1 or more"));
                }
                for _ in 0..*repeat {
                    self.leg("doublet half_s", *half_s, self.at, Drive::Axis(*axis, amount), false)?;
                    self.leg("doublet half_s", *half_s, self.at, Drive::Axis(*axis, -amount), false)?;
                    if *pause_s != 0.0 {
                        self.leg("doublet pause_s", *pause_s, self.at, Drive::Nothing, false)?;
                    }
                }
            }
            Maneuver::Climb { height_m, duration_s } => {
                self.fly("climb duration_s", *duration_s, [0.0, 0.0, *height_m])?;
            }
            Maneuver::Square { side_m, side_s } => {
                let (sin, cos) = self.at.yaw_rad.sin_cos();
                for [ahead, left] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
                    let by_m = [side_m * (cos * ahead - sin * left), side_m * (sin * ahead + cos * left), 0.0];
                    self.fly("square side_s", *side_s, by_m)?;
                }
            }
            Maneuver::FlyTo { position_m, yaw_deg, duration_s } => {
                let yaw_rad = yaw_deg.map_or(self.at.yaw_rad, f64::to_radians);
                let to = Setpoint { position_m: *position_m, yaw_rad };
                self.leg("fly_to duration_s", *duration_s, to, Drive::Nothing, false)?;
            }
            Maneuver::TakeOff { height_m, duration_s } => {
                if self.motors_on {
                    return Err(ScenarioError::Contradiction {
                        what: "a take_off needs a vehicle on the ground, but the vehicle already flies".to_owned(),
                        hint: "for a flight from the ground, write starts_on_ground = true under [flight]; before a second take_off, write \
                               a land; or remove the take_off",
                    });
                }
                self.motors_on = true;
                let [x, y, _] = self.at.position_m;
                let to = Setpoint { position_m: [x, y, *height_m], ..self.at };
                self.at = to;
                self.leg("take_off duration_s", *duration_s, to, Drive::Nothing, false)?;
            }
            Maneuver::Land { duration_s } => {
                let [x, y, _] = self.at.position_m;
                let to = Setpoint { position_m: [x, y, 0.0], ..self.at };
                self.leg("land duration_s", *duration_s, to, Drive::Nothing, false)?;
                self.motors_on = false;
            }
            Maneuver::Csv { file, duration_s } => {
                let text = tables.get(file).ok_or_else(|| ScenarioError::Missing {
                    what: format!("the text of {file}"),
                    hint: "hand it in with the scenario",
                })?;
                let table = CommandTable::parse(file, text)?;
                let length_s = duration_s.unwrap_or(table.end_s());
                self.leg("csv duration_s", length_s, self.at, Drive::Table(table), false)?;
            }
        }
        Ok(())
    }

    fn fly(&mut self, name: &'static str, duration_s: f64, by_m: [f64; 3]) -> Result<(), ScenarioError> {
        let position_m = std::array::from_fn(|axis| self.at.position_m[axis] + by_m[axis]);
        self.leg(name, duration_s, Setpoint { position_m, ..self.at }, Drive::Nothing, false)
    }

    fn leg(
        &mut self,
        name: &'static str,
        duration_s: f64,
        to: Setpoint,
        drive: Drive,
        is_hover: bool,
    ) -> Result<(), ScenarioError> {
        if !(duration_s > 0.0 && duration_s.is_finite()) {
            return Err(ScenarioError::out_of_range(name, duration_s, "above 0"));
        }
        if let Some(bad) = to.position_m.into_iter().chain([to.yaw_rad]).find(|part| !part.is_finite()) {
            return Err(ScenarioError::out_of_range("maneuver position_m", bad, "a number"));
        }
        let to_s = self.now_s + duration_s;
        let leg = Leg { from_s: self.now_s, to_s, from: self.at, to, motors_on: self.motors_on, drive, is_hover };
        self.legs.push(leg);
        (self.now_s, self.at) = (to_s, to);
        Ok(())
    }
}

fn command(amount: f64) -> Result<f64, ScenarioError> {
    if amount.abs() <= 1.0 { Ok(amount) } else { Err(ScenarioError::out_of_range("amount", amount, "within ±1")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: Setpoint = Setpoint { position_m: [1.0, 2.0, 1.0], yaw_rad: 0.0 };

    fn schedule(maneuvers: &[Maneuver], on_ground: bool) -> Result<Schedule, ScenarioError> {
        let tables = BTreeMap::from([("c.csv".to_owned(), "time_s,climb\n0.5,0.2\n2.0,0\n".to_owned())]);
        Schedule::new(maneuvers, START, on_ground, &tables)
    }

    #[test]
    fn a_square_ends_where_it_began_and_turns_with_the_nose() {
        let around = [Maneuver::Hover { duration_s: 1.0 }, Maneuver::Square { side_m: 2.0, side_s: 4.0 }];
        let schedule = schedule(&around, false).unwrap();
        assert_eq!(schedule.end_s(), 17.0);
        assert!(schedule.at(0.5).is_hover && !schedule.at(1.0).is_hover && schedule.at(17.0).is_hover);
        let place = |time_s: f64| schedule.at(time_s).setpoint.position_m;
        for (time_s, x, y) in [(3.0, 2.0, 2.0), (5.0, 3.0, 2.0), (9.0, 3.0, 4.0), (13.0, 1.0, 4.0), (17.0, 1.0, 2.0)] {
            let [found_x, found_y, z] = place(time_s);
            assert!((found_x - x).abs() < 1e-12 && (found_y - y).abs() < 1e-12 && z == 1.0, "{time_s}");
        }
        let turned = Setpoint { yaw_rad: std::f64::consts::FRAC_PI_2, ..START };
        let turned = Schedule::new(&around, turned, false, &BTreeMap::new()).unwrap();
        let [x, y, _] = turned.at(5.0).setpoint.position_m;
        assert!((x - 1.0).abs() < 1e-12 && (y - 4.0).abs() < 1e-12);
    }

    #[test]
    fn doublets_and_tables_drive_their_axes_alone() {
        let doublet = Maneuver::Doublet { axis: Axis::YawRate, amount: 0.3, half_s: 0.5, repeat: 2, pause_s: 1.0 };
        let table = Maneuver::Csv { file: "c.csv".to_owned(), duration_s: None };
        let schedule = schedule(&[doublet, table], false).unwrap();
        assert_eq!(schedule.end_s(), 6.0);
        for (time_s, yaw_rate) in
            [(0.1, Some(0.3)), (0.6, Some(-0.3)), (1.1, None), (2.1, Some(0.3)), (2.6, Some(-0.3))]
        {
            assert_eq!(schedule.at(time_s).driven, [None, None, yaw_rate, None], "{time_s}");
        }
        assert_eq!(schedule.at(4.4).driven, [None; 4]);
        assert_eq!(schedule.at(4.5).driven, [None, None, None, Some(0.2)]);
        assert_eq!(schedule.at(6.0).driven, [None; 4]);
    }

    #[test]
    fn the_ground_is_left_by_taking_off_and_motors_stop_after_landing() {
        let flown = [
            Maneuver::Hover { duration_s: 1.0 },
            Maneuver::TakeOff { height_m: 1.5, duration_s: 2.0 },
            Maneuver::Land { duration_s: 2.0 },
        ];
        let schedule = schedule(&flown, true).unwrap();
        let at = |time_s: f64| schedule.at(time_s);
        assert!(!at(0.5).motors_on && !at(0.5).is_hover);
        assert!(at(1.0).motors_on && at(1.0).setpoint.position_m[2] == 1.5);
        assert!(at(4.9).motors_on && !at(5.0).motors_on && !at(5.0).is_hover);
    }

    #[test]
    fn what_cannot_be_flown_is_refused() {
        let refused = |maneuver: Maneuver, on_ground: bool| schedule(&[maneuver], on_ground).unwrap_err().to_string();
        assert!(refused(Maneuver::Climb { height_m: 1.0, duration_s: 1.0 }, true).contains("ground"));
        assert!(refused(Maneuver::TakeOff { height_m: 1.0, duration_s: 1.0 }, false).contains("already flies"));
        assert!(refused(Maneuver::Hover { duration_s: 0.0 }, false).contains("hover duration_s"));
        let step = Maneuver::Step { axis: Axis::Roll, amount: 1.5, duration_s: 1.0 };
        assert!(refused(step, false).contains("amount = 1.5, but it "));
        assert!(refused(Maneuver::Csv { file: "d.csv".to_owned(), duration_s: None }, false).contains("d.csv"));
    }
}
