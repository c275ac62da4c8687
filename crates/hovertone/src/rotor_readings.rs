//! The further readings of a source, where there are several rotors. No arithmetic here.

use crate::condition::{ConditionReader, blades_known};
use crate::config::Config;
use crate::error::Error;
use crate::harmonic::{RotorScout, RotorTracer, RotorTracks};
use crate::hover::{Hover, Survey};
use crate::labels::{NotTold, SPIN_UP_S_MAX, SpinUp, SpinUpReader};
use crate::listening::listen_again;
use crate::signal::SignalSource;
use crate::span::Span;
use crate::speed::RotorEstimate;
use crate::stream::Progress;
use crate::tone::{BLADES_MAX, lines_between_speeds, lines_worth_hearing};

/// Two more readings, where there are several rotors: where they are, in a wide band of speeds, and then each by itself.
pub(crate) fn rotors_from_source(
    source: &mut dyn SignalSource,
    hover: &Hover,
    speed_rev_s: f64,
    survey: &Survey,
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<RotorTracks, Error> {
    let sample_rate_hz = source.sample_rate_hz();
    let lines_in = |limits_rev_s: (f64, f64)| {
        lines_worth_hearing(lines_between_speeds(limits_rev_s, &config.tone, sample_rate_hz), survey)
    };
    let order = config.tone.order.lines_per_turn();
    let mesh_order = (order > BLADES_MAX).then_some(order);
    let share = config.rotors.band_half_width_share;
    let wide = lines_in((speed_rev_s * (1.0 - share), speed_rev_s * (1.0 + share)));
    let mut scout = RotorScout::new(sample_rate_hz, &wide, mesh_order, config.rotors.count as usize);
    listen_again(source, hover, &mut scout, on_progress)?;
    let rough = scout.finish();
    let mut tracer = RotorTracer::new(sample_rate_hz, &lines_in(rough.band_rev_s()), mesh_order, rough);
    listen_again(source, hover, &mut tracer, on_progress)?;
    Ok(tracer.finish())
}

/// Another reading, where it is wanted: the lines of each rotor's shaft.
pub(crate) fn condition_from_source(
    source: &mut dyn SignalSource,
    hover: &Hover,
    rotors: &mut [RotorEstimate],
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(), Error> {
    let Some(blades) = blades_known(&config.tone).filter(|_| config.rotors.wants_condition) else { return Ok(()) };
    let mut reader = ConditionReader::new(source.sample_rate_hz(), rotors, blades);
    listen_again(source, hover, &mut reader, on_progress)?;
    rotors.iter_mut().zip(reader.finish()).for_each(|(rotor, condition)| rotor.condition = condition);
    Ok(())
}

/// Another reading, where it is wanted: what comes before the hover, and when each rotor begins in it.
pub(crate) fn spin_up_from_source(
    source: &mut dyn SignalSource,
    (heard, hover): (Span, &Hover),
    rotors: &[RotorEstimate],
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<Option<SpinUp>, Error> {
    if !config.rotors.wants_spin_up {
        return Ok(None);
    }
    let count = config.rotors.count as usize;
    let mut reader = match SpinUpReader::new(source.sample_rate_hz(), heard, hover, (rotors, count), &config.tone) {
        Ok(reader) => reader,
        Err(reason) => return Ok(Some(SpinUp::not_told(reason))),
    };
    listen_again(source, &Hover::whole(reader.span()), &mut reader, on_progress)?;
    Ok(Some(reader.finish()))
}

/// Three more readings, where it is wanted: rotors that are told apart in the later hover are followed back to their begins, and the
/// hover begins behind the last of them. Else why that is not known: before a rotor turns there is nothing to tell apart.
pub(crate) fn hover_after_spin_up(
    source: &mut dyn SignalSource,
    (heard, hover): (Span, Hover),
    speed_rev_s: f64,
    survey: &Survey,
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(Hover, Option<NotTold>), Error> {
    let later = hover.later_half(SPIN_UP_S_MAX);
    if !config.rotors.wants_spin_up || later.segments.is_empty() {
        return Ok((hover, None));
    }
    let apart = rotors_from_source(source, &later, speed_rev_s, survey, config, on_progress)?;
    let rotors = apart.rotors(config.tone.order, &config.budget);
    Ok(match spin_up_from_source(source, (heard, &later), &rotors, config, on_progress)? {
        Some(SpinUp { not_told: Some(reason), .. }) => (hover, Some(reason)),
        Some(spin_up) => (hover.after_take_off(spin_up.settled_s()), None),
        None => (hover, None),
    })
}
