"""What a campaign will cost, from a short trial; and compiling ahead of time."""

import os
import time
from collections.abc import Iterator
from itertools import product
from math import ceil

from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.boundary import WALLS
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.shapes import SHAPES
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import start
from rfmpm.study import Study
from rfmpm.variables import active_variables

TRIAL_STEPS = 200
FRICTIONAL = ("mohr_coulomb", "drucker_prager")
RANDOM_FRICTION = "random friction"
TINY_FIELD = {
    "material": "soil",
    "distribution": "lognormal",
    "coefficient_of_variation": 0.1,
    "correlation": "markov_separable",
    "scale_of_fluctuation_h_m": 1.0,
    "scale_of_fluctuation_v_m": 1.0,
}


def estimate(study: Study) -> dict[str, int | float]:
    """Predict the cost of a campaign from a trial of a few hundred steps; nothing is written.

    Args:
        study: the study.

    Returns:
        Counts, times in keys that end in `_s` and sizes in keys that end in `_bytes`. Steps and times are those of a
        realisation that moves until `time.end_s`; one that comes to rest earlier costs less.
    """
    import psutil

    prepared = realisation.prepare(study)
    realisation.compile_kernels(prepared)
    scene = prepared.scene
    controls = scene.controls
    time_step = controls.courant * controls.cell / controls.wave_speed
    steps = ceil(study.time.end_s / time_step)
    per_realisation = _seconds_per_step(prepared, time_step) * steps
    workers = min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
                  study.study.realisations)  # fmt: skip
    numbers = sum(v.dtype != "str" for v in active_variables(study))
    if study.output.surface_bin_m is not None:
        numbers += ceil(scene.body.length / study.output.surface_bin_m)
    return {
        "points": len(scene.points.mass),
        "cells": scene.axes.x.cells * scene.axes.y.cells,
        "time_step_s": time_step,
        "steps_at_most": steps,
        "realisation_at_most_s": per_realisation,
        "local_workers": workers,
        "campaign_at_most_s": per_realisation * ceil(study.study.realisations / workers),
        "memory_per_worker_bytes": psutil.Process().memory_info().rss,
        "disk_at_most_bytes": 8 * numbers * study.study.realisations,
    }


def _seconds_per_step(prepared: realisation.Prepared, time_step: float) -> float:
    scene = prepared.scene
    arguments = scenes.arguments(scene, scenes.release(scene, realisation.typical_strengths(prepared)))
    started = time.perf_counter()
    now = SOLVERS[prepared.study.time.scheme](start(), TRIAL_STEPS * time_step, *arguments)
    return (time.perf_counter() - started) / max(now.step_count, 1)


def warmup() -> Iterator[str]:
    """Compile and cache the kernels of every combination of shape, law and walls.

    Yields:
        The name of each combination, once it is ready.
    """
    soils = [*LAWS, *(f"{law} with {RANDOM_FRICTION}" for law in FRICTIONAL)]
    combinations = list(product(SHAPES, soils, WALLS, WALLS))
    for number, (shape, soil, base, sides) in enumerate(combinations, start=1):
        law = soil.split()[0]
        study = _tiny_study(shape, law, base, sides)
        if soil != law:
            study = study.with_changes({"random_field.friction_angle": TINY_FIELD})
        realisation.compile_kernels(realisation.prepare(study))
        yield f"{number}/{len(combinations)}  {shape}, {soil}, {base} base, {sides} sides"


def _tiny_study(shape: str, law: str, base: str, sides: str) -> Study:
    material = {
        "name": "soil",
        "law": law,
        "unit_weight_kn_m3": 20.0,
        "youngs_modulus_kpa": 1e3,
        "poissons_ratio": 0.3,
    }
    if law != "elastic":
        material["cohesion_kpa"] = 20.0
    if law in FRICTIONAL:
        material["friction_angle_deg"] = 30.0
    return Study(
        study={"name": "warm-up", "seed": 0},
        geometry={"kind": "block", "width_m": 2.0, "height_m": 2.0, "foreland_m": 2.0},
        discretisation={"cell_m": 1.0, "points_per_cell": 4, "shape": shape},
        boundary={"base": _boundary(base), "sides": _boundary(sides)},
        material=[material],
        time={"end_s": 1.0},
        output={"directory": "unused"},
    )


def _boundary(kind: str) -> dict:
    return {"kind": kind, "coefficient": 0.3} if kind == "friction" else {"kind": kind}
