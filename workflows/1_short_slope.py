"""The short slope: the five homogeneous runs of the paper, what a realisation costs, and the campaign's pictures.

    python workflows/1_short_slope.py

writes reports/short_slope.md with its picture, and the two pictures at the top of the README. It takes about five
minutes on two cores; the campaign continues in results/short_slope_random if it is there.
"""

import base64
import os
from pathlib import Path

import rfmpm
from rfmpm import realisation
from rfmpm.mpm.scene import outline
from rfmpm.report import write_simulation_picture
from rfmpm.report.numbers import analyse, usable
from rfmpm.report.probability_figures import charts
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, strain_limit, view
from rfmpm.report.style import DOTS_PER_INCH, drawing, new_figure

ROOT = Path(__file__).parents[1]
REPORTS = ROOT / "reports"
COMMAND = "python workflows/1_short_slope.py"
RUNS = [(12.0, 50.0), (8.0, 50.0), (4.0, 50.0), (4.0, 25.0), (4.0, 75.0)]  # residual cohesion, softening modulus [kPa]
REPEATS = 8
PICTURED = 6  # realisation at the top of the README: a retrogressive slide in which blocks can be told apart


def simulate(study, **changes):
    """Simulate the homogeneous slope with some keys changed; `__` stands for the dots of a path."""
    changed = study.with_changes({path.replace("__", "."): value for path, value in changes.items()})
    return realisation.simulate(realisation.prepare(changed))


def five_runs(study) -> str:
    """Table and picture of the five runs."""
    outcomes = [simulate(study, material__0__residual_cohesion_kpa=c, material__0__softening_modulus_kpa=h)
                for c, h in RUNS]  # fmt: skip
    draw(outcomes, outline(study), REPORTS / "short_slope_five_runs.png")
    lines = [
        "| residual cohesion [kPa] | softening modulus [kPa] | run-out [m] | retrogression [m] | failure volume [m3/m] "
        "| first slide [m3/m] | blocks | at rest [s] | numerical dissipation | energy error |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for (c, h), outcome in zip(RUNS, outcomes, strict=True):
        q = outcome.quantities
        reach = f"{q['retrogression_distance']:.2f}" + (" (boundary)" if q["retrogression_censored"] else "")
        rest = f"{q['time_at_rest']:.1f}" if outcome.status == "ok" else "no"
        lines.append(
            f"| {c:g} | {h:g} | {q['run_out']:.2f} | {reach} | {q['failure_volume']:.1f} "
            f"| {q['initial_failure_volume']:.1f} | {q['block_count']} | {rest} "
            f"| {100 * q['numerical_dissipation_share']:.1f} % | {100 * q['energy_balance_error']:.1f} % |"
        )
    return "\n".join(lines)


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


def draw(outcomes, polygon, path: Path) -> None:
    """Draw the final plastic strain of the runs, one below the other, in one frame and one scale of colours."""
    points = [outcome.points for outcome in outcomes]
    frame = view([polygon[:, 0], *(p["x"] for p in points)], [polygon[:, 1], *(p["y"] for p in points)])
    top = strain_limit(p["plastic_strain"] for p in points)
    with drawing():
        figure = new_figure(WIDTH, len(points) * (panel_height(frame) + 0.35))
        panels = figure.subplots(len(points), 1)
        for axes, (c, h), p in zip(panels, RUNS, points, strict=True):
            axes.set_title(f"residual cohesion {c:g} kPa, softening modulus {h:g} kPa")
            draw_panel(figure, axes, p, p["plastic_strain"], polygon, frame, (0.0, top), "plastic strain [-]")
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


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
    study = rfmpm.load_study(ROOT / "configs" / "papers" / "vardon_2017_short_slope.toml")
    text = f"""# The short slope of Vardon, Wang and Hicks (2017)

Made by `{COMMAND}`. Homogeneous slope of `configs/papers/vardon_2017_short_slope.toml`, softening scaled with the
cell, cells of {study.discretisation.cell_m:g} m, peak cohesion 20 kPa, base friction 0.3.

## Five runs

{five_runs(study)}

![Final plastic strain of the five runs](short_slope_five_runs.png)

Numerical dissipation and energy error are shares of the work of gravity.

## Cost of one realisation

The slope of the main study without its random field, `configs/short_slope.toml`: {cost(main_study)}
"""
    (REPORTS / "short_slope.md").write_text(text, encoding="utf-8")
    campaign()


if __name__ == "__main__":
    main()
