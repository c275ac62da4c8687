//! How often a tone sounds per turn of the rotor, in words.

use hovertone_vehicle::Order;

/// "69 times per turn of the rotor".
pub(crate) fn times_per_turn(order: Order) -> String {
    format!("{} per turn of the rotor", times(order))
}

/// "once", or "69 times".
pub(crate) fn times(order: Order) -> String {
    match order.lines_per_turn() {
        1.0 => "once".to_owned(),
        _ => format!("{order} times"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_sounds_once_or_several_times() {
        let said = |order: f64| times_per_turn(Order::new(order).unwrap());
        assert_eq!(
            (said(1.0).as_str(), said(69.0).as_str()),
            ("once per turn of the rotor", "69 times per turn of the rotor")
        );
    }
}
