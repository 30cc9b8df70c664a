"""`rfmpm status`: how far a campaign is, from any machine that sees its folder; reads only."""

from collections.abc import Iterator, Mapping
from datetime import timedelta
from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.endings import WRONG_STUDY, end

SHOWN = 20  # workers listed one by one


def status(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a campaign.")],
    as_json: Annotated[bool, typer.Option("--json", help="As JSON, for programs.")] = False,
) -> None:
    """Say how far a campaign is: done, running, failed, rate, time left, the estimate so far."""
    from rfmpm import campaign_status

    try:
        found = campaign_status.read(directory)
    except FileNotFoundError:
        end(f"{directory}: no {campaign_status.STATUS_FILE} here; is it the folder of a campaign?", WRONG_STUDY)
    except ValueError as error:
        end(str(error), WRONG_STUDY)
    if "question" not in found:
        found["estimate"] = campaign_status.estimate_so_far(directory, found["first"], found["total"])
    if as_json:
        import json

        typer.echo(json.dumps(found, indent=2))
        return
    for line in _lines(directory, found):
        typer.echo(line)


def _lines(directory: Path, found: Mapping[str, Any]) -> Iterator[str]:
    workers = f"{found['workers']} worker{'s' if found['workers'] != 1 else ''}, rank 0 on {found['host']}"
    if not found["workers"]:
        workers = f"put together from parts on {found['host']}"
    yield f"{directory}: {found['state']} ({workers}, started {found['started']})"
    if found["doubt"]:
        yield f"doubt    {found['doubt']}"
    if found["reason"]:
        yield f"reason   {found['reason']}"
    question = found.get("question")
    if question:
        yield f"question {question}"
    expected = f", about {found['expected']:,} in all" if found.get("expected") else ""
    yield f"done     {found['done']} of {found['total']} realisations{' planned so far' if question else ''}{expected}"
    failed = found["failed"]
    yield f"failed   {', '.join(f'{count} {name}' for name, count in failed.items()) or 0}"
    if found["state"] == "running":
        left = found["seconds_left"]
        time_left = "time left unknown" if left is None else f"{timedelta(seconds=round(left))} left"
        time_left += " of this round" if question else ""
        yield f"rate     {found['rate_per_minute']:.3g} per minute, {time_left}"
        for worker in found["running"][:SHOWN]:
            where = f"rank {worker['rank']} on {worker['host']}"
            level = f" on level {worker['level']}" if "level" in worker else ""
            yield f"running  {worker['realisation']}{level} for {timedelta(seconds=round(worker['seconds']))}, {where}"
        if len(found["running"]) > SHOWN:
            yield f"running  and {len(found['running']) - SHOWN} more"
    yield f"estimate {_answer(found['estimate']) if question else _estimate(found['estimate'])}"


def _answer(found: Mapping[str, Any] | None) -> str:
    if found is None:
        return "none yet: the first round is not finished"
    value = "unknown" if found["value"] is None else f"{found['value']:.4g}"
    ends = ["unbounded" if found[end] is None else f"{found[end]:.4g}" for end in ("lower", "upper")]
    interval = f"{100.0 * found['confidence']:.0f} % interval {ends[0]} to {ends[1]}"
    return f"{value}, {interval}, from rounds that are finished: {found['n']} realisations on the study's own cells"


def _estimate(found: Mapping[str, Any] | None) -> str:
    if found is None:
        return "none yet: no finished realisations on disk without a gap"
    interval = f"{100.0 * found['confidence']:.0f} % interval {found['lower']:.3g} to {found['upper']:.3g}"
    basis = f"the first {found['n']} realisations, finished without a gap"
    value = "unknown" if found["value"] is None else f"= {found['value']:.3g}"
    return f"P(run-out > {found['limit_m']:g} m) {value}, {interval}, from {basis}"
