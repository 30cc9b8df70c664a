"""What the sections of the page hold, as texts: parts of the error, kinds of failure, causes, cost."""

import math
from collections import Counter

from rfmpm.report import modes as kinds
from rfmpm.report import words
from rfmpm.report.answering import FEWEST_PAIRS
from rfmpm.report.costs import WATTS_PER_CORE
from rfmpm.report.numbers import Numbers
from rfmpm.report.question import NAMES

MOST_REASONS = 20  # rows of the table of failures; report.json has all
QUALITY_NAMES = {
    "plastic_work_share": "work of plastic flow",
    "friction_work_share": "work of friction on base and sides",
    "numerical_dissipation_share": "energy dissipated by the method itself",
    "energy_balance_error": "energy not accounted for",
}


def error_parts(numbers: Numbers, study) -> list[dict]:
    """Parts of the error of the answer: label, size in words and as a share of the largest (None: unknown)."""
    budget, unit = numbers.budget, numbers.asked.answer_unit
    parts = [("limited number of simulations", budget.sampling)] if numbers.is_random else []
    parts.append((f"size of the cells, {study.discretisation.cell_m:g} m", budget.discretisation))
    if budget.failed > 0.0:
        parts.append(("failed or cut-off simulations", budget.failed))
    largest = max((size for _, size in parts if size is not None and math.isfinite(size)), default=0.0)
    found = [{"label": label, "size": _plus_minus(size, unit), "share": _share(size, largest)} for label, size in parts]
    if cells := numbers.discretisation:
        sides = (("+", max(-cells.lower, 0.0)), ("-", max(cells.upper, 0.0)))
        moved = [_signed(sign, size, unit) for sign, size in sides if size > 0.0]
        found[int(numbers.is_random)]["size"] = " / ".join(moved) or _plus_minus(0.0, unit)
    return found


def _plus_minus(size: float | None, unit: str) -> str:
    if size is None or math.isinf(size):
        return "unknown" if size is None else "unbounded"
    return _signed("±", size, unit)


def _signed(sign: str, size: float, unit: str) -> str:
    return f"{sign} {words.number(size, 2)}{' ' if unit else ''}{unit}"


def _share(size: float | None, largest: float) -> float | None:
    if size is None:
        return None
    return round(100.0 * min(size / largest, 1.0), 1) if largest > 0.0 else (100.0 if math.isinf(size) else 0.0)


def precision(numbers: Numbers) -> list[str]:
    """Say how the answer was found, and what two sizes of cells tell of its error."""
    if not numbers.completed:
        return []
    method = numbers.answer.method.replace("_", " ")
    found = [f"Estimator: {method}; {words.count(numbers.answer.n, 'realisation')} on the study's own cells."]
    if cells := numbers.discretisation:
        unit = f" {numbers.asked.answer_unit}".rstrip()
        side = "high" if cells.error >= 0.0 else "low"
        sizes = " and ".join(f"{size:g} m" for size in cells.cells)
        found.append(
            f"{cells.n} realisations were simulated on cells of {sizes}. By them the answer is "
            f"{words.number(abs(cells.error), 2)}{unit} too {side} (standard error "
            f"{words.number(cells.standard_error, 2)}) compared with vanishing cells; the bounds allow for "
            f"{words.number(max(cells.upper, 0.0), 2)}{unit} downwards and {words.number(max(-cells.lower, 0.0), 2)}"
            f"{unit} upwards ({cells.note})."
        )
    elif numbers.coarser:
        found.append(
            f"Fewer than {FEWEST_PAIRS} realisations completed on two sizes of cells, too few to tell the error that "
            "these make."
        )
    else:
        found.append("All realisations were simulated on one size of cells, so the error that this makes is unknown.")
    return found


def sample(numbers: Numbers, study) -> str:
    """Say of which realisations kinds of failure, pictures and histograms are, where not of all independent ones."""
    sampling = study.estimator.sampling if study.estimator else "random"
    if sampling == "saltelli":
        return (
            "Kinds of failure, inundation and factors of safety are counted over the first simulation of each base "
            "point of the design: the others repeat a part of its numbers."
        )
    if sampling != "random":
        return (
            "Intervals of kinds of failure, inundation and factors of safety are those of independent simulations; "
            "evenly spread ones scatter less, as a rule."
        )
    if not numbers.choice:
        return ""
    shown = sum(numbers.statuses.values())
    return (
        f"From here on the page shows the first {shown} simulated slopes, a fair sample; the others were "
        f"{numbers.choice} and count in the answer alone."
    )


