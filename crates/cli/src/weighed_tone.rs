//! The tone that `hovertone weigh` hears, and the clock: those of the flags, or those behind the constant.

use crate::args::{ToneArguments, WeighArguments};
use crate::failure::Failure;
use crate::foreign_speed::given;
use crate::order_words::{times, times_per_turn};
use crate::settings::tone_of;
use hovertone::speed::ToneConfig;
use hovertone_exchange::{HeardTone, IdentifiedRotor};
use hovertone_report::{Notice, tone_of_order};
use hovertone_vehicle::{BLADES_MAX, Order, RotorSpeed};

/// The tone of the arguments, else the tone behind the results with the same settings.
pub(crate) fn tone_to_hear(
    arguments: &WeighArguments,
    results: Option<&IdentifiedRotor>,
) -> Result<ToneConfig, Failure> {
    let heard = results.and_then(|rotor| rotor.tone);
    if let Some(tone) = tone_of(&arguments.tone)? {
        if let Some(heard) = heard.filter(|_| arguments.tone.vehicle.is_none()) {
            check_order(tone.order, &heard, &arguments.tone)?;
        }
        return Ok(tone);
    }
    let heard = heard.ok_or_else(|| {
        let hint = match &arguments.tone.vehicle {
            Some(_) => "count the blades of the vehicle, and give --blades N too",
            None => {
                "give the number of blades of one propeller, as in --blades 2, or --vehicle with a name that \
                 `hovertone vehicles` lists; rotors with a gear need --gear too, as in --gear 8:69"
            }
        };
        let what = "hovertone does not know how many times the tone sounds per turn of the rotor, so it cannot tell the \
                    speed from the sound";
        Failure::usage(what, hint)
    })?;
    let order = Order::new(heard.order)?;
    let tone = ToneConfig {
        harmonics: arguments.tone.harmonics.unwrap_or(heard.harmonics),
        blades: heard.blades,
        band_hz: arguments.tone.band,
        band_half_width_share: heard.band_half_width_share,
        speed_min: RotorSpeed::from_rad_s(heard.speed_rad_s_min),
        speed_max: RotorSpeed::from_rad_s(heard.speed_rad_s_max),
        ..ToneConfig::of_order(order)
    };
    tone.check_band()?;
    Ok(tone)
}

/// That the clock behind the constant was corrected, and this recording is not: of one recorder, both must be corrected.
pub(crate) fn tip_of_clock(arguments: &WeighArguments, results: Option<&IdentifiedRotor>) -> Option<Notice> {
    let ppm = results.map_or(0.0, |rotor| rotor.clock_correction_ppm);
    (ppm != 0.0 && arguments.hearing.clock_correction_ppm.is_none()).then(|| {
        Notice::new(
            format!("the constant was measured with a corrected clock of the recorder (clock_correction_ppm = {ppm}), and here no correction is given"),
            format!("if the same recorder made these recordings, add --clock-correction-ppm {ppm}"),
        )
    })
}

/// The warning that the flags name another tone than that of the constant, so that the sound does not show whether it is the same vehicle. `None`
/// where they name that of the constant, or none.
pub(crate) fn warning_of_other_tone(
    typed: &ToneArguments,
    results: Option<&IdentifiedRotor>,
) -> Result<Option<Notice>, Failure> {
    let (Some(heard), Some(said)) = (results.and_then(|rotor| rotor.tone), tone_of(typed)?) else { return Ok(None) };
    Ok((said.order.lines_per_turn() != heard.order).then(|| {
        Notice::new(
            "the flags name another tone than that with which the constant was measured: the sound does not show whether this is the same vehicle, \
             and the mass of another vehicle is wrong",
            "leave the flags of the tone out: then hovertone listens for the tone with which the constant was measured, and says so if it does not fit",
        )
    }))
}

/// The tip that no flag names the tone, so that it is that of the constant. `None` where a flag does.
pub(crate) fn tip_of_tone(typed: &ToneArguments, results: Option<&IdentifiedRotor>) -> Result<Option<Notice>, Failure> {
    let Some(heard) = results.and_then(|rotor| rotor.tone) else { return Ok(None) };
    Ok(match tone_of(typed)? {
        Some(_) => None,
        None => Some(Notice::new(
            format!(
                "no flag says which tone to hear, so hovertone listens for the tone with which the constant was measured: the {}",
                tone_of_order(Order::new(heard.order)?)
            ),
            "this is right with the same propellers; for others, first measure their constant with \
             `hovertone identify`",
        )),
    })
}

/// Refuses an order that is neither that of the tone behind the constant nor that of the blade pass.
fn check_order(said: Order, heard: &HeardTone, typed: &ToneArguments) -> Result<(), Failure> {
    let lines = said.lines_per_turn();
    let may_be_blades = |lines: f64| heard.order > BLADES_MAX && lines <= BLADES_MAX && lines.fract() == 0.0;
    let is_blade_pass = heard.blades.map_or(may_be_blades(lines), |blades| lines == f64::from(blades));
    if lines == heard.order || is_blade_pass {
        return Ok(());
    }
    let flags: Vec<&str> = given(typed).into_iter().filter(|flag| *flag != "--band").collect();
    let flags = flags.join(" and ");
    let what = format!(
        "{flags} does not fit the constant: in its recordings, the tone sounds {}, but by {flags} it sounds {}",
        times_per_turn(Order::new(heard.order)?),
        times(said)
    );
    let hint = format!(
        "if the vehicle still has the same propellers, leave {flags} out; if it has others, measure their constant with \
         `hovertone identify`"
    );
    Err(Failure::usage(what, hint))
}
