//! The static maps of motors, in words the steady speed at each command: the gains, and the steady speeds behind them.

use crate::motor_record::{LoggedMotor, MotorRecord, MotorSound, MotorSource};
use crate::number::{DASH, may_be_zero, significant, with_uncertainty};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_dynamics::MapOrigin;
use hovertone_vehicle::in_list;

/// Digits of a command and of a speed.
const DIGITS: usize = 4;

/// The static maps, in words the steady speed at each command: the gain of each motor, and the plateaus behind it.
pub(crate) fn maps_text(record: &MotorRecord, width: Option<usize>) -> String {
    if record.motors.iter().all(|motor| motor.command.is_none()) {
        return match record.source {
            MotorSource::Log => {
                "\nsteady speed at each command: not known, because this log has no commands, or none of them changes\n"
                    .to_owned()
            }
            MotorSource::Sound(MotorSound { has_commands: true, .. }) => {
                "\nsteady speed at each command: not known, because the commands are not used\n".to_owned()
            }
            MotorSource::Sound(_) => {
                "\nsteady speed at each command: not known without the commands (--commands LOG)\n".to_owned()
            }
        };
    }
    let mut text =
        format!("\ngain: how the steady speed follows the command\n{}", table_text(&gains_table(record), width));
    let maps = || record.motors.iter().filter_map(|motor| motor.model.static_map.as_ref());
    if maps().any(|map| map.origin == MapOrigin::Plateaus && map.gain_rev_s.is_some()) {
        text += "gain: change of the steady speed for one unit of the command. It holds from the smallest to the largest command of the next table; \
        saturated commands do not count\n";
    }
    text += &rows_in_words(record).unwrap_or_default();
    let offsets = || maps().filter(|map| map.gain_rev_s.is_some()).filter_map(|map| map.offset_rev_s);
    if offsets().any(|offset_rev_s| offset_rev_s >= 0.0) {
        text += "speed at command 0: where the fitted straight line reaches command 0; the real motor may stand still there\n";
    }
    if maps().filter_map(|map| map.gain_rev_s).any(may_be_zero) {
        text += "a gain whose ± is larger than the gain shows nothing: the commands differ too little\n";
    }
    if maps().any(|map| !map.points.is_empty()) {
        text += &format!("\n{}", table_text(&plateaus_table(record), width));
    }
    if maps().any(|map| map.points.iter().any(|point| point.is_saturated)) {
        text += "saturated: the speed no longer follows the command; this command is left out of the gain\n";
    }
    text
}

/// Which motors have a gain from all log rows, and what it means; `None` for none.
fn rows_in_words(record: &MotorRecord) -> Option<String> {
    let has_gain = |motor: &&LoggedMotor| motor.model.static_map.as_ref().is_some_and(|map| map.gain_rev_s.is_some());
    let is_of_rows =
        |motor: &LoggedMotor| motor.model.static_map.as_ref().is_some_and(|map| map.origin == MapOrigin::Rows);
    let with_gain: Vec<&LoggedMotor> = record.motors.iter().filter(has_gain).collect();
    let of_rows: Vec<&str> =
        with_gain.iter().filter(|motor| is_of_rows(motor)).map(|motor| motor.name.as_str()).collect();
    let (who, gains) = match of_rows.as_slice() {
        [] => return None,
        all if all.len() == record.motors.len() => {
            ("no motor was held".to_owned(), if all.len() == 1 { "the gain comes" } else { "the gains come" })
        }
        [one] => (format!("{one} was not held"), "its gain comes"),
        several => (format!("{} were not held", in_list(several, "and")), "their gains come"),
    };
    Some(format!(
        "{who} at two different commands for long enough, so {gains} from all log rows. There the speed lags behind the command, so the true gain is \
        larger, perhaps by more than the ±. For a better gain, hold at least two commands for a second each\n"
    ))
}

fn gains_table(record: &MotorRecord) -> TextTable {
    let told_of = |motor: &LoggedMotor| {
        motor.model.static_map.as_ref().and_then(|map| Some((map.gain_rev_s?, map.offset_rev_s?)))
    };
    // no rotor turns backwards at the command 0: such a motor has a threshold
    let has_offsets = record.motors.iter().filter_map(told_of).any(|(_, offset_rev_s)| offset_rev_s >= 0.0);
    let offset = Column::numbers("speed at command 0", "rev/s");
    // a command with the number of its motor tells nothing more
    let is_of_other = |motor: &LoggedMotor| motor.command.as_ref().is_some_and(|command| *command != motor.name);
    let has_names = record.motors.iter().any(is_of_other);
    let mut columns = vec![Column::words("motor")];
    columns.extend(has_names.then_some(Column::words("command")));
    columns.push(Column::numbers("gain", "rev/s per unit"));
    columns.extend(has_offsets.then_some(offset));
    let mut shown = TextTable::new(columns);
    for motor in &record.motors {
        match (&motor.command, told_of(motor)) {
            (None, _) => shown.push_words(motor.name.clone(), "no command in this log".to_owned()),
            (Some(command), None) => {
                shown.push_words(motor.name.clone(), format!("not known: the command \"{command}\" is not held at two values, or the speed does not follow it"));
            }
            (Some(command), Some((gain, offset_rev_s))) => {
                let offset = if offset_rev_s < 0.0 { DASH.to_owned() } else { significant(offset_rev_s, DIGITS) };
                let gain = with_uncertainty(gain.value, gain.std_uncertainty);
                let cells = [
                    Some(motor.name.clone()),
                    has_names.then(|| command.clone()),
                    Some(gain),
                    has_offsets.then_some(offset),
                ];
                shown.push(cells.into_iter().flatten().collect());
            }
        }
    }
    shown
}

fn plateaus_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("motor"),
        Column::numbers("command", ""),
        Column::numbers("steady speed", "rev/s"),
        Column::words("note"),
    ]);
    for motor in &record.motors {
        for point in motor.model.static_map.iter().flat_map(|map| &map.points) {
            let note = if point.is_saturated { "saturated" } else { "" };
            shown.push(vec![
                motor.name.clone(),
                significant(point.command, DIGITS),
                with_uncertainty(point.speed_rev_s, Some(point.speed_std_rev_s)),
                note.to_owned(),
            ]);
        }
    }
    shown
}
