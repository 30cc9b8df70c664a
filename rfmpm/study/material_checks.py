"""What the keys of a material with friction must satisfy together."""

from collections.abc import Callable, Iterator
from math import cos, radians, sin, sqrt

from rfmpm.study.bodies import height_of
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem

FRICTIONAL = ("mohr_coulomb", "drucker_prager")
SOFTENING = ("cohesion_kpa", "friction_angle_deg", "dilation_angle_deg")


def _frictional(known: Known) -> Iterator[str]:
    """Paths of the materials with friction."""
    for index in range(len(known["material"])):
        if known[f"material.{index}.law"] in FRICTIONAL:
            yield f"material.{index}"


def _residual(known: Known, material: str, key: str) -> float:
    residual = known[f"{material}.residual_{key}"]
    return known[f"{material}.{key}"] if residual is None else residual


def _residuals_are_below_the_peaks(known: Known) -> Iterator[Problem]:
    for material in _frictional(known):
        for key in SOFTENING:
            peak = known[f"{material}.{key}"]
            if _residual(known, material, key) > peak:
                yield problem(known, f"{material}.residual_{key}", f"must be at most the peak, {key} = {peak:.10g}")


def _dilation_is_below_friction(known: Known) -> Iterator[Problem]:
    for material in _frictional(known):
        dilation, friction = known[f"{material}.dilation_angle_deg"], known[f"{material}.friction_angle_deg"]
        if dilation > friction:
            text = f"must be at most friction_angle_deg = {friction:.10g}, else shearing would create energy"
            yield problem(known, f"{material}.dilation_angle_deg", text)
            continue
        least = _residual(known, material, "friction_angle_deg")
        if _residual(known, material, "dilation_angle_deg") > least:
            text = f"must be at most the residual angle of friction, {least:.10g}"
            if known[f"{material}.residual_dilation_angle_deg"] is not None:
                yield problem(known, f"{material}.residual_dilation_angle_deg", text)
            else:
                text += ", or have a residual_dilation_angle_deg that is"
                yield problem(known, f"{material}.dilation_angle_deg", text)


def _there_is_some_strength(known: Known) -> Iterator[Problem]:
    for material in _frictional(known):
        if known[f"{material}.cohesion_kpa"] == 0.0 and known[f"{material}.friction_angle_deg"] == 0.0:
            text = "must be greater than 0 where friction_angle_deg = 0, else the soil is a liquid"
            yield problem(known, f"{material}.cohesion_kpa", text)


def _softening_says_how_fast(known: Known) -> Iterator[Problem]:
    for material in _frictional(known):
        falls = [key for key in SOFTENING if _residual(known, material, key) < known[f"{material}.{key}"]]
        if falls and known[f"{material}.residual_plastic_strain"] is None:
            text = f"missing; must be a number greater than 0 where residual_{falls[0]} is less than {falls[0]}"
            yield Problem(path_of(f"{material}.residual_plastic_strain"), text)


def _softening_does_not_snap_back(known: Known) -> Iterator[Problem]:
    """Under the weight of the body's height the strength must fall less steeply than the shear stress unloads.

    Per unit plastic strain, sqrt(2/3 e:e), half the difference of the outer principal stresses unloads by sqrt(3) G.
    """
    height = height_of(known)
    for material in _frictional(known):
        strain = known[f"{material}.residual_plastic_strain"]
        if strain is None:
            continue
        shear_modulus = known[f"{material}.youngs_modulus_kpa"] / (2 * (1 + known[f"{material}.poissons_ratio"]))
        pressure = known[f"{material}.unit_weight_kn_m3"] * height
        friction = radians(known[f"{material}.friction_angle_deg"])
        residual_friction = radians(_residual(known, material, "friction_angle_deg"))
        loss = known[f"{material}.cohesion_kpa"] * cos(friction) + pressure * sin(friction)
        loss -= _residual(known, material, "cohesion_kpa") * cos(residual_friction) + pressure * sin(residual_friction)
        scale = 1.0
        if reference := known[f"{material}.softening_reference_cell_m"]:
            scale = known["discretisation.cell_m"] / reference
        least = scale * loss / (sqrt(3) * shear_modulus)
        if strain <= least:
            text = (
                f"must be greater than {least:.6g} with these cells, this stiffness and this height, "
                "else the stress falls faster than the material can unload"
            )
            yield problem(known, f"{material}.residual_plastic_strain", text)


def _factor_of_safety_needs_strength(known: Known) -> Iterator[Problem]:
    """Of every material; for strength reduction, which moves the whole body, that of one of them is enough."""
    method = known["quantities.factor_of_safety"]
    if not method:
        return
    laws = [known[f"material.{index}.law"] for index in range(len(known["material"]))]
    if method == "strength_reduction" and set(laws) != {"elastic"}:
        return
    for index, law in enumerate(laws):
        if law == "elastic":
            text = f'needs strength, which material.{index} with law = "elastic" has none of: leave it out'
            yield problem(known, "quantities.factor_of_safety", text)


def _k0_is_given_where_it_counts(known: Known) -> Iterator[Problem]:
    if known["time.k0"] is not None and known["time.initial_stress"] != "k0":
        yield problem(known, "time.k0", 'needs initial_stress = "k0": leave it out')


MATERIAL_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _residuals_are_below_the_peaks,
    _dilation_is_below_friction,
    _there_is_some_strength,
    _softening_says_how_fast,
    _softening_does_not_snap_back,
    _factor_of_safety_needs_strength,
    _k0_is_given_where_it_counts,
]
