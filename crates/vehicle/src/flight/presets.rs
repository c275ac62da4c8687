//! Flight parameters of the vehicles with enough sources.
//!
//! The motor of the AR.Drone. The authors' code (AuRoRA) has k_m = 130.14 against k_b = 1.3014e-3, J_m = 0.1215 and B_m = 3.74 with
//! R = 0.6029 ohm, where ω is the speed of the rotor. Its time constant R J/(R B + k_m k_b) = 30.217 ms and its gain of 53.683
//! (rad/s)/V are plausible. Its load term of 17 µV is not, and k_m = k_b fails by a factor of 1e5. The numbers here keep R, the time
//! constant and the gain (both for the linear part of eq 2 and the speed of the rotor). The fourth condition is remark 4 of the paper,
//! 14.5 W per motor in hover. It gives k = 2.132e-3 V s/rad at the motor's shaft, B = (1/gain − k r) k/(R r) and
//! J = time constant / gain · k/(R r). Two results confirm the numbers: the full speed at 11.1 V is 4790 rpm (Parrot: 41,400/8.625 =
//! 4800), and J r² = 1.717e-5 kg m² is near 2.03e-5, a value that the same code has commented out. With its load, the response about
//! hover has a time constant of 23.5 ms and a gain of 41.8 (rad/s)/V.

use super::{
    BatteryParameters, ControllerParameters, FlightParameters, Layout, LoopGains, MotorParameters, RotorParameters,
};
use crate::Sourced;

/// All flight parameters; the vehicle of the paper is the first.
pub fn flight_presets() -> &'static [FlightParameters] {
    &PRESETS
}

/// Names of the vehicles with flight parameters: they alone have rotors with known places.
pub fn flight_preset_names() -> Vec<&'static str> {
    PRESETS.iter().map(|parameters| parameters.id).collect()
}

/// The flight parameters of the vehicle with the given id.
pub fn find_flight_parameters(id: &str) -> Option<&'static FlightParameters> {
    PRESETS.iter().find(|parameters| parameters.id == id)
}

const fn of<T>(value: T, source: &'static str) -> Sourced<T> {
    Sourced { value, source }
}

const AURORA: &str = "LeonardoFagundesJr/UAV_DelayedControl, @ArDronea/iParameters.m (the authors' group)";
const AURORA_GAINS: &str = "LeonardoFagundesJr/UAV_DelayedControl, @ArDronea/iParameters.m and \
     @ArDrone/sDynamicModel.m: gain and tanh limit times their share of 11.1 V - 6.7318 V";
const AURORA_LIMITS: &str =
    "LeonardoFagundesJr/UAV_DelayedControl, @ArDrone/sDynamicModel.m: 15 degrees, 100 degrees/s, 1 m/s";
const MRS: &str = "ctu-mrs/mrs_multirotor_simulator, config/uavs/f450.yaml";
const ROTORPY: &str = "spencerfolk/rotorpy, rotorpy/vehicles/crazyflie_params.py";
const DENSITY: &str = "estimated: the source does not name its air; standard sea level, ISO 2533";
const LIPO_FULL: &str = "lithium polymer, 4.2 V per full cell";
const LIPO_EMPTY: &str = "estimated: lithium polymer at the end of its flat part, 3.5 V per cell";
const TUNED: &str = "estimated: tuned here on the linearised model, no source";
const STANDS: &str = "estimated: not found";

/// Motor of the AR.Drone. *Physics.*
const ARDRONE_MOTOR: MotorParameters = MotorParameters {
    resistance_ohm: of(0.6029, AURORA),
    constant_v_s_rad: of(
        2.132e-3,
        "derived: AuRoRA's gain 53.683 (rad/s)/V with the paper's 14.5 W per motor in hover (remark 4), k_m = k_b",
    ),
    viscous_n_m_s: of(9.807_591_65e-8, "derived: AuRoRA's gain 53.683 (rad/s)/V less the above"),
    inertia_kg_m2: of(2.307_775_73e-7, "derived: AuRoRA's time constant 30.217 ms times the above"),
    rotor_inertia_kg_m2: of(
        1.5e-5,
        "estimated: of the 1.717e-5 kg m² felt at the rotor, what a 5 g, 0.2 m propeller and its wheel have",
    ),
    gear_ratio: of(8.625, "Pizetta et al., preprints201808.0313 v1, remark 4, after the manufacturer"),
};

