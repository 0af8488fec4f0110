#!/usr/bin/env bash
# Tries README's commands on a bare machine: a fresh distribution in a folder, with nothing installed.
set -euo pipefail

here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
. "$here/machine.sh"
usage="Usage, as root, with debootstrap installed: tests/distributions/run.sh NAME [--quick] [--roots FOLDER]

Makes a bare machine, copies the files of this tree to it (also those that are not committed), and runs there ./demo.sh, a
project of the template, and ./test.sh --quick. Only the machine as it was before is kept, for the next time.
  --quick          ./demo.sh and the template only
  --roots FOLDER   where bare machines, downloaded packages and the last output are kept (default: /var/cache/pogosim)
Names, of tests/distributions/table.txt:
$names"

name=""
tests=yes
roots=/var/cache/pogosim
while [ $# -gt 0 ]; do
    case $1 in
        --quick) tests=no ;;
        --roots)
            [ -n "${2:-}" ] || refuse "--roots: expected a folder after it"
            roots=$2
            shift
            ;;
        -h | --help) echo "$usage" && exit 0 ;;
        -*) refuse "unknown option $1; expected --quick or --roots FOLDER" ;;
        *)
            [ -z "$name" ] || refuse "two names, $name and $1; expected one"
            name=$1
            ;;
    esac
    shift
done
[ -n "$name" ] || refuse "no name of a distribution (--help says more); expected one of:"$'\n'"$names"
describe "$name" || refuse "unknown distribution \"$name\"; expected one of:"$'\n'"$names"
[ "$(id -u)" -eq 0 ] || refuse "only root can make machines: sudo tests/distributions/run.sh $name"
command -v debootstrap >/dev/null || refuse "debootstrap is not installed: sudo apt install debootstrap"

say() { printf '\033[1m==> %s: %s\033[0m\n' "$name" "$*"; }

mkdir -p "$roots/packages-$suite/partial" "$roots/pip-$suite"
roots=$(realpath "$roots")
machine=$(mktemp -d "$roots/$name.XXXXXX")
chmod 755 "$machine"
# Only plain files are below: what is mounted disappears with its namespace.
trap 'rm -rf --one-file-system "$machine" "$machine.tar"' EXIT

if [ -f "$roots/$name.tar" ]; then
    say "The bare machine of $(date -r "$roots/$name.tar" +%F)"
    tar -C "$machine" --numeric-owner -xf "$roots/$name.tar"
else
    say "A bare machine"
    make_machine "$machine" "$roots/$name.log"
    tar -C "$machine" --numeric-owner --one-file-system -cf "$machine.tar" .
    mv "$machine.tar" "$roots/$name.tar"
fi

let_reach_the_network "$machine"

say "The files of this tree"
mkdir "$machine/root/pogosim"
cd "$here/../.."
git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
    [ ! -e "$file" ] || printf '%s\0' "$file"
done | tar --null --no-recursion -T - -c | tar -C "$machine/root/pogosim" --no-same-owner -x

cat >"$machine/root/commands.sh" <<'COMMANDS'
set -eux
cd ~/pogosim
./demo.sh
test -s results/demo/swarm.png
(cd ~ && PATH=~/pogosim/.venv/bin:$PATH ~/pogosim/tests/first_steps.sh)
[ "$1" = no ] || ./test.sh --quick
COMMANDS

say "README's commands"
# shellcheck disable=SC2016 # for the shell inside
unshare --mount --pid --fork --kill-child bash -euc '
    mount --rbind /dev "$1/dev"
    mount -t proc proc "$1/proc"
    mount --bind "$2" "$1/var/cache/apt/archives"
    mkdir -p "$1/root/.cache/pip"
    mount --bind "$3" "$1/root/.cache/pip"
    exec chroot "$1" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 bash /root/commands.sh "$4"
    ' bash "$machine" "$roots/packages-$suite" "$roots/pip-$suite" "$tests" 2>&1 | tee "$roots/$name.log" ||
    { say "Failed; all output is in $roots/$name.log" >&2 && exit 1; }
say "Works"
