#!/usr/bin/env bash
# Makes a self-contained wheel of Pogosim. Installs missing dependencies first.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage="Usage: scripts/make_wheel.sh [--for MACHINE | --here] [FOLDER]

Makes a wheel with the simulator and its libraries, for machines where nobody can install system packages, and leaves it in
FOLDER (dist).
  --for MACHINE   linux-x86_64 or linux-aarch64: any Linux since 2018 (glibc 2.28: RHEL 8, Debian 11, Ubuntu 20.04);
                  macos-arm64 or macos-x86_64: macOS 12 and later, made with the compiler zig, and never run by us.
                  All are made on Debian or Ubuntu, on x86-64
  --here          machines whose C library is at least as new as that of this one, with the libraries of its packages
  -h, --help      print this help
Without either, for Linux on processors like this one's."

fail_usage() { echo "$usage" >&2 && exit 2; }

folder=dist
way=(--for "linux-$(uname -m)")
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) echo "$usage" && exit 0 ;;
        --here) way=(--here) ;;
        --for)
            case ${2:-} in linux-x86_64 | linux-aarch64 | macos-arm64 | macos-x86_64) ;; *) fail_usage ;; esac
            way=(--for "$2") && shift
            ;;
        -* | "") fail_usage ;;
        *)
            [ $# -eq 1 ] || fail_usage
            case $1 in /*) folder=$1 ;; *) folder=$here/$1 ;; esac
            ;;
    esac
    shift
done

. scripts/bootstrap.sh
install_packages wheel
make_wheel_environment
say "Building the simulator (takes ten minutes on two processors)"
build/wheel-environment/bin/python scripts/make_wheel.py "${way[@]}" "$folder" || fail "the wheel" "See the messages above"
