"""Measured probabilities of reception, from CSV files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd

from pogosim.communication.reception_law import SHORT_HEADER_BYTES
from pogosim.errors import ToolError

# On real robots: a focal robot and 1, 2 or 6 neighbours that all send short messages at 60 Hz (the article's data).
ROBOTS_OWN = Path(__file__).with_name("ir_reception_profile.csv")

COLUMNS = ("payload_size", "p_send", "success_probability")
# Columns, the least and the greatest value of each.
RANGES = {
    "payload_size": (0.0, 382.0),
    "nb_neighbors": (0.0, 1e6),
    "cluster_size": (1.0, 1e6),
    "p_send": (0.0, 1.0),
    "success_probability": (0.0, 1.0),
}


class MeasurementError(ToolError):
    """A file holds no measurements that can be used; says which file, what, and what to do."""


@dataclass(frozen=True)
class Measurements:
    """Measured probabilities of reception.

    Attributes:
        rows: Columns payload_size (bytes), cluster_size (the sender counts), p_send and success_probability (0 to 1).
        header_bytes: Size of the header of the messages: 3 in short ones, 8 in long ones.
        left_out: How many rows of the file were left out because a number is missing in them.
    """

    rows: pd.DataFrame
    header_bytes: int = SHORT_HEADER_BYTES
    left_out: int = 0

    @property
    def message_bytes(self) -> npt.NDArray[np.float64]:
        """Size of the messages, header included. Shape (rows,)."""
        return self.rows["payload_size"].to_numpy(dtype=float) + self.header_bytes

    @property
    def send_probability(self) -> npt.NDArray[np.float64]:
        """Chance to send in a tick. Shape (rows,)."""
        return self.rows["p_send"].to_numpy(dtype=float)

    @property
    def cluster_size(self) -> npt.NDArray[np.float64]:
        """Robots that hear each other, the sender included. Shape (rows,)."""
        return self.rows["cluster_size"].to_numpy(dtype=float)

    @property
    def success(self) -> npt.NDArray[np.float64]:
        """Measured probability of reception. Shape (rows,)."""
        return self.rows["success_probability"].to_numpy(dtype=float)


def read_measurements(path: str | Path = ROBOTS_OWN, header_bytes: int = SHORT_HEADER_BYTES) -> Measurements:
    """Read measurements.

    Args:
        path: A CSV file with a header and the columns payload_size (bytes), nb_neighbors (or cluster_size, which is one
            more), p_send and success_probability (0 to 1). Others are ignored.
        header_bytes: Size of the header of the messages that were measured.

    Raises:
        MeasurementError: A column is missing, or holds something else.
        OSError: The file cannot be read.
    """
    table = read_table(Path(path))
    names = {str(name).strip(): name for name in table.columns}
    size = "cluster_size" if "cluster_size" in names else "nb_neighbors"
    missing = [name for name in (*COLUMNS, size) if name not in names]
    if missing:
        found = ", ".join(names)
        raise MeasurementError(
            f"{path} has no column {', '.join(missing)}; expected payload_size, nb_neighbors (or cluster_size), p_send "
            f"and success_probability, found {found}"
        )
    used = {name: numbers(path, name, table[names[name]]) for name in (*COLUMNS, size)}
    rows = pd.DataFrame(used)
    complete = rows.dropna().reset_index(drop=True)
    if complete.empty:
        raise MeasurementError(f"{path} has no row with all numbers")
    if size == "nb_neighbors":
        complete = complete.rename(columns={size: "cluster_size"})
        complete["cluster_size"] += 1
    ordered = complete[["payload_size", "cluster_size", "p_send", "success_probability"]]
    return Measurements(ordered, header_bytes, len(rows) - len(complete))


def read_table(path: Path) -> pd.DataFrame:
    """Read a CSV file.

    Raises:
        MeasurementError: It is none.
        OSError: It cannot be read.
    """
    if path.exists() and not path.is_file():
        raise MeasurementError(f"{path} is not a file; expected a CSV file of measurements")
    try:
        return pd.read_csv(path, comment="#", encoding="utf-8-sig", index_col=False)
    except pd.errors.EmptyDataError:
        raise MeasurementError(f"{path} is empty; expected a CSV file of measurements") from None
    except (ValueError, pd.errors.ParserWarning) as error:  # text that is no UTF-8, or no table
        reason = " ".join(str(error).split())
        raise MeasurementError(f"{path} is not a CSV file of measurements: {reason}") from None


def numbers(path: str | Path, name: str, column: pd.Series[float]) -> pd.Series[float]:
    """Return a column as numbers; empty cells and nan stay missing.

    Raises:
        MeasurementError: A cell holds something else, or a number out of range.
    """
    converted = pd.to_numeric(column, errors="coerce")
    low, high = RANGES[name]
    wrong = (converted.isna() & column.notna()) | (converted.notna() & ~converted.between(low, high))
    if wrong.any():
        place = int(np.flatnonzero(wrong.to_numpy())[0])
        raise MeasurementError(
            f"{path}, row {place + 1}: {name} is {column.iloc[place]}; expected a number from {low:g} to {high:g}"
        )
    return converted.astype(float)
