#!/usr/bin/env bash
# All measurements of docs/devices.md in one call: bits and times of passes and lists, what the compiler makes of
# them, and, given the program piola, bits and times of whole runs. Arguments: the program of the benchmark
# (built here unless given), particles a side (100), the program piola (none), the device (cuda:0).
set -uo pipefail
cd "$(dirname "$0")/../../.."
program=${1:-}
side=${2:-100}
piola=${3:-}
device=${4:-cuda:0}
if [ -z "$program" ]; then
    program=$(cargo bench -p piola-device --bench device --no-run 2>&1 | sed -n 's/.*(\(.*device-.*\)).*/\1/p')
fi
# NVRTC from PyPI or a toolkit, where the loader does not know it.
for folder in $(find / -name 'libnvrtc.so.1*' -not -path '*/stubs/*' -not -path '/proc/*' -printf '%h\n' 2>/dev/null | sort -u); do
    LD_LIBRARY_PATH="$folder:${LD_LIBRARY_PATH:-}"
done
export LD_LIBRARY_PATH
if command -v nvidia-smi >/dev/null; then
    nvidia-smi --query-gpu=name,driver_version,clocks.max.sm,clocks.max.mem,memory.total --format=csv
fi
grep -m1 'model name' /proc/cpuinfo
nproc
time "$program" "$side" 32 "$device"
[ -n "$piola" ] || exit 0

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

# bits CASE STEPS ...: the files of a run on the processor and on the device.
bits() {
    local name=$1 steps=$2
    shift 2
    for where in processor "$device"; do
        "$piola" run "cases/ctvf/$name/case.toml" --set time.max_steps="$steps" "$@" --device "$where" \
            --out "$results/$where" --quiet 2>/dev/null
    done
    local differ=0 files=0
    for file in $(cd "$results/processor" && find . -name '*.csv' -o -name '*.vtp'); do
        files=$((files + 1))
        cmp -s "$results/processor/$file" "$results/$device/$file" || differ=$((differ + 1))
    done
    echo "bits of $name after at most $steps steps: $differ of $files files differ"
    rm -rf "$results/processor" "${results:?}/$device"
}

# speed CASE STEPS WHERE ...: milliseconds a step, between a quarter of the steps and all of them.
speed() {
    local name=$1 steps=$2 where=$3
    shift 3
    for count in $((steps / 4)) "$steps"; do
        "$piola" run "cases/ctvf/$name/case.toml" --set time.max_steps="$count" --set time.end=5 \
            --set output.every=5 --set output.table_every=5 "$@" --device "$where" --out "$results/$count" \
            --quiet 2>/dev/null
    done
    python3 - "$results/$((steps / 4))/run.json" "$results/$steps/run.json" "$name on $where $*" <<'PY'
import json, sys
first, last = (json.load(open(path)) for path in sys.argv[1:3])
steps = last["steps"] - first["steps"]
passes = {p["name"]: p["seconds"] for p in last["passes"]}
for p in first["passes"]:
    passes[p["name"]] -= p["seconds"]
ms = {name: 1e3 * seconds / steps for name, seconds in passes.items()}
print(f"{sys.argv[3]}: {sum(ms.values()):.2f} ms a step;", ", ".join(f"{n} {t:.2f}" for n, t in ms.items() if t > 0.05))
PY
    rm -rf "${results:?}"/*
}

bits taylor-green 300 --set output.every=0.1
bits taylor-green-3d 100 --set output.every=0.02
bits cavity 300 --set output.every=0.1
bits poiseuille 300 --set output.every=0.05
bits still-water 300 --set output.every=0.05
bits dam-break-3d 600 --set output.every=0.1
box=(--set parameters.side=100 --set parameters.layers=100)
dam=(--set parameters.dx=0.0125)
speed taylor-green-3d 240 "$device" "${box[@]}"
speed dam-break-3d 240 "$device" "${dam[@]}"
speed taylor-green 240 "$device" --set parameters.side=1000
# Each pass waits for the one before it here, so that its own time shows.
CUDA_LAUNCH_BLOCKING=1 speed taylor-green-3d 120 "$device" "${box[@]}"
CUDA_LAUNCH_BLOCKING=1 speed dam-break-3d 120 "$device" "${dam[@]}"
speed taylor-green-3d 4 processor "${box[@]}" --threads 1
speed taylor-green-3d 12 processor "${box[@]}"
speed dam-break-3d 12 processor "${dam[@]}"
speed taylor-green 12 processor --set parameters.side=1000
