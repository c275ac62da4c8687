//! The stages of the chain: each is one function from one typed value to the next, with its settings from [`Config`].
//!
//! [`Config`]: crate::Config

mod candidates;
mod decision;
mod hover;
mod left_out;
mod lines;
mod propellers;
mod rotors;
mod speeds;
mod stop;
mod survey;

pub(crate) use candidates::{
    Candidates, HARDLY_FITS, HeardRotor, at_ratio, beliefs_of, candidates_from_survey, reading_of,
};
pub(crate) use decision::{Decision, are_far_apart, decision_from_lines};
pub(crate) use hover::hover_from_candidate;
pub(crate) use left_out::heard_instead;
pub(crate) use lines::{Lines, lines_from_hover};
pub(crate) use propellers::{any_propellers, geared_propellers, known_gears};
pub(crate) use rotors::rotors_from_hover;
pub(crate) use speeds::speeds_from_decision;
pub(crate) use stop::{Silence, Stop};
pub use survey::Surveyed;
pub(crate) use survey::{passes_of_survey, survey_from_source};