/// Battery of the AR.Drone. *Physics.*
const ARDRONE_BATTERY: BatteryParameters = BatteryParameters {
    voltage_v: of(11.1, "LeonardoFagundesJr/UAV_DelayedControl, @ArDrone/sDynamicModel.m: limit of the battery"),
    full_v: of(12.6, LIPO_FULL),
    empty_v: of(10.5, LIPO_EMPTY),
    capacity_a_h: of(2.0, "Pizetta et al., preprints201808.0313 v1, section 4: '2000mA battery'"),
    resistance_ohm: of(0.08, "estimated: 20 milliohm per cell and as much again in leads"),
};

/// Controller of the AR.Drone, with the gains of the authors' code. *Physics.*
const ARDRONE_CONTROLLER: ControllerParameters = ControllerParameters {
    period_s: of(0.005, "estimated: 200 runs per second"),
    derivative_filter_s: of(1.0 / 30.0, "LeonardoFagundesJr/UAV_DelayedControl: the sampling time of its differences"),
    roll: of(LoopGains { proportional: 0.065_52, derivative: 0.065_52, limit_v: 0.6552 }, AURORA_GAINS),
    pitch: of(LoopGains { proportional: 0.065_52, derivative: 0.065_52, limit_v: 0.6552 }, AURORA_GAINS),
    yaw_rate: of(LoopGains { proportional: 0.1310, derivative: 0.065_52, limit_v: 1.3105 }, AURORA_GAINS),
    climb: of(LoopGains { proportional: 8.736, derivative: 0.087_36, limit_v: 1.7473 }, AURORA_GAINS),
    tilt_rad_max: of(0.261_799, AURORA_LIMITS),
    yaw_rate_rad_s_max: of(1.745_329, AURORA_LIMITS),
    climb_m_s_max: of(1.0, AURORA_LIMITS),
};

/// Rotor of the AR.Drone. *Physics.*
const ARDRONE_ROTOR: RotorParameters = RotorParameters {
    thrust_constant_n_s2: of(
        7.0775e-6,
        "a quarter of 2.831e-5 N s²: Pizetta et al., tables 1 and 2, speeds as printed, with 413, 444 and 462 g",
    ),
    torque_constant_n_m_s2: of(
        2.1308e-7,
        "derived: AuRoRA's C_τ/C_f = 2.423e-7/8.048e-6 = 0.03011 m times the above; the paper measured none",
    ),
    radius_m: of(0.1, "estimated: 8 inches across, not found in print"),
    air_density_kg_m3: of(1.225, DENSITY),
};

/// The AR.Drone of the authors' simulator. The preset of the second AR.Drone differs in mass and rotor constants. *Physics.*
const ARDRONE: FlightParameters = FlightParameters {
    id: "ardrone",
    mass_kg: of(0.413, "Pizetta et al., preprints201808.0313 v1, section 4: without hull, with the 2000 mAh battery"),
    inertia_kg_m2: of([2.237_568e-3, 2.985_236e-3, 4.803_74e-3], AURORA),
    layout: of(Layout::X, "Pizetta et al., preprints201808.0313 v1, remark 2"),
    arm_length_m: of(
        0.1785,
        "LeonardoFagundesJr/UAV_DelayedControl, @ArDronea/iParameters.m, k1, taken as centre to shaft: their code uses \
         it as the lever itself, against remark 2",
    ),
    standing_height_m: of(0.05, STANDS),
    drag_n_s_m: of([0.2, 0.2, 0.2], "estimated: 15 degrees of tilt end at some 5 m/s; the paper has none"),
    rotor: ARDRONE_ROTOR,
    motor: ARDRONE_MOTOR,
    battery: ARDRONE_BATTERY,
    controller: ARDRONE_CONTROLLER,
};

