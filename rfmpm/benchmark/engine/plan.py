"""What is run: scene by scene, which schemes on which cells."""

from collections.abc import Iterator

from rfmpm.benchmark.convergence import extrapolate
from rfmpm.benchmark.engine import bar, column, slopes, vortex
from rfmpm.benchmark.engine.runs import Measurement
from rfmpm.benchmark.engine.schemes import Scheme, defaults, engine_schemes, orders, transfers

REPEATS = 1
QUICK = [Scheme("quadratic_bspline"), Scheme("quadratic_bspline", engine="fast")]


def _more_points() -> list[Scheme]:
    return [scheme for count in (9, 16) for scheme in defaults(points_per_cell=count)]


def column_runs(quick: bool) -> Iterator[Measurement]:
    """Measure the column."""
    if quick:
        yield from (column.measure(scheme, cells, 1) for scheme in QUICK for cells in (5, 10))
        return
    for scheme in [*transfers(), *orders(), *_more_points(), *engine_schemes()]:
        for cells in (10, 40):
            yield column.measure(scheme, cells, REPEATS)
    for scheme in engine_schemes():
        yield column.measure(scheme, 80, REPEATS)


def bar_runs(quick: bool) -> Iterator[Measurement]:
    """Measure the bar."""
    if quick:
        yield from (bar.measure(scheme, cells, 1, periods=3) for scheme in QUICK for cells in (4, 8))
        return
    for scheme in [*transfers(), *orders(), *_more_points(), *engine_schemes()]:
        for cells in (8, 16):
            yield bar.measure(scheme, cells, REPEATS)
    for scheme in engine_schemes():
        yield bar.measure(scheme, 32, REPEATS)


def vortex_runs(quick: bool) -> Iterator[Measurement]:
    """Measure the vortex; the production engine knows no body force."""
    if quick:
        plain = [scheme for scheme in QUICK if scheme.engine == "plain"]
        yield from (vortex.measure(scheme, 13, 1, end=0.05) for scheme in plain)
        return
    for scheme in [*transfers(), *orders()]:
        for cells in (26, 52):
            yield vortex.measure(scheme, cells, REPEATS)
    yield vortex.measure(Scheme("quadratic_bspline"), 104, REPEATS)


def slope_runs(quick: bool) -> tuple[list[Measurement], str]:
    """Measure the short slope. Returns the measurements and how the run-out behaves, in words."""
    study, judge = slopes.slope_study(), Scheme("quadratic_bspline", engine="fast")
    if quick:
        study = study.with_changes({"time.end_s": 0.5, "quantities.displacement_threshold_m": 0.01})
        schemes, cells, finest = QUICK, (0.5,), (0.5, 0.25, 0.125)
    else:
        schemes, cells, finest = [*transfers(), *orders(), *engine_schemes()], (0.5,), (0.5, 0.25, 0.125)
    measured = [slopes.measure_slope(study, scheme, cell, REPEATS) for scheme in schemes for cell in cells]
    finer = [slopes.measure_slope(study, judge, cell, 1) for cell in finest if cell not in cells]
    if not quick:
        others = [scheme for scheme in engine_schemes() if scheme != judge]
        measured += [slopes.measure_slope(study, scheme, 0.25, 1) for scheme in others]
    ladder = {one.cell: value for one, value in [*measured, *finer] if one.scheme == judge}
    limit = extrapolate([ladder[cell] for cell in sorted(ladder, reverse=True)])
    values = ", ".join(f"{value:.3f} m on {cell:g} m" for cell, value in sorted(ladder.items(), reverse=True))
    words = (
        f"Run-out of the production engine ({judge.label}): {values}; extrapolated {limit.value:.3f} m, uncertain by "
        f"{limit.band:.3f} m. Errors below that uncertainty say nothing."
    )
    return slopes.with_errors([*measured, *finer], limit.value), words


def bars_runs(quick: bool) -> Iterator[Measurement]:
    """Measure the aluminium bars on the production engine, and with the other transfers on the plain solver."""
    study = slopes.bars_study()
    if quick:
        yield slopes.measure_bars(study.with_changes({"time.end_s": 0.02}), QUICK[-1], 0.02, 1)
        return
    plain = [scheme for scheme in transfers() if scheme.shape == "quadratic_bspline"]
    for scheme in [*engine_schemes(), *plain]:
        for cell in (0.02, 0.01):
            yield slopes.measure_bars(study, scheme, cell, 1)
