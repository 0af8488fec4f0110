"""What a call of an exported policy takes on a robot's processor: cycles of a run on an emulated one, and code."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from elftools.elf.elffile import ELFFile
from elftools.elf.sections import SymbolTableSection

from pogosim.firmware.making import firmware_of
from pogosim.firmware.profile.raw import Profile, read_profile
from pogosim.firmware.profile.running import profile_run
from pogosim.installation import Installation
from pogosim.policy.errors import PolicyError

PROGRAM = """#include "pogobase.h"
#include "exported.h"
typedef struct {
    uint32_t ticks;
    bool is_right;
    STATE
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)
void @probe(@value_t const inputs[], @value_t outputs[]);
__attribute__((noinline)) void @probe(@value_t const inputs[], @value_t outputs[]) {
    @step(ARGUMENT inputs, outputs);
}
void self_test_fails(void);
__attribute__((noinline)) void self_test_fails(void) {
    __asm__ volatile("");
}
void user_init(void) {
    mydata->is_right = @self_test();
}
void user_step(void) {
    if (!mydata->is_right) {
        self_test_fails();
        return;
    }
    static volatile @value_t result;
    @value_t outputs[sizeof(@test_outputs[0]) / sizeof(@value_t)];
    @probe(@test_inputs[mydata->ticks++ % (sizeof(@test_inputs) / sizeof(@test_inputs[0]))], outputs);
    result = outputs[0];
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
"""
CONFIGURATION = """arena_file: arenas/disk.csv
simulation_time: 0.5
enable_data_logging: false
enable_console_logging: false
objects: {robots: {type: pogobot, nb: 1}}
"""


@dataclass(frozen=True)
class Measured:
    """What an exported policy takes.

    Attributes:
        cycles: Cycles of a call, on average, with the compiler's routines that it calls.
        budget: Cycles between two ticks.
        code_bytes: Machine code of its functions, without the compiler's routines.
    """

    cycles: float
    budget: float
    code_bytes: int

    @property
    def share(self) -> float:
        """Share of a tick, 0 to 1 if it fits."""
        return self.cycles / self.budget

    @property
    def percent(self) -> str:
        """Share of a tick: "1.4 %"."""
        return f"{100 * self.share:.2g} %" if self.share < 0.995 else f"{100 * self.share:.0f} %"


def program_of(prefix: str, is_recurrent: bool) -> str:
    """Return a program that calls a policy in each tick, after its self test."""
    state = f"{prefix}_state_t {prefix}_state;" if is_recurrent else ""
    argument = f"&mydata->{prefix}_state," if is_recurrent else ""
    return PROGRAM.replace("@", f"{prefix}_").replace("STATE", state).replace("ARGUMENT ", f"{argument} ")


def cycles_and_calls(profile: Profile, function: str) -> tuple[float, float]:
    """Return the cycles of a function, with all that it calls, and how often it was called."""
    cycles = calls = 0.0
    for stack in profile.stacks:
        names = [profile.functions[frame] for frame in stack.frames]
        if function in names:
            cycles += profile.cost(stack)
        if names[-1] == function:
            calls += stack.calls
    return cycles, calls


def code_bytes(firmware: Path, prefix: str) -> int:
    """Return the size of the functions whose names begin with a prefix, bytes."""
    with firmware.open("rb") as file:
        tables = [part for part in ELFFile(file).iter_sections() if isinstance(part, SymbolTableSection)]
        return sum(
            int(symbol["st_size"])
            for table in tables
            for symbol in table.iter_symbols()
            if symbol["st_info"]["type"] == "STT_FUNC" and symbol.name.startswith(f"{prefix}_")
        )


def measure(header: str, prefix: str, is_recurrent: bool, installation: Installation) -> Measured:
    """Compile a policy for robots, let an emulated one check itself and call it in each tick, and measure it.

    Args:
        header: The exported policy.
        prefix: What its names begin with.
        is_recurrent: Whether it has a state.
        installation: The simulator.

    Raises:
        FirmwareError: The robots' compiler is missing.
        ProjectError: It cannot be compiled.
        PolicyError: The emulated robot's self test has failed, or the run has ended with another error.
        ToolError: The run cannot be profiled.
        OSError: The temporary folder cannot be written.
    """
    with tempfile.TemporaryDirectory(prefix="pogosim-policy-") as name:
        folder = Path(name)
        (folder / "exported.h").write_text(header, encoding="utf-8")
        source = folder / "main.c"
        source.write_text(program_of(prefix, is_recurrent), encoding="utf-8")
        configuration = folder / "test.yaml"
        configuration.write_text(CONFIGURATION, encoding="utf-8")
        raw = folder / "profile.json"
        with firmware_of(source, installation, is_quiet=True) as made:
            if (code := profile_run(made.firmware, raw, 1, ["-c", str(configuration)], installation)) != 0:
                raise PolicyError(
                    f"the run on an emulated robot that measures the policy ended with exit code {code}; the messages "
                    "above say why, and --no-cycles exports without it"
                )
            size = code_bytes(made.firmware, prefix)
        profile = read_profile(raw, "the profile of the policy")
    budget = profile.budget_cycles
    assert budget is not None  # it has a main loop
    if cycles_and_calls(profile, "self_test_fails")[1]:
        raise PolicyError(
            "the self test of the policy fails on an emulated robot, which computes something else than this computer; "
            "--no-cycles exports it all the same"
        )
    cycles, calls = cycles_and_calls(profile, f"{prefix}_probe")
    if calls == 0:
        raise PolicyError("the program that measures the policy has not called it")
    return Measured(cycles / calls, budget, size)
