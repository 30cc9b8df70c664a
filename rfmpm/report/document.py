"""The report of a campaign: one page that needs nothing but itself, and the same numbers as JSON."""

import json
import math
from collections import Counter
from pathlib import Path

from rfmpm.report import snapshots, words
from rfmpm.report.numbers import Numbers, analyse, as_json, usable
from rfmpm.report.question import NAMES, answer, question, reservations

MOST_REASONS = 20  # rows of the table of failures; report.json has all
QUALITY_NAMES = {
    "plastic_work_share": "work of plastic flow",
    "friction_work_share": "work of friction on base and sides",
    "numerical_dissipation_share": "energy dissipated by the method itself",
    "energy_balance_error": "energy not accounted for",
}


def write(directory: Path | str, out: Path | str | None = None, simulate: snapshots.Simulate | None = None) -> Path:
    """Write the report of a campaign.

    Args:
        directory: of the campaign; holds ensemble.nc and study.toml, and keeps the pictured states under snapshots/.
        out: the page; report.html in the directory if None. The numbers go beside it, with the ending json.
        simulate: function of the index -> x, y, plastic_strain and run_out of that realisation; None simulates it.

    Returns:
        Path of the page.

    Raises:
        FileNotFoundError: if the directory holds no campaign.
        StudyError: if its study.toml is not valid.
    """
    from rfmpm.results import open_ensemble
    from rfmpm.study import load_study

    directory = Path(directory)
    dataset = open_ensemble(directory)
    study_file = directory / "study.toml"
    study = load_study(study_file)
    numbers = analyse(dataset, study)
    simulate = simulate or snapshots.simulator(study)
    states = snapshots.take(numbers.pictured, directory / "snapshots", study.physics_hash, simulate)
    page = Path(out) if out is not None else directory / "report.html"
    html = _page(dataset, study, numbers, states, study_file.read_text(encoding="utf-8"))
    snapshots.write_atomically(page, html.encode("utf-8"))
    numbers_text = json.dumps(_record(dataset, study, numbers, states), indent=1, allow_nan=False)
    snapshots.write_atomically(page.with_suffix(".json"), numbers_text.encode("utf-8"))
    return page


def _page(dataset, study, numbers: Numbers, states: list[snapshots.Snapshot], study_text: str) -> str:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    from rfmpm.mpm.scene import outline
    from rfmpm.report.probability_figures import charts, unvarying
    from rfmpm.report.slope_figures import slope_pictures

    rows = usable(dataset)
    environment = Environment(loader=PackageLoader("rfmpm", "report"), autoescape=True, undefined=StrictUndefined)
    return environment.get_template("report.html").render(
        title=study.study.name,
        question=question(study),
        answer=answer(numbers),
        reservations=reservations(numbers, study),
        cards=_cards(numbers),
        charts=charts(rows, numbers),
        unvarying=unvarying(rows),
        slopes=slope_pictures(states, outline(study)) if states else [],
        statuses=[(NAMES.get(name, name), count) for name, count in numbers.statuses.items()],
        reasons=_reasons(numbers),
        quality=_quality(numbers),
        cost=_cost(numbers),
        study_text=study_text,
        versions=_versions(dataset),
    )


def _cards(numbers: Numbers) -> list[tuple[str, str, str]]:
    """Label, number and remark of the tiles at the top."""
    mean, probability = numbers.mean_run_out, numbers.exceedance
    failed = numbers.used - numbers.completed
    return [
        (
            f"P(run-out > {numbers.limit:g} m)",
            words.share(probability.value),
            words.share_interval(probability),
        ),
        ("mean run-out", words.with_unit(mean.value, "m"), words.interval(mean, "m")),
        ("did not complete", f"{failed} of {numbers.used}", words.count(numbers.used, "realisation")),
        (
            "computing time",
            words.duration(numbers.cost["computing"]),
            f"{words.duration(numbers.cost['per_realisation'])} per realisation",
        ),
    ]


def _reasons(numbers: Numbers) -> dict:
    """Status, reason, how many and the first indices, the most frequent first; and how many kinds are left out."""
    groups = Counter((status, reason) for _, status, reason in numbers.reasons)
    rows = []
    for (status, reason), count in groups.most_common(MOST_REASONS):
        indices = [str(index) for index, *kind in numbers.reasons if tuple(kind) == (status, reason)]
        shown = ", ".join(indices[:8]) + (" ..." if len(indices) > 8 else "")
        rows.append((NAMES.get(status, status), reason or "no reason recorded", count, shown))
    return {"rows": rows, "left_out": max(0, len(groups) - MOST_REASONS)}


def _quality(numbers: Numbers) -> list[tuple[str, str, str]]:
    return [
        (QUALITY_NAMES[name], _percent(values["median"]), _percent(values["worst"]))
        for name, values in numbers.quality.items()
    ]


def _percent(value: float) -> str:
    return "unknown" if math.isnan(value) else f"{words.number(100.0 * value, 2)} %"


def _cost(numbers: Numbers) -> list[tuple[str, str]]:
    labels = {
        "computing": "computing time of all realisations together",
        "per_realisation": "computing time of one realisation, mean",
        "elapsed": "from start to end of the campaign",
    }
    return [(label, words.duration(numbers.cost[name])) for name, label in labels.items() if name in numbers.cost]


def _versions(dataset) -> list[tuple[str, str]]:
    """The global attributes that say where the result comes from, but for the study text, which has its own place."""
    return [(name.replace("_", " "), str(value)) for name, value in dataset.attrs.items() if name != "study"]


def _record(dataset, study, numbers: Numbers, states: list[snapshots.Snapshot]) -> dict:
    pictured = [
        {"which": s.name, "realisation": s.index, "run_out_recorded": s.recorded, "run_out_repeated": s.found}
        for s in states
    ]
    record = {"study": study.study.name, **as_json(numbers), "pictured": as_json(pictured)}
    record["reasons"] = [
        {"realisation": index, "status": status, "reason": reason} for index, status, reason in numbers.reasons
    ]
    return record | {"provenance": {name: as_json(value) for name, value in dataset.attrs.items()}}
