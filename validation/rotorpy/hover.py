"""A client that is not ours: rotorpy loads the exported constants and hovers at the speed that was heard.

    cargo xtask validate

runs `hovertone demo`, exports its results to every format, and then this script with rotorpy 3.0.0:

    python hover.py RESULTS.json FOLDER_OF_EXPORTS OUT.json

For each load of the demo rotorpy's Multirotor (its hummingbird, updated by `exported_rotorpy.py` as a user would do it) is started
0.3 m off its place under rotorpy's own SE3Control and flown for 10 s; the mean shaft speed of the last 2 s is compared with what
was heard: within 0.1 %. rotorpy's gravity is 9.81 m/s^2, the demo's 9.80: it is set, in vehicle and controller.

The other formats are read here by Python's own parsers, in each program's own unit and by its own formula, and must hover at the
same speed.
"""

import ast
import datetime
import json
import platform
import re
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import yaml
from rotorpy.controllers.quadrotor_control import SE3Control
from rotorpy.vehicles.hummingbird_params import quad_params
from rotorpy.vehicles.multirotor import Multirotor

STEP_S, FLIGHT_S, JUDGED_S, START_OFF_M = 0.005, 10.0, 2.0, 0.3
TOLERANCE = 1e-3


def identified_from(text):
    """The dictionary of the export, as Python reads it."""
    tree = ast.parse(text)
    assignment = next(node for node in tree.body if isinstance(node, ast.Assign))
    return ast.literal_eval(assignment.value)


def hover(parameters, gravity_m_s2):
    """Mean shaft speed and height error of the last seconds of a flight under rotorpy's own controller."""
    start_rad_s = 0.9 * np.sqrt(parameters["mass"] * gravity_m_s2 / (4 * parameters["k_eta"]))
    state = {
        "x": np.array([START_OFF_M, -START_OFF_M, START_OFF_M]), "v": np.zeros(3), "q": np.array([0.0, 0.0, 0.0, 1.0]),
        "w": np.zeros(3), "wind": np.zeros(3), "rotor_speeds": np.full(4, start_rad_s),
    }
    vehicle, controller = Multirotor(parameters, initial_state=state), SE3Control(parameters)
    vehicle.g = controller.g = gravity_m_s2
    vehicle.weight = np.array([0.0, 0.0, -parameters["mass"] * gravity_m_s2])
    place = {name: np.zeros(3) for name in ("x", "x_dot", "x_ddot", "x_dddot", "x_ddddot")} | {"yaw": 0.0, "yaw_dot": 0.0, "yaw_ddot": 0.0}
    speeds = []
    for step in range(round(FLIGHT_S / STEP_S)):
        state = vehicle.step(state, controller.update(step * STEP_S, state, place), STEP_S)
        if (step + 1) * STEP_S > FLIGHT_S - JUDGED_S:
            speeds.append(np.mean(state["rotor_speeds"]))
    return float(np.mean(speeds)), float(np.linalg.norm(state["x"]))


def constants_by_other_parsers(folder):
    """Thrust of one rotor at w rad/s by each program's own formula, from its file, in N."""
    rpm, rev_s = 60 / (2 * np.pi), 1 / (2 * np.pi)

    def xml(name):
        return ElementTree.fromstring((folder / name).read_text())

    def motor_constant(name):
        return float(xml(name).find(".//motorConstant").text)

    def polynomial_of_rpm(name):
        a, b, c = next(iter(tomllib.loads((folder / name).read_text()).values()))["rpm2thrust"]
        return lambda w: a + b * (w * rpm) + c * (w * rpm) ** 2

    gazebo, px4 = motor_constant("gazebo"), motor_constant("px4")
    rotors = next(float(e.get("value")) for e in xml("rotors").iter("{http://www.ros.org/wiki/xacro}property") if e.get("name") == "motor_constant")
    kf = float(xml("gym-pybullet-drones").find(".//properties").get("kf"))
    polynomial = yaml.safe_load((folder / "flightmare").read_text())["quadrotor_dynamics"]["thrust_map"]
    polynomial = [float(number) for number in polynomial]  # YAML 1.1 reads 1.0e-6 as a number and 1e-6 as a word
    airsim = dict(re.findall(r"real_T (\w+) = ([-+.\de]+)f;", (folder / "airsim").read_text()))
    c_t, density, diameter = (float(airsim[name]) for name in ("C_T", "air_density", "propeller_diameter"))
    own = json.loads((folder / "json").read_text())["thrust_constant_per_rotor_n_rpm2"]
    own_yaml = float(yaml.safe_load((folder / "yaml").read_text())["thrust_constant_per_rotor_n_rev_s2"])
    return {
        "gazebo": lambda w: gazebo * w**2,
        "px4": lambda w: px4 * w**2,
        "rotors": lambda w: rotors * w**2,
        "gym-pybullet-drones": lambda w: kf * (w * rpm) ** 2,
        "flightmare": lambda w: polynomial[0] * w**2 + polynomial[1] * w + polynomial[2],
        "airsim": lambda w: c_t * density * (w * rev_s) ** 2 * diameter**4,
        "crazyflow": polynomial_of_rpm("crazyflow"),
        "crazyflie": polynomial_of_rpm("crazyflie"),
        "json": lambda w: own * (w * rpm) ** 2,
        "yaml": lambda w: own_yaml * (w * rev_s) ** 2,
    }


def main():
    results_path, folder, out = (Path(argument) for argument in sys.argv[1:4])
    results = json.loads(results_path.read_text())
    exported = identified_from((folder / "rotorpy").read_text())
    loads, worst = [], 0.0
    gravity_m_s2 = results["settings"]["experiment"]["loads"][0]["force"]["gravity_m_s2"]
    for load in results["loads"]:
        parameters = quad_params | exported | {"mass": load["mass_kg"]}
        speed_rad_s, off_m = hover(parameters, gravity_m_s2)
        error = speed_rad_s / load["speed_rad_s"] - 1
        worst = max(worst, abs(error))
        assert off_m < 1e-2, f"{load['name']}: rotorpy did not hover, {off_m} m off"
        loads.append({
            "load": load["name"], "mass_kg": load["mass_kg"], "heard_rad_s": load["speed_rad_s"],
            "rotorpy_rad_s": speed_rad_s, "difference_percent": 100 * error,
        })
    others = {}
    for name, thrust in constants_by_other_parsers(folder).items():
        carried = [4 * thrust(load["heard_rad_s"]) / (load["mass_kg"] * gravity_m_s2) for load in loads]
        # thrust goes with the square of the speed
        others[name] = 100 * max((abs(np.sqrt(1 / share) - 1) for share in carried))
    report = {
        "date": datetime.date.today().isoformat(),
        "versions": {
            "hovertone": results["version"], "rotorpy": version("rotorpy"), "numpy": version("numpy"), "scipy": version("scipy"),
            "python": platform.python_version(),
        },
        "experiment": "hovertone demo, seed 1",
        "tolerance_percent": 100 * TOLERANCE,
        "rotorpy": loads,
        "other_formats_largest_difference_percent": others,
    }
    out.write_text(json.dumps(report, indent=2) + "\n")
    print(json.dumps(report, indent=2))
    assert worst < TOLERANCE, f"rotorpy hovers {100 * worst:.3f} % off what was heard"
    assert max(others.values()) < 100 * TOLERANCE, others


if __name__ == "__main__":
    main()
