"""Every total-stress simulation of the papers that the program rests on, run again and judged.

A new case is a file here and a line in CASES.
"""

from rfmpm.benchmark.papers import short_slope_five_runs, short_slope_random, short_slope_stress_regions
from rfmpm.benchmark.papers.case import Case

CASES: dict[str, Case] = {
    "short_slope_five_runs": short_slope_five_runs.CASE,
    "short_slope_stress_regions": short_slope_stress_regions.CASE,
    "short_slope_random": short_slope_random.CASE,
}
