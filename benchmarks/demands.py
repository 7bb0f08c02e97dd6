"""What flights of designs that are drawn at random ask for, against the margins and the supply.

    python benchmarks/demands.py [COUNT] [SEED]

Each design is sized by the command line, for Solo12 or a robot by hand, with a voltage, a power, a
layout, a radius and a drop of its own. Speeds and torques of `validation/*.csv` are read, and what
they take of winding and supply is computed here: nothing of the program is used. Prints a Markdown
table of the largest of each quantity over the margin's demand, which is not to be above 1 but for
the six digits of the series, and of the supply's power and current over what it gives.
"""

import csv
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from paired import SOLO12


def random_options(generator: random.Random) -> list[str]:
    """Arguments of a design."""
    options = ["--bus-voltage", f"{generator.choice([18, 20, 22.2, 24, 25.2, 36, 48])}V"]
    options += ["--bus-power", f"{generator.uniform(400, 900):.0f}W"]
    options += ["--r-max", f"{generator.uniform(45, 70):.0f}mm"]
    options += [
        "--layout",
        generator.choice(["pair", "pair", "triad", "orthogonal", "double-pair"]),
    ]
    if generator.random() < 0.5:
        options += ["--fall", f"{generator.uniform(0.7, 1.5):.2f}m", "--tilt", "20deg"]
    if generator.random() < 0.2:
        inertia = generator.choice(["0.03,0.055,0.07", "0.05,0.09,0.12"])
        mass = f"{generator.uniform(2, 6):.2f}"
        return ["--mass", mass, "--inertia", inertia, "--ballistic", *options]
    return [str(SOLO12), *options]


def shares_of_demands(folder: Path) -> dict[str, float]:
    """Largest of each quantity over its margin's demand, and over what the supply gives."""
    design = json.loads((folder / "design.json").read_text())
    motor, supply = design["ocs"]["motor"], design["supply"]
    names = [module["name"] for module in design["ocs"]["modules"]]
    loss, ratio, k_t = (motor[f] for f in ("gear_efficiency", "gear_ratio", "torque_constant"))
    gain, idle = loss * ratio * k_t, motor["no_load_current"] or 0.0
    most: dict[str, float] = {}
    for path in folder.glob("validation/*_with_ocs.csv"):
        heading, *rows = csv.reader(path.open(encoding="utf-8"))
        table = dict(zip(heading, np.array(rows, dtype=float).T, strict=True))
        speed = np.stack([table[f"wheel_speed_{name}_rad_s"] for name in names], axis=1)
        torque = np.stack([table[f"wheel_torque_{name}_nm"] for name in names], axis=1)
        # A torque is held from each sample to the next.
        held, at = np.concatenate([torque[:-1]] * 2), np.concatenate([speed[:-1], speed[1:]])
        shaft = held * at
        given = np.where(shaft > 0.0, shaft / loss, shaft * loss)
        drawn_power, fed_back = (
            (
                motor["resistance"] * (np.abs(held) / gain + current) ** 2
                + given
                + k_t * current * ratio * np.abs(at)
            ).sum(axis=1)
            for current in (idle, 0.0)
        )
        line = at / motor["no_load_speed"]
        line += (held + gain * idle * np.sign(at)) / motor["stall_torque"]
        found = {
            "wheel speed": np.abs(speed).max(),
            "motor torque": np.abs(torque).max() + gain * idle,
            "voltage line": np.abs(line).max(),
            "bus power": max(drawn_power.max(), table["bus_power_w"].max()),
            "bus power, fed back": -min(fed_back.min(), table["bus_power_w"].min()),
            "bus current": table["bus_current_a"].max(),
            "bus current, fed back": -table["bus_current_a"].min(),
        }
        most = {name: max(float(value), most.get(name, 0.0)) for name, value in found.items()}
    demands = {margin["name"]: margin["demand"] for margin in design["margins"]}
    shares = {name: value / demands[name] for name, value in most.items() if demands[name]}
    for key, name in (("power_max", "power"), ("current_max", "current")):
        largest = max(most[f"bus {name}"], most[f"bus {name}, fed back"])
        shares[f"supply's {name}"] = largest / supply[key]
    return shares


def main() -> None:
    numbers = [int(argument) for argument in sys.argv[1:]]
    count, seed = (*numbers, *(20, 15)[len(numbers) :])
    generator, worst = random.Random(seed), {}
    for number in range(count):
        options = random_options(generator)
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "ocs"
            command = [sys.executable, "-m", "ocs_design", "size", *options, "-q", "-o", str(out)]
            code = subprocess.run(command, check=False, capture_output=True).returncode
            if code not in {0, 1}:
                print(f"{number}: exit code {code}: {' '.join(options)}", file=sys.stderr)
                continue
            for name, share in shares_of_demands(out).items():
                worst[name] = max(share, worst.get(name, 0.0))
    print("| quantity | largest share |\n|---|---|")
    for name, share in worst.items():
        print(f"| {name} | {share:.6f} |")


if __name__ == "__main__":
    main()