static PRESETS: [FlightParameters; 4] = [
    ARDRONE,
    FlightParameters {
        id: "ardrone2",
        mass_kg: of(0.429, AURORA),
        rotor: RotorParameters {
            thrust_constant_n_s2: of(8.048e-6, "Li, MSc TU Delft 2014, as AuRoRA's @ArDronea/iParameters.m has it"),
            torque_constant_n_m_s2: of(2.423e-7, "Li, MSc TU Delft 2014, as AuRoRA's @ArDronea/iParameters.m has it"),
            ..ARDRONE_ROTOR
        },
        ..ARDRONE
    },
    FlightParameters {
        id: "crazyflie",
        mass_kg: of(0.027, "utiasDSL/gym-pybullet-drones, gym_pybullet_drones/assets/cf2x.urdf: without decks"),
        inertia_kg_m2: of([1.43e-5, 1.43e-5, 2.89e-5], ROTORPY),
        layout: of(Layout::X, ROTORPY),
        arm_length_m: of(
            0.0397,
            "utiasDSL/gym-pybullet-drones, cf2x.urdf: arm, hubs at 0.028 m; rotorpy has 0.043 m, the older 0.046 m",
        ),
        standing_height_m: of(0.015, STANDS),
        drag_n_s_m: of(
            [6.96e-3, 6.96e-3, 5.13e-3],
            "derived: k_d and k_z of rotorpy's crazyflie_params.py times the four speeds in hover, 1697 rad/s",
        ),
        rotor: RotorParameters {
            thrust_constant_n_s2: of(2.3e-8, ROTORPY),
            torque_constant_n_m_s2: of(
                1.372e-10,
                "derived: 0.005964552 m times the above (Förster 2015, at second hand from a public model); rotorpy's \
                 7.8e-10 is 'mostly made up' by its own word and more than the blade's radius can give",
            ),
            radius_m: of(0.023_134_8, "utiasDSL/gym-pybullet-drones, later cf2x.urdf: prop_radius"),
            air_density_kg_m3: of(1.225, DENSITY),
        },
        motor: MotorParameters {
            resistance_ohm: of(
                1.75,
                "estimated: what lets 4.2 V turn it at 25,000 rpm (Bitcraze blog, measuring propeller RPM part 3)",
            ),
            constant_v_s_rad: of(
                6.82e-4,
                "14,000 rpm/V: its coreless 16 mm motor, at second hand from a public model of it",
            ),
            viscous_n_m_s: of(0.0, "estimated: not found, its loss is within the resistance above"),
            inertia_kg_m2: of(
                5.27e-8,
                "derived: rotorpy's motor time constant 72 ms, taken as the response about hover with its load",
            ),
            rotor_inertia_kg_m2: of(5.27e-8, "direct drive: all that turns"),
            gear_ratio: of(1.0, "direct drive"),
        },
        battery: BatteryParameters {
            voltage_v: of(3.7, "one lithium polymer cell"),
            full_v: of(4.2, LIPO_FULL),
            empty_v: of(3.5, LIPO_EMPTY),
            capacity_a_h: of(0.25, "estimated: the battery it is sold with, 240 to 250 mAh"),
            resistance_ohm: of(0.2, "estimated: not found"),
        },
        controller: ControllerParameters {
            period_s: of(0.002, "estimated: 500 runs per second"),
            derivative_filter_s: of(0.02, TUNED),
            roll: of(LoopGains { proportional: 0.08, derivative: 0.024, limit_v: 0.4 }, TUNED),
            pitch: of(LoopGains { proportional: 0.08, derivative: 0.024, limit_v: 0.4 }, TUNED),
            yaw_rate: of(LoopGains { proportional: 0.06, derivative: 0.0, limit_v: 0.3 }, TUNED),
            climb: of(LoopGains { proportional: 0.5, derivative: 0.0, limit_v: 0.6 }, TUNED),
            tilt_rad_max: of(0.349_066, "estimated: 20 degrees"),
            yaw_rate_rad_s_max: of(1.745_329, "estimated: 100 degrees/s"),
            climb_m_s_max: of(1.0, "estimated: chosen here"),
        },
    },
    FlightParameters {
        id: "f450",
        mass_kg: of(1.7, "ctu-mrs/mrs_multirotor_simulator, config/uavs/f450.yaml: with its computer; weigh yours"),
        inertia_kg_m2: of(
            [0.022_93, 0.022_93, 0.043_03],
            "ctu-mrs/mrs_multirotor_simulator, multirotor_model.hpp: cylinder of the mass, arm and height 0.1 m; \
             JBannwarth/multirotor_model measured 0.0176, 0.0176, 0.0362 on a 460 mm frame of 1.48 kg",
        ),
        layout: of(Layout::X, MRS),
        arm_length_m: of(0.225, MRS),
        standing_height_m: of(0.1, "estimated: body_height of MRS's f450.yaml"),
        drag_n_s_m: of([0.35, 0.35, 0.35], "estimated: not found; MRS has a square law instead"),
        rotor: RotorParameters {
            thrust_constant_n_s2: of(1.114e-5, "MRS f450.yaml, force_constant 1.2216e-7 N/rpm², times (30/π)²"),
            torque_constant_n_m_s2: of(
                2.573e-7,
                "derived: the above times 0.07 · 3 · 0.11 m, as MRS's multirotor_model.hpp scales moment_constant",
            ),
            radius_m: of(0.127, "by its name: 1045 is 10 inches across"),
            air_density_kg_m3: of(1.225, DENSITY),
        },
        motor: MotorParameters {
            resistance_ohm: of(
                0.11,
                "estimated: another 920 rpm/V motor, RCTimer MT2610, in JBannwarth/multirotor_model, \
                 scripts/MotorRcTimerMt2610.m",
            ),
            constant_v_s_rad: of(0.010_380, "by its name: 2212, 920 rpm/V"),
            viscous_n_m_s: of(6.8e-6, "estimated: 0.7 A idle of that MT2610, at 11.1 V"),
            inertia_kg_m2: of(
                3.90e-5,
                "derived: MRS's motor time constant 0.03 s, taken as the response about hover with its load",
            ),
            rotor_inertia_kg_m2: of(3.90e-5, "direct drive: all that turns"),
            gear_ratio: of(1.0, "direct drive"),
        },
        battery: BatteryParameters {
            voltage_v: of(11.1, "three lithium polymer cells"),
            full_v: of(12.6, LIPO_FULL),
            empty_v: of(10.5, LIPO_EMPTY),
            capacity_a_h: of(5.0, "estimated: a usual size"),
            resistance_ohm: of(0.03, "estimated: 5 milliohm per cell and as much again in leads"),
        },
        controller: ControllerParameters {
            period_s: of(0.004, "estimated: 250 runs per second"),
            derivative_filter_s: of(0.02, TUNED),
            roll: of(LoopGains { proportional: 2.3, derivative: 0.41, limit_v: 1.5 }, TUNED),
            pitch: of(LoopGains { proportional: 2.3, derivative: 0.41, limit_v: 1.5 }, TUNED),
            yaw_rate: of(LoopGains { proportional: 0.8, derivative: 0.0, limit_v: 0.8 }, TUNED),
            climb: of(LoopGains { proportional: 1.7, derivative: 0.0, limit_v: 1.7 }, TUNED),
            tilt_rad_max: of(0.349_066, "estimated: 20 degrees"),
            yaw_rate_rad_s_max: of(1.745_329, "estimated: 100 degrees/s"),
            climb_m_s_max: of(1.5, "estimated: chosen here"),
        },
    },
];
