"""Reference for the rigid body: an aggressive flight of rotorpy's Multirotor, written as CSV.

    python3 -m venv venv && venv/bin/pip install rotorpy==3.0.0
    venv/bin/python make_reference.py > rigid_body.csv

rotorpy (Spencer Folk and others, https://github.com/spencerfolk/rotorpy) is an independent simulator. Its Multirotor integrates
the rigid body, and first-order rotor speeds towards commanded ones, by scipy's solve_ivp; here with DOP853 at relative tolerance
1e-12. Aerodynamic drag is off (its law is another one). The vehicle is the AR.Drone of crates/vehicle, with products of inertia
that the real one does not have, so that the whole of Euler's equations is examined. rotorpy's rotor_directions are the signs of the
torque on the body; it has no gyroscopic torque of the rotors. Gravity is rotorpy's 9.81.

crates/sim/tests/rotorpy_reference.rs flies the same in Rust.
"""

import platform
import sys
from importlib.metadata import version

import numpy as np
from rotorpy.vehicles.multirotor import Multirotor

LEVER = 0.1785 / np.sqrt(2.0)
PARAMETERS = {
    "mass": 0.413,
    "Ixx": 2.237568e-3, "Iyy": 2.985236e-3, "Izz": 4.80374e-3, "Ixy": 1.0e-4, "Ixz": -2.0e-4, "Iyz": 3.0e-4,
    "num_rotors": 4,
    "rotor_pos": {
        "r1": np.array([LEVER, LEVER, 0.0]), "r2": np.array([-LEVER, LEVER, 0.0]),
        "r3": np.array([-LEVER, -LEVER, 0.0]), "r4": np.array([LEVER, -LEVER, 0.0]),
    },
    "rotor_directions": np.array([1, -1, 1, -1]),
    "rotor_speed_min": 0.0, "rotor_speed_max": 600.0,
    "k_eta": 7.0775e-6, "k_m": 2.1308e-7, "tau_m": 0.0235, "motor_noise_std": 0.0,
}
# Commanded rotor speeds, rad/s, each for a quarter of a second: hover, roll, pitch, yaw, climb, and mixtures of them.
COMMANDS = [
    [378.0, 378.0, 378.0, 378.0], [390.0, 390.0, 366.0, 366.0], [360.0, 360.0, 396.0, 396.0], [385.0, 385.0, 371.0, 371.0],
    [366.0, 390.0, 390.0, 366.0], [396.0, 360.0, 360.0, 396.0], [430.0, 320.0, 430.0, 320.0], [420.0, 420.0, 420.0, 420.0],
    [330.0, 400.0, 350.0, 390.0], [410.0, 340.0, 380.0, 360.0], [300.0, 310.0, 305.0, 320.0], [440.0, 430.0, 445.0, 425.0],
]
HOLD_S, ROW_S = 0.25, 0.05


def main():
    state = {
        "x": np.array([1.0, -2.0, 50.0]), "v": np.array([0.5, 1.0, -0.5]), "q": np.array([0.0, 0.0, 0.0, 1.0]),
        "w": np.array([0.4, -0.3, 0.8]), "wind": np.zeros(3), "rotor_speeds": np.full(4, 378.0),
    }
    solver = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
    vehicle = Multirotor(PARAMETERS, initial_state=state, control_abstraction="cmd_motor_speeds", aero=False,
                         integrator_kwargs=solver)
    packages = ", ".join(f"{name} {version(name)}" for name in ("rotorpy", "numpy", "scipy"))
    print(f"# validation/rotorpy/make_reference.py; {packages}, Python {platform.python_version()}")
    print("time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz,p_rad_s,q_rad_s,r_rad_s,"
          "speed1_rad_s,speed2_rad_s,speed3_rad_s,speed4_rad_s")
    write(0.0, state)
    rows = round(HOLD_S / ROW_S)
    for k, command in enumerate(COMMANDS):
        for row in range(1, rows + 1):
            state = vehicle.step(state, {"cmd_motor_speeds": np.array(command)}, ROW_S)
            write(k * HOLD_S + row * ROW_S, state)


def write(time_s, state):
    qx, qy, qz, qw = state["q"]
    numbers = [*state["x"], *state["v"], qw, qx, qy, qz, *state["w"], *state["rotor_speeds"]]
    print(f"{time_s:.2f}," + ",".join(f"{number:.15g}" for number in numbers))


if __name__ == "__main__":
    sys.exit(main())
