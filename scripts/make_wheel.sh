#!/usr/bin/env bash
# Makes a self-contained wheel of Pogosim. Installs missing dependencies first.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/bootstrap.sh

usage="Usage: scripts/make_wheel.sh [--for MACHINE | --here] [FOLDER]

Makes a wheel with the simulator and its libraries, for machines where nobody can install system packages, and leaves it in
FOLDER (dist).
  --for MACHINE   linux-x86_64 or linux-aarch64: any Linux since 2018 (glibc 2.28: RHEL 8, Debian 11, Ubuntu 20.04);
                  macos-arm64 or macos-x86_64: macOS 12 and later, made with the compiler zig, and never run by us.
                  All are made on Debian or Ubuntu, on x86-64
  --here          machines whose C library is at least as new as that of this one, with the libraries of its packages
  -h, --help      print this help
Without either, for Linux on processors like this one's."

targets="linux-x86_64, linux-aarch64, macos-arm64 or macos-x86_64"
folder=dist
way=(--for "linux-$(uname -m)")
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) echo "$usage" && exit 0 ;;
        --here) way=(--here) ;;
        --for)
            [ -n "${2:-}" ] || refuse "--for: expected a machine after it: $targets"
            case $2 in
                linux-x86_64 | linux-aarch64 | macos-arm64 | macos-x86_64) ;;
                *) refuse "--for: unknown machine '$2', expected $targets" ;;
            esac
            way=(--for "$2") && shift
            ;;
        -*) refuse "unknown option '$1', expected --for or --here" ;;
        "") refuse "the folder for the wheel is empty" ;;
        *)
            [ $# -eq 1 ] || refuse "'$2' after the folder '$1', expected the folder last"
            case $1 in /*) folder=$1 ;; *) folder=$here/$1 ;; esac
            ;;
    esac
    shift
done

# The wheel says what it is made of: libpogosim.commit.
case $([ ! -e .git ] || git describe --always --tags --dirty 2>/dev/null) in
    *-dirty)
        echo "${0##*/}: warning: this checkout has uncommitted changes: the wheel cannot be reproduced, and .ci/publish refuses it" >&2
        ;;
esac
install_packages wheel
make_wheel_environment
say "Building the simulator (takes ten minutes on two processors)"
build/wheel-environment/bin/python scripts/make_wheel.py "${way[@]}" "$folder" || fail "the wheel" "See the messages above"
