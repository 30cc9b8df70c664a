"""What a question, its estimator and the rest of a study must satisfy together."""

from collections.abc import Callable, Iterator
from copy import deepcopy
from math import isclose

from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.question_models import DEFAULTS, FIRST_OF_TWO_PHASES, READERS, TOWARDS_LIMIT, reads
from rfmpm.study.soils import has_fields

UNTIL, OWN = "study.until", "estimator"
UNIT = {"failure_volume": "m3_per_m", "initial_failure_volume": "m3_per_m"}  # of all others: m
WIDTHS = ("half_width", "half_width_m", "half_width_m3_per_m", "relative_half_width")
FIXED = "must be left out together with study.until, which says when to end"
FEWEST_REPLICATES = 8  # Student's factor is then 2.36; with 4 it is 3.18
FEWEST_SUBSETS = 2  # independent subset simulations: their scatter shows what the chains of one do not
WITH_QUESTION = ("multilevel", "control_variate", "two_phase", *TOWARDS_LIMIT)


def _has_question(known: Known) -> bool:
    return known[UNTIL] is not None


def _asks_for_a_probability(known: Known) -> bool:
    return any(known[f"{UNTIL}.exceeds_{unit}"] is not None for unit in ("m", "m3_per_m"))


def _estimator(known: Known) -> tuple[str, str] | None:
    """Method and sampling; None where there is no table."""
    return None if known[OWN] is None else (known[f"{OWN}.method"], known[f"{OWN}.sampling"])


def _number_is_fixed_or_open(known: Known) -> Iterator[Problem]:
    if _has_question(known) and known["study.realisations"] is not None:
        yield problem(known, "study.realisations", FIXED)


def _question_is_one(known: Known) -> Iterator[Problem]:
    if not _has_question(known):
        return
    unit = UNIT.get(known[f"{UNTIL}.quantity"], "m")
    other = "m" if unit == "m3_per_m" else "m3_per_m"
    for key in (f"exceeds_{other}", f"half_width_{other}"):
        if known[f"{UNTIL}.{key}"] is not None:
            instead = key.replace(other, unit)
            text = f"does not fit {known[f'{UNTIL}.quantity']}, which is in {unit}: write {instead}"
            yield problem(known, f"{UNTIL}.{key}", text)
    is_probability = known[f"{UNTIL}.exceeds_{unit}"] is not None
    if is_probability and known[f"{UNTIL}.quantile"] is not None:
        yield problem(known, f"{UNTIL}.quantile", f"cannot be asked together with exceeds_{unit}: ask one question")
    if is_probability and known[f"{UNTIL}.half_width_{unit}"] is not None:
        text = "is of a distance or volume; of a probability, write half_width"
        yield problem(known, f"{UNTIL}.half_width_{unit}", text)
    if not is_probability and known[f"{UNTIL}.half_width"] is not None:
        text = f"is of a probability, asked by exceeds_{unit}; of a mean or a quantile, write half_width_{unit}"
        yield problem(known, f"{UNTIL}.half_width", text)


def _question_has_an_end(known: Known) -> Iterator[Problem]:
    if not _has_question(known):
        return
    given = [key for key in WIDTHS if known[f"{UNTIL}.{key}"] is not None]
    for key in given[1:]:
        yield problem(known, f"{UNTIL}.{key}", f"cannot be given together with {given[0]}: say one width")
    if not given and known[f"{UNTIL}.at_most"] is None:
        yield problem(known, UNTIL, f"never ends: give one of {', '.join(WIDTHS)}, or at_most")
    if given == ["relative_half_width"] and known[f"{UNTIL}.at_most"] is None:
        text = "needs at_most too: an estimate of 0 has no relative width"
        yield problem(known, f"{UNTIL}.relative_half_width", text)


def _keys_are_read(known: Known) -> Iterator[Problem]:
    if (chosen := _estimator(known)) is None:
        return
    for key, readers in READERS.items():
        if known[f"{OWN}.{key}"] is not None and not reads(key, *chosen):
            yield problem(known, f"{OWN}.{key}", f"is read by {', '.join(readers)} alone: leave it out")


