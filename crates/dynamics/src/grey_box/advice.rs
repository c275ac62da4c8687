//! What a flight does not tell, and the manoeuvre that would.

use super::fit::GreyBoxFit;
use super::information::Correlation;
use super::inputs::LoopInputs;
use super::parameters::Parameter;
use hovertone_vehicle::{Axis, in_list};

/// A gap of the result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// What is not told, and why.
    pub what: String,
    /// What to fly, or to log.
    pub hint: String,
}

/// The gaps of a fit, in the order of the loops.
pub fn advice_of(fit: &GreyBoxFit, inputs: &LoopInputs) -> Vec<Advice> {
    let mut advice = Vec::new();
    for axis in Axis::ALL {
        if !inputs.has_loop[axis as usize] {
            advice.push(Advice {
                what: format!(
                    "the model leaves out the control of {0}: the log lacks its command or its measured value",
                    axis.in_words()
                ),
                hint: format!("log the command and the {} of the vehicle", measurement(axis)),
            });
            continue;
        }
        let gains = [Parameter::Proportional(axis), Parameter::Derivative(axis)];
        let untold: Vec<String> =
            gains.into_iter().filter(|gain| fit.estimate(*gain).is_none()).map(Parameter::in_words).collect();
        if !untold.is_empty() {
            advice.push(Advice {
                what: format!(
                    "the flight does not show {}: it changes the speeds of the rotors too little",
                    untold.join(" and ")
                ),
                hint: doublet(axis),
            });
        }
    }
    let is_unlimited = |axis: &Axis| inputs.has_loop[*axis as usize] && fit.estimate(Parameter::Limit(*axis)).is_none();
    let unlimited: Vec<&str> = Axis::ALL.into_iter().filter(is_unlimited).map(Axis::in_words).collect();
    if !unlimited.is_empty() {
        let limits = if unlimited.len() == 1 { "limit" } else { "limits" };
        let axes = in_list(&unlimited, "and");
        advice.push(Advice {
            what: format!(
                "the flight does not show the {limits} of {axes} (a command above its limit has no more effect), because its commands stay below"
            ),
            hint: "use the model only for commands no larger than in this flight".to_owned(),
        });
    }
    if fit.estimate(Parameter::TimeConstant).is_none() {
        advice.push(Advice {
            what: "the flight does not show the time constant of the motors: the speeds change too slowly".to_owned(),
            hint: "fly yaw and climb doublets: move the stick one way, then at once the other way".to_owned(),
        });
    }
    if fit.estimate(Parameter::Load).is_none() {
        advice.push(Advice {
            what: "the flight does not show the square term of the load (b in equation 2 of docs/greybox.md): the \
            range of speeds is too small"
                .to_owned(),
            hint: "fly climbs and descents with the largest command".to_owned(),
        });
    }
    advice.extend(alike(&fit.information.correlations));
    advice
}

/// That some parameters have nearly the same effect in a flight; `None` where it tells all.
fn alike(correlations: &[Correlation]) -> Option<Advice> {
    let strongest = correlations.first()?.correlation;
    let mut names: Vec<String> = Vec::new();
    for name in correlations.iter().flat_map(|pair| [pair.first, pair.second]).map(Parameter::in_words) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Some(Advice {
        what: format!(
            "{} have nearly the same effect in this flight, so each of them is uncertain (largest correlation: {})",
            in_list(&names, "and"),
            format!("{strongest:.2}").replace('-', "−")
        ),
        hint: "fly doublets (stick to one side, then to the other) for longer, in roll, pitch, yaw and climb, half of them with 0.2 s for each \
               side and half with 0.5 s"
            .to_owned(),
    })
}

fn measurement(axis: Axis) -> &'static str {
    match axis {
        Axis::Roll => "roll angle",
        Axis::Pitch => "pitch angle",
        Axis::YawRate => "yaw rate",
        Axis::Climb => "vertical rate",
    }
}

fn doublet(axis: Axis) -> String {
    format!(
        "fly more {} doublets (stick to one side, then to the other) with a large command, half of them with 0.2 s for each side and half with 0.5 s",
        axis.in_words()
    )
}
