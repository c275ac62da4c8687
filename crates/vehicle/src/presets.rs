//! Common multirotors, every number with its source.
//!
//! No source was found for these numbers, so they are absent: the propeller diameter of both AR.Drones and of the Bebops; the number
//! of blades of the first Bebop, the Tello, the Iris and the Hummingbird; a take-off mass of the F450, which is a kit. The AR.Drone
//! models of RotorS and `tum_simulator` are not used: one is a copy of the Firefly (1.5 kg), the other weighs 1.477 kg.

use crate::{Gear, ShaftSpeedRange, Sourced, Vehicle};

/// Metres in an inch, the unit in which propellers are sold. *Physics.*
pub(crate) const INCH_M: f64 = 0.0254;

/// Source of the number of blades: the paper of the method (Pizetta, Brandao, Pizziolo, Sarcinelli-Filho, preprints201808.0313).
const PAPER_BLADES: &str = "Pizetta et al., preprints201808.0313 v1, text at eq 6: each propeller has two blades";

/// All presets; the vehicle of the paper is the first.
pub fn presets() -> &'static [Vehicle] {
    &PRESETS
}

/// The preset with the given [`Vehicle::id`].
pub fn find_preset(id: &str) -> Option<&'static Vehicle> {
    PRESETS.iter().find(|vehicle| vehicle.id == id)
}

const fn sourced<T>(value: T, source: &'static str) -> Option<Sourced<T>> {
    Some(Sourced { value, source })
}

const fn four_rotors(source: &'static str) -> Sourced<u32> {
    Sourced { value: 4, source }
}

