"""The report of a campaign: one page that needs nothing but itself, and the same numbers as JSON."""

import json
from dataclasses import replace
from pathlib import Path

from rfmpm import planning
from rfmpm.report import answer, sections, snapshots, words
from rfmpm.report.answering import Answers
from rfmpm.report.costs import WATTS_PER_CORE
from rfmpm.report.driving import Drivers, drivers
from rfmpm.report.members import usable
from rfmpm.report.numbers import CONFIDENCE, Numbers, analyse, as_json
from rfmpm.report.question import NAMES, background, setting


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
    replay = None if simulate else _replay(dataset, study)
    driven = drivers(dataset, study, Answers(dataset, study, CONFIDENCE), replay)
    simulate = simulate or snapshots.simulator(replay)
    states = snapshots.take(_to_picture(numbers), directory / "snapshots", study.physics_hash, simulate)
    page = Path(out) if out is not None else directory / "report.html"
    html = _page(dataset, study, numbers, states, driven, study_file.read_text(encoding="utf-8"))
    snapshots.write_atomically(page, html.encode("utf-8"))
    numbers_text = json.dumps(_record(dataset, study, numbers, states, driven), indent=1, allow_nan=False)
    snapshots.write_atomically(page.with_suffix(".json"), numbers_text.encode("utf-8"))
    return page


def _to_picture(numbers: Numbers) -> list[tuple[str, int, float]]:
    """The realisations at ranks of run-out, then those typical of a kind of failure; one that serves twice is once."""
    known = {index for _, index, _ in numbers.pictured}
    typical = [(m.name, m.typical, m.run_out) for m in numbers.modes if m.typical is not None]
    return [*numbers.pictured, *(member for member in typical if member[1] not in known)]


def _replay(dataset, study) -> planning.Replay:
    """Makes realisations again; nothing is prepared before the first one."""
    return planning.Replay(study, planning.rows_of(study, dataset) if planning.approaches_limit(study) else None)


def _page(dataset, study, numbers: Numbers, states: list[snapshots.Snapshot], driven: Drivers, study_text: str) -> str:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    from rfmpm.report.histograms import unvarying
    from rfmpm.report.probability_figures import charts

    rows = usable(dataset, study)
    slopes, thumbnails = _pictures(study, numbers, states)
    environment = Environment(loader=PackageLoader("rfmpm", "report"), autoescape=True, undefined=StrictUndefined)
    environment.filters["kept"] = words.kept_together
    return environment.get_template("report.html").render(
        title=study.study.name,
        seed=study.study.seed,
        question=numbers.asked.sentence,
        setting=setting(study),
        headline=answer.headline(numbers),
        certainty=answer.certainty(numbers, study),
        parts=sections.error_parts(numbers, study) if numbers.completed else [],
        basis=answer.basis(numbers, study),
        warnings=answer.warnings(numbers, study),
        next_steps=numbers.next_steps,
        background=background(study),
        details=answer.details(numbers),
        precision=sections.precision(numbers),
        charts=charts(rows, numbers),
        unvarying=unvarying(rows),
        sample=sections.sample(numbers, study),
        modes=sections.mode_cards(numbers, thumbnails),
        modes_not_found=sections.modes_not_found(numbers),
        slopes=slopes,
        drivers=driven,
        safety=sections.safety(numbers),
        statuses=[(NAMES.get(name, name), count) for name, count in numbers.statuses.items()],
        reasons=sections.reasons(numbers),
        quality=sections.quality(numbers),
        cost=sections.costs(numbers),
        study_text=study_text,
        versions=_versions(dataset),
    )


def _pictures(study, numbers: Numbers, states: list[snapshots.Snapshot]):
    """Large pictures of the realisations at ranks of run-out, and a thumbnail by kind of failure."""
    from rfmpm.mpm.scene import outline
    from rfmpm.report.slope_figures import slope_pictures

    if not states:
        return [], {}
    by_index = {state.index: state for state in states}
    typical = [replace(by_index[m.typical], name=m.name) for m in numbers.modes if m.typical is not None]
    large, small = slope_pictures(states[: len(numbers.pictured)], typical, outline(study))
    return large, {picture.title: picture for picture in small}


def _versions(dataset) -> list[tuple[str, str]]:
    """The global attributes that say where the result comes from, but for the study text, which has its own place."""
    return [(name.replace("_", " "), str(value)) for name, value in dataset.attrs.items() if name != "study"]


def _record(dataset, study, numbers: Numbers, states: list[snapshots.Snapshot], driven: Drivers) -> dict:
    record = {
        "study": study.study.name,
        "question": numbers.asked.sentence,
        "headline": answer.headline(numbers),
        "warnings": answer.warnings(numbers, study),
        **as_json(numbers),
    }
    record["pictured"] = as_json(
        [
            {"which": s.name, "realisation": s.index, "run_out_recorded": s.recorded, "run_out_repeated": s.found}
            for s in states
        ]
    )
    record["reasons"] = [
        {"realisation": index, "status": status, "reason": reason} for index, status, reason in numbers.reasons
    ]
    record["sensitivity"] = as_json(driven.numbers)
    record["watts_per_core_assumed"] = WATTS_PER_CORE
    return record | {"provenance": {name: as_json(value) for name, value in dataset.attrs.items()}}