def _method_has_what_it_needs(known: Known) -> Iterator[Problem]:
    if (chosen := _estimator(known)) is None:
        return
    method, sampling = chosen
    if method != "monte_carlo" and sampling != "random":
        yield problem(known, f"{OWN}.sampling", f'must be "random" where method = "{method}"')
    if method in WITH_QUESTION and not _has_question(known):
        yield problem(known, f"{OWN}.method", "needs a question: give study.until instead of study.realisations")
    has_coarser = bool(known[f"{OWN}.coarser_cells_m"])
    if method == "multilevel" and not has_coarser:
        yield problem(known, f"{OWN}.method", "needs coarser_cells_m, such as twice the cells of the study")
    if method == "control_variate" and not has_coarser and known[f"{OWN}.principal_components"] is None:
        yield problem(known, f"{OWN}.method", "needs coarser_cells_m or principal_components, or both")
    if method in TOWARDS_LIMIT and _has_question(known) and not _asks_for_a_probability(known):
        text = "finds a probability of exceeding: ask for exceeds_m or exceeds_m3_per_m in study.until"
        yield problem(known, f"{OWN}.method", text)
    if sampling == "saltelli" and not known["uncertain"]:
        yield problem(known, f"{OWN}.sampling", "finds what uncertain numbers matter: add [[uncertain]]")
    elif (method, sampling) != ("monte_carlo", "random") and not (has_fields(known) or known["uncertain"]):
        key = "method" if method != "monte_carlo" else "sampling"
        text = "has no use where nothing is random: add a random_field or [[uncertain]]"
        yield problem(known, f"{OWN}.{key}", text)


