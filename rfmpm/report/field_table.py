"""A random field in words: how it is made, its sample statistics beside the asked ones, and its data."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

NAMES = {
    "mean": "mean",
    "standard_deviation": "standard deviation",
    "correlation_h": "correlation along h",
    "correlation_v": "correlation along v",
    "covariance_h": "conditional cov. along h",
    "covariance_v": "conditional cov. along v",
    "cross_correlation": "correlation at a point",
    "cross_covariance": "conditional cov. at a point",
}
VALUES = ("mean", "standard_deviation")
SEEN = 0.1  # standard errors; what is less does not show in a table


def property_lines(field, entry, look, soils: Sequence, count: int) -> list[str]:
    """Tables of every soil of a random field.

    Args:
        field: an entry of the study's `fields`.
        entry: the prepared property.
        look: names and units of the property.
        soils: its soils, compared.
        count: number of realisations behind the statistics.
    """
    lines = []
    for soil in soils:
        lines += [
            f"{look.field}{_where(field, soil.part.soil)}: {method_line(soil.part.field)}",
            *_notes(field.settings, entry, soil),
            *_table(entry, look, soil, count),
            *data_lines(soil, count),
        ]
    return lines


def soil_name(soil: int) -> str:
    """What a soil is called: layers have the numbers of the study's list, from 0."""
    return f"layer {soil - 1}" if soil else "soil above the layers"


def _where(field, soil: int) -> str:
    if not field.settings.layer:
        return ""
    path = field.path + (f".layer.{soil - 1}" if soil else "")
    return f", {soil_name(soil)} ({path})"


def _notes(settings, entry, soil) -> list[str]:
    """What the statistics leave out."""
    notes = {
        "those of the crest: a trend changes what the values stand for, not how they vary": (
            soil.part.field is not soil.part.at_crest
        ),
        "those of the field after it is mixed with the earlier one": len(soil.shares) > 1,
        "those of the reference points; what the material points take of them is last": bool(soil.of_means),
        "those of the first material; in the others all is in proportion to the mean": entry.ratio is not None,
        "those of the standard-normal field, whose correlation makes that of the values as asked": (
            settings.correlation_space == "physical"
        ),
    }
    return [f"the statistics are {note}" for note, applies in notes.items() if applies]


def method_line(field) -> str:
    """How the field is made, and what is known of its error before any sampling."""
    averaged = f"; averages over volumes keep {field.variance_factor:.3f} of the variance"
    made = f"method {field.method}, {field.n_variables} variables; largest error of its covariance"
    return f"{made} {_known_error(field):.1e}{averaged if field.variance_factor < 1.0 else ''}"


def _known_error(field) -> float:
    from rfmpm.random_fields.methods import covariance_error

    return covariance_error(field.method, field.record)


def _table(entry, look, soil, count: int) -> list[str]:
    points = f"{len(soil.part.points)} {'material' if entry.taken is None else 'reference'} points"
    lines = [
        f"{count} realisations on {points}; correlations of the standard-normal field below the marginal",
        _header(),
        *(_row(record, look) for record in soil.statistics),
    ]
    if soil.of_means:
        lines.append(f"the means over {entry.taken.shape[1]} reference points that material points take")
        lines += [_row(record, look) for record in soil.of_means]
    return lines + _misfit_of_method(soil)


def _misfit_of_method(soil) -> list[str]:
    """What the method is known to miss is no error of sampling, and no fault either."""
    field = soil.part.field
    known = _known_error(field)
    errors = [record.standard_error for record in soil.statistics if record.name not in VALUES]
    if not errors or known < SEEN * min(errors):
        return []
    return [
        f"method {field.method} is approximate: the error of its covariance, known without sampling, is part of the "
        f"misfit; it is up to {known:.1e}, or {known / min(errors):.2g} of these standard errors"
    ]


def _header() -> str:
    return f"{'':<26}{'lag [m]':>7}{'asked':>10}{'found':>10}{'std. error':>12}{'in std. errors':>18}"


def _row(record, look) -> str:
    is_of_values = record.name in VALUES
    unit = look.per_field_unit if is_of_values else 1.0
    name = NAMES[record.name] + (f" [{look.unit}]" if is_of_values else "")
    lag = f"{record.lag:.2f}" if record.lag else ""
    asked, found, error = (value / unit for value in (record.asked, record.found, record.standard_error))
    if asked != asked:
        return f"{name:<26}{lag:>7}{'unknown':>10}{found:>10.4f}{error:>12.4f}{'':>18}"
    ratio = (found - asked) / error if error > 0.0 else float("nan")
    return f"{name:<26}{lag:>7}{asked:>10.4f}{found:>10.4f}{error:>12.4f}{ratio:>18.1f}"


def cross_lines(cross: Iterable, looks: Mapping) -> list[str]:
    """Correlation between properties, asked and found.

    Args:
        cross: pairs of properties, compared.
        looks: names and units of the properties.
    """
    lines = []
    for between, record in cross:
        first, second = (looks[name].field for name in between)
        lines += [f"{first} with {second}: their standard-normal fields", _header(), _row(record, None)]
    return lines


def data_lines(soil, count: int) -> list[str]:
    """Say how the data of a soil are honoured; nothing for a soil without data.

    Args:
        soil: the soil, compared.
        count: number of realisations.
    """
    conditioning = soil.part.field.conditioning
    if conditioning is None:
        return []
    exact = conditioning.data.error_variances == 0.0
    on_points = conditioning.on_points >= 0
    lines = [
        f"conditioned on {len(exact)} data, {exact.sum()} of them exact, {on_points.sum()} on points; "
        "asked: the conditional distribution, averaged over the points",
        f"largest error of the conditional covariance beyond that of the method {conditioning.covariance_error:.1e}",
        f"data up to {np.abs(conditioning.data.values).max():.2f} standard deviations from the median of the field",
    ]
    if soil.misfit == soil.misfit:
        lines.append(f"largest relative misfit at exact data on points {soil.misfit:.1e}, over {count} realisations")
    return lines
