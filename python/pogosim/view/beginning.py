"""What a view shows first: what the configuration of the run says, in its section `view` or by older keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

OLDER = {
    "show_time": "time",
    "show_scale_bar": "scale_bar",
    "show_light_levels": "light_levels",
    "show_trajectory_traces": "trails",
}


def view_of(configuration: Mapping[str, Any]) -> dict[str, Any]:
    """Return the section `view` of a configuration, older keys translated; keys with one value, as JSON has them."""
    view = {name: configuration[older] for older, name in OLDER.items() if isinstance(configuration.get(older), bool)}
    if configuration.get("show_communication_channels") is True:
        view["links"] = "above" if configuration.get("show_communication_channels_above_all") is True else "below"
    own = configuration.get("view")
    return {**view, **plain(own if isinstance(own, Mapping) else {})}


def plain(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys whose value is a number, a text or a truth value."""
    return {key: value for key, value in keys.items() if isinstance(value, (bool, int, float, str))}
