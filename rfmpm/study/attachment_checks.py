"""What loads on the ground and obstacles must satisfy together with the body."""

from collections.abc import Callable, Iterator

from rfmpm.ground import body_polygon
from rfmpm.study.bodies import geometry_of, size_of, sound_regions_in
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem


def _loads_lie_on_the_ground(known: Known) -> Iterator[Problem]:
    if not known["load"]:
        return
    if known["time.initial_stress"] != "elastic":
        text = 'cannot be found with a load: take "elastic", or leave load out'
        yield problem(known, "time.initial_stress", text)
    for index in range(len(known["load"])):
        path = f"load.{index}"
        start, end, length = known[f"{path}.from_m"], known[f"{path}.to_m"], size_of(known).length
        if end <= start:
            yield problem(known, f"{path}.to_m", f"must be greater than from_m = {start:g}")
        elif end > length:
            yield problem(known, f"{path}.to_m", f"must be at most {length:.6g}, where the soil ends")


def _obstacles_stand_clear(known: Known) -> Iterator[Problem]:
    if not known["obstacle"]:
        return
    import shapely

    body, cell = body_polygon(geometry_of(known), sound_regions_in(known)), known["discretisation.cell_m"]
    for index in range(len(known["obstacle"])):
        path = f"obstacle.{index}.corners_m"
        corners = known[path]
        if len(corners) < 3:
            yield problem(known, path, f"has {len(corners)} corners: must be three or more")
            continue
        polygon = shapely.Polygon(corners)
        left, low, _, _ = polygon.bounds
        if not polygon.is_valid:
            yield Problem(path_of(path), "crosses or touches itself: its corners must follow each other around it")
        elif left < 0.0 or low < 0.0:
            yield Problem(path_of(path), "lies outside the domain: x and y must be at least 0")
        elif shapely.buffer(polygon, -0.5 * cell * (1.0 - 1e-6), join_style="mitre").is_empty:
            yield Problem(path_of(path), f"is thinner than a cell of {cell:g} m: soil would pass between its nodes")
        elif (common := polygon.intersection(body).area) > 1e-3 * cell**2:
            yield Problem(path_of(path), f"stands in {common:.4g} m2 of soil: it may touch it, or cut it away")


ATTACHMENT_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [_loads_lie_on_the_ground, _obstacles_stand_clear]
