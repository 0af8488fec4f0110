#!/usr/bin/env bash
# Builds the simulator for macOS on Debian, with the compiler zig, and looks at what comes out. Nothing of it can be run here.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/bootstrap.sh

usage="Usage: scripts/check_macos.sh [arm64 | x86_64]...

Makes the wheel for macOS, in build/cross/macos-*/wheel, and with it the program of template_prj, for both kinds of Macs or
those named, warnings as errors. Checks processors, versions, the libraries that each file names, and the symbols between them.
Builds in build/cross; the first time takes long."

case "${1:-}" in -h | --help) echo "$usage" && exit 0 ;; esac
[ $# -gt 0 ] || set -- arm64 x86_64
for processor in "$@"; do
    case $processor in arm64 | x86_64) ;; *) refuse "unknown kind of Macs '$processor', expected arm64 or x86_64" ;; esac
done

install_packages wheel
make_wheel_environment
python=build/wheel-environment/bin/python
for processor in "$@"; do
    target=macos-$processor
    folder=$PWD/build/cross/$target
    "$python" scripts/make_wheel.py --for "$target" "$folder/wheel"
    # As users build their programs with it.
    rm -rf "$folder/site-packages" "$folder/template"
    "$python" -m zipfile -e "$folder"/wheel/*.whl "$folder/site-packages"
    simulator=$folder/site-packages/pogosim/simulator
    cp -r template_prj "$folder/template"
    make -s -C "$folder/template" sim "POGOSIM_DIR=$simulator" "CC=$folder/tools/cc" "CXX=$folder/tools/c++"
    "$python" scripts/cross/check_mach_o.py "$target" "$folder/template/template" "$folder/template/template.so" \
        --with "$simulator/lib/libpogosim.dylib"
    echo "macOS on $processor: built, and its files are as expected; not run, since this is no Mac"
done
