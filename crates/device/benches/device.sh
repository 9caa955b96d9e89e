#!/usr/bin/env bash
# All measurements of docs/devices.md: the files of runs on the processor and on a device, and times of steps.
# Arguments: the program piola, the device (cuda:0), and `bits` or `speed` for one of both.
set -uo pipefail
cd "$(dirname "$0")/../../.."
piola=${1:?the program piola}
device=${2:-cuda:0}
part=${3:-all}
scripts=crates/device/benches
# NVRTC from PyPI or a toolkit, where the loader does not know it.
for folder in $(find / -name 'libnvrtc.so.1*' -not -path '*/stubs/*' -not -path '/proc/*' -printf '%h\n' 2>/dev/null | sort -u); do
    LD_LIBRARY_PATH="$folder:${LD_LIBRARY_PATH:-}"
done
export LD_LIBRARY_PATH
if command -v nvidia-smi >/dev/null; then
    nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
fi
grep -m1 'model name' /proc/cpuinfo
nproc
[ "$part" = speed ] || python3 "$scripts/bits.py" "$piola" "$device"
[ "$part" = bits ] && exit 0

# speed LABEL CASE STEPS ...: milliseconds a step over the last three quarters of the steps.
speed() { python3 "$scripts/speed.py" "$piola" "$@"; }
# With this each pass waits for the one before it, so that its own time shows.
by_pass() { CUDA_LAUNCH_BLOCKING=1 speed "$@"; }
quiet=(--set time.end=5 --set output.every=5 --set output.table_every=5)
box=(cases/ctvf/taylor-green-3d/case.toml)
large=("${quiet[@]}" --set parameters.side=100 --set parameters.layers=100)
# Supports of 2.7 spacings in place of 3: 80 neighbours in place of 107.
few=("${large[@]}" --set scheme.smoothing_length=0.9)
small=("${quiet[@]}" --set parameters.side=50 --set parameters.layers=50)
dam=(cases/ctvf/dam-break-3d/case.toml)
wet=("${quiet[@]}" --set parameters.dx=0.0125)
block=$scripts/block.toml
for precision in double single; do
    on=(--device "$device" --precision "$precision")
    by_pass "taylor-green-3d, few neighbours, by pass, $precision" "${box[@]}" 200 "${few[@]}" "${on[@]}"
    by_pass "taylor-green-3d by pass, $precision" "${box[@]}" 200 "${large[@]}" "${on[@]}"
    by_pass "block by pass, $precision" "$block" 400 "${on[@]}"
    by_pass "block of 531441 by pass, $precision" "$block" 400 --set parameters.n=80 "${on[@]}"
    by_pass "block of 132651 by pass, $precision" "$block" 400 --set parameters.n=50 "${on[@]}"
    speed "taylor-green-3d, $precision" "${box[@]}" 400 "${large[@]}" "${on[@]}"
    speed "block, $precision" "$block" 1000 "${on[@]}"
    speed "dam-break-3d, $precision" "${dam[@]}" 400 "${wet[@]}" "${on[@]}"
    speed "column-impact-3d (upwind), $precision" cases/upwind/column-impact-3d/case.toml 1000 "${quiet[@]}" --set body.column.spacing=0.05 --set scheme.smoothing_length=0.13 "${on[@]}"
done
speed "taylor-green-3d, 16 threads" "${box[@]}" 12 "${large[@]}" --threads 16
speed "taylor-green-3d, 125000 particles, one core" "${box[@]}" 8 "${small[@]}" --threads 1
speed "block of 132651, 16 threads" "$block" 40 --set parameters.n=50 --threads 16
speed "block of 132651, one core" "$block" 12 --set parameters.n=50 --threads 1
