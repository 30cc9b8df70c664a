"""The report of scheduling: scheduling.md and its picture."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import ensemble
from rfmpm.benchmark.scheduling import overhead, prediction
from rfmpm.benchmark.scheduling.picture import draw
from rfmpm.benchmark.scheduling.replay import ideal, replay
from rfmpm.benchmark.scheduling.stopping import biases
from rfmpm.benchmark.scheduling.text import TEXT
from rfmpm.study import Study, load_study

CONFIGS = Path(__file__).parents[3] / "configs"
WORKERS, RANKS = 4, (64, 256, 1000, 4000)
MEANS = (0.1, 0.5, 2.0, 10.0, 60.0)  # of a realisation [s]
CLAIMS = 5000
PER_RANK = (10, 20, 50, 100)  # realisations
NOTICE = 0.003  # how long after its answer has come a rank looks, on average [s]
STOPPED = {"ranks": 64, "wanted": 200}


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Measure scheduling and write the report.

    Args:
        folder: where scheduling.md and its picture go; made if missing.
        quick: short sleeps, few claims and few campaigns: a look at the machinery.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    predictions = _told(_predictions(quick), tell)
    losses = _told(_losses(quick), tell)
    service = overhead.service_seconds(200 if quick else CLAIMS)
    tell(f"a claim in line takes rank 0 {1e3 * service:.3f} ms")
    seconds, fails = _measured_times(quick)
    tell(f"{len(seconds)} realisations measured")
    efficiencies = {mean: _efficiencies(seconds * mean / seconds.mean(), service, quick) for mean in MEANS}
    stopped = _biases(seconds, fails, quick)
    draw(efficiencies, RANKS, stopped, folder / "scheduling.png")
    path = folder / "scheduling.md"
    path.write_text(
        TEXT.format(
            predictions="\n".join(predictions),
            losses="\n".join(losses),
            load=os.getloadavg()[0],
            service=1e3 * service,
            most=1.0 / service,
            last=STOPPED["wanted"] - 1,
            measured=len(seconds),
            mean=seconds.mean(),
            variation=seconds.std() / seconds.mean(),
            longest=seconds.max() / seconds.mean(),
            tails="\n".join(_tails(seconds, service)),
            breaks="\n".join(_breaks(efficiencies)),
            biases="\n".join(_bias_rows(stopped)),
            failing=100 * fails.mean(),
            campaigns=_campaigns(quick),
            **STOPPED,
        ),
        encoding="utf-8",
    )
    return path


def _told(lines, tell: Callable[[str], None]) -> list[str]:
    found = []
    for line in lines:
        tell(line)
        found.append(line)
    return found


def _cell(cell: float | None, file: str, realisations: int) -> Study:
    changes: dict[str, Any] = {"study.realisations": realisations}
    return load_study(CONFIGS / file).with_changes(changes | ({} if cell is None else {"discretisation.cell_m": cell}))


def _predictions(quick: bool):
    cases = {
        "short slope, cells 0.5 m": (0.5, "short_slope_random.toml"),
        "drained slope, cells 0.5 m": (None, "drained_cross_correlated.toml"),
        "short slope, cells 0.25 m": (0.25, "short_slope_random.toml"),
        "short slope, cells 0.125 m": (0.125, "short_slope_random.toml"),
    }
    yield from prediction.HEAD.splitlines()
    for name, (cell, file) in list(cases.items())[: 1 if quick else None]:
        yield prediction.row(name, prediction.compare(_cell(cell, file, 4 if quick else 16)))


def _losses(quick: bool):
    rng = np.random.default_rng(20161)
    few = 0.1 if quick else 1.0
    times = {
        "1 s each": few * np.ones(16 if quick else 120),
        "0.2 to 2 s, evenly in the logarithm": few * 0.2 * 10.0 ** rng.uniform(0.0, 1.0, 16 if quick else 200),
    }
    yield (
        "| realisations | crew | median gap [ms] | lost between realisations | ideal [s] | in order, nothing lost [s] "
        "| mean late start [s] | took [s] | over ideal + late start | load |"
    )
    yield "|---" * 10 + "|"
    for name, seconds in times.items():
        for crew in overhead.CREWS:
            loss = overhead.measure(seconds, WORKERS, crew)
            yield (
                f"| {len(seconds)}, {name} | {WORKERS} {crew} | {1e3 * loss.between:.1f} | {100 * loss.lost:.2f} % "
                f"| {loss.ideal:.2f} | {loss.greedy:.2f} | {loss.late:.2f} | {loss.span:.2f} "
                f"| {100 * loss.over_ideal:+.2f} % | {os.getloadavg()[0]:.1f} |"
            )


def _measured_times(quick: bool) -> tuple[np.ndarray, np.ndarray]:
    """Times of a real campaign, without what other programs took of the processors, and who ran beyond the limit."""
    study = _cell(0.5, "short_slope_random.toml", 10 if quick else 200)
    with tempfile.TemporaryDirectory() as scratch:
        rows = ensemble.run(study, Path(scratch) / "campaign", progress=False)
    steps = rows["step_count"].values.astype(float)
    return steps * np.median(rows["wall_time"].values / steps), rows[
        "run_out"
    ].values > study.quantities.run_out_limit_m


def _efficiencies(seconds: np.ndarray, service: float, quick: bool) -> list[float]:
    rng = np.random.default_rng(20162)
    per_rank = 10 if quick else 50
    return [replay(rng.choice(seconds, per_rank * ranks), ranks, service, NOTICE).efficiency for ranks in RANKS]


def _tails(seconds: np.ndarray, service: float):
    rng = np.random.default_rng(20163)
    yield "| realisations on 1000 ranks | nothing but realisations takes time | with the desk | lost to the desk |"
    yield "|---|---|---|---|"
    scaled = seconds * 10.0 / seconds.mean()
    for per_rank in PER_RANK:
        drawn = rng.choice(scaled, 1000 * per_rank)
        free, served = (ideal(drawn, 1000) / replay(drawn, 1000, *costs).makespan for costs in ((), (service, NOTICE)))
        yield f"| {1000 * per_rank:,} | {100 * free:.1f} % | {100 * served:.1f} % | {100 * (1 - served / free):.2f} % |"


def _breaks(efficiencies: dict[float, list[float]]):
    yield "| mean realisation [s] | " + " | ".join(f"{ranks} ranks" for ranks in RANKS) + " |"
    yield "|---" * (len(RANKS) + 1) + "|"
    for mean, found in efficiencies.items():
        yield f"| {mean:g} | " + " | ".join(f"{100 * value:.1f} %" for value in found) + " |"


def _campaigns(quick: bool) -> int:
    return 20 if quick else 2000


def _biases(seconds: np.ndarray, fails: np.ndarray, quick: bool) -> dict[str, dict]:
    rng, slow = np.random.default_rng(20164), np.arange(1000) < 200
    cases = {
        "one in five fails and takes three times as long": (slow, np.where(slow, 3.0, 1.0)),
        "times and outcomes as measured": (fails, seconds),
    }
    return {name: biases(rng, *case, **STOPPED, campaigns=_campaigns(quick)) for name, case in cases.items()}


def _bias_rows(stopped: dict[str, dict]):
    yield "| case | estimate from | bias | standard error |"
    yield "|---|---|---|---|"
    for case, found in stopped.items():
        for name, bias in found.items():
            yield f"| {case} | {name} | {bias.value:+.4f} | {bias.error:.4f} |"
