"""What a random field of a study must satisfy together with its material, the geometry and the cells."""

from collections.abc import Callable, Iterator
from math import isclose

from rfmpm.study.bodies import height_of
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.schema import one_of
from rfmpm.study.soils import (
    FRICTIONAL,
    LAWS_WITH,
    MEAN_KEY,
    fields_of,
    layers_of,
    material_above,
    materials_of,
    means_of_fields,
    paths_of_fields,
    soils_of,
)

SOFTENS_WITH = {"von_mises": "softening_modulus_kpa"} | dict.fromkeys(FRICTIONAL, "residual_plastic_strain")
SEPARABLE = ("markov_separable", "gaussian", "second_order_markov", "cosine_exponential")
FACTORISED = {"ar1": ("markov_separable",), "kronecker": SEPARABLE}  # methods along x and y, and their correlations
LARGEST_VARIATION_OF_FRICTION = 0.5  # of tan phi, for which 0.05 to 0.2 are reported
LARGEST_VARIATION = 2.0
OF_ONE_MATERIAL = {  # why a field of several materials cannot have them
    "layer": "give each material a field of its own",
    "data": "the data would be of which material? Give each a field of its own",
    "trend_kpa_per_m": "a gain in kPa is that of one mean",
    "standard_deviation_trend_kpa_per_m": "a gain in kPa is that of one mean",
}


def _field_has_its_material(known: Known) -> Iterator[Problem]:
    for variable, field in paths_of_fields(known):
        laws = {known[f"material.{i}.name"]: known[f"material.{i}.law"] for i in range(len(known["material"]))}
        if not laws:
            return
        if material := material_above(field):
            if (law := known[f"{material}.law"]) not in LAWS_WITH[variable]:
                yield Problem(path_of(field), f'is of a material with law = "{law}", which has no {variable}')
            continue
        others = range(len(known[f"{field}.shared_with"] or ()))
        for key in (f"{field}.material", *(f"{field}.shared_with.{number}" for number in others)):
            asked = known[key]
            if asked not in laws:
                yield problem(known, key, f"names no material; must be {one_of(list(laws), asked)}")
            elif laws[asked] not in LAWS_WITH[variable]:
                text = f'is a material with law = "{laws[asked]}", which has no {variable}'
                yield problem(known, key, text)


def _material_has_one_field_of_a_variable(known: Known) -> Iterator[Problem]:
    taken: dict[tuple[str, str], str] = {}
    for variable, field in paths_of_fields(known):
        for material in materials_of(known, field):
            other = taken.setdefault((variable, material), field)
            if other != field:
                text = f"is a second one: {other} is of {known[f'{material}.name']}, too; leave one out"
                yield Problem(path_of(field), text)
        if material_above(field):
            continue
        named = [known[f"{field}.material"]]
        for number, name in enumerate(known[f"{field}.shared_with"] or ()):
            if name in named:
                yield problem(known, f"{field}.shared_with.{number}", "is named twice; leave it out")
            named.append(name)


