"""The command `pogoptim`, which is `pogosim optimize`."""

from __future__ import annotations

import argparse
import functools
import logging
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import pogosim
from pogosim.batch.configurations.configuration import Configuration
from pogosim.batch.configurations.names import NamesError
from pogosim.batch.ending import catch_signals, start_logging
from pogosim.batch.errors import reason
from pogosim.batch.run_options import (
    INTERRUPTED,
    ISOLATED,
    PROGRAM_HELP,
    WRONG,
    add_retry_options,
    add_saving_option,
    check_names,
    give_program,
)
from pogosim.batch.workers.jobqueue_options import add_jobqueue_options
from pogosim.batch.workers.slurm_options import add_slurm_options
from pogosim.command.parser import Parser, warn, warnings_told
from pogosim.errors import AmbiguousStepsWarning, ToolError
from pogosim.optimize.optimizers.table import OPTIMIZERS, check_optimizer, optimizer_for
from pogosim.optimize.settings import SECTION, Settings, settings_from

if TYPE_CHECKING:
    from pogosim.optimize.variables import Space

EPILOG = """Settings can also stand in the section "optimization" of the configuration; the command line comes first.
Exit codes: 0 the search is complete; 2 usage, configuration or file error; 3 all candidates failed, or an optimiser of
another package did; 130 interrupted."""

log = logging.getLogger("pogosim.optimize")


def parser(prog: str, optimizers: Iterable[str] = OPTIMIZERS.own) -> Parser:
    """Return the parser of the command line.

    Args:
        prog: Name of the command.
        optimizers: Names that its help lists.
    """
    usual = Settings()
    options = Parser(
        prog=prog,
        description="Searches for the parameters of a program that make an objective as large as possible.",
        epilog=EPILOG,
        allow_abbrev=False,
    )
    add = options.add_argument
    add("-c", "--config", required=True, help="configuration in which some keys have an optimization_domain (YAML)")
    add("-S", "--simulator-binary", metavar="PROGRAM", help=PROGRAM_HELP)
    add("-r", "--runs", type=int, metavar="N", help=f"runs per candidate ({usual.runs})")
    add("-O", "--objective", metavar="FILE.py", help="Python file with the function objective_fn(df) (mean MSD)")
    add("--objective-func", metavar="NAME", help="name of that function (objective_fn, or else compute_objective)")
    add("--features-func", metavar="NAME", help="name of the function that returns features (fd_fn)")
    add("--optimizer", metavar="NAME", help=f"{', '.join(optimizers)} ({usual.optimizer})")
    add("--max-evals", type=int, metavar="N", help=f"how many candidates are evaluated ({usual.max_evals})")
    add("--sigma0", type=float, metavar="S", help=f"first step size of CMA-ES, ranges being 1 ({usual.sigma0})")
    add("--popsize", type=int, metavar="N", help="candidates per generation (as usual for the optimiser)")
    add("--seed", type=int, help=f"seed of the optimiser ({usual.seed})")
    add(
        "--seeds",
        metavar="common|fresh|blocks",
        help="the runs of all candidates have the same seeds 0, 1, ... (common), or each its own (fresh), or its own "
        "block, with room for --retry-new-seed (blocks) (common)",
    )
    add(
        "--final-runs",
        type=int,
        metavar="N",
        help=f"runs of the best candidate at the end, with seeds that the search has not seen ({usual.final_runs})",
    )
    add("--resume", action="store_true", help="continue the search that is in the folder of the results")
    add("-o", "--output-dir", metavar="FOLDER", help=f"folder of the results ({usual.output_dir})")
    add("-t", "--temp-base", metavar="FOLDER", help=f"folder for temporary files ({usual.temp_base})")
    add("--keep-temp", action=argparse.BooleanOptionalAction, help="keep the folders of single runs")
    add("-R", "--retries", type=int, metavar="N", help=f"how many times a failed run is repeated ({usual.retries})")
    add_retry_options(options)
    add("-v", "--verbose", action="store_true", help="say more")
    add("-V", "--version", action="version", version=f"{prog} {pogosim.__version__}")
    add_quality_diversity_options(options, usual)
    group = options.add_argument_group("workers")
    group.add_argument("-j", "--workers", type=int, metavar="N", help="runs at the same time (one per processor)")
    group.add_argument("--isolated", action="store_true", help=ISOLATED)
    add_saving_option(group)
    group.add_argument(
        "--candidate-jobs", type=int, metavar="N", help=f"candidates at the same time ({usual.candidate_jobs})"
    )
    group.add_argument(
        "--batch-jobs",
        type=int,
        metavar="N",
        help=f"runs of each at the same time; 0: one run per processor in all ({usual.batch_jobs})",
    )
    group.add_argument("--backend", help="multiprocessing (default), sequential or dask")
    group.add_argument("--scheduler", metavar="tcp://...", help="let the workers of this Dask scheduler do the runs")
    add_slurm_options(options)
    add_jobqueue_options(options)
    return options


