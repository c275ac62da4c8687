//! Heard speeds at which the vehicle of a known constant cannot turn its rotors.

use crate::args::ToneArguments;
use hovertone::speed::{NoTone, OtherRotor, Outcome};
use hovertone_exchange::HeardTone;
use hovertone_report::{Contradicted, Notice, NoticeKind, SpeedRecord};
use hovertone_vehicle::RotorSpeed;

/// What to do where a recording seems to be of another vehicle than the constant.
const OTHER_VEHICLE: &str = "give recordings of the vehicle with which the constant was measured";

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
    let [low, high] = range_rev_s(heard);
    let what = format!(
        "{}{more}: the rotors turn at {:.1} rev/s, but the constant was measured with rotors that turn at {low:.0} to \
        {high:.0} rev/s",
        first.file,
        speed.rev_s()
    );
    let flags = given(typed);
    let hint = match flags.as_slice() {
        [] => OTHER_VEHICLE.to_owned(),
        flags => {
            format!(
                "leave {} out, because the results already say which tone to use; if the warning stays, \
                {OTHER_VEHICLE}",
                flags.join(" and ")
            )
        }
    };
    Some(Notice::new(what, hint))
}

/// Where the facts are those of the constant and nobody typed them, advice to correct them, or to give others in their place, leads astray: the
/// recording is of another vehicle.
pub(crate) fn advise_by_constant(record: &mut SpeedRecord, heard: &HeardTone, typed: &ToneArguments) {
    if typed.vehicle.is_some() || !given(typed).is_empty() {
        return;
    }
    let [low, high] = range_rev_s(heard);
    let not_heard = format!(
        "no rotor is heard at {low:.0} to {high:.0} rev/s, the speeds of the rotors with which the constant was \
        measured"
    );
    match no_series_of(record) {
        _ if record.spoiled.is_some() => {}
        Some(Some(OtherRotor { blades, speed_rev_s })) => {
            record.spoiled = Some(format!(
                "{not_heard}. But a rotor with {blades} blades may turn at {speed_rev_s:.1} rev/s: {OTHER_VEHICLE}"
            ));
        }
        Some(None) => record.spoiled = Some(format!("{not_heard}; {OTHER_VEHICLE}, or move the microphone nearer")),
        None => {}
    }
    if record.contradiction() == Some(Contradicted::ByAnotherRotor) {
        let is_advice = |notice: &&mut Notice| notice.kind == NoticeKind::AnotherRotorFits;
        record.notices.iter_mut().filter(is_advice).for_each(|notice| OTHER_VEHICLE.clone_into(&mut notice.hint));
    }
}

/// The rotor that is heard in place of the expected one, if there is one; `None` where the expected one is not missing.
fn no_series_of(record: &SpeedRecord) -> Option<Option<OtherRotor>> {
    match &record.analysis()?.outcome {
        Outcome::NoRotorTone { reason: NoTone::NoSeries { instead, .. } } => Some(*instead),
        _ => None,
    }
}

fn range_rev_s(heard: &HeardTone) -> [f64; 2] {
    [heard.speed_rad_s_min, heard.speed_rad_s_max].map(|rad_s| RotorSpeed::from_rad_s(rad_s).rev_s())
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
