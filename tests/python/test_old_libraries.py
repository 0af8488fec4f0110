"""What is linked against the lists of older libraries asks for nothing newer, and works."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from running import ROOT

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the libraries are those of Linux")
TIMEOUT_S = 300
CROSS = ROOT / "scripts" / "cross"
NEWEST = {"GLIBC": (2, 27), "GLIBCXX": (3, 4, 25), "CXXABI": (1, 3, 11)}
COMPILERS = {
    "x86_64": ("g++", []),
    "aarch64": ("aarch64-linux-gnu-g++", ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"]),
}

# What old C++ libraries lack, what old C libraries lack, a constructor before main(), an exception, and a thread.
PROGRAM = """
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <thread>

struct Early { int value = 41; Early() { ++value; } } early;

int main() {
    double number = 0.0;
    char const text[] = "0.1";
    std::from_chars(text, text + 3, number);
    std::mutex mutex;
    std::condition_variable condition;
    std::unique_lock lock(mutex);
    auto const start = std::chrono::steady_clock::now();
    condition.wait_for(lock, std::chrono::milliseconds(30));
    auto const waited = std::chrono::steady_clock::now() - start;
    int in_thread = 0;
    std::thread([&in_thread] { in_thread = 7; }).join();
    try {
        throw std::out_of_range("far");
    } catch (std::exception const& error) {
        std::cout << early.value << ' ' << number << ' ' << in_thread << ' ' << error.what() << ' '
                  << std::filesystem::is_directory("/") << ' ' << (waited >= std::chrono::milliseconds(30)) << '\\n';
    }
}
"""

# The functions themselves, on a machine that has none of the newer ones: dlsym() finds nothing.
OLD_MACHINE = """
#define _GNU_SOURCE
#include <dlfcn.h>
#undef dlsym
#define dlsym(handle, name) ((void)(handle), (void)(name), (void*)0)
#include "newer_functions.c"
#include <stdio.h>
#include <sys/wait.h>

int main(int count, char** words) {
    (void)count;
    struct stat status;
    printf("%d %d ", stat(words[0], &status) == 0 && status.st_size > 1000, stat("/no/such/file", &status));
    struct timespec start, end, until;
    clock_gettime(CLOCK_MONOTONIC, &start);
    until = start;
    until.tv_nsec += 30000000L;
    if (until.tv_nsec >= 1000000000L) { until.tv_nsec -= 1000000000L; until.tv_sec += 1; }
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
    pthread_mutex_lock(&mutex);
    int const result = pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &until);
    clock_gettime(CLOCK_MONOTONIC, &end);
    double const waited = (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
    printf("%d %d ", result == ETIMEDOUT, waited >= 0.029);
    size_t const before = mallinfo2().uordblks;
    char* const block = malloc(100000);
    block[0] = 1;
    printf("%d ", mallinfo2().uordblks - before >= 100000);
    free(block);
    fflush(stdout);
    pid_t const child = _Fork();
    if (child == 0) { _exit(5); }
    int how = 0;
    waitpid(child, &how, 0);
    printf("%d\\n", WEXITSTATUS(how));
    return 0;
}
"""


def output(*words: str | Path) -> str:
    """Return what a command prints; it must work."""
    result = subprocess.run(words, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert result.returncode == 0, f"{words}\n{result.stderr}"
    return result.stdout


def versions(program: Path) -> set[tuple[str, tuple[int, ...]]]:
    """Return the versions of functions that a program asks for."""
    found = re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([\d.]+)", output("readelf", "--version-info", "--wide", program))
    return {(series, tuple(map(int, number.split(".")))) for series, number in found}


@pytest.fixture(scope="module", params=COMPILERS)
def machine(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[list[str | Path], list[str]]:
    """Return a compiler with the old libraries of a kind of machine, and what runs its programs."""
    compiler, runner = COMPILERS[request.param]
    folder = tmp_path_factory.mktemp(f"old libraries {request.param}")  # a name with blanks
    output(sys.executable, CROSS / "old_libraries.py", folder, "--compiler", compiler)
    return [compiler, "-L", folder, "-Wl,--no-as-needed"], runner


def test_programs_ask_for_old_versions_only_and_work(
    machine: tuple[list[str | Path], list[str]], tmp_path: Path
) -> None:
    compiler, runner = machine
    (tmp_path / "program.cpp").write_text(PROGRAM, encoding="utf-8")
    output(*compiler, "-std=c++20", "-O2", tmp_path / "program.cpp", "-o", tmp_path / "program")
    asked = versions(tmp_path / "program")
    assert {series for series, _ in asked} == set(NEWEST)
    assert not [(series, number) for series, number in asked if number > NEWEST[series]]
    # Before glibc 2.30, programs that asked libc.so.6 for a function of threads did not start.
    assert re.search(r"File: libpthread\.so\.0", output("readelf", "--version-info", "--wide", tmp_path / "program"))
    assert output(*runner, tmp_path / "program") == "42 0.1 7 far 1 1\n"


def test_new_functions_work_where_the_library_has_none(
    machine: tuple[list[str | Path], list[str]], tmp_path: Path
) -> None:
    compiler, runner = machine
    (tmp_path / "old.c").write_text(OLD_MACHINE, encoding="utf-8")
    output(*compiler, "-x", "c", "-I", CROSS, tmp_path / "old.c", "-o", tmp_path / "old")
    assert output(*runner, tmp_path / "old") == "1 -1 1 1 1 5\n"


@pytest.mark.parametrize(
    ("folder", "compiler", "message"),
    [
        ("old", "echo no", "echo no has no libc.so.6; expected a gcc with its libraries"),
        ("old", "no-such-program", "cannot run 'no-such-program': No such file or directory"),
        ("old", "false", "false -print-file-name=libc.so.6 failed, see above"),
        ("old", "", "the compiler is ''; expected a gcc, such as aarch64-linux-gnu-g++"),
        ("old", "clang++", "the compiler is 'clang++'; expected a gcc, such as aarch64-linux-gnu-g++"),
        ("old", 'g++ "', "the compiler 'g++ \"' is no command line: No closing quotation"),
        ("a,b", "g++", "the path {folder} has , in it, which linkers cannot take"),
        ("file", "g++", "cannot make the folder {folder}: File exists"),
    ],
)
def test_mistake_is_one_line(folder: str, compiler: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    command: list[str | Path] = [sys.executable, CROSS / "old_libraries.py", tmp_path / folder, "--compiler", compiler]
    result = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert result.returncode == 2
    assert result.stderr == f"old_libraries.py: {message.format(folder=tmp_path / folder)}\n"
