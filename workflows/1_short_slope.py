"""The main study: what a realisation costs, and the pictures of its campaign.

    python workflows/1_short_slope.py

writes reports/short_slope.md and the two pictures at the top of the README. It takes about two minutes on two cores;
the campaign continues in results/short_slope_random if it is there.
"""

import base64
import os
from pathlib import Path

import rfmpm
from rfmpm import realisation
from rfmpm.report import write_simulation_picture
from rfmpm.report.numbers import analyse, usable
from rfmpm.report.probability_figures import charts

ROOT = Path(__file__).parents[1]
REPORTS = ROOT / "reports"
COMMAND = "python workflows/1_short_slope.py"
REPEATS = 8
PICTURED = 6  # realisation at the top of the README: a slide that took the whole crest


def cost(study) -> str:
    """What one realisation costs, the least of some repeats, and the load of the machine meanwhile."""
    prepared = realisation.prepare(study)
    outcomes = [realisation.simulate(prepared) for _ in range(REPEATS)]
    best = min(outcomes, key=lambda outcome: outcome.wall_time)
    points = len(best.points["x"])
    speed = 1e9 * best.wall_time / best.step_count / points
    return (
        f"{points} points, {best.step_count} steps to rest at {best.quantities['time_at_rest']:.1f} s: "
        f"{best.wall_time:.2f} s on one core, {speed:.0f} ns per point and step "
        f"(least of {REPEATS} repeats on a shared machine, load {os.getloadavg()[0]:.1f})."
    )


def campaign() -> None:
    """Run or continue the campaign of the README, and make its two pictures."""
    study = rfmpm.load_study(ROOT / "configs" / "short_slope_random.toml")
    dataset = rfmpm.run_ensemble(study, directory=ROOT / study.output.directory)
    write_simulation_picture(rfmpm.simulate(study, index=PICTURED), study, REPORTS / "short_slope.png")
    exceedance = charts(usable(dataset), analyse(dataset, study))["exceedance"][0]
    (REPORTS / "exceedance.png").write_bytes(base64.b64decode(exceedance.source.partition(",")[2]))


def main() -> None:
    """Make the report."""
    REPORTS.mkdir(exist_ok=True)
    main_study = rfmpm.load_study(ROOT / "configs" / "short_slope.toml")
    text = f"""# Cost of a realisation of the main study

Made by `{COMMAND}`. The slope of the main study without its random field, `configs/short_slope.toml`:
{cost(main_study)}

The five runs of Vardon, Wang and Hicks (2017): [papers/short_slope_five_runs.md](papers/short_slope_five_runs.md).
"""
    (REPORTS / "short_slope.md").write_text(text, encoding="utf-8")
    campaign()


if __name__ == "__main__":
    main()
