"""Stratified sampling on the short slope against the reference: runs and error of a small probability."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from rfmpm import ensemble, planning, realisation, seeds
from rfmpm.benchmark.probabilities.bank import SCRATCH
from rfmpm.benchmark.probabilities.rare import Found, Small
from rfmpm.estimators import Rows, Stratified
from rfmpm.planning.components import directions_of
from rfmpm.study import Study

FILE = "probabilities_rare_rows.nc"  # beside the report: run-out of every realisation of every campaign
AT_MOST = 1100  # a tenth of what plain Monte Carlo takes for a relative error of 0.3
SEEDS = (1, 2, 3, 4, 5, 6, 8)


def asking(study: Study, limit: float, seed: int) -> Study:
    """The study that asks for the small probability."""
    until = {"quantity": "run_out", "exceeds_m": limit, "at_most": AT_MOST}
    table = {"study": {"name": "small probability", "seed": seed, "until": until}}
    return study.with_changes(table | {"estimator": {"method": "stratified"}})


def campaigns(
    study: Study, limit: float, chosen: Sequence[int], folder: Path, tell: Callable[[str], None]
) -> Iterator[Found]:
    """Run a campaign for each seed, or take it from the rows that are kept.

    Args:
        study: on the coarse cells.
        limit: that run-out is to exceed [m].
        chosen: seeds of the campaigns.
        folder: that holds FILE, or gets it.
        tell: is told each answer.

    Yields:
        What each found.
    """
    kept = _kept(folder / FILE)
    asked = {seed: asking(study, limit, seed) for seed in chosen}
    missing = [seed for seed in chosen if asked[seed].physics_hash not in kept]
    for seed in missing:
        rows = ensemble.run(asked[seed], SCRATCH / f"stratified_{seed}", progress=False)
        kept[asked[seed].physics_hash] = rows["run_out"].values.astype(float)
    if missing:
        _write(folder / FILE, {one.physics_hash: kept[one.physics_hash] for one in asked.values()})
    prepared = realisation.prepare(asked[chosen[0]])
    directions = directions_of(asked[chosen[0]], prepared)
    for seed, one in asked.items():
        own = replace(directions, seed=seed)
        found = _answer(one, own, kept[one.physics_hash])
        tell(f"P(run-out > {limit:g} m), stratified, seed {seed}: {found.value:.2e} with {found.runs} runs")
        yield found


def _answer(study: Study, directions, run_out: np.ndarray) -> Found:
    def features(span: range) -> np.ndarray:
        plain = (seeds.standard_normal(directions.seed, 0, index, directions.n_variables) for index in span)
        return np.array([directions.scores(xi) for xi in plain])

    n = len(run_out)
    rows = Rows(np.zeros(n, int), np.arange(n), run_out, np.zeros(n, bool), np.ones(n))
    found = Stratified(planning.question_of(study), features, study.estimator.pilot_size).estimate(rows)
    return Found(found.value, found.lower, found.upper, n)


def _kept(path: Path) -> dict[str, np.ndarray]:
    """Run-out of the campaigns that are kept, by the hash of their physics."""
    import xarray as xr

    if not path.is_file():
        return {}
    with xr.open_dataset(path) as stored:
        return dict(zip(stored["physics_hash"].values.tolist(), stored["run_out"].values, strict=True))


def _write(path: Path, kept: dict[str, np.ndarray]) -> None:
    import xarray as xr

    dataset = xr.Dataset(
        {
            "run_out": (("campaign", "realisation"), np.array(list(kept.values())), {"units": "m"}),
            "physics_hash": ("campaign", list(kept)),
        },
        attrs={"title": "rows of the small probability in rfmpm benchmark probabilities"},
    )
    dataset.to_netcdf(path, encoding={"run_out": {"zlib": True, "shuffle": True}})


def lines(found: list[Found], chosen: Sequence[int], small: Small) -> Iterator[str]:
    """The rows of the table of the report, and what they come to.

    Args:
        found: by the campaigns.
        chosen: their seeds.
        small: the reference.
    """
    yield "| seed | probability | 95 % interval | realisations |"
    yield "|---|---|---|---|"
    for seed, one in zip(chosen, found, strict=True):
        yield f"| {seed} | {one.value:.2e} | {one.lower:.2e} to {one.upper:.2e} | {one.runs} |"
    values = np.array([one.value for one in found])
    error = np.sqrt(np.mean((values / small.probability - 1.0) ** 2))
    scatter = values.std(ddof=1) / values.mean() if len(values) > 1 else float("nan")
    own = 1.0 / np.sqrt(small.count)
    holds = sum(one.lower <= small.probability <= one.upper for one in found)
    yield ""
    yield (
        f"Mean {values.mean():.2e}, relative scatter about it {scatter:.0%}. Relative root-mean-square error against "
        f"the reference {error:.0%}, with what the reference itself errs in it, {own:.0%}; {holds} of {len(found)} "
        "intervals hold the reference's value."
    )
