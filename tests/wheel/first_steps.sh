#!/usr/bin/env bash
# Tries a wheel on this machine as a new user does, on Linux and macOS: installs it in an environment of its own, and does there
# what ../first_steps.sh says. Needs Python (PYTHON is another one than python3), compilers of C and C++, make, and a network for
# the packages that the wheel requires; takes a minute; leaves nothing behind. (bare_machine.sh makes a machine to try it on.)
set -euo pipefail

refuse() { echo "first_steps.sh: $1: tests/wheel/first_steps.sh WHEEL" >&2 && exit 2; }

[ $# -eq 1 ] || refuse "expected one argument, the wheel, found $#"
[ -f "$1" ] || refuse "there is no file '$1'"

wheel=$(cd "$(dirname "$1")" && pwd)/${1##*/}
steps=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/first_steps.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

set -x
"${PYTHON:-python3}" -m venv env
env/bin/pip install --quiet --disable-pip-version-check "$wheel"
PATH=$folder/env/bin:$PATH
"$steps"
