#!/usr/bin/env python3
"""Milliseconds a step over the last three quarters of a run, from its progress; with CUDA_LAUNCH_BLOCKING the times of its
passes, from two runs. Arguments: the program piola, a label, the case, the steps, and more for `piola run`."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

PIOLA, LABEL, CASE, STEPS, *MORE = sys.argv[1:]
STEPS = int(STEPS)


def run(steps, folder):
    """The record of a run, and when it said that it was at which step."""
    command = [PIOLA, "run", CASE, "--set", f"time.max_steps={steps}", "--json-progress", "--out", folder]
    points, said = [], ""
    with subprocess.Popen(command + MORE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as piola:
        for line in piola.stdout:
            event = json.loads(line)
            if event["event"] == "progress":
                points.append((time.time(), event["step"]))
            said = event.get("message", said)
    try:
        return json.loads((pathlib.Path(folder) / "run.json").read_text()), points
    except OSError:
        sys.exit(f"{LABEL}: {said}")


def passes(record):
    return {entry["name"]: entry["seconds"] for entry in record["passes"]}


with tempfile.TemporaryDirectory() as folder:
    begin = time.time()
    record, points = run(STEPS, folder)
    if os.environ.get("CUDA_LAUNCH_BLOCKING"):
        first, _ = run(STEPS // 4, folder)
        before, after = passes(first), passes(record)
        steps = record["steps"] - first["steps"]
        times = {name: 1e3 * (after[name] - before.get(name, 0.0)) / steps for name in after}
        parts = ", ".join(f"{name} {spent:.2f}" for name, spent in times.items() if spent > 0.005)
        print(f"{LABEL}: {sum(times.values()):.2f} ms a step without the look: {parts}", flush=True)
    else:
        late = [point for point in points if point[1] >= STEPS / 4]
        (start, first), (end, last) = late[0], late[-1]
        spent = 1e3 * (end - start) / max(last - first, 1)
        print(f"{LABEL}: {spent:.2f} ms a step over {last - first} steps; begun after {points[0][0] - begin:.0f} s", flush=True)
