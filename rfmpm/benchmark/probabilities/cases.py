"""The campaigns from whose rows estimators are judged: the short slope with random cohesion on two cell sizes."""

from pathlib import Path

from rfmpm.study import Study, load_study

CONFIG = Path(__file__).parents[3] / "configs" / "short_slope_random.toml"
FINE, COARSE = 0.25, 0.5  # cells [m]
NUMBERS = {"fine": 2000, "coarse": 20_000, "latin_hypercube": 6400, "sobol": 6400}  # rows of each campaign
REPLICATE, COMPONENTS = 32, 32  # of the designs: points of a replicate, principal components that are fixed


def studies(numbers: dict[str, int]) -> dict[str, Study]:
    """Make the studies: the fields of one index are those of one reference lattice on both cell sizes.

    Args:
        numbers: realisations of each.

    Returns:
        Studies by name.
    """
    base = load_study(CONFIG).with_changes(
        {
            "random_field.cohesion.reference_cell_m": FINE,
            "random_field.cohesion.method": "auto",
            "output": {"directory": "results/probabilities"},
        }
    )
    coarse = base.with_changes({"discretisation.cell_m": COARSE})
    design = {"replicate_size": REPLICATE, "principal_components": COMPONENTS}
    tables = {"fine": {}, "coarse": {}} | {
        name: {"estimator": {"sampling": name, **design}} for name in ("latin_hypercube", "sobol")
    }
    return {
        name: (base if name == "fine" else coarse).with_changes({"study.realisations": numbers[name], **table})
        for name, table in tables.items()
    }
