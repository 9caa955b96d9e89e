#!/usr/bin/env bash
# What the transport corrections cost on the paper's own cases: the cavity of CTVF section 4.2 with 50 a side and the rings of
# section 4.6, in turns with and without them on one thread; processor time a step.
# Arguments: the program (built here unless given), and how often each is run (5).
set -euo pipefail
cd "$(dirname "$0")/../../.."
program=${1:-}
times=${2:-5}
if [ -z "$program" ]; then
    cargo build --release -q
    program=target/release/piola
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
TIMEFORMAT=%U
# Name of a case, its time in s, and corrections: microseconds of processor time a step.
cost() {
    local seconds steps
    seconds=$({ time "$program" run "cases/ctvf/$1/case.toml" --threads 1 --quiet --out "$out" --set "time.end=$2" \
        --set 'picture=[]' --set "output.every=$2" --set "output.table_every=$2" --set "scheme.corrections='$3'" >/dev/null 2>"$out.log"; } 2>&1)
    steps=$(tail -n 1 "$out/steps.csv" | cut -d, -f2)
    rm -rf "$out"
    awk -v s="$seconds" -v n="$steps" 'BEGIN { print 1e6 * s / n }'
}
for case in "cavity 1.0" "rings 1e-3"; do
    read -r name end <<<"$case"
    ratios=()
    for ((k = 0; k < times; k++)); do
        full=$(cost "$name" "$end" full)
        none=$(cost "$name" "$end" none)
        ratios+=("$(awk -v a="$full" -v b="$none" 'BEGIN { printf "%.3f", a / b }')")
        echo "$name: full $full us a step, none $none us, ratio ${ratios[-1]}"
    done
    echo "$name: median ratio $(printf '%s\n' "${ratios[@]}" | sort -g | sed -n "$(((times + 1) / 2))p")"
done
