#!/usr/bin/env bash
# Runs all benchmarks on two cores, some again on one, and prints the table of README.md here in Markdown.
# Usage: table.sh FOLDER, where the programs were built; `ninja bench` does that. ASTROSPLAT_BENCH_CPUS=0,1 chooses the
# two cores, ASTROSPLAT_BENCH_RUNS=3 how many runs the medians are of, TMPDIR the disk. Needs about 8 GiB of memory, 4 GiB
# of disk and 2 to 7 minutes.
set -euo pipefail

programs=${1:?usage: table.sh FOLDER_OF_THE_PROGRAMS}
cpus=${ASTROSPLAT_BENCH_CPUS:-0,1}
runs=${ASTROSPLAT_BENCH_RUNS:-3}
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

# measure CORES CPUS PROGRAM [OPTION...]: writes PROGRAM.CORES.json
measure() {
    local cores=$1 on=$2 program=$3
    shift 3
    echo "$program on $cores ..." >&2
    taskset -c "$on" "$programs/${program}_bench" --benchmark_repetitions="$runs" --benchmark_format=json "$@" \
        > "$results/$program.$cores.json" 2> "$results/errors" || { cat "$results/errors" >&2; exit 1; }
}

measure 2 "$cpus" memory
measure 2 "$cpus" render
measure 2 "$cpus" look
measure 2 "$cpus" generate
measure 2 "$cpus" bodies
measure 2 "$cpus" files
measure 2 "$cpus" sequence
measure 1 "${cpus%%,*}" memory --benchmark_filter='copy'
measure 1 "${cpus%%,*}" render --benchmark_filter='10M_5px_over|2600k_26px_over'
measure 1 "${cpus%%,*}" look
measure 1 "${cpus%%,*}" generate --benchmark_filter='ball_13k'

"$programs/bench_table" "$results"
