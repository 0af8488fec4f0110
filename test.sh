#!/usr/bin/env bash
# Runs all tests. Installs missing dependencies first. The last line counts tests and checks: "N passed, N failed".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/bootstrap.sh

usage="Usage: ./test.sh [--quick | --style] [--tidy]

Builds Release with the system's compiler and runs the C++ tests (CTest) and the Python tests (pytest); builds Debug
with clang and sanitizers and runs the C++ tests again; checks formatting (clang-format, ruff), Python style (ruff) and
types (mypy).
  --quick      run the Release build and its tests only
  --style      check formatting, Python style and types only: a minute, nothing is built
  --tidy       also run clang-tidy on the C++ sources (slow)
  -h, --help   print this help"

quick=no
style=no
needs="test"
for argument in "$@"; do
    case $argument in
        --quick) quick=yes ;;
        --style) style=yes ;;
        --tidy) needs=tidy ;;
        -h | --help) echo "$usage" && exit 0 ;;
        *) refuse "unknown argument '$argument', expected --quick, --style or --tidy" ;;
    esac
done
[ "$quick$style" != yesyes ] || refuse "--quick and --style: expected one of them"

bootstrap "$needs"
# Modules are compiled once for all the processes that tests start, also where the environment keeps Python from it.
unset PYTHONDONTWRITEBYTECODE
export PYTHONPYCACHEPREFIX=$PWD/build/pycache

python=.venv/bin/python
reports=build/reports
mkdir -p "$reports"
passed=0
failed=0
failures=""

count() {  # count PASSED FAILED WHAT
    passed=$((passed + $1))
    failed=$((failed + $2))
    [ "$2" -eq 0 ] || failures="$failures  $3: $2 failed
"
}

# check WHAT COMMAND...: one check, which passes if the command does.
check() {
    local what=$1
    shift
    say "$what"
    if "$@"; then
        count 1 0 "$what"
    else
        count 0 1 "$what"
        return 1
    fi
}

# suite WHAT REPORT COMMAND...: many tests; the command writes a JUnit report. If it fails without a failed test (a
# crash, no tests at all), that counts as one failure.
suite() {
    local what=$1 report=$2 status=0 counts
    shift 2
    say "$what"
    rm -f "$report"
    "$@" || status=$?
    counts=$("$python" scripts/count_tests.py "$report") || counts="0 1"
    if [ "$status" -ne 0 ] && [ "${counts#* }" -eq 0 ]; then
        counts="${counts% *} 1"
    fi
    # shellcheck disable=SC2086 # two numbers
    count $counts "$what"
}

# build_tree FOLDER PRESET [options of cmake]
build_tree() {
    configure "$@" && cmake --build "$1" --parallel "$(processors)"
}

run_ctest() {  # run_ctest FOLDER REPORT
    ctest --test-dir "$1" --output-on-failure --no-tests=error --parallel "$(processors)" --output-junit "$PWD/$2" \
        >"$1/ctest.log" 2>&1 || {
        grep -v ' Passed ' "$1/ctest.log"
        return 1
    }
    tail -n 4 "$1/ctest.log"
}

build_release() {
    build_tree build/release release
}

# without_warnings COMMAND...: -Werror without a flag of its own, which would build everything anew after ./build.sh.
without_warnings() {
    "$@" 2>&1 | tee "$reports/build.log"
    [ "${PIPESTATUS[0]}" -eq 0 ] && ! grep -q 'warning:' "$reports/build.log"
}

release_tests() {
    check "Release build, without a warning" without_warnings build_release || return 0
    suite "C++ tests (Release)" "$reports/release.xml" run_ctest build/release "$reports/release.xml"
}

# One process more than processors: many tests wait most of their time. tests/python/conftest.py has the order of files.
python_tests() {
    suite "Python tests" "$reports/python.xml" \
        "$python" -m pytest -q -c pyproject.toml --rootdir . --numprocesses $(($(processors) + 1)) --dist loadfile \
        --no-loadscope-reorder tests/python --junitxml "$reports/python.xml"
}

# sanitizes COMPILER: whether a program can be built with its sanitizers; it is left in $reports/leak.
sanitizes() {
    echo 'int main() { return 0; }' >"$reports/leak.cpp"
    "$1" -fsanitize=address,undefined "$reports/leak.cpp" -o "$reports/leak" 2>/dev/null
}

# Whether leaks can be detected: this needs ptrace, which many containers forbid.
leak_sanitizer_works() { ASAN_OPTIONS=detect_leaks=1 "$reports/leak" 2>/dev/null; }

sanitized_tests() {
    local leaks=1 folder=build/asan c=clang cpp=clang++
    if ! sanitizes clang++; then
        echo "Not tested with clang: it is not installed with its sanitizers. The system's compiler is taken instead."
        folder=build/asan-cc c=cc cpp=c++
        sanitizes c++ || true
    fi
    if ! leak_sanitizer_works; then
        echo "Leak detection is off: LeakSanitizer needs ptrace, which this machine or container forbids."
        leaks=0
    fi
    # The build also runs the test programs, to list their tests.
    export ASAN_OPTIONS=detect_leaks=$leaks UBSAN_OPTIONS=print_stacktrace=1
    # The second compiler: Release is built with the system's, gcc on Linux.
    check "Debug build with sanitizers ($cpp)" build_tree "$folder" asan \
        -DCMAKE_C_COMPILER=$c -DCMAKE_CXX_COMPILER=$cpp || return 0
    suite "C++ tests (sanitizers, $cpp)" "$reports/sanitized.xml" run_ctest "$folder" "$reports/sanitized.xml"
}

# cpp_files: all files formatted by clang-format, separated by zero bytes.
cpp_files() {
    find . \( -name build -o -name .venv -o -name .git \) -prune -o \
        \( -name '*.c' -o -name '*.h' -o -name '*.[ch]pp' \) -print0
}

clang_format() { cpp_files | xargs -0 .venv/bin/clang-format --dry-run -Werror; }

clang_tidy() {
    local tidy
    tidy=$(command -v clang-tidy || command -v clang-tidy-14 || echo "$(brew --prefix llvm)/bin/clang-tidy")
    find src -name '*.cpp' -print0 |
        xargs -0 -n 1 -P "$(processors)" "$tidy" -p build/release --quiet --extra-arg=-Wno-unknown-warning-option
}

style_checks() {
    local ruff="$python -m ruff" sources="python tests/python cmake scripts bench docs/figures docs/sim_to_real examples/learning examples/policy tools/gdb"
    check "C++ formatting (clang-format 14)" clang_format || true
    # shellcheck disable=SC2086 # a command with arguments, a list of words
    check "Python style (ruff)" $ruff check --config pyproject.toml $sources || true
    # shellcheck disable=SC2086
    check "Python formatting (ruff)" $ruff format --check --config pyproject.toml $sources || true
    # shellcheck disable=SC2086
    check "Python types (mypy --strict)" env MYPYPATH=python:tests/python \
        "$python" -m mypy --config-file pyproject.toml $sources || true
}

if [ "$style" = no ]; then
    release_tests
    python_tests
    [ "$quick" = yes ] || sanitized_tests
fi
[ "$quick" = yes ] || style_checks
if [ "$needs" = tidy ]; then
    check "clang-tidy" clang_tidy || true
fi

echo
printf '%s' "$failures"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
