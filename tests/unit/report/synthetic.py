"""A made-up study, ensemble and outcome, shaped as the interface says, so that the report needs no simulation."""

from types import SimpleNamespace

import numpy as np

from rfmpm.failure_modes import MODES
from rfmpm.mpm.scene import domain_size, outline, toe_x
from rfmpm.results import dataset
from rfmpm.study import Study, load_study
from rfmpm.variables import STATUS

STUDY = {
    "study": {"name": "short slope, random cohesion", "seed": 20160901, "realisations": 64},
    "geometry": {"kind": "slope", "height_m": 5.0, "crest_m": 10.0, "angle_deg": 45.0, "foreland_m": 25.0},
    "discretisation": {"cell_m": 0.25, "points_per_cell": 4, "shape": "quadratic_bspline"},
    "boundary": {"base": {"kind": "friction", "coefficient": 0.3}, "sides": {"kind": "roller"}},
    "material": [
        {
            "name": "clay",
            "law": "von_mises",
            "unit_weight_kn_m3": 20.0,
            "youngs_modulus_kpa": 1000.0,
            "poissons_ratio": 0.33,
            "cohesion_kpa": 20.0,
            "residual_cohesion_kpa": 4.0,
            "softening_modulus_kpa": 50.0,
        }
    ],
    "random_field": {
        "cohesion": {
            "material": "clay",
            "distribution": "lognormal",
            "coefficient_of_variation": 0.25,
            "correlation": "markov_separable",
            "scale_of_fluctuation_h_m": 6.0,
            "scale_of_fluctuation_v_m": 1.0,
        }
    },
    "time": {"end_s": 40.5},
    "output": {"directory": "results/short_slope_random", "surface_bin_m": 0.25},
}


def make_study(**changes) -> Study:
    return load_study(STUDY).with_changes(changes)


def make_rows(study, n=64, failed=(), censored=(), not_at_rest=(), still=(), seed=1) -> list[dict]:
    """Rows of n realisations; the named indices failed, met the far wall, kept moving or never moved."""
    generator = np.random.default_rng(seed)
    rows = []
    for index in range(n):
        run_out = 0.0 if index in still else float(np.round(generator.gamma(6.0, 1.2), 6))
        row = {
            "realisation": index,
            "level": 0,
            "run_out": run_out,
            "run_out_censored": int(index in censored),
            "retrogression_distance": min(10.0, 1.1 * run_out),
            "retrogression_censored": int(1.1 * run_out >= 10.0),
            "failure_volume": 4.5 * run_out,
            "initial_failure_volume": 2.0 * run_out,
            "influence_distance": 2.1 * run_out + 5.0,
            "block_count": int(run_out // 3),
            "failure_mode": min(int(np.ceil(run_out / 3)), len(MODES) - 1),
            "status": STATUS["not_at_rest" if index in not_at_rest else "ok"],
            "status_reason": "kinetic energy still 0.4 % of its peak" if index in not_at_rest else "",
            "time_at_rest": np.nan if index in not_at_rest else 12.0,
            "step_count": 9000,
            "wall_time": float(generator.gamma(20.0, 0.7)),
            "plastic_work_share": 0.75,
            "friction_work_share": 0.15,
            "energy_balance_error": float(10 ** generator.uniform(-5, -3)),
            "numerical_dissipation_share": float(generator.uniform(0.05, 0.2)),
        }
        if study.output.surface_bin_m is not None:
            row["final_surface"] = _surface(study, run_out)
        if index in failed:
            kept = ("realisation", "level", "wall_time")
            row = {name: value if name in kept else np.nan for name, value in row.items()}
            row |= {"status": STATUS["diverged"], "status_reason": f"energy grew at step {4000 + index}"}
        rows.append(row)
    return rows


def _surface(study, run_out: float) -> np.ndarray:
    length, _ = domain_size(study)
    size = int(np.ceil(length / study.output.surface_bin_m - 1e-9))
    x = (np.arange(size) + 0.5) * study.output.surface_bin_m
    front = toe_x(study) + run_out
    return np.where(x < front, np.minimum(5.0, 0.25 * (front - x)), 0.0)


def make_ensemble(study, **options):
    attributes = {"start": "2024-05-01T08:00:00+00:00", "end": "2024-05-01T08:12:30+00:00"}
    return dataset(make_rows(study, **options), study, attributes)


def make_points(study, run_out: float, seed=0, spacing=0.125) -> dict[str, np.ndarray]:
    """Material points of a slope that slid: what lay above an inclined band moved, the band sheared."""
    polygon = outline(study)
    toe, height = toe_x(study), polygon[:, 1].max()
    xs, ys = (np.arange(0.5 * spacing, end, spacing) for end in (toe, height))
    x, y = (axis.ravel() for axis in np.meshgrid(xs, ys))
    inside = y < np.minimum(height, toe - x)
    x, y = x[inside], y[inside]
    above = np.clip((x + y - 0.55 * toe) / toe, 0.0, 1.0)
    moved_x, moved_y = x + 2.0 * run_out * above**1.5, y * (1.0 - 0.7 * above * min(run_out, 1.0))
    noise = np.random.default_rng(seed).normal(size=x.size)
    strain = 1.5 * np.exp(-((((x + y - 0.55 * toe) % 3.0) / 0.4) ** 2)) * (above > 0) if run_out else np.zeros(x.size)
    return {
        "x": moved_x,
        "y": moved_y,
        "x_initial": x,
        "y_initial": y,
        "plastic_strain": strain,
        "cohesion": 20e3 * np.exp(0.2 * np.sin(x) * np.cos(3.0 * y) + 0.05 * noise),
    }


def make_outcome(study, run_out=6.0, status="ok", reason="", frames=0) -> SimpleNamespace:
    steps = [(40.0 * (k + 1) / frames, make_points(study, run_out * (k + 1) / frames)) for k in range(frames)]
    return SimpleNamespace(
        quantities={"run_out": run_out},
        status=status,
        reason=reason,
        points=make_points(study, run_out),
        frames=steps,
        motion={},
    )