static PRESETS: [Vehicle; 11] = [
    Vehicle {
        id: "ardrone",
        name: "Parrot AR.Drone (the paper's)",
        rotor_count: four_rotors("Pizetta et al., preprints201808.0313 v1, section 3"),
        blade_count: sourced(2, PAPER_BLADES),
        gear: sourced(
            Gear { pinion: 8, wheel: 69 },
            "tooth counts derived, not found in print: the paper's ratio 8.625 (Remark 4, after the manufacturer) is \
             69/8 in lowest terms, and its n r = 8 x 8.625 = 69 in eq 6 is the wheel",
        ),
        propeller_diameter_m: None,
        mass_kg: sourced(
            0.413,
            "Pizetta et al., preprints201808.0313 v1, section 4 and table 1: without hull, with the 2000 mAh battery",
        ),
        shaft_speed: sourced(
            ShaftSpeedRange { rev_s_low: 20.0, rev_s_high: 80.0 },
            "motor 10,350 to 41,400 rpm behind 8.625: Parrot's datasheet at second hand, from a repairer's log",
        ),
    },
    Vehicle {
        id: "ardrone2",
        name: "Parrot AR.Drone 2.0",
        rotor_count: four_rotors("Parrot's specification of the AR.Drone 2.0: 4 inrunner motors"),
        blade_count: sourced(
            2,
            "Pizetta et al., preprints201808.0313 v1, text at eq 6, of an AR.Drone whose version it does not name",
        ),
        gear: sourced(
            Gear { pinion: 8, wheel: 69 },
            "tooth counts derived, not found in print: ratio 8.625 in LeonardoFagundesJr/UAV_DelayedControl, \
             @ArDronea/iParameters.m (model 'ArDrone2'), is 69/8 in lowest terms",
        ),
        propeller_diameter_m: None,
        mass_kg: sourced(
            0.429,
            "LeonardoFagundesJr/UAV_DelayedControl, @ArDronea/iParameters.m (model 'ArDrone2'; 0.442 commented out); \
             Parrot's specification has 380 and 420 g, by hull",
        ),
        shaft_speed: sourced(
            ShaftSpeedRange { rev_s_low: 20.0, rev_s_high: 80.0 },
            "motor 10,350 to 41,400 rpm behind 8.625: Parrot's datasheet at second hand, from a repairer's log",
        ),
    },
    Vehicle {
        id: "bebop",
        name: "Parrot Bebop (the first)",
        rotor_count: four_rotors("RTL info, test of the Bebop, 2015: four propellers"),
        blade_count: None,
        gear: None,
        propeller_diameter_m: None,
        mass_kg: sourced(
            0.400,
            "Radio-Canada, Triplex, test of the Bebop Drone, 25 February 2015: 400 g; RTL info has 420 g with hull",
        ),
        shaft_speed: None,
    },
    Vehicle {
        id: "bebop2",
        name: "Parrot Bebop 2",
        rotor_count: four_rotors("Little-Arms-Studios/zephyr-wiki, getting-started/drones/bepop-2.md: quadcopter"),
        blade_count: sourced(3, "Little-Arms-Studios/zephyr-wiki, getting-started/drones/bepop-2.md"),
        gear: None,
        propeller_diameter_m: None,
        mass_kg: sourced(
            0.5,
            "20 Minutes, test of the Bebop 2, 20 November 2015: 500 g; the same in iff-gsc/LADAC-Examples-Data, \
             indiCeBody_params_bebop2.m in LADAC_params/Bebop2/control",
        ),
        shaft_speed: None,
    },
    Vehicle {
        id: "mambo",
        name: "Parrot Mambo",
        rotor_count: four_rotors("MathWorks Parrot minidrone model: 'Quadcopter Flight Simulation Model - Mambo'"),
        blade_count: sourced(2, "MathWorks Parrot minidrone model, Vehicle.Rotor.blades (public copies)"),
        gear: None,
        propeller_diameter_m: sourced(
            0.066,
            "MathWorks Parrot minidrone model, Vehicle.Rotor.radius = 0.033 m (public copies)",
        ),
        mass_kg: sourced(
            0.063,
            "Dronezine, Parrot's new minidrones, 2016: 63 g; the same in the MathWorks model, Vehicle.Airframe.mass",
        ),
        shaft_speed: sourced(
            ShaftSpeedRange { rev_s_low: 59.2, rev_s_high: 418.7 },
            "MathWorks Parrot minidrone model: motor commands 10 to 500 with speed^2 = 13840.8 (rad/s)^2 per command",
        ),
    },
    Vehicle {
        id: "tello",
        name: "Ryze Tello",
        rotor_count: four_rotors("Tello documentation, oneoffcoder, drone parts: 2 CW and 2 CCW props"),
        blade_count: None,
        gear: None,
        propeller_diameter_m: sourced(3.0 * INCH_M, "Ryze, Tello specifications: propeller 3 inches"),
        mass_kg: sourced(0.080, "Ryze, Tello specifications: about 80 g, propellers and battery included"),
        shaft_speed: None,
    },
    Vehicle {
        id: "crazyflie",
        name: "Bitcraze Crazyflie 2.x",
        rotor_count: four_rotors("Bitcraze, measuring propeller RPM part 3: motors M1 to M4"),
        blade_count: sourced(
            2,
            "LCAV/crazyflie-audio, bench recordings: the strongest line is twice the shaft speed that fits Bitcraze's \
             optical rpm",
        ),
        gear: None,
        propeller_diameter_m: sourced(
            0.0462696,
            "utiasDSL/gym-pybullet-drones, assets/cf2x.urdf, later versions: prop_radius 2.31348e-2 m",
        ),
        mass_kg: sourced(
            0.027,
            "utiasDSL/gym-pybullet-drones, gym_pybullet_drones/assets/cf2x.urdf; at second hand, Bitcraze's \
             specification: take-off weight 27 g, without decks",
        ),
        shaft_speed: sourced(
            ShaftSpeedRange { rev_s_low: 204.0, rev_s_high: 417.0 },
            "Bitcraze wiki, misc:investigations:thrust: half the weight at 12,277 rpm; blog, measuring propeller RPM \
             part 3: 25,000 rpm at full thrust on a fresh battery",
        ),
    },
    Vehicle {
        id: "f450",
        name: "DJI Flame Wheel F450 with 1045 propellers",
        rotor_count: four_rotors("PX4 user guide, DJI FlameWheel 450 build: four arms and motors"),
        blade_count: sourced(2, "Gemfan 1045, modelled as a two-blade propeller in a public CAD script"),
        gear: None,
        propeller_diameter_m: sourced(10.0 * INCH_M, "by its name: 1045 is 10 x 4.5 inches (Holybro 1045 propeller)"),
        mass_kg: None,
        shaft_speed: None,
    },
    Vehicle {
        id: "m300",
        name: "DJI Matrice 300 RTK",
        rotor_count: four_rotors("DJI's propeller table as quoted in a public model of the Matrice: 4 rotors"),
        blade_count: sourced(2, "the same public model of the Matrice: 2110s, two blades, folding"),
        gear: None,
        propeller_diameter_m: sourced(
            21.0 * INCH_M,
            "DJI's propeller table: 2110, 21 x 10 inch; at second hand, as quoted in a public model of the Matrice",
        ),
        mass_kg: sourced(
            6.3,
            "DJI developer documentation, Payload SDK, hardware platform: M300 RTK with batteries, without payload",
        ),
        shaft_speed: None,
    },
    Vehicle {
        id: "iris",
        name: "3DR Iris",
        rotor_count: four_rotors("PX4/PX4-SITL_gazebo-classic, models/iris/iris.sdf.jinja: rotor_0 to rotor_3"),
        blade_count: None,
        gear: None,
        propeller_diameter_m: sourced(
            0.256,
            "PX4/PX4-SITL_gazebo-classic, models/iris/iris.sdf.jinja: collision radius 0.128 m; \
             ethz-asl/rotors_simulator, iris.xacro, has radius_rotor 0.1 m instead",
        ),
        mass_kg: sourced(
            1.5,
            "PX4/PX4-SITL_gazebo-classic, models/iris/iris.sdf.jinja: a simulator's number; weigh yours",
        ),
        shaft_speed: None,
    },
    Vehicle {
        id: "hummingbird",
        name: "AscTec Hummingbird",
        rotor_count: four_rotors("ethz-asl/rotors_simulator, rotors_description/urdf/hummingbird.xacro"),
        blade_count: None,
        gear: None,
        propeller_diameter_m: sourced(
            0.2,
            "ethz-asl/rotors_simulator, hummingbird.xacro: radius_rotor 0.1 m; the same in spencerfolk/rotorpy, \
             rotorpy/vehicles/hummingbird_params.py",
        ),
        mass_kg: sourced(
            0.5,
            "spencerfolk/rotorpy, rotorpy/vehicles/hummingbird_params.py; ethz-asl/rotors_simulator, \
             hummingbird.xacro, has 0.68 kg: weigh yours",
        ),
        shaft_speed: None,
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_id_is_found_and_stands_once() {
        let ids: BTreeSet<_> = presets().iter().map(|vehicle| vehicle.id).collect();
        assert_eq!(ids.len(), presets().len());
        for id in ids {
            assert!(id.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit()), "{id}");
            assert_eq!(find_preset(id).unwrap().id, id);
        }
        assert!(find_preset("arducopter").is_none());
    }

    #[test]
    fn every_number_has_a_source_and_is_a_quantity() {
        let mut numbers = 0;
        for vehicle in presets() {
            let counts = [Some(vehicle.rotor_count), vehicle.blade_count].into_iter().flatten();
            let measures = [vehicle.propeller_diameter_m, vehicle.mass_kg].into_iter().flatten();
            let mut sources = Vec::new();
            sources.extend(counts.clone().map(|number| number.source));
            sources.extend(measures.clone().map(|number| number.source));
            sources.extend(vehicle.gear.map(|number| number.source));
            sources.extend(vehicle.shaft_speed.map(|number| number.source));
            assert!(sources.iter().all(|source| source.len() > 10), "{}: {sources:?}", vehicle.id);
            assert!(counts.clone().all(|number| (1..=8).contains(&number.value)), "{}", vehicle.id);
            assert!(measures.clone().all(|number| number.value > 0.0 && number.value < 10.0), "{}", vehicle.id);
            if let Some(range) = vehicle.shaft_speed {
                assert!(0.0 < range.value.rev_s_low && range.value.rev_s_low < range.value.rev_s_high);
            }
            numbers += sources.len();
        }
        assert!(numbers > 3 * presets().len(), "only {numbers} numbers looked at");
    }

    #[test]
    fn a_geared_vehicle_is_heard_by_its_mesh_and_any_other_by_its_blades() {
        for id in ["ardrone", "ardrone2"] {
            let vehicle = find_preset(id).unwrap();
            assert_eq!(vehicle.gear.unwrap().value.ratio(), 8.625);
            assert_eq!(vehicle.tone_order().unwrap().lines_per_turn(), 69.0);
            assert_eq!(vehicle.blade_pass_order().unwrap().lines_per_turn(), 2.0);
        }
        assert_eq!(find_preset("crazyflie").unwrap().tone_order().unwrap().lines_per_turn(), 2.0);
        assert_eq!(find_preset("bebop2").unwrap().tone_order().unwrap().lines_per_turn(), 3.0);
        assert!(find_preset("iris").unwrap().tone_order().is_none());
    }

    #[test]
    fn the_papers_speeds_lie_within_the_plausible_range_of_its_vehicle() {
        let range = find_preset("ardrone").unwrap().shaft_speed.unwrap().value;
        for rpm in [3610.3438, 3742.0275, 3820.1625] {
            assert!((range.rev_s_low..range.rev_s_high).contains(&(rpm / 60.0)));
        }
    }
}
