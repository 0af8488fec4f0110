#!/usr/bin/env bash
# Builds the library and, in place, all examples. Installs missing dependencies first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/bootstrap.sh

usage="Usage: ./build.sh [Release|Debug]

Builds the library (in build/release or build/debug) and the examples (examples/NAME/NAME). Default: Release.
  -h, --help   print this help"

case "$#:${1:-Release}" in
    [01]:Release | [01]:Debug) type=${1:-Release} ;;
    1:-h | 1:--help) echo "$usage" && exit 0 ;;
    *) refuse "'$*': expected nothing, Release or Debug" ;;
esac

bootstrap build

folder=build/$(printf %s "$type" | tr '[:upper:]' '[:lower:]')
say "Building ($type)"
configure "$folder" "$type" -DPOGOSIM_BUILD_EXAMPLES=ON -DPOGOSIM_BUILD_TESTS=OFF -DPOGOSIM_BUILD_BENCH=OFF ||
    fail "cmake could not configure $folder" "See its output above"
cmake --build "$folder" --parallel "$(processors)" || fail "compilation" "See the compiler's output above"

echo "Built the library in $folder and the examples in their own folders ($type)."
echo "Try:  ./examples/hanabi/hanabi -c conf/demo.yaml"