def mode_cards(numbers: Numbers, pictures: dict) -> list[dict]:
    """Kinds of failure that occurred: name, share with its interval, meaning, thumbnail of a typical member."""
    total = sum(mode.count for mode in numbers.modes)
    return [
        {
            "name": kinds.NAMES[mode.name],
            "meaning": kinds.MEANINGS[mode.name],
            "count": f"{mode.count} of {total}",
            "edge": f"{mode.at_edge} met an edge of the model and might have gone on" if mode.at_edge else "",
            "share": words.share(mode.value, mode.upper - mode.lower),
            "interval": _interval(mode, numbers) if numbers.is_random else "",
            "picture": pictures.get(mode.name),
        }
        for mode in numbers.modes
        if mode.count
    ]


def modes_not_found(numbers: Numbers) -> str:
    """Name the kinds of failure that did not occur; nothing where no realisation completed."""
    absent = [kinds.NAMES[mode.name].lower() for mode in numbers.modes if not mode.count]
    return f"Not found: {', '.join(absent)}." if 0 < len(absent) < len(numbers.modes) else ""


def _interval(mode: kinds.Mode, numbers: Numbers) -> str:
    width = mode.upper - mode.lower
    bounds = f"{words.share(mode.lower, width)} to {words.share(mode.upper, width)}"
    return f"{100.0 * numbers.answer.confidence:g} % interval {bounds}"


def reasons(numbers: Numbers) -> dict:
    """Status, reason, how many and the first indices, the most frequent first; and how many kinds are left out."""
    groups = Counter((status, reason) for _, status, reason in numbers.reasons)
    members: dict[tuple[str, str], list[str]] = {}
    for index, *kind in numbers.reasons:
        members.setdefault(tuple(kind), []).append(str(index))
    rows = []
    for (status, reason), count in groups.most_common(MOST_REASONS):
        indices = members[status, reason]
        shown = ", ".join(indices[:8]) + (" ..." if len(indices) > 8 else "")
        rows.append((NAMES.get(status, status), reason or "no reason recorded", count, shown))
    return {"rows": rows, "left_out": max(0, len(groups) - MOST_REASONS)}


def safety(numbers: Numbers) -> dict | None:
    """Failures beside factors of safety: a sentence and the table of both; None without factors."""
    found = numbers.safety
    if found is None:
        return None
    return {
        "below_one": _estimate(found.below_one),
        "failing": _estimate(found.failing),
        "rows": [
            ("factor of safety below 1", found.both, found.factor_alone),
            ("factor of safety 1 or more", found.simulation_alone, found.neither),
        ],
    }


def _estimate(estimate) -> str:
    return f"{words.share(estimate.value, estimate.upper - estimate.lower)} ({words.share_interval(estimate)})"


def quality(numbers: Numbers) -> list[tuple[str, str, str]]:
    """Shares of gravity's work: what, median and worst."""
    return [
        (QUALITY_NAMES[name], _percent(values["median"]), _percent(values["worst"]))
        for name, values in numbers.quality.items()
    ]


def _percent(value: float) -> str:
    return "unknown" if math.isnan(value) else f"{words.number(100.0 * value, 2)} %"


def costs(numbers: Numbers) -> list[tuple[str, str]]:
    """What the campaign took: label and amount."""
    labels = {
        "computing": "computing time of all simulations together",
        "coarser": "of it, on coarser cells",
        "per_realisation": "computing time of one realisation, mean",
        "elapsed": "from start to end of the campaign",
    }
    times = [(label, words.duration(numbers.cost[name])) for name, label in labels.items() if name in numbers.cost]
    label = f"electricity, assuming {WATTS_PER_CORE:g} W for a busy core with its share of memory and cooling"
    return [*times, (label, words.energy(numbers.cost["electricity_j"]))]
