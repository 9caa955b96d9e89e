#!/usr/bin/env bash
# All measurements of docs/devices.md in one call: bits and times of the passes, and what the compiler
# makes of them. Arguments: the program (built here unless given), and particles a side (100).
set -uo pipefail
cd "$(dirname "$0")/../../.."
program=${1:-}
side=${2:-100}
if [ -z "$program" ]; then
    program=$(cargo bench -p piola-device --bench device --no-run 2>&1 | sed -n 's/.*(\(.*device-.*\)).*/\1/p')
fi
# NVRTC from PyPI or a toolkit, where the loader does not know it.
for folder in $(find / -name 'libnvrtc.so.1*' -not -path '/proc/*' -printf '%h\n' 2>/dev/null | sort -u); do
    LD_LIBRARY_PATH="$folder:${LD_LIBRARY_PATH:-}"
done
export LD_LIBRARY_PATH
if command -v nvidia-smi >/dev/null; then
    nvidia-smi --query-gpu=name,driver_version,clocks.max.sm,clocks.max.mem,memory.total --format=csv
fi
grep -m1 'model name' /proc/cpuinfo
nproc
time "$program" "$side" 32
