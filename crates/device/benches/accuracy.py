#!/usr/bin/env python3
"""What single precision costs: the largest difference of columns of probes and energies between a run with pairs in single
precision and one on the processor, over the largest value of the column. Arguments: the program piola, the device."""

import csv
import pathlib
import subprocess
import sys
import tempfile

PIOLA, DEVICE = sys.argv[1:3]

# Case, columns, and what is set.
RUNS = [
    ("ctvf/taylor-green", "probes:fastest.velocity.magnitude probes:pressure.error energy:kinetic", "time.end=0.5"),
    ("ctvf/dam-break-3d", "probes:toe.position.x probes:tank.force.x energy:kinetic", "time.end=0.3"),
    ("ctvf/swinging-plate", "probes:tip.position.y energy:kinetic energy:total", "parameters.across=10", "time.end=0.04"),
    ("ctvf/taylor-bar", "probes:foot.position.x probes:strain.plastic_strain energy:total", "parameters.across=8", "time.end=20e-6"),
    ("ctvf/rings", "probes:A.position.x energy:kinetic energy:total", "time.end=0.002"),
    ("upwind/piston", "probes:top.displacement.y probes:top.pressure energy:total", "time.end=5"),
    ("upwind/bar-sine", "probes:tip.displacement.x probes:clamp.pressure energy:total", "time.end=3"),
    ("upwind/column-impact", "probes:top.displacement.y probes:floor.pressure energy:total", "time.end=1"),
    ("dual-support/free-vibration", "probes:tip.displacement.y energy:strain energy:total", "parameters.dx=0.5", "time.end=0.1"),
    ("total-lagrangian/presets", "probes:tip.displacement.y energy:strain energy:total", "time.end=2"),
]


def tables(case, changes, more, folder):
    command = [PIOLA, "run", f"cases/{case}/case.toml", "--quiet", "--out", folder, *more]
    subprocess.run(command + [word for change in changes for word in ("--set", change)], check=True)
    found = {}
    for name in ("probes", "energy"):
        with open(pathlib.Path(folder) / f"{name}.csv") as file:
            head, *rows = csv.reader(file)
        for column, title in enumerate(head):
            key = f"{name}:{title.split(' [')[0]}"
            found[key] = [float(row[column]) for row in rows]
    return found


for case, columns, *changes in RUNS:
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        double = tables(case, changes, [], one)
        single = tables(case, changes, ["--device", DEVICE, "--precision", "single"], other)
    for column in columns.split():
        pairs = list(zip(double[column], single[column]))
        most = max(abs(value) for value, _ in pairs)
        off = max(abs(value - other) for value, other in pairs)
        print(f"| `cases/{case}` {' '.join(changes)} | {column.split(':')[1]} | {off / most:.1e} |", flush=True)
