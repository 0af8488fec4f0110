"""`pogosim export-policy`: a small neural network as C for robots, with what it takes there."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pogosim.command.parser import Parser, complain, guarded, say_of_complete, warn
from pogosim.outputs import OutputError, checked_output, leads_to, partial_output
from pogosim.policy.choices import ACTIVATIONS, NUMBERS

if TYPE_CHECKING:
    from pogosim.policy.c_header import Header
    from pogosim.policy.measuring import Measured
    from pogosim.policy.policy import Policy

EPILOG = """POLICY is an .npz file of NumPy, an .onnx file, or a .pt file with the state_dict() of a PyTorch module:
layers that see all values before them, Elman layers and GRUs. docs/policy_export.md lists the arrays and operators.

float needs no other file. int16 and int8 compute in whole numbers, which robots do about ten times as fast or more;
they need the range of each input, that of the policy or else of observations of a run: an .npz or .npy file with an
array of shape (..., inputs), or a data file with a column for each input. Inputs are cut to their range, in floats as
well."""
MEMORY_BYTES = 128 * 1024  # of a robot, for program, variables and stack

# Headers that programs include by <...>, where -I. may lead to this one: those of C, and those of robots.
OF_OTHERS = """assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg
stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype
pogobase pogobot"""


def parser(prog: str) -> Parser:
    """Return the command line."""
    made = Parser(
        prog=prog,
        usage=f"{prog} POLICY -o FILE.h [OPTIONS]",
        description="Makes C of a policy: a header for programs of robots. Says how much memory it needs, and how many "
        "cycles a call takes on an emulated robot.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    made.add_argument("policy", metavar="POLICY", help="the policy (.npz, .onnx, .pt)")
    made.add_argument("-o", "--output", metavar="FILE.h", required=True, help="the header to write")
    made.add_argument("--numbers", choices=NUMBERS, default="float", help="numbers (default: %(default)s)")
    made.add_argument("--calibration", metavar="FILE", help="observations of a run, for the ranges of the inputs")
    made.add_argument("--scaling", metavar="FILE.npz", help="names, scales and ranges of inputs and outputs")
    made.add_argument("--activation", choices=ACTIVATIONS, help="between the layers of a .pt file")
    made.add_argument("--output-activation", choices=ACTIVATIONS, help="of the last layer of a .pt file")
    made.add_argument("--name", default="policy", help="what names in C begin with (default: %(default)s)")
    made.add_argument("--no-cycles", action="store_true", help="do not measure how many cycles a call takes")
    return made


def checked_header(options: argparse.Namespace) -> Path:
    """Return where to write.

    Raises:
        OutputError: It would take the place of an input, or cannot be written.
        OSError: It cannot be looked at.
    """
    output = checked_output(options.output, options.policy, ["h"])
    if output.stem in OF_OTHERS.split():
        raise OutputError(f"{options.output} would hide the header <{output.name}> of C or robots; choose another name")
    for given in (options.calibration, options.scaling):
        if given is not None and leads_to(output, given):
            raise OutputError(f"{options.output} would take the place of {given}; name another output")
    return output


def measured(header: Header, policy: Policy, prefix: str) -> Measured | str:
    """Return what the policy takes on an emulated robot, or why that cannot be said.

    Raises:
        ToolError: It does not do there what it does here.
    """
    from pogosim.firmware.making import FirmwareError
    from pogosim.installation import InstallationError, find_installation
    from pogosim.policy.measuring import measure

    try:
        return measure(header.text, prefix, policy.network.is_recurrent, find_installation())
    except (FirmwareError, InstallationError) as error:
        return str(error)


def accuracy(policy: Policy, observations: object) -> list[str]:
    """Return how far the outputs in whole numbers are from exact ones: at most, and from those in floats in a run.

    What recurrent policies remember is left out of the latter: observations need not follow each other.
    """
    from dataclasses import replace

    import numpy as np

    from pogosim.policy.policy import Policy as Stepped

    if policy.fixed is None:
        return []
    bounds = policy.fixed.error_bound
    worst = int(np.argmax(bounds))
    where = "a step from the same state" if policy.network.is_recurrent else "any inputs in range"
    text = f"outputs within {bounds[worst]:.3g} ({policy.network.output_names[worst]}) of exact arithmetic, for {where}"
    if observations is not None and not policy.network.is_recurrent:
        rows = np.rint(np.asarray(observations))
        ends = np.stack([policy.fixed.input_low, policy.fixed.input_high], axis=1).astype(np.float32)
        off = np.abs(policy.step(rows) - Stepped(replace(policy.network, input_range=ends)).step(rows))
        policy.reset()
        text += f"; in the {len(rows)} observations {off.mean():.3g} from floats on average, {off.max():.3g} at most"
        if beyond := int(((rows < ends[:, 0]) | (rows > ends[:, 1])).any(axis=1).sum()):
            text += f"; {beyond} of {len(rows)} observations are beyond the range of the inputs, and are cut to it"
    return [f"accuracy         {text}"]


def report(header: Header, policy: Policy, cost: Measured | str, observations: object, output: str) -> list[str]:
    """Return what is said of an exported policy."""
    form = "float" if policy.fixed is None else f"int{policy.fixed.bits}"
    code = f" and {cost.code_bytes} bytes of code" if not isinstance(cost, str) else ""
    lines = [
        f"{output}: {policy.network.describe()}; {form}",
        f"program          {header.constant_bytes} bytes of constants{code}",
        f"memory           {header.state_bytes} bytes of state, {header.stack_bytes} bytes of stack in a call",
        f"multiplications  {header.multiplications} per call",
        *accuracy(policy, observations),
    ]
    if isinstance(cost, str):
        return [*lines, f"cycles           not measured: {cost}"]
    fits = "it fits" if cost.share <= 1 else "it does not fit"
    return [
        *lines,
        f"cycles           {cost.cycles:.0f} per call on an emulated robot, {cost.percent} of a tick at 60 Hz "
        f"({cost.budget:.0f}): {fits}",
    ]


def run(options: argparse.Namespace, prog: str) -> int:
    """Export a policy. Returns the exit code.

    Raises:
        ToolError: It cannot be done.
        OSError: A file cannot be read or written.
    """
    from pogosim.policy.c_header import check_size, checked_prefix, header_of
    from pogosim.policy.calibration import read_observations
    from pogosim.policy.example_steps import example_steps
    from pogosim.policy.overflow import check_overflow
    from pogosim.policy.policy import Policy
    from pogosim.policy.reading import read_policy, with_scaling

    output = checked_header(options)
    checked_prefix(options.name)
    network = read_policy(Path(options.policy), options.activation, options.output_activation)
    check_size(network)
    if options.scaling is not None:
        network = with_scaling(network, Path(options.scaling))
    observations = read_observations(Path(options.calibration), network) if options.calibration is not None else None
    policy = Policy(network, numbers=options.numbers, calibration=observations)
    may_overflow = check_overflow(policy.network) if policy.fixed is None else None
    header = header_of(policy, example_steps(policy, observations), options.name, Path(options.policy).name)
    cost = "--no-cycles" if options.no_cycles else measured(header, policy, options.name)
    with partial_output(output) as partial:
        partial.write_text(header.text, encoding="utf-8")
    lines = report(header, policy, cost, observations, options.output)
    if code := say_of_complete(prog, options.output, *lines):
        return code
    if may_overflow is not None:
        warn(prog, may_overflow)
    program_bytes = header.constant_bytes + (0 if isinstance(cost, str) else cost.code_bytes)
    if program_bytes + header.state_bytes + header.stack_bytes > MEMORY_BYTES:
        warn(prog, f"the policy does not fit into the {MEMORY_BYTES // 1024} KiB of a robot")
    return 0


def main(arguments: Sequence[str] | None = None, prog: str = "pogosim export-policy") -> int:
    """Run the command. Returns its exit code: 0 done, 2 nothing could be done."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if not given:
        return complain(prog, "expected a policy (.npz, .onnx, .pt) and -o FILE.h")
    options = parser(prog).parse_args(given)
    return guarded(prog, lambda: run(options, prog), options.policy)
