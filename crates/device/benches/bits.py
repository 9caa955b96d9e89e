#!/usr/bin/env python3
"""Compares the files of runs on the processor and on a device. Arguments: the program piola, the device."""

import json
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

PIOLA, DEVICE = sys.argv[1:3]

OGDEN = (
    "body.strip.material={ kind = 'ogden', density = 1000.0, moduli = [0.63e6, 1.2e3, -1e4], "
    "exponents = [1.3, 5.0, -2.0], bulk_modulus = 2e6, plane = 'strain' }"
)
SPALL = "body.{}.material.spall_strength=1.5e9"
CORRECTED = "scheme.corrected_gradients=true"
BY_LAW = "scheme.pressure='state_equation'"
PUSHED = "scheme.shifting='background'"
# Case, most steps, and what is set besides.
RUNS = [
    ("ctvf/taylor-green", 100, "output.every=0.05"),
    ("ctvf/taylor-green", 100, "scheme.kernel='gaussian'"),
    ("ctvf/taylor-green-3d", 100, "output.every=0.02"),
    ("ctvf/cavity", 300, "output.every=0.1"),
    ("ctvf/poiseuille", 300, "output.every=0.05"),
    ("ctvf/still-water", 300, "output.every=0.05"),
    ("ctvf/dam-break", 400, "output.every=0.02"),
    ("ctvf/dam-break-3d", 400, "output.every=0.1"),
    ("dual-support/free-vibration", 200, "parameters.dx=0.5", "output.every=0.01"),
    ("total-lagrangian/presets", 200, "output.every=0.05"),
    ("total-lagrangian/presets", 200, "scheme.kind='dual_support'"),
    ("total-lagrangian/presets", 200, "scheme.kind='elastodynamics'"),
    ("total-lagrangian/presets", 200, OGDEN),
    (
        "total-lagrangian/presets",
        200,
        "scheme.viscosity=100",
        "scheme.artificial_viscosity=[1, 2]",
        "scheme.damping=0.1",
    ),
    ("elastodynamics/hole", 200),
    ("elastodynamics/biaxial", 200),
    ("elastodynamics/wave-2d", 200),
    ("elastodynamics/wave-3d", 100),
    ("elastodynamics/pulse-3d", 100),
    ("elastodynamics/reflection-3d", 100),
    ("upwind/bar-sine", 200),
    ("upwind/bar-step", 200),
    ("upwind/piston", 200),
    ("upwind/piston-gamma", 200, "time.integrator='ssp_rk3'", "time.step=0.01"),
    ("upwind/impact-linear", 200),
    ("upwind/column-impact", 200),
    (
        "upwind/column-impact",
        200,
        "scheme.reconstruction=true",
        "scheme.wave_speed='stretch'",
    ),
    ("upwind/column-impact-3d", 100),
    ("upwind/dam-break", 200),
    ("upwind/dam-break-3d", 100),
    ("upwind/drop-3d", 100),
    ("ctvf/swinging-plate", 200),
    ("ctvf/swinging-plate", 200, "scheme.pressure='edac'"),
    ("ctvf/swinging-plate-3d", 100),
    ("ctvf/rings", 200),
    ("ctvf/rings", 200, "scheme.self_contact=10.0"),
    ("ctvf/rings-3d", 100),
    ("ctvf/impact", 200),
    ("ctvf/impact", 200, SPALL.format("projectile"), SPALL.format("plate")),
    ("ctvf/impact-3d", 100),
    ("ctvf/taylor-bar", 100),
    ("ctvf/compression", 200),
    ("ctvf/contact", 200),
    ("ctvf/contact", 200, "scheme.contact='repulsive'"),
    ("ctvf/johnson-cook", 200),
    ("ctvf/plane-shock", 200),
    (
        "ctvf/plane-shock",
        200,
        "body.bar.material.pressure_law={ kind = 'tait', exponent = 4.0 }",
    ),
    ("ctvf/taylor-green", 100, CORRECTED),
    ("ctvf/dam-break", 400, CORRECTED),
    ("ctvf/dam-break-3d", 400, CORRECTED),
    ("ctvf/dam-break", 400, BY_LAW),
    ("ctvf/dam-break", 400, PUSHED, BY_LAW),
    ("ctvf/rings", 200, PUSHED),
    ("ctvf/swinging-plate", 200, PUSHED),
]


def run(case, steps, changes, device, folder):
    changes = [f"time.max_steps={steps}", *changes]
    command = [PIOLA, "run", f"cases/{case}/case.toml", "--quiet", "--threads", "2"]
    command += ["--out", str(folder), "--device", device]
    command += [word for change in changes for word in ("--set", change)]
    return subprocess.run(command, capture_output=True, text=True).stderr


def compare(row):
    case, steps, *changes = row
    with tempfile.TemporaryDirectory() as scratch:
        here, there = (pathlib.Path(scratch) / name for name in ("here", "there"))
        run(case, steps, changes, "processor", here)
        said = run(case, steps, changes, DEVICE, there)
        files = [path for path in here.rglob("*") if path.suffix in (".csv", ".vtp")]
        others = [there / path.relative_to(here) for path in files]
        differ = sum(
            not other.exists() or path.read_bytes() != other.read_bytes()
            for path, other in zip(files, others)
        )
        try:
            steps = json.loads((there / "run.json").read_text())["steps"]
        except OSError:
            steps = f"no steps ({said.strip()[:200]})"
    return f"{differ} of {len(files)} files differ after {steps} steps: {case} {' '.join(changes)}"


with ThreadPoolExecutor(8) as pool:
    for line in pool.map(compare, RUNS):
        print(line, flush=True)
