"""Every total-stress simulation of the papers that the program rests on, run again and judged.

A new case is a file here and a line in CASES.
"""

from rfmpm.benchmark.papers import (
    column_collapse,
    column_compression,
    long_slope_angles,
    long_slope_excavated,
    long_slope_random,
    short_slope_five_runs,
    short_slope_random,
    short_slope_stress_regions,
    stress_oscillation,
    toro_rojas_slope,
)
from rfmpm.benchmark.papers.case import Case

CASES: dict[str, Case] = {
    "short_slope_five_runs": short_slope_five_runs.CASE,
    "short_slope_stress_regions": short_slope_stress_regions.CASE,
    "short_slope_random": short_slope_random.CASE,
    "long_slope_angles": long_slope_angles.CASE,
    "long_slope_random": long_slope_random.CASE,
    "long_slope_excavated": long_slope_excavated.CASE,
    "column_compression": column_compression.CASE,
    "stress_oscillation": stress_oscillation.CASE,
    "column_collapse": column_collapse.CASE,
    "toro_rojas_slope": toro_rojas_slope.CASE,
}
