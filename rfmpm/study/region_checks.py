"""What the regions, layers and benches of a geometry must satisfy, with each other and with the materials."""

from collections.abc import Callable, Iterator
from math import isclose

from rfmpm.ground import faults, is_plain
from rfmpm.study.bodies import geometry_of, is_plain_body, regions_in, size_of
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.schema import one_of

FEWEST_CELLS = 4  # from the base to the highest ground


def _corners_are_given(known: Known) -> Iterator[Problem]:
    for kind in ("region", "cut"):
        if kind == "region" and known["geometry.kind"] != "regions":
            continue
        if known["geometry.kind"] == "block":
            continue
        for number in range(len(known[f"geometry.{kind}"] or ())):
            path = f"geometry.{kind}.{number}"
            corners = known[f"{path}.corners_m"]
            if kind == "region" and known[f"{path}.file"] is not None:
                text = "is read where a study is loaded: use load_study, or give its content as corners_m"
                yield problem(known, f"{path}.file", text)
            elif corners is None:
                yield Problem(path_of(f"{path}.corners_m"), "missing; must be a list of [x, y] in m, or give file")
            elif len(corners) < 3:
                yield problem(known, f"{path}.corners_m", f"has {len(corners)} corners: must be three or more")
        if kind == "region" and not known["geometry.region"]:
            yield Problem(
                path_of("geometry.region"), "missing; must be one or more tables, written [[geometry.region]]"
            )


def _names_differ(known: Known) -> Iterator[Problem]:
    if known["geometry.kind"] != "regions":
        return
    seen = set()
    for number in range(len(known["geometry.region"])):
        name = known[f"geometry.region.{number}.name"]
        if name in seen:
            yield problem(
                known, f"geometry.region.{number}.name", "is the name of another region too; names must differ"
            )
        seen.add(name)


def _materials_are_there(known: Known) -> Iterator[Problem]:
    names = [known[f"material.{index}.name"] for index in range(len(known["material"]))]
    if not names:
        return
    kind, used = known["geometry.kind"], set() if known["geometry.kind"] == "regions" else {names[0]}
    paths = []
    for table in {"regions": ("region",), "slope": ("layer",), "block": ()}[kind]:
        paths += [f"geometry.{table}.{number}.material" for number in range(len(known[f"geometry.{table}"] or ()))]
    if kind == "slope" and known["geometry.foundation_material"] is not None:
        paths.append("geometry.foundation_material")
    for path in paths:
        used.add(known[path])
        if known[path] not in names:
            yield problem(known, path, f"names no material; must be {one_of(names, known[path])}")
    for index, name in enumerate(names):
        if name not in used and paths:
            yield problem(known, f"material.{index}.name", "is the material of no soil: leave it out, or use it")


def _layers_fit_the_slope(known: Known) -> Iterator[Problem]:
    if known["geometry.kind"] != "slope":
        return
    height = known["geometry.height_m"]
    thicknesses = [known[f"geometry.layer.{k}.thickness_m"] for k in range(len(known["geometry.layer"] or ()))]
    if sum(thicknesses) > height * (1.0 + 1e-9):
        text = f"are {sum(thicknesses):.6g} m thick together: must be at most geometry.height_m = {height:.6g}"
        yield Problem(path_of("geometry.layer"), f"{text}; what lies deeper is the foundation")
    for number in range(len(known["geometry.bench"] or ())):
        if known[f"geometry.bench.{number}.height_m"] >= height:
            text = f"must be less than geometry.height_m = {height:.6g}"
            yield problem(known, f"geometry.bench.{number}.height_m", text)
    if known["geometry.foundation_material"] is not None and known["geometry.foundation_m"] is None:
        yield problem(known, "geometry.foundation_material", "needs a foundation_m, or leave it out")


def _regions_make_a_body(known: Known) -> Iterator[Problem]:
    kind, cell = geometry_of(known).kind, known["discretisation.cell_m"]
    if is_plain_body(known):
        return
    for number, text in faults(regions_in(known), cell):
        if kind == "regions":
            path = f"geometry.region.{number}.corners_m"
            yield Problem(path_of(path), f'region "{known[f"geometry.region.{number}.name"]}" {text}')
        else:
            yield Problem(path_of("geometry"), f"the {regions_in(known)[number].name} {text}")


def _regions_fit_the_cells(known: Known) -> Iterator[Problem]:
    if known["geometry.kind"] != "regions":
        return
    size, cell = size_of(known), known["discretisation.cell_m"]
    if size.height < FEWEST_CELLS * cell * (1.0 - 1e-9):
        text = f"rise to {size.height:.4g} m: must be at least {FEWEST_CELLS} cells of {cell:g} m: take smaller cells"
        yield Problem(path_of("geometry.region"), text)
    cells = size.length / cell
    if known["geometry.foreland_m"] == 0.0 and not isclose(cells, round(cells), rel_tol=1e-9):
        text = f"must be greater than 0, or the regions, which end at x = {size.length:.6g} m, must end at a whole "
        yield problem(known, "geometry.foreland_m", f"{text}number of cells of {cell:g} m")
    for key in ("toe_m", "crest_edge_m"):
        if known[f"geometry.{key}"] is not None and known[f"geometry.{key}"] > size.length:
            yield problem(known, f"geometry.{key}", f"must be within the regions, at most {size.length:.6g}")
    toe, crest_edge = known["geometry.toe_m"], known["geometry.crest_edge_m"]
    if None not in (toe, crest_edge) and toe < crest_edge:
        text = f"must be at least crest_edge_m = {crest_edge:g}: the slope descends to the right"
        yield problem(known, "geometry.toe_m", text)


def _cuts_leave_a_body(known: Known) -> Iterator[Problem]:
    import shapely

    geometry = geometry_of(known)
    if is_plain(geometry) or not geometry.cut:
        return
    regions = regions_in(known)
    if not all(region.polygon.is_valid for region in regions):
        return
    left = shapely.union_all([region.polygon for region in regions])
    for number, cut in enumerate(geometry.cut):
        polygon, path = shapely.Polygon(cut.corners_m), f"geometry.cut.{number}.corners_m"
        if not polygon.is_valid:
            yield Problem(path_of(path), "crosses or touches itself: its corners must follow each other around it")
            return
        taken = shapely.intersection(left, polygon).area
        left = shapely.difference(left, polygon)
        if taken <= 1e-9 * polygon.area:
            yield Problem(path_of(path), "removes no soil: it lies beside the body, or in an earlier cut")
        elif left.area < known["discretisation.cell_m"] ** 2:
            yield Problem(path_of(path), f"leaves no soil: it removes the last {taken:.4g} m2")
            return


def _initial_stress_suits_the_regions(known: Known) -> Iterator[Problem]:
    if known["time.initial_stress"] == "gravity_ramp" and known["geometry.kind"] != "block" and known["geometry.cut"]:
        text = 'cannot be found with soil that is then cut: take "elastic" or "k0", or leave geometry.cut out'
        yield problem(known, "time.initial_stress", text)


REGION_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _corners_are_given,
    _names_differ,
    _materials_are_there,
    _layers_fit_the_slope,
    _regions_make_a_body,
    _regions_fit_the_cells,
    _cuts_leave_a_body,
    _initial_stress_suits_the_regions,
]
