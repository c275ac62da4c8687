//! The 4x4 mixer of eq 1.

use crate::forces::torque_signs;
use hovertone_vehicle::Layout;

/// Rows are rotors 1 to 4, columns roll, pitch, yaw rate and vertical rate: Δv = M u. For the X layout it is the
/// paper's matrix; for the plus layout each row has a 0 for the axis along its arm. A row has the signs of the torques
/// from more thrust of that rotor, and 1 for the climb.
pub fn mixer(layout: Layout) -> [[f64; 4]; 4] {
    torque_signs(layout).map(|[roll, pitch, yaw]| [roll, pitch, yaw, 1.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::{hubs, rotor_wrench};
    use hovertone_vehicle::find_flight_parameters;
    use nalgebra::Vector3;

    #[test]
    fn on_an_x_it_is_the_papers_matrix() {
        let paper = [[1.0, -1.0, 1.0, 1.0], [1.0, 1.0, -1.0, 1.0], [-1.0, 1.0, 1.0, 1.0], [-1.0, -1.0, -1.0, 1.0]];
        assert_eq!(mixer(Layout::X), paper);
    }

    /// More of one command gives more of its own torque, or of thrust for the climb, and no change of the other three.
    #[test]
    fn each_command_makes_its_own_torque_and_only_that() {
        for layout in [Layout::X, Layout::Plus] {
            let mut parameters = find_flight_parameters("ardrone").unwrap().clone();
            parameters.layout.value = layout;
            let (hubs, mixer) = (hubs(&parameters, Vector3::zeros()), mixer(layout));
            for command in 0..4 {
                let changes = mixer.map(|row| row[command]);
                let loads = changes.map(|change| 0.03 * change);
                let wrench = rotor_wrench(&hubs, &changes, &loads);
                let torque = wrench.torque_n_m;
                let made = [torque.x, torque.y, torque.z, wrench.force_n.z];
                for (kind, value) in made.into_iter().enumerate() {
                    if kind == command {
                        assert!(value > 0.1, "{layout:?}: command {command} gives {value}");
                    } else {
                        assert!(value.abs() < 1e-15, "{layout:?}: command {command} gives {value} of {kind}");
                    }
                }
            }
        }
    }
}
