#!/usr/bin/env bash
# Builds everything and runs all tests through CTest. In: a preset of CMakePresets.json (default: release), then
# arguments for ctest, such as `-R camera`. With CI=true, warnings are errors.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset="${1:-release}"
[ $# -eq 0 ] || shift
warnings_are_errors=OFF
[ "${CI:-}" != true ] || warnings_are_errors=ON

bash third_party/install.sh build tests
cmake --preset "$preset" -DASTROSPLAT_TESTS=ON -DASTROSPLAT_WERROR=$warnings_are_errors
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel 2 "$@"
