//! The grey box as a JSON line, for programs.

use crate::grey_box::{GreyBoxRecord, trust};
use crate::notice::Notice;
use crate::version::VERSION;
use hovertone_dynamics::{Correlation, Echoes, Parameter, TorqueConstant};
use hovertone_vehicle::{Axis, Estimate};
use serde::Serialize;

#[derive(Serialize)]
struct GreyBoxLine<'a> {
    recording: Option<&'a str>,
    log: &'a str,
    vehicle: &'a str,
    are_speeds_logged: bool,
    observation_count: usize,
    parameters: Vec<ParameterLine>,
    loops: Vec<LoopLine>,
    torque_constant_n_m_s2: Option<Estimate>,
    torque_constant_reason: Option<String>,
    rank: usize,
    condition: f64,
    correlations: Vec<CorrelationLine>,
    names_nats: Option<f64>,
    echoes: Option<EchoesLine>,
    log_moved_s: f64,
    advice: Vec<AdviceLine<'a>>,
    rms_share: Option<f64>,
    check: Option<CheckLine<'a>>,
    trust: String,
    warnings: &'a [Notice],
    version: &'static str,
}

#[derive(Serialize)]
struct ParameterLine {
    name: String,
    value: f64,
    std_uncertainty: Option<f64>,
    is_told: bool,
}

#[derive(Serialize)]
struct LoopLine {
    name: &'static str,
    proportional_v: Option<Estimate>,
    derivative_v: Option<Estimate>,
}

#[derive(Serialize)]
struct EchoesLine {
    direct_share: f64,
    reverberation_s: f64,
}

#[derive(Serialize)]
struct CorrelationLine {
    first: String,
    second: String,
    correlation: f64,
}

#[derive(Serialize)]
struct AdviceLine<'a> {
    what: &'a str,
    hint: &'a str,
}

#[derive(Serialize)]
struct CheckLine<'a> {
    recording: Option<&'a str>,
    log: &'a str,
    rms_share: Option<f64>,
    change_share: Option<f64>,
    compared_share: Option<f64>,
}

/// The grey box as one line of JSON, ending with a line feed. Gains are in rad/s of the rotor, and in volts by the vehicle's motor. `warnings` are
/// all notices about the flights: those of [`crate::grey_box_warnings`], lost parts of the logs, and loops that are left out.
///
/// # Errors
/// A number that JSON cannot hold.
pub fn grey_box_json(record: &GreyBoxRecord, warnings: &[Notice]) -> serde_json::Result<String> {
    let fit = &record.fit;
    let parameters = Parameter::all().into_iter().zip(fit.model.to_vector());
    let volts = |parameter| Some(fit.estimate(parameter)?.scaled(record.slope_v_s_rad));
    let correlation = |pair: &Correlation| CorrelationLine {
        first: pair.first.name(),
        second: pair.second.name(),
        correlation: pair.correlation,
    };
    let line = GreyBoxLine {
        recording: record.recording.as_deref(),
        log: &record.log,
        vehicle: &record.vehicle,
        are_speeds_logged: record.are_speeds_logged,
        observation_count: fit.observations,
        parameters: parameters
            .map(|(parameter, value)| {
                let told = fit.estimate(parameter);
                let std_uncertainty = told.and_then(|told| told.std_uncertainty);
                ParameterLine { name: parameter.name(), value, std_uncertainty, is_told: told.is_some() }
            })
            .collect(),
        loops: Axis::ALL
            .into_iter()
            .map(|axis| LoopLine {
                name: axis.name(),
                proportional_v: volts(Parameter::Proportional(axis)),
                derivative_v: volts(Parameter::Derivative(axis)),
            })
            .collect(),
        torque_constant_n_m_s2: match &record.torque_constant {
            TorqueConstant::Told(told) => Some(*told),
            _ => None,
        },
        torque_constant_reason: record.torque_constant.reason(),
        rank: fit.information.rank,
        condition: fit.information.condition,
        correlations: fit.information.correlations.iter().map(correlation).collect(),
        log_moved_s: record.log_moved_s,
        names_nats: record.names_nats.filter(|nats| nats.is_finite()),
        echoes: record
            .echoes
            .map(|Echoes { direct_share, reverberation_s }| EchoesLine { direct_share, reverberation_s }),
        advice: record.advice.iter().map(|advice| AdviceLine { what: &advice.what, hint: &advice.hint }).collect(),
        rms_share: record.fitted.map(|fitted| fitted.rms_share),
        check: record.other_flight.as_ref().map(|other| CheckLine {
            recording: other.recording.as_deref(),
            log: &other.log,
            rms_share: other.result.map(|result| result.rms_share),
            change_share: other.result.map(|result| result.change_share),
            compared_share: other.result.map(|result| result.compared_share),
        }),
        trust: trust(record),
        warnings,
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}
