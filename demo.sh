#!/usr/bin/env bash
# One minute of a swarm: builds the project, runs the hanabi example without a window, and draws the run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/bootstrap.sh

case "$#:${1:-}" in
    0:) ;;
    1:-h | 1:--help) echo "Usage: ./demo.sh    (leaves results/demo/data.feather and results/demo/swarm.png)" && exit 0 ;;
    *) refuse "'$*': expected no arguments" ;;
esac

./build.sh Release

data=results/demo/data.feather
picture=results/demo/swarm.png
mkdir -p results/demo
say "Running 100 robots for 60 s of simulated time"
./examples/hanabi/hanabi -c conf/demo.yaml --no-GUI --progress || fail "the run" "See its message above"
say "Drawing"
.venv/bin/python -m pogosim.swarm_picture "$data" "$picture" || fail "the picture" "See the message above"

size_of() { du -h "$1" | cut -f1; }
echo
echo "Made $data ($(size_of "$data")): the positions of all robots, ten times per second"
echo "     $picture ($(size_of "$picture")): trajectories and final LED colours"
echo "To watch it in a window (F1 shows the keys):  ./examples/hanabi/hanabi -c conf/demo.yaml"
