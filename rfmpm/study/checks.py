"""What several keys of a study must satisfy together."""

from collections import Counter
from collections.abc import Callable, Iterator
from math import sqrt

from rfmpm.study.attachment_checks import ATTACHMENT_CHECKS
from rfmpm.study.bodies import is_plain_body
from rfmpm.study.correlation_checks import CORRELATION_CHECKS
from rfmpm.study.data_checks import DATA_CHECKS
from rfmpm.study.distribution_checks import DISTRIBUTION_CHECKS
from rfmpm.study.errors import Problem
from rfmpm.study.field_checks import FIELD_CHECKS
from rfmpm.study.known import Known, Unknown, problem
from rfmpm.study.layer_checks import LAYER_CHECKS
from rfmpm.study.material_checks import MATERIAL_CHECKS
from rfmpm.study.question_checks import QUESTION_CHECKS, level_problems
from rfmpm.study.region_checks import REGION_CHECKS
from rfmpm.study.size_checks import SIZE_CHECKS
from rfmpm.study.uncertain_checks import UNCERTAIN_CHECKS, problems_at_the_ends

Check = Callable[[Known], Iterator[Problem]]

LARGEST_CELL_OVER_LENGTH = 1.0  # of a softening length; the transfer itself averages over 0.7 cells


def joint_problems(known: Known) -> list[Problem]:
    """Everything that is wrong between keys, as far as their values are known."""
    found = _problems(known, [*CHECKS, *QUESTION_CHECKS])
    return found or [*problems_at_the_ends(known, _problems), *level_problems(known, _problems)]


def _problems(known: Known, checks: list[Check] | None = None) -> list[Problem]:
    found = []
    for check in checks or CHECKS:
        problems = check(known)
        while True:
            try:
                found.append(next(problems))
            except (StopIteration, Unknown):
                break
    return found


def _residual_is_below_the_peak(known: Known) -> Iterator[Problem]:
    for index in range(len(known["material"])):
        if known[f"material.{index}.law"] == "von_mises":
            residual, peak = known[f"material.{index}.residual_cohesion_kpa"], known[f"material.{index}.cohesion_kpa"]
            if residual is not None and residual > peak:
                text = f"must be at most the peak, cohesion_kpa = {peak:.10g}"
                yield problem(known, f"material.{index}.residual_cohesion_kpa", text)


def _softening_does_not_snap_back(known: Known) -> Iterator[Problem]:
    """On the uniaxial path of the shear stress invariant the softening line must be less steep than the elastic one."""
    for index in range(len(known["material"])):
        material = f"material.{index}"
        if known[f"{material}.law"] != "von_mises" or known[f"{material}.softening_length_m"]:
            continue
        shear_modulus = known[f"{material}.youngs_modulus_kpa"] / (2 * (1 + known[f"{material}.poissons_ratio"]))
        scale = 1 / sqrt(3)
        if reference := known[f"{material}.softening_reference_cell_m"]:
            scale *= known["discretisation.cell_m"] / reference
        if known[f"{material}.strength_convention"] == "sqrt_3j2":
            scale /= sqrt(3)
        if scale * known[f"{material}.softening_modulus_kpa"] >= shear_modulus:
            text = (
                f"must be less than {shear_modulus / scale:.6g} with these cells and this stiffness, "
                "else the stress falls faster than the material can unload"
            )
            yield problem(known, f"{material}.softening_modulus_kpa", text)


def _softening_has_one_length(known: Known) -> Iterator[Problem]:
    """A scaled modulus and a softening length exclude each other; the cells must resolve the length."""
    for index in range(len(known["material"])):
        material = f"material.{index}"
        if known[f"{material}.law"] != "von_mises" or not (length := known[f"{material}.softening_length_m"]):
            continue
        if known[f"{material}.softening_reference_cell_m"]:
            text = "cannot be given together with softening_length_m: the modulus is then the soil's own, not scaled"
            yield problem(known, f"{material}.softening_reference_cell_m", text)
        if known["discretisation.cell_m"] > LARGEST_CELL_OVER_LENGTH * length * (1 + 1e-9):
            text = (
                f"must be at least {known['discretisation.cell_m'] / LARGEST_CELL_OVER_LENGTH:.4g} m with these cells, "
                "or take smaller cells: an average over less than a cell depends on the cell"
            )
            yield problem(known, f"{material}.softening_length_m", text)


def _there_is_a_material(known: Known) -> Iterator[Problem]:
    count = len(known["material"])
    if not count:
        yield problem(known, "material", "must be one or more tables, written [[material]]; there are none")
    elif count > 1 and is_plain_body(known):
        text = f"must be exactly one table, written [[material]]; there are {count}, but no regions or layers of them"
        yield problem(known, "material", text)


def _softening_lengths_are_equal(known: Known) -> Iterator[Problem]:
    """One average, over all points that soften by it, serves a scene."""
    lengths = {}
    for index in range(len(known["material"])):
        key = f"material.{index}.softening_length_m"
        if known[f"material.{index}.law"] == "von_mises" and known[key] is not None:
            lengths[key] = known[key]
    for key, length in lengths.items():
        first, expected = next(iter(lengths.items()))
        if length != expected:
            yield problem(
                known, key, f"must be that of {first}, {expected:g}, or left out: a scene has one such length"
            )


def _names_are_unique(known: Known) -> Iterator[Problem]:
    names = [known[f"material.{index}.name"] for index in range(len(known["material"]))]
    for name, count in Counter(names).items():
        if count > 1:
            last = len(names) - 1 - names[::-1].index(name)
            yield problem(known, f"material.{last}.name", f"is the name of {count} materials; names must differ")


def _histories_have_names_of_their_own(known: Known) -> Iterator[Problem]:
    names = [known[f"history.{index}.name"] for index in range(len(known["history"] or ()))]
    for index, name in enumerate(names):
        if name in names[:index]:
            yield problem(known, f"history.{index}.name", "is the name of another history too; names must differ")


CHECKS: list[Check] = [
    _histories_have_names_of_their_own,
    *REGION_CHECKS,
    *ATTACHMENT_CHECKS,
    *SIZE_CHECKS,
    _residual_is_below_the_peak,
    _softening_does_not_snap_back,
    _softening_has_one_length,
    _there_is_a_material,
    _softening_lengths_are_equal,
    _names_are_unique,
    *DATA_CHECKS,
    *DISTRIBUTION_CHECKS,
    *MATERIAL_CHECKS,
    *FIELD_CHECKS,
    *LAYER_CHECKS,
    *CORRELATION_CHECKS,
    *UNCERTAIN_CHECKS,
]