def _shared_field_suits_all_its_materials(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        if material_above(field) or not known[f"{field}.shared_with"]:
            continue
        for key, why in OF_ONE_MATERIAL.items():
            if known[f"{field}.{key}"]:
                yield Problem(path_of(f"{field}.{key}"), f"must be left out where there is shared_with: {why}")


def _random_property_has_a_mean(known: Known) -> Iterator[Problem]:
    for variable, field, material in means_of_fields(known):
        key = f"{material}.{MEAN_KEY[variable]}"
        if known[key] is None:
            text = f"missing; must be a number greater than 0, the mean of {field}"
            yield Problem(path_of(key), text)
        elif known[key] == 0.0:
            yield problem(known, key, "must be greater than 0, the mean of its random field")


def _random_residual_is_reached(known: Known) -> Iterator[Problem]:
    for variable, field, material in means_of_fields(known):
        key = f"{material}.{SOFTENS_WITH[known[f'{material}.law']]}"
        if variable == "residual_cohesion" and not known[key]:
            text = f"must be given and greater than 0 where there is a {field}, else no point comes to its residual"
            yield Problem(path_of(key), text)


def _friction_varies_little(known: Known) -> Iterator[Problem]:
    for variable, field, _ in fields_of(known):
        for key in (f"{place}.coefficient_of_variation" for place in (field, *layers_of(known, field))):
            if variable == "friction_angle" and (known[key] or 0.0) > LARGEST_VARIATION_OF_FRICTION:
                text = f"must be at most {LARGEST_VARIATION_OF_FRICTION:g}: it is that of tan(friction angle)"
                yield problem(known, key, text)


def _trend_keeps_the_field_positive(known: Known) -> Iterator[Problem]:
    """Mean and standard deviation are linear in depth: what holds at crest and base holds between them."""
    for variable, field, material in fields_of(known):
        given = [key for key in ("trend_kpa_per_m", "standard_deviation_trend_kpa_per_m") if known[f"{field}.{key}"]]
        if variable == "friction_angle":
            for key in given:
                yield problem(known, f"{field}.{key}", "must be left out: a friction angle has no trend in kPa")
            continue
        height = height_of(known)
        for soil in soils_of(known, variable, field, material):
            mean, base = soil.mean, soil.mean_at(height)
            if mean == 0.0:
                continue  # another check's matter
            if base <= 0.0:
                text = f"makes the mean {base:.4g} kPa at a depth of {height:g} m: must be above {-mean / height:.4g}"
                yield problem(known, f"{field}.trend_kpa_per_m", text)
            elif soil.deviation_gain is not None and not 0.0 < soil.variation_at(height) <= LARGEST_VARIATION:
                deviation = soil.variation_at(height) * base
                least = -mean * soil.variation / height
                most = (LARGEST_VARIATION * base - mean * soil.variation) / height
                text = f"makes the standard deviation {deviation:.4g} kPa at a depth of {height:g} m, where the "
                text += f"mean is {base:.4g} kPa: must be greater than {least:.4g} and at most {most:.4g}"
                yield problem(known, f"{field}.standard_deviation_trend_kpa_per_m", text)


def _reference_divides_the_cells(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        key, cell = f"{field}.reference_cell_m", known["discretisation.cell_m"]
        if known[key] is None:
            if known[f"{field}.reference_value"] is not None:
                yield problem(known, f"{field}.reference_value", "needs a reference_cell_m")
            continue
        ratio = cell / known[key]
        if round(ratio) < 1 or not isclose(ratio, round(ratio), rel_tol=1e-9):
            text = f"must be discretisation.cell_m = {cell:.10g} over a whole number, such as {cell / 2:.10g}"
            yield problem(known, key, text)


def _keys_go_together(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        is_averaged = known[f"{field}.averaging"] == "volume"
        if is_averaged and known[f"{field}.data"]:
            text = 'must be "point" where there are data, which are values at points'
            yield problem(known, f"{field}.averaging", text)
        key = f"{field}.standard_deviation_trend_kpa_per_m"
        if known[key] is not None and (is_averaged or known[f"{field}.correlation_space"] == "physical"):
            text = 'must be left out where averaging = "volume" or correlation_space = "physical": these need one '
            yield problem(known, key, f"{text}coefficient of variation at all depths")


def _method_suits_the_correlation(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        method, correlation = known[f"{field}.method"], known[f"{field}.correlation"]
        if method not in FACTORISED:
            continue
        turned = [known[f"{field}.rotation_deg"]]
        for layer in layers_of(known, field):
            own = known[f"{layer}.rotation_deg"]
            turned.append(known[f"{layer}.dip_deg"] if own is None else own)
        is_mapped = known[f"{field}.averaging"] == "volume" or known[f"{field}.correlation_space"] == "physical"
        if correlation not in FACTORISED[method] or any(angle % 90.0 for angle in turned) or is_mapped:
            text = f"needs one of the correlations {', '.join(FACTORISED[method])}, of the standard-normal field, at "
            yield problem(known, f"{field}.method", f'{text}points, and no rotation or dip; "auto" suits all')


def _errors_have_data(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        has_data = known[f"{field}.data"] or known[f"{field}.data_file"]
        if known[f"{field}.measurement_error"] is not None and not has_data:
            yield problem(
                known, f"{field}.measurement_error", "is that of data: give data or a data_file, or leave it out"
            )


FIELD_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _field_has_its_material,
    _material_has_one_field_of_a_variable,
    _shared_field_suits_all_its_materials,
    _random_property_has_a_mean,
    _random_residual_is_reached,
    _friction_varies_little,
    _trend_keeps_the_field_positive,
    _reference_divides_the_cells,
    _keys_go_together,
    _method_suits_the_correlation,
    _errors_have_data,
]
