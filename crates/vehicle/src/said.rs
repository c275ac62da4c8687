//! The comparison of what a person says of a vehicle with what is known of it.

use crate::{BLADES_MAX, Contradiction, Gear, Order, RotorSpeed, Vehicle, are_masses_of_one_vehicle};

/// What a person says of a known vehicle, on the command line or in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SaidOfVehicle {
    /// Blades of each propeller.
    pub blades: Option<u32>,
    /// Gear between motor and rotor. A pinion of one tooth means that only the wheel was said.
    pub gear: Option<Gear>,
    /// Order of the tone to follow.
    pub order: Option<Order>,
    /// Number of rotors that turn.
    pub rotors: Option<u32>,
    /// Whether the vehicle hovers: on a bench fewer rotors may turn than it has.
    pub is_hovering: bool,
    /// Mass as flown.
    pub mass_kg: Option<f64>,
}

impl Vehicle {
    /// Compares what a person says with what is known of the vehicle.
    ///
    /// # Errors
    /// The first statement that differs; a mass differs if it is more than [`crate::MASS_FACTOR_MAX`] times larger or smaller.
    pub fn check_said(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        self.check_blades(said)?;
        self.check_gear(said)?;
        self.check_order(said)?;
        self.check_rotors(said)?;
        self.check_mass(said)
    }

    fn check_blades(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        match (said.blades, self.blade_count.map(|blades| blades.value)) {
            (Some(said), Some(known)) if said != known => Err(Contradiction::Blades { vehicle: self.id, known, said }),
            _ => Ok(()),
        }
    }

    fn check_gear(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        let (Some(said), Some(known)) = (said.gear, self.gear.map(|gear| gear.value)) else { return Ok(()) };
        let is_same_pinion = said.pinion == 1 || said.pinion == known.pinion;
        if said.wheel == known.wheel && is_same_pinion {
            return Ok(());
        }
        Err(Contradiction::Gear { vehicle: self.id, known, said })
    }

    fn check_order(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        match (said.order, self.tone_order()) {
            (Some(said), Some(known)) if !self.may_have(said) => {
                Err(Contradiction::Order { vehicle: self.id, known, said })
            }
            _ => Ok(()),
        }
    }

    /// Whether the rotors may have a tone of this order: the shaft, the blade pass, the gear mesh, the motor's shaft. Where the blades are
    /// not known it may be any small order, where the gear is not known any large one.
    fn may_have(&self, order: Order) -> bool {
        let lines = order.lines_per_turn();
        let is_blade_pass = match self.blade_count {
            Some(blades) => lines == f64::from(blades.value),
            None => lines <= BLADES_MAX,
        };
        let is_of_gear = match self.gear.map(|gear| gear.value) {
            Some(gear) => lines == f64::from(gear.wheel) || lines == gear.ratio(),
            None => lines > BLADES_MAX,
        };
        lines == 1.0 || is_blade_pass || is_of_gear
    }

    fn check_rotors(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        let known = self.rotor_count.value;
        let is_wrong = |rotors: &u32| *rotors > known || said.is_hovering && *rotors < known;
        match said.rotors.filter(is_wrong) {
            Some(said) => Err(Contradiction::Rotors { vehicle: self.id, known, said }),
            None => Ok(()),
        }
    }

    fn check_mass(&self, said: &SaidOfVehicle) -> Result<(), Contradiction> {
        match (said.mass_kg, self.mass_kg.map(|mass| mass.value)) {
            (Some(said_kg), Some(known_kg)) if !are_masses_of_one_vehicle(said_kg, known_kg) => {
                Err(Contradiction::Mass { vehicle: self.id, known_kg, said_kg })
            }
            _ => Ok(()),
        }
    }
}

/// A band of the command line or of a file, and where the tone of a rotor can lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchedTone {
    /// Lower and upper edge of the band, Hz.
    pub band_hz: Option<(f64, f64)>,
    /// Order of the tone.
    pub order: Order,
    /// Slowest shaft speed.
    pub speed_min: RotorSpeed,
    /// Fastest shaft speed.
    pub speed_max: RotorSpeed,
}

