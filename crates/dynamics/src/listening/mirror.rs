//! Two models with the same sound: the rotors by other names, and loops with the opposite sign.

use crate::grey_box::GreyBoxModel;
use hovertone_vehicle::Axis;

/// The same sound by a model whose loops all turn against their errors, where another naming of the rotors makes it. Turned by half a turn, a vehicle
/// has the rotors of roll and pitch exchanged: with both gains negative, the same four speeds belong to other rotors. A controller with a negative
/// gain would not fly. The same model where no naming does so.
pub(super) fn with_positive_gains(model: &GreyBoxModel, mixer: &[[f64; 4]; 4]) -> GreyBoxModel {
    let signs = Axis::ALL.map(|axis| if model.loops[axis as usize].proportional < 0.0 { -1.0 } else { 1.0 });
    let turned = mixer.map(|of_rotor| std::array::from_fn::<f64, 4, _>(|axis| signs[axis] * of_rotor[axis]));
    let own = turned.map(|wanted| mixer.iter().position(|of_rotor| *of_rotor == wanted));
    let [Some(first), Some(second), Some(third), Some(fourth)] = own else { return *model };
    let names = [first, second, third, fourth];
    let mut named = GreyBoxModel {
        hover_rad_s: names.map(|name| model.hover_rad_s[name]),
        motor_gain: names.map(|name| model.motor_gain[name]),
        ..*model
    };
    for (gains, sign) in named.loops.iter_mut().zip(signs) {
        gains.proportional *= sign;
        gains.derivative *= sign;
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    /// Roll, pitch, yaw, climb of the rotors front right, rear right, rear left, front left.
    const MIXER: [[f64; 4]; 4] =
        [[-1.0, -1.0, 1.0, 1.0], [-1.0, 1.0, -1.0, 1.0], [1.0, 1.0, 1.0, 1.0], [1.0, -1.0, -1.0, 1.0]];

    fn model(negative: &[Axis]) -> GreyBoxModel {
        let vehicle = find_flight_parameters("ardrone").expect("a preset");
        let mut model = GreyBoxModel::of(vehicle, vehicle.mass_kg.value, 9.81);
        model.hover_rad_s = [401.0, 402.0, 403.0, 404.0];
        model.motor_gain = [1.01, 1.02, 0.99, 0.98];
        for axis in negative {
            model.loops[*axis as usize].proportional *= -1.0;
            model.loops[*axis as usize].derivative *= -1.0;
        }
        model
    }

    #[test]
    fn negative_gains_of_two_loops_are_other_names_of_the_rotors() {
        let right = model(&[]);
        assert_eq!(with_positive_gains(&right, &MIXER), right);
        for (negative, hover_rad_s) in [
            ([Axis::Roll, Axis::Pitch], [403.0, 404.0, 401.0, 402.0]),
            ([Axis::Roll, Axis::YawRate], [404.0, 403.0, 402.0, 401.0]),
            ([Axis::Pitch, Axis::YawRate], [402.0, 401.0, 404.0, 403.0]),
        ] {
            let named = with_positive_gains(&model(&negative), &MIXER);
            assert_eq!(named.loops, right.loops, "{negative:?}");
            assert_eq!(named.hover_rad_s, hover_rad_s, "{negative:?}");
        }
        // no naming explains one loop alone, nor a climb that falls
        for negative in [[Axis::Roll].as_slice(), &[Axis::Climb, Axis::Roll]] {
            assert_eq!(with_positive_gains(&model(negative), &MIXER), model(negative));
        }
    }
}
