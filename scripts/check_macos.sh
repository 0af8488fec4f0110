#!/usr/bin/env bash
# Builds the simulator for macOS on Debian, with the compiler zig, and looks at what comes out. Nothing of it can be run here.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage="Usage: scripts/check_macos.sh [arm64 | x86_64]...

Builds all of the simulator for macOS, the window and the program of template_prj included, for both kinds of Macs or those
named, warnings as errors. Then checks processors, versions, the libraries that each file names, and the symbols between them.
Builds in build/cross; the first time takes long."

case "${1:-}" in -h | --help) echo "$usage" && exit 0 ;; esac
[ $# -gt 0 ] || set -- arm64 x86_64
for processor in "$@"; do
    case $processor in arm64 | x86_64) ;; *) echo "$usage" >&2 && exit 2 ;; esac
done

. scripts/bootstrap.sh
install_packages wheel
make_wheel_environment
python=build/wheel-environment/bin/python
export PYTHONPATH=scripts
for processor in "$@"; do
    target=macos-$processor
    folder=$PWD/build/cross/$target
    "$python" -m cross.dependencies "$target"
    cmake -S . -B "$folder/check" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DCMAKE_TOOLCHAIN_FILE=$PWD/scripts/cross/$target.cmake" \
        "-DPOGOSIM_PYARROW=$folder/pyarrow/pyarrow" -DPOGOSIM_WERROR=ON \
        -DPOGOSIM_BUILD_TESTS=OFF -DPOGOSIM_BUILD_BENCH=OFF -DPOGOSIM_BUILD_EXAMPLES=OFF >"$folder/check.log" ||
        { cat "$folder/check.log" && exit 1; }
    cmake --build "$folder/check" -- -k 0
    # As users build their programs.
    rm -rf "$folder/template" && cp -r template_prj "$folder/template"
    make -s -C "$folder/template" sim "POGOSIM_DIR=$folder/check" "CC=$folder/tools/cc" "CXX=$folder/tools/c++"
    "$python" -m cross.check_mach_o "$target" "$folder"/check/src/libpogosim.dylib "$folder"/check/src/libpogosim_*.dylib \
        "$folder/check/src/pogosim-without-program" "$folder/template/template" "$folder/template/template.so" \
        --with "$folder"/pyarrow/pyarrow/lib{arrow,parquet}.*.dylib "$folder/prefix/lib/libSDL2.dylib"
    echo "macOS on $processor: built, and its files are as expected; not run, since this is no Mac"
done
