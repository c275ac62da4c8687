//! Heard speeds at which the vehicle of a known constant cannot turn its rotors.

use crate::args::ToneArguments;
use hovertone_exchange::HeardTone;
use hovertone_report::{Notice, SpeedRecord};
use hovertone_vehicle::RotorSpeed;

/// The warning that recordings have such a speed. Flags that name the tone can lead there, since they replace the tone behind the constant.
pub(crate) fn foreign_speed(records: &[SpeedRecord], heard: &HeardTone, typed: &ToneArguments) -> Option<Notice> {
    let range_rad_s = heard.speed_rad_s_min..=heard.speed_rad_s_max;
    let speeds = records.iter().filter_map(|record| Some((record, record.speed()?.speed)));
    let foreign: Vec<(&SpeedRecord, RotorSpeed)> =
        speeds.filter(|(_, speed)| !range_rad_s.contains(&speed.rad_s())).collect();
    let (first, speed) = foreign.first()?;
    let more = match foreign.len() {
        1 => String::new(),
        count => format!(" (and {} more)", count - 1),
    };
    let [low, high] = [heard.speed_rad_s_min, heard.speed_rad_s_max].map(|rad_s| RotorSpeed::from_rad_s(rad_s).rev_s());
    let what = format!(
        "{}{more} has {:.1} rev/s, but the rotors behind the constant turn at {low:.0} to {high:.0} rev/s",
        first.file,
        speed.rev_s()
    );
    let flags = given(typed);
    let hint = match flags.as_slice() {
        [] => "give recordings of the vehicle of the constant".to_owned(),
        flags => format!(
            "leave {} out, since the results have the tone; if that does not help, give recordings of the vehicle of the constant",
            flags.join(" and ")
        ),
    };
    Some(Notice::new(what, hint))
}

/// The flags that were typed of those that name a tone.
fn given(typed: &ToneArguments) -> Vec<&'static str> {
    let flags = [
        ("--blades", typed.blades.is_some()),
        ("--gear", typed.gear.is_some()),
        ("--order", typed.order.is_some()),
        ("--band", typed.band.is_some()),
    ];
    flags.into_iter().filter_map(|(flag, is_given)| is_given.then_some(flag)).collect()
}
