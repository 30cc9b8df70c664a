"""What a random field of a study must satisfy together with its material, the geometry and the cells."""

from collections.abc import Callable, Iterator
from math import isclose, radians, tan

from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.schema import one_of

FRICTIONAL = ("mohr_coulomb", "drucker_prager")
LAWS_WITH = {
    "cohesion": ("von_mises", *FRICTIONAL),
    "residual_cohesion": ("von_mises", *FRICTIONAL),
    "friction_angle": FRICTIONAL,
}
MEAN_KEY = {
    "cohesion": "cohesion_kpa",
    "residual_cohesion": "residual_cohesion_kpa",
    "friction_angle": "friction_angle_deg",
}
LAYER_MEAN_KEY = {"cohesion": "mean_kpa", "residual_cohesion": "mean_kpa", "friction_angle": "mean_deg"}
SOFTENS_WITH = {"von_mises": "softening_modulus_kpa"} | dict.fromkeys(FRICTIONAL, "residual_plastic_strain")
SEPARABLE = ("markov_separable", "gaussian", "second_order_markov", "cosine_exponential")
FACTORISED = {"ar1": ("markov_separable",), "kronecker": SEPARABLE}  # methods along x and y, and their correlations
LARGEST_VARIATION_OF_FRICTION = 0.5  # of tan phi, for which 0.05 to 0.2 are reported
LARGEST_VARIATION = 2.0


def _field_has_its_material(known: Known) -> Iterator[Problem]:
    for variable in known["random_field"]:
        key = f"random_field.{variable}.material"
        asked = known[key]
        laws = {known[f"material.{i}.name"]: known[f"material.{i}.law"] for i in range(len(known["material"]))}
        if not laws:
            return
        if asked not in laws:
            yield problem(known, key, f"names no material; must be {one_of(list(laws), asked)}")
        elif laws[asked] not in LAWS_WITH[variable]:
            text = f'is a material with law = "{laws[asked]}", which has no {variable}'
            yield problem(known, key, text)


def _fields(known: Known) -> Iterator[tuple[str, str, str]]:
    """Variable, path of its field and path of its material, for the fields that have one."""
    for variable in known["random_field"]:
        for index in range(len(known["material"])):
            material = f"material.{index}"
            is_its_own = known[f"{material}.name"] == known[f"random_field.{variable}.material"]
            if is_its_own and known[f"{material}.law"] in LAWS_WITH[variable]:
                yield variable, f"random_field.{variable}", material


def _random_property_has_a_mean(known: Known) -> Iterator[Problem]:
    for variable, _, material in _fields(known):
        key = f"{material}.{MEAN_KEY[variable]}"
        if known[key] is None:
            text = f"missing; must be a number greater than 0, the mean of random_field.{variable}"
            yield Problem(path_of(key), text)
        elif known[key] == 0.0:
            yield problem(known, key, "must be greater than 0, the mean of its random field")


def _random_residual_is_reached(known: Known) -> Iterator[Problem]:
    for variable, field, material in _fields(known):
        key = f"{material}.{SOFTENS_WITH[known[f'{material}.law']]}"
        if variable == "residual_cohesion" and not known[key]:
            text = f"must be given and greater than 0 where there is a {field}, else no point comes to its residual"
            yield Problem(path_of(key), text)


def _friction_varies_little(known: Known) -> Iterator[Problem]:
    for variable, field, _ in _fields(known):
        layers = [f"{field}.layer.{number}" for number in range(len(known[f"{field}.layer"] or ()))]
        for key in (f"{place}.coefficient_of_variation" for place in (field, *layers)):
            if variable == "friction_angle" and (known[key] or 0.0) > LARGEST_VARIATION_OF_FRICTION:
                text = f"must be at most {LARGEST_VARIATION_OF_FRICTION:g}: it is that of tan(friction angle)"
                yield problem(known, key, text)


def _trend_keeps_the_field_positive(known: Known) -> Iterator[Problem]:
    """Mean and standard deviation are linear in depth: what holds at crest and base holds between them."""
    for variable, field, material in _fields(known):
        gain, spread = known[f"{field}.trend_kpa_per_m"], known[f"{field}.standard_deviation_trend_kpa_per_m"]
        given = [key for key in ("trend_kpa_per_m", "standard_deviation_trend_kpa_per_m") if known[f"{field}.{key}"]]
        if variable == "friction_angle":
            for key in given:
                yield problem(known, f"{field}.{key}", "must be left out: a friction angle has no trend in kPa")
            continue
        height, own = known["geometry.height_m"], known[f"{material}.{MEAN_KEY[variable]}"]
        for mean, variation in _moments_of_soils(known, field, own or 0.0):
            if mean == 0.0:
                continue  # another check's matter
            if mean + (gain or 0.0) * height <= 0.0:
                text = f"makes the mean {mean + gain * height:.4g} kPa at a depth of {height:g} m: must be above "
                yield problem(known, f"{field}.trend_kpa_per_m", f"{text}{-mean / height:.4g}")
            elif spread is not None:
                deviation, base = mean * variation + spread * height, mean + (gain or 0.0) * height
                key = f"{field}.standard_deviation_trend_kpa_per_m"
                if not 0.0 < deviation <= LARGEST_VARIATION * base:
                    least, most = -mean * variation / height, (LARGEST_VARIATION * base - mean * variation) / height
                    text = f"makes the standard deviation {deviation:.4g} kPa at a depth of {height:g} m, where the "
                    text += f"mean is {base:.4g} kPa: must be greater than {least:.4g} and at most {most:.4g}"
                    yield problem(known, key, text)


