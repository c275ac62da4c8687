//! A fit says of its loads what was said before they were heard.

use super::campaign_tests::{exact_hovers, fitted, load, weight};
use crate::*;

/// Whatever the loads are, the fit of perfect speeds has the warnings of its outline, and no other of their kind.
#[test]
fn a_fit_has_the_warnings_of_its_outline() {
    let bench = load("bench", Force::Thrust { thrust_n: 2.0, thrust_std_n: 0.01 }, &[260.0, 260.1]);
    let hovers = exact_hovers(&[0.0, 0.05], 2);
    let mut seen = Vec::new();
    for loads in [
        exact_hovers(&[0.0], 1),
        exact_hovers(&[0.0, 0.05], 1),
        exact_hovers(&[0.0, 0.1, 0.2], 3),
        exact_hovers(&[0.0, 0.0], 2),
        hovers.into_iter().chain([bench]).collect(),
        vec![load("empty", weight(0.3), &[]), load("a", weight(0.0), &[378.0])],
    ] {
        let table = fitted(&loads);
        let planned = warnings_of_outline(&outlines(&loads), &ThrustSettings::for_rotors(4));
        let is_planned = |warning: &&ThrustWarning| {
            matches!(
                warning,
                ThrustWarning::SingleLoad
                    | ThrustWarning::OneRecordingEach { .. }
                    | ThrustWarning::EqualLoads { .. }
                    | ThrustWarning::MixedBenchAndHover
                    | ThrustWarning::MassFarFromKnown { .. }
                    | ThrustWarning::MassNotWeighed { .. }
            )
        };
        let of_fit: Vec<ThrustWarning> = table.warnings.iter().filter(is_planned).cloned().collect();
        assert_eq!(of_fit, planned);
        seen.extend(planned);
    }
    assert!(seen.len() >= 6, "{seen:?}");
}

fn outlines(loads: &[LoadSpeeds]) -> Vec<LoadOutline<'_>> {
    loads
        .iter()
        .map(|load| LoadOutline {
            name: &load.name,
            force: load.force,
            rotors_running: load.rotors_running,
            recording_count: load.trials.len(),
        })
        .collect()
}
