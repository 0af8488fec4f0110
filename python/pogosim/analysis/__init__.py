"""Analyses of runs, as functions: what `pogosim analyze` computes, for scripts of one's own.

    from pogosim.analysis.trajectories import trajectories_of, unwrapped
    from pogosim.utils import load_dataframe

    rows, metadata = load_dataframe("result.feather")
    for run in trajectories_of(rows):
        path = unwrapped(run)  # (times, robots, 2), mm

They take a `Trajectories` (one run as arrays) and return arrays, with one value per time, or per time and robot. Files
and figures are made in `pogosim.reports`.
"""
