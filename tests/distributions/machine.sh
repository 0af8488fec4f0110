# Makes bare machines, for scripts that source this file: a fresh distribution in a folder, with nothing installed.
#
#   refuse WHAT                          # says in one line what is wrong with the arguments or the machine, and exits
#   describe NAME                        # sets suite, script and components of a name of table.txt; fails if there is none
#   make_machine FOLDER LOG [OPTIONS]    # makes it in an empty folder, by debootstrap, with more options for that
#   let_reach_the_network FOLDER         # the machine gets what this one needs for that
# shellcheck shell=bash disable=SC2034 # variables are for the scripts

table=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/table.txt
names=$(awk '!/^#/ { print "  " $1 }' "$table")

refuse() {
    echo "${0##*/}: $1" >&2
    exit 2
}

describe() {
    read -r suite script components < <(awk -v name="$1" '$1 == name && !/^#/ { print $2, $3, $4 }' "$table")
}

make_machine() {
    local folder=$1 log=$2 scripts=/usr/share/debootstrap/scripts keys check=""
    shift 2
    # An empty mirror means the usual one; without the keys of the distribution, debootstrap would take Debian's.
    keys=$(sed -n 's/^ *keyring //p' "$scripts/$script" | head -n 1)
    if [ ! -f "$keys" ]; then
        [ "${POGOSIM_UNSIGNED:-}" = yes ] || {
            echo "The keys of $suite are not there, $keys: install the distribution's package of them, or take what comes without
a check of its signatures: POGOSIM_UNSIGNED=yes" >&2
            return 1
        }
        check=--no-check-gpg
    fi
    debootstrap $check --variant=minbase --components="$components" "$@" "$suite" "$folder" "" "$scripts/$script" >"$log" ||
        { tail -n 20 "$log" >&2 && return 1; }
}

let_reach_the_network() {  # names of hosts, this machine's own certificates, settings of pip
    local file
    for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /usr/local/share/ca-certificates; do
        [ ! -e "$file" ] || cp -rL "$file" "$1${file%/*}/"
    done
}
