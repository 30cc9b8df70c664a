"""Every total-stress simulation of the papers that the program rests on, run again and judged.

A new case is a file here and a line in CASES.
"""

from rfmpm.benchmark.papers import long_slope_angles, long_slope_excavated, long_slope_random, short_slope_five_runs
from rfmpm.benchmark.papers.case import Case

CASES: dict[str, Case] = {
    "short_slope_five_runs": short_slope_five_runs.CASE,
    "long_slope_angles": long_slope_angles.CASE,
    "long_slope_random": long_slope_random.CASE,
    "long_slope_excavated": long_slope_excavated.CASE,
}