def _moments_of_soils(known: Known, field: str, mean: float) -> Iterator[tuple[float, float]]:
    """Mean [kPa] and coefficient of variation of the soil above all layers and of each layer, at the crest."""
    own = known[f"{field}.coefficient_of_variation"]
    yield mean, own
    for number in range(len(known[f"{field}.layer"] or ())):
        layer = f"{field}.layer.{number}"
        yield known[f"{layer}.mean_kpa"] or mean, known[f"{layer}.coefficient_of_variation"] or own


def _layers_cross_the_body(known: Known) -> Iterator[Problem]:
    for variable, field, _ in _fields(known):
        height = known["geometry.height_m"]
        if known["geometry.kind"] == "slope":
            crest = known["geometry.crest_m"]
            toe = crest + height / tan(radians(known["geometry.angle_deg"]))
        else:
            crest = toe = known["geometry.width_m"]
        for number in range(len(known[f"{field}.layer"] or ())):
            layer = f"{field}.layer.{number}"
            for key in {"mean_kpa", "mean_deg"} - {LAYER_MEAN_KEY[variable]}:
                if known[f"{layer}.{key}"] is not None:
                    text = f"must be left out: the mean of {variable} is {LAYER_MEAN_KEY[variable]}"
                    yield problem(known, f"{layer}.{key}", text)
            slope = tan(radians(known[f"{layer}.dip_deg"]))
            offsets = [y - slope * x for x, y in ((0.0, 0.0), (toe, 0.0), (crest, height), (0.0, height))]
            if not min(offsets) < known[f"{layer}.top_m"] < max(offsets):
                text = f"must be greater than {min(offsets):.4g} and less than {max(offsets):.4g}, to cross the body"
                yield problem(known, f"{layer}.top_m", text)


def _reference_divides_the_cells(known: Known) -> Iterator[Problem]:
    for _, field, _ in _fields(known):
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
    for _, field, _ in _fields(known):
        is_averaged = known[f"{field}.averaging"] == "volume"
        if is_averaged and known[f"{field}.data"]:
            text = 'must be "point" where there are data, which are values at points'
            yield problem(known, f"{field}.averaging", text)
        key = f"{field}.standard_deviation_trend_kpa_per_m"
        if known[key] is not None and (is_averaged or known[f"{field}.correlation_space"] == "physical"):
            text = 'must be left out where averaging = "volume" or correlation_space = "physical": these need one '
            yield problem(known, key, f"{text}coefficient of variation at all depths")


def _method_suits_the_correlation(known: Known) -> Iterator[Problem]:
    for _, field, _ in _fields(known):
        method, correlation = known[f"{field}.method"], known[f"{field}.correlation"]
        if method not in FACTORISED:
            continue
        layers = [f"{field}.layer.{number}" for number in range(len(known[f"{field}.layer"] or ()))]
        turned = [known[f"{field}.rotation_deg"]]
        for layer in layers:
            own = known[f"{layer}.rotation_deg"]
            turned.append(known[f"{layer}.dip_deg"] if own is None else own)
        is_mapped = known[f"{field}.averaging"] == "volume" or known[f"{field}.correlation_space"] == "physical"
        if correlation not in FACTORISED[method] or any(angle % 90.0 for angle in turned) or is_mapped:
            text = f"needs one of the correlations {', '.join(FACTORISED[method])}, of the standard-normal field, at "
            yield problem(known, f"{field}.method", f'{text}points, and no rotation or dip; "auto" suits all')


def _errors_have_data(known: Known) -> Iterator[Problem]:
    for _, field, _ in _fields(known):
        has_data = known[f"{field}.data"] or known[f"{field}.data_file"]
        if known[f"{field}.measurement_error"] is not None and not has_data:
            yield problem(
                known, f"{field}.measurement_error", "is that of data: give data or a data_file, or leave it out"
            )


FIELD_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _field_has_its_material,
    _random_property_has_a_mean,
    _random_residual_is_reached,
    _friction_varies_little,
    _trend_keeps_the_field_positive,
    _layers_cross_the_body,
    _reference_divides_the_cells,
    _keys_go_together,
    _method_suits_the_correlation,
    _errors_have_data,
]
