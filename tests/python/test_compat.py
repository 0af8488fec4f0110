"""Names under which scripts written for other Pogosim packages call our analyses."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pogosim import compute_optimal_psend
from pogosim.compat import MODULES, functions_of
from pogosim.errors import AnalysisError
from pogosim.reports import figures
from pogosim.reports.command import main as analyze
from pogosim.utils import load_dataframe
from swarms import brownian_walk, metadata_of, rows_of, write_rows

ANALYSIS_OF = {"am": "collective"}  # the other modules have the name of their analysis
ALL = [(module, name) for module in MODULES for name in functions_of(module)]


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the data file of two runs of 20 robots."""
    starts = np.random.default_rng(3).uniform(300.0, 700.0, (20, 2))
    walks = [starts + brownian_walk(30, 20, 10.0, seed=seed) for seed in (1, 2)]
    rows = pd.concat([rows_of(walk).assign(run=run) for run, walk in enumerate(walks)])
    return write_rows(tmp_path_factory.mktemp("compat") / "two_runs.feather", rows, metadata_of())


@pytest.fixture(scope="module")
def written(data: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Analyse the data with the names of others' options, and return the folder of each module."""
    folders = {module: tmp_path_factory.mktemp(module) for module in MODULES}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figures, "FORMATS", ())  # tables alone
        for module, folder in folders.items():
            analysis = ANALYSIS_OF.get(module, module)
            assert analyze([analysis, "--inputFile", str(data), "--outputDir", str(folder)]) == 0
    return folders


@pytest.mark.parametrize(("module", "name"), ALL)
def test_each_function_returns_the_table_that_the_analysis_writes(
    data: Path, written: dict[str, Path], module: str, name: str
) -> None:
    options = {"avg_window_s": 5.0} if name == "compute_timeavg_eigs" else {}
    table = getattr(importlib.import_module(f"pogosim.{module}"), name)(load_dataframe(data)[0], **options)
    if name == "compute_timeavg_eigs":  # its window has to be asked for
        assert sorted(set(table["run"])) == [0, 1]
        return
    (path,) = written[module].rglob(f"{name.removeprefix('compute_')}.csv")
    expected = pd.read_csv(path)
    if name == "compute_msd_per_agent":  # the function of `pogosim.locomotion` itself has no column of the arena
        expected = expected[list(table.columns)]
    assert list(table.columns) == list(expected.columns)
    for column in table.columns:
        if pd.api.types.is_numeric_dtype(table[column]):
            np.testing.assert_allclose(table[column], expected[column], rtol=1e-12)
        else:
            assert list(table[column].astype(str)) == list(expected[column].astype(str))


def test_table_that_the_options_do_not_give_is_an_error_and_no_other_table(data: Path) -> None:
    rows, functions = load_dataframe(data)[0], functions_of("network")
    with pytest.raises(AnalysisError, match="compute_timeavg_eigs: the table is that with the option avg_window_s; "):
        functions["compute_timeavg_eigs"](rows)
    for name in ("compute_timeavg_eigs_tau_c", "compute_timeavg_eigs_10dt"):
        with pytest.raises(AnalysisError, match=f"{name}: the table is that without the option avg_window_s; "):
            functions[name](rows, avg_window_s=5.0)


def test_options_have_the_names_of_the_command_line(data: Path) -> None:
    compute = functions_of("am")["compute_psi_k"]
    rows, metadata = load_dataframe(data)
    six, four = compute(rows), compute(rows, metadata, psi_k=4)
    assert not six["psi_local"].equals(four["psi_local"])
    near, far = (functions_of("neighbors")["compute_neighbors_time"](rows, rc=rc) for rc in (60.0, 500.0))
    assert near["mean_degree"].mean() < far["mean_degree"].mean()


def test_an_option_that_does_not_exist_is_an_error_with_those_that_do(data: Path) -> None:
    rows = load_dataframe(data)[0]
    with pytest.raises(TypeError, match=r"compute_psi_k\(\) has no option 'k'; it has .*psi_k"):
        functions_of("am")["compute_psi_k"](rows, k=4)
    with pytest.raises(TypeError, match="has no option 'output_dir'"):
        functions_of("am")["compute_psi_k"](rows, output_dir=".")


def test_a_name_that_does_not_exist_is_an_error_with_the_nearest_one() -> None:
    module = importlib.import_module("pogosim.am")
    with pytest.raises(AttributeError, match=r"'compute_polar_ordr' \(did you mean compute_polar_order\?\)"):
        module.compute_polar_ordr  # noqa: B018
    assert not hasattr(module, "__wrapped__")


def test_details_are_left_out_if_asked_to(data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "FORMATS", ())
    arguments = ["collective", "--inputFile", str(data), "--no-extended-infos", "--outputDir"]
    assert analyze([*arguments, str(tmp_path)]) == 0
    assert (tmp_path / "SUMMARY_global.txt").is_file()
    assert not (tmp_path / "SUMMARY_metric_details.txt").exists()
    assert not (tmp_path / "metrics.pkl").exists()


def test_sizes_of_clusters_and_messages_have_both_names(capsys: pytest.CaptureFixture[str]) -> None:
    texts = []
    for cluster, size in (("--cluster_size", "--msg_size"), ("--cluster", "--msg-size")):
        assert compute_optimal_psend.main([cluster, "7", size, "110"]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]
    assert "0.2507" in texts[0]