def _design_is_whole(known: Known) -> Iterator[Problem]:
    chosen = _estimator(known)
    if chosen is None or chosen[1] == "random" or chosen[0] != "monte_carlo":  # others have no design
        return
    size = known[f"{OWN}.replicate_size"]
    if chosen[1] == "saltelli":
        size = saltelli_size(len(known["uncertain"] or ()), has_fields(known))
    if chosen[1] == "sobol" and size is not None and size & (size - 1):
        below = 1 << (size.bit_length() - 1)
        text = f"must be a power of two for sobol; nearest: {below} or {2 * below}"
        yield problem(known, f"{OWN}.replicate_size", text)
    least = FEWEST_REPLICATES * (size or DEFAULTS["replicate_size"])
    key = f"{UNTIL}.at_most" if _has_question(known) else "study.realisations"
    number = known[key] if _has_question(known) else known[key] or 1
    if number is not None and number < least:
        text = f"must be at least {least}: {FEWEST_REPLICATES} replicates of the design, whose scatter tells its error"
        if chosen[1] != "saltelli" and number >= 2 * FEWEST_REPLICATES:
            text += f"; or let estimator.replicate_size be at most {number // FEWEST_REPLICATES}"
        yield Problem(path_of(key), text, number)
    elif number is not None and not _has_question(known) and number % (least // FEWEST_REPLICATES):
        text = f"must be whole replicates of the design, a multiple of {least // FEWEST_REPLICATES}"
        yield Problem(path_of(key), text, number)


def saltelli_size(numbers: int, has_fields: bool) -> int:
    """Simulations of one base point of a saltelli design: two, and one for each uncertain number and for the fields."""
    return 2 + numbers + has_fields


def _chains_fit(known: Known) -> Iterator[Problem]:
    if (chosen := _estimator(known)) is None or chosen[0] != "subset_simulation":
        return
    size = known[f"{OWN}.level_size"] or DEFAULTS["level_size"]
    share = known[f"{OWN}.level_probability"] or DEFAULTS["level_probability"]
    chains = round(size * share)
    if chains < 2 or size % chains:
        text = f"must be a multiple of its product with level_probability, {size * share:.4g}, which must be 2 or more"
        yield Problem(path_of(f"{OWN}.level_size"), text, size)
    most = known[f"{UNTIL}.at_most"] if _has_question(known) else None
    if most is not None and most < FEWEST_SUBSETS * size:
        text = f"must be at least {FEWEST_SUBSETS * size}: the first levels of {FEWEST_SUBSETS} subset simulations"
        yield problem(known, f"{UNTIL}.at_most", text)


def _pilot_fits(known: Known) -> Iterator[Problem]:
    if (chosen := _estimator(known)) is None or chosen[0] != "stratified":
        return
    size = known[f"{OWN}.pilot_size"] or DEFAULTS["pilot_size"]
    most = known[f"{UNTIL}.at_most"] if _has_question(known) else None
    if most is not None and most < 2 * size:
        text = f"must be at least {2 * size}: the plain realisations of stratified, and as many that follow from them"
        yield problem(known, f"{UNTIL}.at_most", text)


def _two_phases_fit(known: Known) -> Iterator[Problem]:
    if (chosen := _estimator(known)) is None or chosen[0] != "two_phase":
        return
    coarser = known[f"{OWN}.coarser_cells_m"] or ()
    if len(coarser) != 1:
        text = "needs one cell size, such as twice the cells of the study"
        yield Problem(path_of(f"{OWN}.coarser_cells_m"), text, list(coarser) or None)
    most, least = known[f"{UNTIL}.at_most"] if _has_question(known) else None, 2 * FIRST_OF_TWO_PHASES
    if most is not None and most < least:
        text = f"must be at least {least}: the first realisations of two_phase and as many chosen ones"
        yield problem(known, f"{UNTIL}.at_most", text)


def _cells_are_coarser(known: Known) -> Iterator[Problem]:
    if known[OWN] is None or not (coarser := known[f"{OWN}.coarser_cells_m"]):
        return
    cell = finer = known["discretisation.cell_m"]
    for number, coarse in enumerate(coarser):
        key, ratio = f"{OWN}.coarser_cells_m.{number}", coarse / cell
        if coarse <= finer:
            yield problem(known, key, f"must be larger than the cells before it, {finer:.10g} m")
        elif not isclose(ratio, round(ratio), rel_tol=1e-9):
            text = f"must be a whole multiple of discretisation.cell_m = {cell:.10g}, such as {2 * cell:.10g}"
            yield problem(known, key, text)
        finer = max(finer, coarse)


def level_tables(tables: dict, cell: float) -> dict:
    """Tables of the study that simulates the same fields on other cells: the study's own cells carry the fields.

    Args:
        tables: of the study, nested dicts and lists; not changed.
        cell: side of the cells of that level [m].

    Returns:
        The tables, without [estimator].
    """
    found = deepcopy(tables)
    found.pop(OWN, None)
    own = found["discretisation"]["cell_m"]
    found["discretisation"]["cell_m"] = cell
    for table in (found, *found["material"]):
        for field in (table.get("random_field") or {}).values():
            if field.get("reference_cell_m") is None:
                field["reference_cell_m"] = own
    return found


def level_problems(known: Known, joint_problems: Callable[[Known], list[Problem]]) -> list[Problem]:
    """What is wrong with the studies of the levels and not with the study itself.

    Args:
        known: the study.
        joint_problems: finds what is wrong between the keys of a study.

    Returns:
        A problem for each level that cannot be simulated, at its cells.
    """
    tables = known.data.get(OWN)
    coarser = tables.get("coarser_cells_m") if isinstance(tables, dict) else None
    if not coarser or known.doubtful:
        return []
    found = []
    for number, cell in enumerate([known["discretisation.cell_m"], *coarser]):
        level = Known(known.model, level_tables(known.data, cell), set())
        where = f"{OWN}.coarser_cells_m" + (f".{number - 1}" if number else "")
        found += [problem(known, where, f"does not fit: {wrong}") for wrong in joint_problems(level)]
    return found


QUESTION_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _number_is_fixed_or_open,
    _question_is_one,
    _question_has_an_end,
    _keys_are_read,
    _method_has_what_it_needs,
    _design_is_whole,
    _chains_fit,
    _two_phases_fit,
    _pilot_fits,
    _cells_are_coarser,
]
