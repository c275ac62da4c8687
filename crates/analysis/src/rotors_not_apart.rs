//! What is said where some rotors could not be separated.

/// "4 rotors", and whether their number was given.
fn all_rotors_text(of: u32, is_assumed: bool) -> String {
    let assumed = format!(" (hovertone assumes {of}, because no number was given)");
    format!("{of} rotors{}", if is_assumed { &assumed } else { "" })
}

/// How many rotors were separated, and what their speed is then.
pub(crate) fn not_apart_text(resolved: usize, of: u32, is_assumed: bool, has_mean: bool, spread_share: f64) -> String {
    let rotors = all_rotors_text(of, is_assumed);
    match (resolved, has_mean) {
        (0, true) => {
            format!("the {rotors} could not be separated, so only their mean speed is known")
        }
        (0, false) => format!(
            "the {rotors} could not be separated: one tone is used for all, and it may come from one rotor alone. \
            So the ± is larger: hovertone assumes that the speeds of the rotors differ by {:.1} % (standard deviation)",
            100.0 * spread_share
        ),
        _ => format!("only {resolved} of the {rotors} could be separated"),
    }
}

/// Advice that begins with what the speed is.
macro_rules! of_mean {
    ($speed:literal) => {
        concat!(
            $speed,
            "if fewer rotors turn, give their number with --rotors; a nearer microphone may help, but not with rotors at nearly equal speeds"
        )
    };
}

/// What to do. `in_mean` rotors are in the mean, of which `resolved` are separated; 0 where one tone is used for all.
pub(crate) fn not_apart_hint(resolved: usize, of: u32, in_mean: usize, is_assumed: bool) -> &'static str {
    match in_mean {
        0 if is_assumed => {
            "if fewer rotors turn, give their number, as in --rotors 1: the ± becomes smaller; to separate several, place the microphone nearer"
        }
        0 => {
            "to separate them and get a smaller ±, place the microphone nearer; rotors at nearly equal speeds cannot be separated"
        }
        all if all == of as usize && resolved == 0 => {
            of_mean!("the speed is the mean of all rotors, and its ± is larger, because they could not be separated; ")
        }
        all if all == of as usize => {
            of_mean!("the speed is the mean of all rotors, and its ± is larger, because some could not be separated; ")
        }
        separated if separated == resolved => {
            of_mean!(
                "the speed is the mean of the separated rotors, and its ± is larger, because the speeds of the others are not known; "
            )
        }
        _ => {
            of_mean!(
                "the speed is the mean of the rotors that are heard, and its ± is larger, because the speeds of the others are not known; "
            )
        }
    }
}