impl SearchedTone {
    /// Checks that the tone can lie in the band.
    ///
    /// # Errors
    /// [`Contradiction::Band`].
    pub fn check(&self) -> Result<(), Contradiction> {
        let Some((low_hz, high_hz)) = self.band_hz else { return Ok(()) };
        let (order, rev_s_min, rev_s_max) = (self.order, self.speed_min.rev_s(), self.speed_max.rev_s());
        let lines = order.lines_per_turn();
        if high_hz < lines * rev_s_min || low_hz > lines * rev_s_max {
            return Err(Contradiction::Band { low_hz, high_hz, order, rev_s_min, rev_s_max });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find_preset;

    #[test]
    fn a_vehicle_has_its_own_blades_and_gear() {
        let vehicle = find_preset("ardrone").unwrap();
        let known = Gear { pinion: 8, wheel: 69 };
        let said = SaidOfVehicle { blades: Some(2), gear: Some(known), ..SaidOfVehicle::default() };
        vehicle.check_said(&said).unwrap();
        vehicle.check_said(&SaidOfVehicle { blades: None, gear: Some(Gear { pinion: 1, wheel: 69 }), ..said }).unwrap();
        assert_eq!(
            vehicle.check_said(&SaidOfVehicle { blades: Some(3), ..said }),
            Err(Contradiction::Blades { vehicle: "ardrone", known: 2, said: 3 })
        );
        for other in [Gear { pinion: 1, wheel: 68 }, Gear { pinion: 9, wheel: 69 }] {
            assert_eq!(
                vehicle.check_said(&SaidOfVehicle { gear: Some(other), ..said }),
                Err(Contradiction::Gear { vehicle: "ardrone", known, said: other })
            );
        }
        // nothing is known of the first Bebop's blades
        find_preset("bebop").unwrap().check_said(&SaidOfVehicle { blades: Some(3), ..said }).unwrap();
    }

    #[test]
    fn a_vehicle_has_its_own_tones() {
        let with_order = |vehicle: &str, order: f64| {
            let said = SaidOfVehicle { order: Some(Order::new(order).unwrap()), ..SaidOfVehicle::default() };
            find_preset(vehicle).unwrap().check_said(&said)
        };
        // shaft, blade pass, gear mesh, the motor's shaft; an unknown gear; unknown blades
        for (vehicle, order) in
            [("ardrone", 1.0), ("ardrone", 2.0), ("ardrone", 69.0), ("ardrone", 8.625), ("f450", 46.0), ("bebop", 3.0)]
        {
            with_order(vehicle, order).unwrap();
        }
        for (vehicle, order) in [("ardrone", 4.0), ("ardrone", 46.0), ("ardrone", 138.0), ("crazyflie", 3.0)] {
            let error = with_order(vehicle, order).unwrap_err();
            assert!(error.to_string().contains(&format!("order = {order}")), "{error}");
        }
    }

    #[test]
    fn a_band_holds_the_tone() {
        let of = |low_hz: f64, high_hz: f64| SearchedTone {
            band_hz: Some((low_hz, high_hz)),
            order: Order::new(69.0).unwrap(),
            speed_min: RotorSpeed::from_rev_s(20.0),
            speed_max: RotorSpeed::from_rev_s(80.0),
        };
        of(4000.0, 4300.0).check().unwrap();
        of(100.0, 1400.0).check().unwrap();
        SearchedTone { band_hz: None, ..of(0.0, 0.0) }.check().unwrap();
        for outside in [of(100.0, 130.0), of(6000.0, 7000.0)] {
            let error = outside.check().unwrap_err();
            assert!(error.hint().contains("1380 to 5520 Hz"), "{}", error.hint());
        }
        assert!(of(100.0, 130.0).check().unwrap_err().to_string().contains("means 1.4 to 1.9 rev/s"));
    }

    #[test]
    fn a_vehicle_has_its_own_rotors_and_mass() {
        let vehicle = find_preset("ardrone").unwrap();
        let of = |rotors, mass_kg| SaidOfVehicle { rotors, mass_kg, ..SaidOfVehicle::default() };
        for (rotors, mass_kg) in [(Some(1), None), (Some(4), Some(0.413)), (None, Some(0.6))] {
            vehicle.check_said(&of(rotors, mass_kg)).unwrap();
        }
        assert_eq!(
            vehicle.check_said(&of(Some(6), None)),
            Err(Contradiction::Rotors { vehicle: "ardrone", known: 4, said: 6 })
        );
        assert_eq!(
            vehicle.check_said(&SaidOfVehicle { is_hovering: true, ..of(Some(2), None) }),
            Err(Contradiction::Rotors { vehicle: "ardrone", known: 4, said: 2 })
        );
        let grams = vehicle.check_said(&of(None, Some(413.0))).unwrap_err();
        assert!(grams.hint().ends_with("for 413 g write 0.413"), "{}", grams.hint());
        let another = vehicle.check_said(&of(None, Some(0.04))).unwrap_err();
        assert!(another.hint().contains("name of the vehicle"), "{}", another.hint());
    }
}
