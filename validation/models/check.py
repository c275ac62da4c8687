"""Exports and changed models in the hands of the programs that they are for.

    cargo xtask validate

runs it after `hovertone demo` and its exports:

    python check.py HOVERTONE RESULTS.json FOLDER_OF_EXPORTS OUT.json

Every XML is parsed as a whole file with one root. Then, where the program is installed (in continuous integration, where CI is set,
a program that is not installed is an error):

- SDF: `gz sdf --check`, or `ign sdf --check` of Debian's ignition-tools and libsdformat-dev, as PX4 checks its models.
- URDF: `check_urdf` of Debian's liburdfdom-tools. pybullet loads it and flies: four forces kf rpm^2 at the speed that was heard carry
  the vehicle; the acceleration that remains is told as a difference of speed, which must stay below 0.1 %. (gym-pybullet-drones itself
  is in no package registry; this is its formula on its engine.)
- xacro: the program expands the export, and the changed model.
- rotorpy: its own hummingbird, changed in place, hovers under its own controller at the speed that was heard.

`hovertone export --into` changes copies of the models beside this script; each line that differs must be a line of the constant.
"""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import xacro

TOLERANCE = 1e-3
RPM = 60 / (2 * np.pi)
HERE = Path(__file__).parent


def tool(*words):
    """Runs a checker of another project; None where it is not installed."""
    if shutil.which(words[0]) is None:
        return None
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0 and "Error" not in done.stderr + done.stdout, f"{words}: {done.stdout}{done.stderr}"
    return "accepted"


def not_installed(what, how):
    """Says that a check is left out; continuous integration leaves none out."""
    assert not os.environ.get("CI"), f"{what} is not installed: {how}"
    return f"{what} is not installed"


def check_sdf(path):
    verdict = tool("gz", "sdf", "--check", str(path)) or tool("ign", "sdf", "--check", str(path))
    return verdict or not_installed("a checker of SDF", "apt-get install ignition-tools libsdformat-dev")


def check_urdf(path):
    return tool("check_urdf", str(path)) or not_installed("check_urdf", "apt-get install liburdfdom-tools")


def expanded(path):
    """The XML after xacro, as text."""
    return xacro.process_file(str(path)).toprettyxml()


def changed(hovertone, results, model, folder):
    """A copy of a model after `export --into`; only lines with the constant may differ."""
    copy = folder / model.name
    shutil.copy(model, copy)
    subprocess.run([hovertone, "export", results, "--into", copy], check=True, capture_output=True)
    before, after = model.read_text().splitlines(), copy.read_text().splitlines()
    assert len(before) == len(after), copy
    differs = [new for old, new in zip(before, after) if old != new]
    words = ("motorConstant", "motor_constant", "kf=", "k_eta")
    assert differs and all(any(word in line for word in words) for line in differs), differs
    return copy


def fly_in_pybullet(path, speed_rad_s, gravity_m_s2):
    """What remains of gravity under four rotors at a speed, as a relative difference of speed."""
    import pybullet

    kf = float(ElementTree.parse(path).getroot().find("properties").get("kf"))
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -gravity_m_s2, physicsClientId=client)
        body = pybullet.loadURDF(str(path), [0, 0, 1], physicsClientId=client)
        pybullet.changeDynamics(body, -1, linearDamping=0, angularDamping=0, physicsClientId=client)
        step_s, steps = 1 / 240, 240
        thrust_n = kf * (speed_rad_s * RPM) ** 2
        for _ in range(steps):
            for x, y in ((1, 1), (1, -1), (-1, -1), (-1, 1)):
                place = [0.127 * x, 0.127 * y, 0]
                pybullet.applyExternalForce(body, -1, [0, 0, thrust_n], place, pybullet.LINK_FRAME, physicsClientId=client)
            pybullet.stepSimulation(physicsClientId=client)
        velocity, _ = pybullet.getBaseVelocity(body, physicsClientId=client)
    finally:
        pybullet.disconnect(client)
    # thrust goes with the square of the speed
    return 0.5 * velocity[2] / (step_s * steps) / gravity_m_s2


def fly_in_rotorpy(hovertone, results, folder, load, gravity_m_s2):
    """rotorpy's own hummingbird with the constant changed in place hovers with the mass of a load."""
    import rotorpy.vehicles.hummingbird_params as hummingbird

    sys.path.insert(0, str(HERE.parent / "rotorpy"))
    from hover import hover

    copy = changed(hovertone, results, Path(hummingbird.__file__), folder)
    spec = importlib.util.spec_from_file_location("changed", copy)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    speed_rad_s, off_m = hover(module.quad_params | {"mass": load["mass_kg"]}, gravity_m_s2)
    assert off_m < 1e-2, off_m
    return speed_rad_s / load["speed_rad_s"] - 1


def main():
    hovertone, results_path, exports, out = sys.argv[1], *(Path(argument) for argument in sys.argv[2:5])
    results = json.loads(results_path.read_text())
    load = results["loads"][0]
    gravity_m_s2 = results["settings"]["experiment"]["loads"][0]["force"]["gravity_m_s2"]
    constant = results["thrust_constant_per_rotor_n_s2"]["value"]
    # one constant for all loads: the hover of this one is off by its residual
    speed_rad_s = np.sqrt(load["mass_kg"] * gravity_m_s2 / (4 * constant))
    assert abs(speed_rad_s / load["speed_rad_s"] - 1) < TOLERANCE, "the loads do not agree"
    report = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for export, root in (("gazebo", "sdf"), ("px4", "sdf"), ("rotors", "robot"), ("gym-pybullet-drones", "robot")):
            assert ElementTree.parse(exports / export).getroot().tag == root
        models = {model.suffix: changed(hovertone, results_path, model, folder) for model in HERE.glob("quad.*")}
        report["gazebo"] = {"export": check_sdf(exports / "gazebo"), "changed model": check_sdf(models[".sdf"])}
        report["px4"] = {"export": check_sdf(exports / "px4")}
        expanded(exports / "rotors")
        assert f"{constant:.6e}"[:6] in expanded(models[".xacro"]), "xacro does not see the constant"
        report["rotors"] = {"export": "accepted", "changed model": "accepted"}
        urdf = {"export": check_urdf(exports / "gym-pybullet-drones"), "changed model": check_urdf(models[".urdf"])}
        try:
            off = fly_in_pybullet(models[".urdf"], load["speed_rad_s"], gravity_m_s2)
            assert abs(off) < TOLERANCE, f"pybullet hovers {100 * off:.3f} % off"
            urdf["speed in pybullet off by percent"] = 100 * off
        except ImportError:
            urdf["speed in pybullet off by percent"] = not_installed("pybullet", "pip install pybullet")
        report["gym-pybullet-drones"] = urdf
        off = fly_in_rotorpy(hovertone, results_path, folder, load, gravity_m_s2)
        assert abs(off) < TOLERANCE, f"rotorpy hovers {100 * off:.3f} % off"
        report["rotorpy"] = {"speed of the changed hummingbird off by percent": 100 * off}
    out.write_text(json.dumps(report, indent=2) + "\n")
    print(json.dumps(report, indent=2))


main()
