#!/usr/bin/env bash
# One minute of a swarm: builds what is needed, runs the hanabi example without a window, and draws the run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

if [ "$#" -ne 0 ]; then
    echo "Usage: ./demo.sh    (no arguments; leaves results/demo/data.feather and results/demo/swarm.png)" >&2
    case $1 in
        -h | --help) exit 0 ;;
        *) exit 2 ;;
    esac
fi

./build.sh Release
. scripts/bootstrap.sh

data=results/demo/data.feather
picture=results/demo/swarm.png
mkdir -p results/demo
say "Running 100 robots for 60 s of their time"
./examples/hanabi/hanabi -c conf/demo.yaml --no-GUI --progress || fail "the run" "See its message above"
say "Drawing"
.venv/bin/python -m pogosim.swarm_picture "$data" "$picture" || fail "the picture" "See the message above"

size_of() { du -h "$1" | cut -f1; }
echo
echo "Made $data ($(size_of "$data")): where every robot was, ten times a second"
echo "     $picture ($(size_of "$picture")): trajectories and final LED colours"
echo "The same run in a window (this version has none yet and runs without):  ./examples/hanabi/hanabi -c conf/demo.yaml"
