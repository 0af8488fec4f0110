#!/usr/bin/env bash
# Tries a wheel on a bare machine: a fresh Debian in a folder, with nothing but Python, a C compiler and make, as a user who is
# not root and has no network. Needs root and debootstrap; takes about three minutes; leaves nothing behind.
#
#   ./scripts/make_wheel.sh && sudo tests/wheel/bare_machine.sh dist/pogobot_simulator-*.whl
set -euo pipefail

if [ $# -ne 1 ] || [ ! -f "$1" ] || [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
    echo "Usage, as root, with debootstrap installed: tests/wheel/bare_machine.sh WHEEL" >&2
    exit 2
fi

wheel=$(realpath "$1")
machine=$(mktemp -d)
chmod 755 "$machine"
# Only plain files are below: what is mounted disappears with its namespace.
trap 'rm -rf --one-file-system "$machine"' EXIT

echo "==> A fresh Debian with Python, gcc and make"
debootstrap --variant=minbase --include=python3,python3-venv,gcc,libc6-dev,make bookworm "$machine" >/dev/null

echo "==> The wheel, and those it requires"
python3 -m venv "$machine/download"
"$machine/download/bin/pip" download --quiet --disable-pip-version-check --only-binary :all: --python-version 3.11 \
    --dest "$machine/wheels" "$wheel"
rm -r "$machine/download"

cat >"$machine/as_a_user.sh" <<'USER'
set -eux
cd ~
python3 -m venv env
. env/bin/activate
pip install --quiet --disable-pip-version-check --no-index --find-links /wheels pogobot-simulator
pogosim new first
cd first
make sim
./first -c conf/test.yaml -g -q
pogosim picture frames/data.feather swarm.png
SDL_VIDEODRIVER=dummy ./first -c conf/test.yaml -q --set simulation_time=2 | tee window.txt
[ ! -s window.txt ]  # no warning that the window cannot be opened
./first -c conf/test.yaml -g -q --set simulation_time=2 --set save_video_period=1 --set 'frames_name=frames/f{:05.0f}.png'
pogobatch -c conf/test.yaml -S ./first -r 2 -o results
pogosim run main.c -c conf/test.yaml -g -q --set simulation_time=1
pogosim doctor
ls -l swarm.png frames results
USER

echo "==> As a user there"
useradd --root "$machine" --create-home --shell /bin/bash user
unshare --mount --net --pid --fork --mount-proc="$machine/proc" \
    chroot --userspec=user:user "$machine" env -i HOME=/home/user PATH=/usr/bin:/bin LANG=C.UTF-8 bash /as_a_user.sh
echo "==> The wheel works on a bare machine"
