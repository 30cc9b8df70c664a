"""What the numbers say to a designer, each sentence made of them."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rfmpm.benchmark.variability.contrasts import (
    Contrast,
    against,
    against_uniform,
    effects,
    mean_of,
    probability_beyond,
)
from rfmpm.benchmark.variability.summary import each_cell, outcomes
from rfmpm.estimators import Estimate, exceedance

if TYPE_CHECKING:
    import xarray as xr

WORDS = {"coefficient_of_variation": "variation", "vertical_scale": "vertical scale [m]", "scale_ratio": "ratio"}
SETTLED = 5  # slopes of the rarer kind from which the interval of a mean or a standard deviation is trusted


def findings(found: "xr.Dataset", limit: float) -> Iterator[str]:
    """Say what the study means, one finding after the other.

    Args:
        found: dataset of the study.
        limit: the l in P(run-out > l) [m]; one of the thresholds.

    Yields:
        Sentences in Markdown.
    """
    yield _uniform(found)
    yield _on_average(found, limit)
    yield _mean(found)
    yield _two_kinds(found)
    yield _spread(found)
    yield _characteristic(found)
    yield _cautious(found)
    yield _anisotropy(found, limit)
    yield _vertical_scale(found, limit)
    yield _undecided(found, limit)


def span(values: Sequence[float], unit: str = "", places: int = 1, signed: bool = False) -> str:
    """Write the range of some numbers, e.g. "1.2 to 3.4 m"; one number where they are the same as written."""
    form = f"{{:{'+' if signed else ''}.{places}f}}"
    low, high = form.format(min(values)), form.format(max(values))
    return f"{low if low == high else f'{low} to {high}'}{unit and ' '}{unit}"


def verdict(contrasts: Sequence[Contrast], more: str = "larger", less: str = "smaller") -> str:
    """Count the differences that are secure in either direction."""
    up = sum(each.is_secure and each.estimate.value > 0.0 for each in contrasts)
    down = sum(each.is_secure and each.estimate.value < 0.0 for each in contrasts)
    total = len(contrasts)
    if up + down == 0:
        return f"none of {total} secure"
    counts = [f"{count} securely {word}" for count, word in ((up, more), (down, less)) if count]
    return f"of {total}, {', '.join(counts)}, {total - up - down} undecided"


def crest_lost(cell: "xr.Dataset") -> Estimate:
    """Probability that the failure takes the whole crest, up to the boundary behind it."""
    values, censored = outcomes(cell, "retrogression_distance")
    return exceedance(values, np.inf, censored)


def standing(cell: "xr.Dataset") -> int:
    """Number of realisations in which nothing moves beyond the toe."""
    return int(np.sum(cell["run_out"].values == 0.0))


def _values(found: "xr.Dataset", name: str, **chosen: float) -> list[float]:
    return found[name].sel(chosen).values.ravel().tolist()


def _uniform(found: "xr.Dataset") -> str:
    one = found.sel(strength="mean").isel(coefficient_of_variation=0)
    return (
        f"**Mean strength everywhere.** The uniform slope of {float(one['uniform_cohesion']):g} kPa runs out "
        f"{float(one['run_out_uniform']):.1f} m; {float(one['failure_volume_uniform']):.0f} m³/m fail, back to "
        f"{float(one['retrogression_distance_uniform']):.1f} m behind the crest."
    )


def _on_average(found: "xr.Dataset", limit: float) -> str:
    columns = effects(found, limit)
    parts = [f"in {title}, {_secure(contrasts)}" for title, contrasts in columns.items()]
    return (
        "**On average over the other two dimensions.** Against the smallest variation, the smallest vertical scale and "
        f"a ratio of {float(found['scale_ratio'][0]):g}, these differences are secure (each with its interval in the "
        f"table below): {'; '.join(parts)}."
    )


def _secure(contrasts: Sequence[Contrast]) -> str:
    """Name the dimensions with secure differences, and the range of these."""
    secure: dict[str, list[float]] = {}
    for each in contrasts:
        (name,) = each.here
        if each.is_secure:
            secure.setdefault(WORDS[name].removesuffix(" [m]"), []).append(each.estimate.value)
    return ", ".join(f"{word} {span(values, places=2, signed=True)}" for word, values in secure.items()) or "none"


def _mean(found: "xr.Dataset") -> str:
    contrasts = against_uniform(found, "run_out")
    differences = [each.estimate.value for each in contrasts]
    low, high = (contrasts[int(pick(differences))] for pick in (np.argmin, np.argmax))
    return (
        f"**Mean run-out.** Against that slope, variability changes the mean run-out by {low.estimate.value:+.1f} m "
        f"({_named(low.here)}) to {high.estimate.value:+.1f} m ({_named(high.here)}): "
        f"{verdict(contrasts, 'longer', 'shorter')}. "
        "Among the combinations themselves, each against the smallest variation at the same scales: "
        f"{verdict(_over_variation(found), 'longer', 'shorter')}."
    )


def _over_variation(found: "xr.Dataset") -> list[Contrast]:
    smallest = float(found["coefficient_of_variation"][0])
    return against(found, "coefficient_of_variation", smallest, mean_of("run_out"))


def _named(place: dict[str, float]) -> str:
    return (
        f"variation {place['coefficient_of_variation']:g}, vertical scale {place['vertical_scale']:g} m, "
        f"ratio {place['scale_ratio']:g}"
    )


def _two_kinds(found: "xr.Dataset") -> str:
    parts = []
    for variation in found["coefficient_of_variation"].values:
        cells = list(each_cell(found.sel(coefficient_of_variation=[variation])))
        stand = [100.0 * standing(cell) / cell.sizes["realisation"] for cell in cells]
        moved = [values[values > 0.0] for values in (outcomes(cell, "run_out")[0] for cell in cells)]
        runs = [values.mean() for values in moved if values.size]
        others = f"the others run {span(runs, 'm')} on average" if runs else "no other is left"
        parts.append(f"{variation:g}: {span(stand, '%', 0)} stand, {others}")
    return (
        "**Two effects that oppose each other.** Slopes that stand shorten the mean, long run-outs of the others "
        f"lengthen it. At a variation of {'; at '.join(parts)}."
    )


def _spread(found: "xr.Dataset") -> str:
    variations = found["coefficient_of_variation"].values
    name = "run_out_standard_deviation"
    low, high = found.sel(coefficient_of_variation=variations[0]), found.sel(coefficient_of_variation=variations[-1])
    apart = int((high[f"{name}_lower"] > low[f"{name}_upper"]).sum())
    parts = [
        f"{span(_values(found, name, coefficient_of_variation=v), 'm')} at a variation of {v:g}" for v in variations
    ]
    return (
        f"**Spread.** The standard deviation of the run-out is {', '.join(parts)}. Between the smallest and the "
        f"largest variation the 95 % intervals are apart for {apart} of the {high[name].size} pairs of scales."
    )


def _characteristic(found: "xr.Dataset") -> str:
    uniform = found["run_out_uniform"].sel(strength="mean")
    above = (found["run_out_characteristic"] - uniform).to_dataset(name="above")
    secure = int((found["run_out_characteristic_lower"] > uniform).sum())
    parts = [
        f"{span(_values(above, 'above', coefficient_of_variation=v), 'm', signed=True)} at a variation of {v:g}"
        for v in above["coefficient_of_variation"].values
    ]
    return (
        "**Characteristic run-out.** The distance that one slope in twenty exceeds lies beyond the run-out of the "
        f"uniform slope by {', '.join(parts)}; in {secure} of {above.above.size} combinations its whole interval does. "
        "A calculation with the mean strength gives no upper estimate of the run-out."
        if secure
        else "**Characteristic run-out.** At this size the study does not tell the distance that one slope in twenty "
        "exceeds from the run-out of the uniform slope."
    )


def _cautious(found: "xr.Dataset") -> str:
    cautious = found["run_out_uniform"].sel(strength="cautious")
    strengths = found["uniform_cohesion"].sel(strength="cautious").values
    above = cautious - found["run_out_characteristic"]
    further = int((found["run_out"] > cautious).sum())
    is_known = np.isfinite(found["run_out_characteristic_upper"])
    safe = int(((cautious > found["run_out_characteristic_upper"]) & is_known).sum())
    beyond = (
        f"and beyond the upper end of its 95 % interval in {safe} of {above.size} combinations{_unbounded(is_known)}"
        if is_known.any()
        else f"whose 95 % interval has no upper end with {found.sizes['realisation']} realisations"
    )
    return (
        "**A cautious strength everywhere.** With the strength that 5 % of the soil falls below "
        f"({_listed(strengths)} kPa at a variation of {_listed(found['coefficient_of_variation'].values, '{:g}')}) the "
        f"uniform slope runs {_listed(cautious.values)} m. That is {span(above.values.ravel(), 'm', signed=True)} "
        f"against the characteristic run-out, {beyond}; {further or 'none'} of the {found['run_out'].size} "
        f"realisations {'run' if further > 1 else 'runs'} further."
    )


def _listed(values: Sequence[float], form: str = "{:.1f}") -> str:
    return ", ".join(form.format(value) for value in values)


def _unbounded(is_known: "xr.DataArray") -> str:
    missing = int((~is_known).sum())
    return f" ({missing} have no upper end: too few realisations for one)" if missing else ""


def _anisotropy(found: "xr.Dataset", limit: float) -> str:
    isotropic = float(found["scale_ratio"][0])
    run_out, volume = (against(found, "scale_ratio", isotropic, mean_of(q)) for q in ("run_out", "failure_volume"))
    fails = against(found, "scale_ratio", isotropic, probability_beyond("run_out", limit))
    spread = found["run_out_standard_deviation"]
    ratio = (spread / spread.sel(scale_ratio=isotropic)).drop_sel(scale_ratio=isotropic)
    quantile = found["run_out_characteristic"]
    longer = (quantile - quantile.sel(scale_ratio=isotropic)).drop_sel(scale_ratio=isotropic)
    return (
        "**Ignoring anisotropy.** Against a field whose horizontal scale is the vertical one, long horizontal scales "
        f"change the mean run-out by {span(_estimates(run_out), 'm', signed=True)} ({verdict(run_out)}), "
        f"P(run-out > {limit:g} m) by {span(_estimates(fails), places=2, signed=True)} ({verdict(fails)}) and the mean "
        f"volume by {span(_estimates(volume), 'm³/m', signed=True)} ({verdict(volume)}). The standard deviation of the "
        f"run-out is {span(ratio.values.ravel(), places=1)} times that of the isotropic field "
        f"({_apart(found, 'run_out_standard_deviation', isotropic)}); the characteristic run-out differs by "
        f"{span(longer.values.ravel(), 'm', signed=True)} ({_apart(found, 'run_out_characteristic', isotropic)})."
    )


def _apart(found: "xr.Dataset", name: str, isotropic: float) -> str:
    """For how many combinations the interval of a statistic is beyond that of the isotropic field."""
    others, there = found.drop_sel(scale_ratio=isotropic), found.sel(scale_ratio=isotropic)
    larger = int((others[f"{name}_lower"] > there[f"{name}_upper"]).sum())
    smaller = int((others[f"{name}_upper"] < there[f"{name}_lower"]).sum())
    if larger + smaller == 0:
        return f"intervals apart in none of {others[name].size}"
    return f"intervals apart in {larger + smaller} of {others[name].size}, {larger} of them larger"


def _estimates(contrasts: Sequence[Contrast]) -> list[float]:
    return [each.estimate.value for each in contrasts]


def _vertical_scale(found: "xr.Dataset", limit: float) -> str:
    shortest = float(found["vertical_scale"][0])
    run_out = against(found, "vertical_scale", shortest, mean_of("run_out"))
    fails = against(found, "vertical_scale", shortest, probability_beyond("run_out", limit))
    return (
        f"**Vertical scale.** At the same ratio, so with both scales growing, vertical scales above {shortest:g} m "
        f"change the mean run-out by {span(_estimates(run_out), 'm', signed=True)} ({verdict(run_out)}) and "
        f"P(run-out > {limit:g} m) by {span(_estimates(fails), places=2, signed=True)} ({verdict(fails)})."
    )


def _undecided(found: "xr.Dataset", limit: float) -> str:
    part = found.sel(run_out_threshold=limit)
    half = 0.5 * (found["run_out_mean_upper"] - found["run_out_mean_lower"])
    width = 0.5 * (part["run_out_exceedance_upper"] - part["run_out_exceedance_lower"])
    cells, n = list(each_cell(found)), found.sizes["realisation"]
    few = sum(0 < min(standing(cell), n - standing(cell)) < SETTLED for cell in cells)
    none = sum(standing(cell) in (0, n) for cell in cells)
    return (
        f"**What this size leaves open.** Half an interval of the mean run-out is {span(half.values.ravel(), 'm', 2)}, "
        f"of P(run-out > {limit:g} m) up to {float(width.max()):.2f}: smaller effects are not seen. Where fewer than "
        f"{SETTLED} slopes stand (or fail), in {few} combinations, mean and standard deviation hang on these few; "
        f"where none does, in {none}, an interval of mean or standard deviation knows nothing of the rare ones. "
        f"Probabilities much below 1/{n} are beyond this study. The error of the cells is in no interval "
        "([slope_error.md](slope_error.md))."
    )
