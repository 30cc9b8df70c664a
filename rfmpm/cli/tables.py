"""Results as a table of labels and texts with units."""

from collections.abc import Iterable
from typing import Any

import typer


def print_table(rows: Iterable[tuple[str, str]]) -> None:
    """Print labels and texts in two columns."""
    rows = list(rows)
    width = max(len(label) for label, _ in rows)
    for label, text in rows:
        typer.echo(f"{label:{width}}  {text}")


def outcome_rows(outcome: Any) -> list[tuple[str, str]]:
    """Status, quantities and cost of a realisation, as label and text with unit."""
    from rfmpm.report.words import duration
    from rfmpm.variables import VARIABLES

    status = outcome.status if outcome.status == "ok" else f"{outcome.status}: {outcome.reason}"
    rows = [("status", status)]
    for name, value in outcome.quantities.items():
        variable = VARIABLES[name]
        if getattr(value, "ndim", 0) == 0:
            rows.append((variable.long_name, _with_unit(value, variable)))
    return [*rows, ("steps", f"{outcome.step_count:,}"), ("wall time", duration(outcome.wall_time))]


def _with_unit(value: Any, variable: Any) -> str:
    if value != value:  # NaN
        return "unknown"
    if meanings := variable.attributes.get("flag_meanings"):
        return meanings.split()[list(variable.attributes["flag_values"]).index(int(value))]
    unit = "" if variable.unit == "1" else variable.unit
    return f"{value:.4g} {unit}".rstrip()


def cost_row(key: str, value: Any) -> tuple[str, str]:
    """Label and text of a cost whose key ends in its unit (`time_step_s`, `memory_bytes`, `cell_m`), or of a number."""
    from rfmpm.report.words import duration

    name, _, unit = key.rpartition("_")
    if unit == "s":
        return name.replace("_", " "), duration(value)
    if unit == "bytes":
        return name.replace("_", " "), f"{value / 1e6:,.3g} MB" if value < 1e9 else f"{value / 1e9:,.3g} GB"
    if unit == "m":
        return name.replace("_", " "), f"{value:.4g} m"
    return key.replace("_", " "), f"{value:,}" if isinstance(value, int) else str(value)
