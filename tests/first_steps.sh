#!/usr/bin/env bash
# What a user does first, in the folder that this is called in: makes a project, compiles it, runs it, draws the run, opens a
# window without a display, starts a batch, runs a program in C++. The command pogosim must be found. For machines that tests
# make, and for this one: gcc, g++, make and find are needed.
set -euxo pipefail
pogosim --version
pogosim new first
cd first
make sim
./first -c conf/test.yaml -g -q --set simulation_time=5
pogosim picture frames/data.feather swarm.png
test -s swarm.png
./first -c conf/test.yaml -g -q --set simulation_time=2 --set save_video_period=1 --set 'frames_name=frames/f{:05.0f}.png'
[ "$(find frames -name 'f0*.png' | wc -l)" -eq 2 ]
if [ "$(uname)" = Linux ]; then
    SDL_VIDEODRIVER=dummy ./first -c conf/test.yaml -q --close-at-end --set simulation_time=2 2>window.txt
    cat window.txt
    [ ! -s window.txt ] # no warning that the window cannot be opened
fi
pogobatch -c conf/test.yaml -S ./first -r 2 -t tmp -o results
cp main.c main.cpp
pogosim run main.cpp -c conf/test.yaml -g -q --set simulation_time=1
rm main.cpp
pogosim doctor
ls -l swarm.png frames results
