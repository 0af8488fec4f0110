#!/usr/bin/env bash
# Tries a wheel on this machine as a new user does, on Linux and macOS: installs it in an environment of its own, makes a project,
# compiles it, runs it, draws the run. Needs Python, a C compiler and make, and a network for the packages that the wheel requires;
# takes a minute; leaves nothing behind. (bare_machine.sh makes a machine to try it on.)
set -euo pipefail

if [ $# -ne 1 ] || [ ! -f "$1" ]; then
    echo "Usage: tests/wheel/first_steps.sh WHEEL" >&2
    exit 2
fi

wheel=$(cd "$(dirname "$1")" && pwd)/${1##*/}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

set -x
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check "$wheel"
PATH=$folder/env/bin:$PATH
pogosim --version
pogosim new first
cd first
make sim
./first -c conf/test.yaml -g -q
pogosim picture frames/data.feather swarm.png
pogobatch -c conf/test.yaml -S ./first -r 2 -o results
pogosim doctor
test -s swarm.png