def add_quality_diversity_options(options: argparse.ArgumentParser, usual: Settings) -> None:
    """Add the options of MAP-Elites, CMA-ME and CMA-MAE."""
    group = options.add_argument_group(
        "quality-diversity", "For optimisers that need features (mapelites, cma_me, cma_mae)."
    )
    add = group.add_argument
    cells = ",".join(map(str, usual.qd_shape))
    add("--qd-shape", metavar="N,N", help=f"cells of the archive along each feature ({cells})")
    add("--qd-ranges", metavar="A:B,A:B", help="least and greatest value of each feature (0:1 if all are, or as seen)")
    add("--qd-features-domain", metavar="A:B,A:B", help="the same; a candidate with features outside has failed (none)")
    add("--qd-init-samples", type=int, metavar="N", help=f"random candidates at first ({usual.qd_init_samples})")
    add("--qd-batch", type=int, metavar="N", help=f"candidates per generation afterwards ({usual.qd_batch})")


def space_of(configuration: Configuration) -> Space:
    """Return the variables of a configuration.

    Raises:
        BatchError: A domain is wrong, or there is none.
    """
    from pogosim.optimize.variables import Space  # imports NumPy

    with configuration.placing_errors():
        return Space(configuration.entries)


def main(arguments: Sequence[str] | None = None, prog: str = "pogoptim") -> int:
    """Run the command. Returns its exit code, see its help."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    others = OPTIMIZERS.loaded_others(functools.partial(warn, prog)) if {"-h", "--help"} & set(words) else ()
    parsed = parser(prog, [*OPTIMIZERS.own, *others]).parse_args(words)
    start_logging(parsed.verbose, "[%(asctime)s] [%(levelname)s] %(message)s", log.name)
    catch_signals()
    try:
        check_names(parsed)
        configuration = Configuration(parsed.config)
        section = configuration.entries.get(SECTION)
        settings = settings_from(section, vars(parsed), configuration.where, lambda text: log.warning("%s", text))
        check_optimizer(settings)
        space = space_of(configuration)
        give_program(parsed)
        optimizer = optimizer_for(space, settings)
        from pogosim.optimize.execution import optimize  # takes a while

        with warnings_told(prog, AmbiguousStepsWarning):
            return optimize(parsed, configuration, settings, space, optimizer)
    except ToolError as error:
        log.error("%s", error)
        return error.exit_code
    except NamesError as error:
        log.error("%s", error)
    except OSError as error:
        log.error("%s: %s", error.filename or parsed.temp_base or Settings.temp_base, reason(error))
    except UnicodeEncodeError:
        log.error("%s: a value is no text in UTF-8 (such as \\ud800)", parsed.config)
    except MemoryError:
        log.error("not enough memory for the runs of a generation; lower --popsize, or save data less often")
    except KeyboardInterrupt:
        log.error("interrupted; the same command with --resume continues")
        return INTERRUPTED
    return WRONG


if __name__ == "__main__":
    sys.exit(main())
