#!/usr/bin/env bash
# Builds and tests.
#   tests/run.sh                           the lane ci of the Release build
#   tests/run.sh PRESET [PROGRAM...]       the lane ci of a preset of CMakePresets.json; only these test programs: `asan render`
#   tests/run.sh nightly                   everything: both lanes, all sanitizers, every file compiled alone
#   tests/run.sh mutation [OPTION...]      which small faults no test notices; see tests/mutation
# With CI=true, warnings are errors; without, as the build folder has it: another choice would compile everything again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
warnings=()
[ "${CI:-}" != true ] || warnings=(-DASTROSPLAT_WERROR=ON)

configure() { cmake --preset "$1" -DASTROSPLAT_TESTS=ON "${warnings[@]}"; }

# test_with LANES PRESET [PROGRAM...]: a regular expression of lanes, and the programs to build and run; none: all.
test_with() {
    local lanes=$1 preset=$2; shift 2
    local programs='.*' log=build/$preset/Testing/Temporary/LastTest.log
    [ $# -eq 0 ] || programs="^($(IFS='|'; echo "$*"))\$"
    configure "$preset"
    cmake --build --preset "$preset" ${@:+--target ${@/#/test_}}
    # One more than there are processors: the window's tests mostly wait, for a hand.
    local result=0 output=build/$preset/ctest.txt jobs=$(($(nproc) + 1))
    ctest --preset "$preset" --parallel "$jobs" --no-label-summary -L "$lanes" -L "$programs" | tee "$output" || result=$?
    grep --only-matching 'SKIPPED \] [A-Za-z].*' "$log" | sed 's/SKIPPED \]/skipped:/' | sort --unique || true
    grep ' tests passed, ' "$output" || true  # once more, where a reader of the last lines finds it
    return $result
}

bash third_party/install.sh build window tests
case "${1:-release}" in
nightly)
    test_with '^(ci|nightly)$' release
    configure dev
    cmake --build --preset dev --target glad  # its header is generated
    python3 tests/each_file_alone.py build/dev
    test_with '^(ci|nightly)$' asan
    test_with '^(ci|nightly)$' tsan core generate look render pipeline viewer ;;
mutation)
    shift
    python3 tests/mutation/mutate.py "$@" ;;
*)
    test_with '^ci$' "${@:-release}" ;;
esac
