#!/usr/bin/env bash
# Tries a wheel on a bare machine: a fresh distribution in a folder, with nothing but Python, gcc, g++ and make, as a user
# who is not root and has no network.
set -euo pipefail

here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
. "$here/../distributions/machine.sh"
usage="Usage, as root, with debootstrap installed: tests/wheel/bare_machine.sh WHEEL [NAME]

NAME (debian-12) is one of tests/distributions/table.txt with Python 3.10 or later. A wheel for ARM64 is tried on a machine for
that, which this one must be able to run: on x86-64, install qemu-user-static and binfmt-support. Takes a few minutes, more on
an emulated processor; leaves nothing behind."

case ${1:-} in -h | --help) echo "$usage" && exit 0 ;; esac
[ $# -eq 1 ] || [ $# -eq 2 ] || refuse "expected a wheel, or a wheel and a distribution, found $# arguments (--help says more)"
[ -f "$1" ] || refuse "there is no file $1"
wheel=$(realpath "$1")
name=${2:-debian-12}
describe "$name" || refuse "unknown distribution \"$name\"; expected one of:"$'\n'"$names"
case $wheel in
    *-manylinux*x86_64.whl) processor=amd64 platform=manylinux_2_28_x86_64 ;;
    *-manylinux*aarch64.whl) processor=arm64 platform=manylinux_2_28_aarch64 ;;
    *) refuse "$1 is no wheel for Linux on x86_64 or aarch64, by its name" ;;
esac
[ "$(id -u)" -eq 0 ] || refuse "only root can make machines"
command -v debootstrap >/dev/null || refuse "debootstrap is not installed: sudo apt install debootstrap"

machine=$(mktemp -d)
chmod 755 "$machine"
# Only plain files are below: what is mounted disappears with its namespace.
trap 'rm -rf --one-file-system "$machine" "$machine.log"' EXIT

echo "==> $name with Python, gcc, g++ and make, for $processor"
make_machine "$machine" "$machine.log" --arch="$processor" --include=python3,python3-venv,gcc,g++,libc6-dev,make

echo "==> The wheel, and those it requires"
version=$(chroot "$machine" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
python3 -m venv "$machine/download"
mkdir "$machine/wheels"
cp "$wheel" "$machine/wheels"
older=()  # a machine for one platform takes what is for older ones; pip must be told of each
for minor in 28 27 26 24 17; do older+=(--platform "${platform/_2_28_/_2_${minor}_}"); done
"$machine/download/bin/pip" download --quiet --disable-pip-version-check --only-binary :all: --python-version "$version" \
    "${older[@]}" --platform "manylinux2014_${platform#manylinux_2_28_}" --dest "$machine/wheels" "$wheel"
rm -r "$machine/download"

cp "$here/../first_steps.sh" "$machine/"
cat >"$machine/as_a_user.sh" <<'USER'
set -eux
cd ~
python3 -m venv env
. env/bin/activate
pip install --quiet --disable-pip-version-check --no-index --find-links /wheels pogobot-simulator
/first_steps.sh
USER

echo "==> As a user there"
useradd --root "$machine" --create-home --shell /bin/bash user
# shellcheck disable=SC2016 # for the shell inside
unshare --mount --net --pid --fork --kill-child bash -euc '
    mount -t proc proc "$1/proc"
    exec chroot --userspec=user:user "$1" env -i HOME=/home/user PATH=/usr/bin:/bin LANG=C.UTF-8 bash /as_a_user.sh
    ' bash "$machine"
echo "==> The wheel works on $name"
