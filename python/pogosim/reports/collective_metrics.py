"""The metrics of `pogosim analyze collective`: one entry each in `METRICS`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from pogosim.analysis.arena import Floats
from pogosim.analysis.bond_order import bond_order
from pogosim.analysis.correlations import correlation_length, correlation_lengths, pair_correlation
from pogosim.analysis.fluctuations import mean_square_speed, number_fluctuations
from pogosim.analysis.milling import milling
from pogosim.analysis.neighbourhood import clusters
from pogosim.analysis.order import nematic_order, polar_order
from pogosim.analysis.structure_factor import structure_factor
from pogosim.reports.collective_swarm import VORTICITY_BINS, Swarm, mean_of_robots

BINS = 40  # of distributions
SIGNIFICANT_Z = 5.99  # 5 % of chi^2 with two degrees of freedom are above it


@dataclass(frozen=True)
class Metric:
    """A table for each run, one or more curves, and one or more numbers for the summary."""

    key: str  # name of the CSV file
    title: str  # what it is, with the formula
    compute: Callable[[Swarm], pd.DataFrame]  # columns: x, then values
    curves: dict[str, str]  # columns to draw, and the labels of their axes, with units
    x_label: str = "time (s)"
    needs_arena: bool = False
    logarithmic: bool = False
    limits: tuple[float, float] | None = None  # of the ordinate; None: those of the data
    chance: float | None = None  # drawn as a line: what there is without any order
    numbers: Callable[[pd.DataFrame], dict[str, float]] | None = None  # None: means over time

    @property
    def figure(self) -> str:
        """Name of the figure, without suffix."""
        return f"{self.key}_time" if self.numbers is None else self.key

    def summary(self, table: pd.DataFrame) -> dict[str, float]:
        """Return the numbers of a run by name."""
        if self.numbers is not None:
            return self.numbers(table)
        values = table.drop(columns="time_s")
        return {f"mean {name}": float(values[name].mean()) for name in values}


def over_time(swarm: Swarm, **columns: Floats) -> pd.DataFrame:
    """Return a table with a row for each time."""
    return pd.DataFrame({"time_s": swarm.run.time_s, **columns})


def compute_polar_order(swarm: Swarm) -> pd.DataFrame:
    """Order of all directions."""
    return over_time(swarm, polar_order=polar_order(swarm.direction), nematic_order=nematic_order(swarm.direction))


def compute_local_polar(swarm: Swarm) -> pd.DataFrame:
    """Order of the directions of neighbours: means over robots."""
    local = swarm.local
    known = np.isfinite(local.rayleigh_z)
    return over_time(
        swarm,
        local_polar=mean_of_robots(local.polar_order),
        local_polar_corrected=mean_of_robots(local.corrected),
        rayleigh_z=mean_of_robots(local.rayleigh_z),
        significant_fraction=mean_of_robots(np.where(known, local.rayleigh_z > SIGNIFICANT_Z, np.nan)),
        group_size=mean_of_robots(np.where(known, local.group_size, np.nan)),
    )


def compute_local_pair_align(swarm: Swarm) -> pd.DataFrame:
    """Mean cosine between neighbours."""
    return over_time(swarm, pair_alignment=mean_of_robots(swarm.local.pair_alignment))


def distribution(name: str, values: Floats, low: float, high: float) -> pd.DataFrame:
    """Return the probability density of values of all robots and times."""
    edges = np.linspace(low, high, BINS + 1)
    values = values[np.isfinite(values)]
    counted = np.histogram(np.clip(values, low, high), edges)[0]
    density = counted / (len(values) * np.diff(edges)) if len(values) else np.full(BINS, np.nan)
    return pd.DataFrame({name: (edges[1:] + edges[:-1]) / 2.0, "probability_density": density})


def mean_of_distribution(table: pd.DataFrame) -> dict[str, float]:
    """Return mean and standard deviation of what is distributed."""
    value, density = table.iloc[:, 0].to_numpy(), table.iloc[:, 1].to_numpy()
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = float((value * density).sum() / density.sum())
        return {
            "mean": centre,
            "standard deviation": float(np.sqrt(((value - centre) ** 2 * density).sum() / density.sum())),
        }


def compute_align_corr(swarm: Swarm) -> pd.DataFrame:
    """Correlation of velocities by distance, over all times."""
    own = swarm.correlation
    return pd.DataFrame({"distance_mm": own.distance_mm, "correlation": own.mean, "pairs": own.pairs.sum(axis=0)})


def length_of(table: pd.DataFrame) -> dict[str, float]:
    """Return the correlation length over all times."""
    length = correlation_length(table["distance_mm"].to_numpy(), table["correlation"].to_numpy())
    return {"correlation length of all times in mm": length}


def compute_align_corr_len(swarm: Swarm) -> pd.DataFrame:
    """Correlation length at each time."""
    own = swarm.correlation
    return over_time(swarm, correlation_length_mm=correlation_lengths(own.distance_mm, own.at_times))


def compute_psi_k(swarm: Swarm) -> pd.DataFrame:
    """Bond order: mean of the lengths, and length of the mean."""
    psi = bond_order(swarm.run, swarm.settings.psi_k)
    there = np.isfinite(psi)
    with np.errstate(invalid="ignore"):
        mean = np.abs(np.where(there, psi, 0.0).sum(axis=1) / there.sum(axis=1))
    return over_time(swarm, psi_local=mean_of_robots(np.where(there, np.abs(psi), np.nan)), psi_global=mean)


def compute_largest_cluster(swarm: Swarm) -> pd.DataFrame:
    """Share of the largest cluster."""
    label = clusters(swarm.run)
    there = (label >= 0).sum(axis=1)
    share = np.divide((label == 0).sum(axis=1), there, out=np.full(len(there), np.nan), where=there > 0)
    return over_time(swarm, largest_cluster=share, clusters=label.max(axis=1) + 1.0)


def compute_g_r(swarm: Swarm) -> pd.DataFrame:
    """Pair correlation function."""
    own = pair_correlation(swarm.run, swarm.settings.gr_rmax_mm, swarm.settings.gr_dr_mm)
    return pd.DataFrame({"distance_mm": own.distance_mm, "g_r": own.g_r, "pairs": own.pairs})


def compute_s_k(swarm: Swarm) -> pd.DataFrame:
    """Structure factor."""
    wave_number, s = structure_factor(swarm.run, swarm.settings.sk_shape)
    return pd.DataFrame({"wave_number_rad_mm": wave_number, "S_k": s})


def peak(x: str, y: str) -> Callable[[pd.DataFrame], dict[str, float]]:
    """Return a function that finds the highest point of a curve."""

    def found(table: pd.DataFrame) -> dict[str, float]:
        values = table[y].to_numpy(dtype=float)
        if not np.isfinite(values).any():
            return {f"highest {y}": float("nan"), f"at {x}": float("nan")}
        top = int(np.nanargmax(values))
        return {f"highest {y}": float(values[top]), f"at {x}": float(table[x].iloc[top])}

    return found


def compute_number_fluct(swarm: Swarm) -> pd.DataFrame:
    """Fluctuations of the number of robots in boxes."""
    own = number_fluctuations(swarm.run)
    columns: dict[str, Any] = {
        "mean_count": own.mean,
        "std_count": own.deviation,
        "box_mm": own.box_mm,
        "boxes": own.boxes,
    }
    return pd.DataFrame({**columns, "exponent": own.exponent}).iloc[::-1]


def exponent_of(table: pd.DataFrame) -> dict[str, float]:
    """Return the exponent of number fluctuations."""
    return {"exponent": float(table["exponent"].iloc[0]) if len(table) else float("nan")}


def compute_teff_ratio(swarm: Swarm) -> pd.DataFrame:
    """Mean square speed, and its ratio to the reference."""
    square = mean_square_speed(swarm.velocity)
    reference = swarm.settings.v2_ref_mm2_s2 or float("nan")
    return over_time(swarm, Teff_ratio=square / reference, mean_square_speed_mm2_s2=square)


def compute_vortex_summary(swarm: Swarm) -> pd.DataFrame:
    """Means over the velocity field."""
    return swarm.vortices.at_times


def compute_vortex_field_dist(swarm: Swarm) -> pd.DataFrame:
    """Distribution of the vorticity."""
    edges = np.linspace(-1.0, 1.0, VORTICITY_BINS + 1) * swarm.settings.vorticity_range
    middle = (edges[1:] + edges[:-1]) / 2.0
    return pd.DataFrame({"vorticity_per_s": middle, "probability_density": swarm.vortices.density})


def compute_milling(swarm: Swarm) -> pd.DataFrame:
    """Rotation about the centre."""
    settings = swarm.settings
    tangential, momentum = milling(swarm.run, swarm.velocity, settings.milling_centre, settings.min_speed_mm_s)
    return over_time(swarm, tangential_alignment=tangential, angular_momentum=momentum)


DENSITY = "probability density"
METRICS = (
    Metric(
        "polar_order",
        "polar order P = |<u>| and nematic order S = |<exp(2 i theta)>| of all directions",
        compute_polar_order,
        {"polar_order": "polar order P", "nematic_order": "nematic order S"},
        limits=(0.0, 1.0),
    ),
    Metric(
        "local_polar",
        "polar order P of each robot with its neighbours, without what m directions have by chance, "
        "max(0, P - sqrt(pi) / (2 sqrt(m))), and Z = 2 m P^2, above 5.99 for 5 % of independent directions; "
        "means over robots with a neighbour",
        compute_local_polar,
        {"local_polar_corrected": "local polar order, corrected", "significant_fraction": "fraction with Z > 5.99"},
        limits=(0.0, 1.0),
    ),
    Metric(
        "local_polar_dist",
        "distribution of the local polar order, not corrected, over robots and times",
        lambda swarm: distribution("local_polar", swarm.local.polar_order, 0.0, 1.0),
        {"probability_density": DENSITY},
        "local polar order P",
        numbers=mean_of_distribution,
    ),
    Metric(
        "local_pair_align",
        "mean of cos(theta_j - theta_i) over the neighbours j of each robot i; mean over robots with a neighbour",
        compute_local_pair_align,
        {"pair_alignment": "alignment of neighbours, mean cosine"},
        limits=(-1.0, 1.0),
        chance=0.0,
    ),
    Metric(
        "local_pair_align_dist",
        "distribution of the mean cosine over robots and times",
        lambda swarm: distribution("pair_alignment", swarm.local.pair_alignment, -1.0, 1.0),
        {"probability_density": DENSITY},
        "alignment with neighbours, mean cosine",
        numbers=mean_of_distribution,
    ),
    Metric(
        "align_corr",
        "correlation of velocities C(r) = <v_i . v_j>_r / <|v|^2>, over all times",
        compute_align_corr,
        {"correlation": "velocity correlation C(r)"},
        "distance r (mm)",
        chance=0.0,
        numbers=length_of,
    ),
    Metric(
        "align_corr_len",
        "correlation length at each time, the integral of the positive part of C(r)",
        compute_align_corr_len,
        {"correlation_length_mm": "correlation length (mm)"},
    ),
    Metric(
        "psi_k",
        "bond order psi_k of the k nearest neighbours: <|psi|> (psi_local) and |<psi>| (psi_global)",
        compute_psi_k,
        {"psi_local": "local bond order", "psi_global": "global bond order"},
        limits=(0.0, 1.0),
    ),
    Metric(
        "largest_cluster",
        "share of the robots in the largest cluster, the largest set connected through neighbours",
        compute_largest_cluster,
        {"largest_cluster": "share of the largest cluster"},
        limits=(0.0, 1.0),
    ),
    Metric(
        "g_r",
        "pair correlation function g(r), with the pairs of independent positions on the same floor as 1",
        compute_g_r,
        {"g_r": "pair correlation g(r)"},
        "distance r (mm)",
        needs_arena=True,
        chance=1.0,
        numbers=peak("distance_mm", "g_r"),
    ),
    Metric(
        "S_k",
        "static structure factor S(k), mean over directions and times",
        compute_s_k,
        {"S_k": "structure factor S(k)"},
        "wave number k (rad/mm)",
        needs_arena=True,
        chance=1.0,
        numbers=peak("wave_number_rad_mm", "S_k"),
    ),
    Metric(
        "number_fluct",
        "standard deviation of the number of robots in boxes by its mean, sigma ~ N^alpha; independent positions: 1/2",
        compute_number_fluct,
        {"std_count": "standard deviation of the number"},
        "mean number of robots in a box",
        needs_arena=True,
        logarithmic=True,
        numbers=exponent_of,
    ),
    Metric(
        "Teff_ratio",
        "effective temperature ratio <v^2> / v2_ref",
        compute_teff_ratio,
        {"Teff_ratio": "effective temperature ratio"},
    ),
    Metric(
        "vortex_summary",
        "means over the velocity field: vorticity, its absolute value, enstrophy (half its square), swirling strength, "
        "Okubo-Weiss parameter, fraction where it is negative (vortex_fraction), fraction of cells with a value "
        "(known_fraction)",
        compute_vortex_summary,
        {
            "vorticity_per_s": "mean vorticity (1/s)",
            "enstrophy_per_s2": "enstrophy (1/s$^2$)",
            "swirling_strength_rad_s": "swirling strength (rad/s)",
            "okubo_weiss_per_s2": "Okubo-Weiss parameter (1/s$^2$)",
        },
    ),
    Metric(
        "vortex_field_dist",
        "distribution of the vorticity over cells and times",
        compute_vortex_field_dist,
        {"probability_density": "probability density (s)"},
        "vorticity (1/s)",
        numbers=mean_of_distribution,
    ),
    Metric(
        "milling",
        "tangential alignment <r x u> and normalised angular momentum sum(R x v) / sum(|R| |v|) about the centre; "
        "positive: clockwise as seen",
        compute_milling,
        {"tangential_alignment": "tangential alignment", "angular_momentum": "normalised angular momentum"},
        limits=(-1.0, 1.0),
        chance=0.0,
    ),
)
