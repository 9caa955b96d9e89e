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
quiet=(--set time.end=5 --set output.every=5 --set output.table_every=5)
box=(cases/ctvf/taylor-green-3d/case.toml)
large=("${quiet[@]}" --set parameters.side=100 --set parameters.layers=100)
dam=(cases/ctvf/dam-break-3d/case.toml)
wet=("${quiet[@]}" --set parameters.dx=0.0125)
block=$scripts/block.toml
for precision in double single; do
    on=(--device "$device" --precision "$precision")
    speed "taylor-green-3d, $precision" "${box[@]}" 400 "${large[@]}" "${on[@]}"
    # Each pass waits for the one before it here, so that its own time shows.
    CUDA_LAUNCH_BLOCKING=1 speed "taylor-green-3d by pass, $precision" "${box[@]}" 200 "${large[@]}" "${on[@]}"
    speed "dam-break-3d, $precision" "${dam[@]}" 400 "${wet[@]}" "${on[@]}"
    speed "block, $precision" "$block" 2000 "${on[@]}"
    CUDA_LAUNCH_BLOCKING=1 speed "block by pass, $precision" "$block" 400 --set parameters.n=80 "${on[@]}"
    CUDA_LAUNCH_BLOCKING=1 speed "small block by pass, $precision" "$block" 400 --set parameters.n=50 "${on[@]}"
    speed "column-impact-3d (upwind), $precision" cases/upwind/column-impact-3d/case.toml 1000 "${quiet[@]}" --set body.column.spacing=0.05 --set scheme.smoothing_length=0.13 "${on[@]}"
done
speed "taylor-green-3d, 16 threads" "${box[@]}" 12 "${large[@]}"
speed "small block, 16 threads" "$block" 40 --set parameters.n=50
speed "small block, one core" "$block" 12 --set parameters.n=50 --threads 1
speed "taylor-green-3d, one core" "${box[@]}" 4 "${large[@]}" --threads 1
