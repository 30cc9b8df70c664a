"""The picture of scheduling: efficiency over the number of ranks, and what stopping early does."""

from pathlib import Path

from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, ORANGE, VERMILION, drawing, new_figure

COLOURS = (VERMILION, ORANGE, "#009E73", BLUE, GREY)


def draw(efficiencies: dict[float, list[float]], ranks: tuple[int, ...], stopped: dict[str, dict], path: Path) -> None:
    """Draw both.

    Args:
        efficiencies: share of the ranks' time spent in realisations, by their mean time [s], for each number of ranks.
        ranks: their numbers.
        stopped: bias by estimate, by case.
        path: the picture.
    """
    with drawing():
        figure = new_figure(10.0, 3.8)
        left, right = figure.subplots(1, 2)
        for colour, (mean, found) in zip(COLOURS, efficiencies.items(), strict=False):
            left.plot(ranks, [100 * value for value in found], "o-", color=colour, label=f"{mean:g} s")
        left.axhline(95.0, color=GREY, linewidth=1.0, linestyle="--")
        left.set_xscale("log")
        left.set_xticks(ranks, [str(count) for count in ranks])
        left.minorticks_off()
        left.set_ylim(0.0, 101.0)
        left.set(xlabel="ranks", ylabel="ranks' time in realisations [%]", title="Simulated, 50 realisations per rank")
        left.legend(title="mean realisation")
        for number, (case, found) in enumerate(stopped.items()):
            places = [place + 0.12 * number for place in range(len(found))]
            values, errors = [bias.value for bias in found.values()], [2.0 * bias.error for bias in found.values()]
            right.errorbar(places, values, errors, fmt="o", capsize=4, color=(VERMILION, BLUE)[number % 2], label=case)
        right.axhline(0.0, color=GREY, linewidth=1.0)
        right.set_xticks(range(len(found)), list(found))
        right.set(ylabel="bias of P(failing) [-]", title="Stopped early, two standard errors")
        right.legend(loc="lower right")
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)
