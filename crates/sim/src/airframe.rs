//! The vehicle in flight: parameters, payloads, spread and air, computed once.

use crate::body::{GroundContact, RigidBody};
use crate::flight_settings::{FlightSettings, Payload};
use crate::forces::{Hub, hubs};
use crate::motor::Motor;
use crate::rotor::Rotor;
use hovertone_vehicle::{FlightParameters, QuantityError};
use nalgebra::{Matrix3, Vector3};

/// The properties of the vehicle that do not change in flight.
#[derive(Clone, Debug)]
pub struct Airframe {
    /// Mass and inertia, payloads included.
    pub body: RigidBody,
    /// Positions of the rotors about the centre of mass.
    pub hubs: [Hub; 4],
    /// The rotors in this air.
    pub rotors: [Rotor; 4],
    /// The motors.
    pub motors: [Motor; 4],
    /// Linear drag in this air, body axes, N s/m.
    pub drag_n_s_m: Vector3<f64>,
    /// The contact with the ground.
    pub contact: GroundContact,
    /// Whether thrust grows near the ground.
    pub has_ground_effect: bool,
}

impl Airframe {
    pub(crate) fn new(settings: &FlightSettings) -> Result<Self, QuantityError> {
        let vehicle = &settings.vehicle;
        let (mass_kg, centre_m, inertia) = mass_properties(vehicle, &settings.payloads);
        let bad_inertia =
            QuantityError { name: "inertia_kg_m2", value: inertia.determinant(), must_be: "of a body with extent" };
        let body = RigidBody::new(mass_kg, inertia, settings.gravity_m_s2).ok_or(bad_inertia)?;
        let reference_kg_m3 = vehicle.rotor.air_density_kg_m3.value;
        let density_share = settings.air.map_or(1.0, |air| air.density_kg_m3() / reference_kg_m3);
        let spread = settings.spread.unwrap_or_default();
        let torque_constant = density_share * vehicle.rotor.torque_constant_n_m_s2.value;
        let rotors = spread.thrust_shares.map(|share| Rotor {
            thrust_constant_n_s2: share * density_share * vehicle.rotor.thrust_constant_n_s2.value,
            torque_constant_n_m_s2: torque_constant,
            radius_m: vehicle.rotor.radius_m.value,
        });
        let feet_m = hubs(vehicle, centre_m)
            .map(|hub| Vector3::new(hub.position_m.x, hub.position_m.y, -vehicle.standing_height_m.value - centre_m.z));
        let contact = GroundContact::new(feet_m, vehicle.standing_height_m.value, mass_kg, settings.gravity_m_s2);
        Ok(Self {
            body,
            hubs: hubs(vehicle, centre_m),
            rotors,
            motors: spread.motor_gains.map(|gain| Motor::new(&vehicle.motor, torque_constant, gain)),
            drag_n_s_m: density_share * Vector3::from(vehicle.drag_n_s_m.value),
            contact,
            has_ground_effect: settings.ground_effect,
        })
    }
}

/// Mass; centre of mass from the centre of mass without payloads; inertia about the centre. Point masses are added by
/// Steiner's theorem.
fn mass_properties(vehicle: &FlightParameters, payloads: &[Payload]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let own_kg = vehicle.mass_kg.value;
    let mass_kg = own_kg + payloads.iter().map(|payload| payload.mass_kg).sum::<f64>();
    let moment: Vector3<f64> = payloads.iter().map(|p| Vector3::from(p.position_m) * p.mass_kg).sum();
    let centre_m = moment / mass_kg;
    let of_point =
        |mass_kg: f64, at: Vector3<f64>| (Matrix3::identity() * at.norm_squared() - at * at.transpose()) * mass_kg;
    let mut inertia = Matrix3::from_diagonal(&vehicle.inertia_kg_m2.value.into()) + of_point(own_kg, centre_m);
    for payload in payloads {
        inertia += of_point(payload.mass_kg, Vector3::from(payload.position_m) - centre_m);
    }
    (mass_kg, centre_m, inertia)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    #[test]
    fn two_equal_masses_apart_are_a_dumbbell_about_their_middle() {
        let mut vehicle = find_flight_parameters("ardrone").unwrap().clone();
        vehicle.inertia_kg_m2.value = [1e-3; 3];
        let payload = Payload { mass_kg: vehicle.mass_kg.value, position_m: [0.2, 0.0, 0.0] };
        let (mass_kg, centre_m, inertia) = mass_properties(&vehicle, &[payload]);
        assert_eq!(mass_kg, 0.826);
        assert!((centre_m - Vector3::new(0.1, 0.0, 0.0)).norm() < 1e-15);
        let across = 1e-3 + 0.826 * 0.1 * 0.1;
        let expected = Matrix3::from_diagonal(&Vector3::new(1e-3, across, across));
        assert!((inertia - expected).norm() < 1e-15);
    }

    #[test]
    fn feet_stay_under_the_vehicle_when_its_centre_moves() {
        let mut settings = FlightSettings::for_vehicle(find_flight_parameters("ardrone").unwrap().clone());
        settings.payloads.push(Payload { mass_kg: 0.1, position_m: [0.05, 0.0, -0.02] });
        let airframe = Airframe::new(&settings).unwrap();
        let shift = 0.1 / 0.513;
        let expected = 0.1785 / 2.0_f64.sqrt() - 0.05 * shift;
        assert!((airframe.hubs[0].position_m.x - expected).abs() < 1e-12);
        let resting = airframe.contact.resting_height_m(airframe.body.weight_n());
        assert!((resting - (0.05 - 0.02 * shift - 0.02 * 0.05)).abs() < 1e-12);
    }
}
