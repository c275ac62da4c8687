//! Heard speeds at which the vehicle of a known constant cannot turn its rotors.

use crate::args::ToneArguments;
use hovertone::speed::{NoTone, OtherRotor, Outcome};
use hovertone_exchange::HeardTone;
use hovertone_report::{Contradicted, Notice, NoticeKind, SpeedRecord};
use hovertone_vehicle::RotorSpeed;

/// What to do where a recording seems to be of another vehicle than the constant.
const OTHER_VEHICLE: &str = "another vehicle needs a constant of its own (`hovertone identify`)";

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

/// Where the facts are those of the constant, advice to correct them, or to give others in their place, leads astray: the
/// recording is of another vehicle.
pub(crate) fn advise_by_constant(record: &mut SpeedRecord, heard: &HeardTone, typed: &ToneArguments) {
    if typed.vehicle.is_some() {
        return;
    }
    if record.spoiled.is_none()
        && let Some(instead) = no_series_of(record)
    {
        record.spoiled = why_not_heard(instead, range_rev_s(heard), &given(typed));
    }
    if !given(typed).is_empty() {
        return;
    }
    if record.contradiction() == Some(Contradicted::ByAnotherRotor) {
        let is_advice = |notice: &&mut Notice| notice.kind == NoticeKind::AnotherRotorFits;
        record.notices.iter_mut().filter(is_advice).for_each(|notice| OTHER_VEHICLE.clone_into(&mut notice.hint));
    }
}

/// Why the rotors of a constant are not heard, and what to do. `None` where flags name the tone and no other rotor is heard.
fn why_not_heard(instead: Option<OtherRotor>, [low, high]: [f64; 2], flags: &[&str]) -> Option<String> {
    let not_heard = format!(
        "no rotor is heard at {low:.0} to {high:.0} rev/s, where hovertone searches for the vehicle of the constant"
    );
    let Some(OtherRotor { blades, speed_rev_s }) = instead else {
        return flags.is_empty().then(|| format!("{not_heard}; move the microphone nearer; {OTHER_VEHICLE}"));
    };
    let may_turn = format!("a rotor with {blades} blades may turn at {speed_rev_s:.1} rev/s");
    Some(match flags {
        [] if (low..=high).contains(&speed_rev_s) => format!(
            "this does not sound like the vehicle of the constant, but {may_turn}; if it is the same vehicle, \
            move the microphone nearer; {OTHER_VEHICLE}"
        ),
        [] => format!("{not_heard}. But {may_turn}: {OTHER_VEHICLE}"),
        flags => {
            let flags = flags.join(" and ");
            format!(
                "no rotor that fits {flags} is heard, but {may_turn}; leave {flags} out, because the results already \
                say which tone to use; if there is still no speed, {OTHER_VEHICLE}"
            )
        }
    })
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
pub(crate) fn given(typed: &ToneArguments) -> Vec<&'static str> {
    let flags = [
        ("--blades", typed.blades.is_some()),
        ("--gear", typed.gear.is_some()),
        ("--order", typed.order.is_some()),
        ("--band", typed.band.is_some()),
    ];
    flags.into_iter().filter_map(|(flag, is_given)| is_given.then_some(flag)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_among_those_of_the_constant_is_not_denied() {
        let at = |speed_rev_s| Some(OtherRotor { blades: 2, speed_rev_s });
        let among = why_not_heard(at(60.0), [13.0, 120.0], &[]).unwrap();
        assert!(
            !among.contains("no rotor is heard at 13 to 120")
                && among.contains("does not sound like the vehicle of the constant, but"),
            "{among}"
        );
        let beyond = why_not_heard(at(327.0), [13.0, 120.0], &[]).unwrap();
        assert!(beyond.starts_with("no rotor is heard at 13 to 120 rev/s"), "{beyond}");
        let in_band = why_not_heard(at(60.0), [13.0, 120.0], &["--band"]).unwrap();
        assert!(in_band.contains("leave --band out") && !in_band.contains("give --blades"), "{in_band}");
        assert_eq!(why_not_heard(None, [13.0, 120.0], &["--band"]), None);
    }
}
