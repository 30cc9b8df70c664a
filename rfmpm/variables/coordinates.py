"""The table of what tells the rows of a dataset from each other."""

from rfmpm.variables.variable import Variable, has_surface, is_uncertain, table

COORDINATES = table(
    Variable(
        "realisation",
        ("realisation",),
        "int64",
        "1",
        "index of the realisation",
        {"comment": "Computed again, bit for bit, by: rfmpm rerun DIR --index INDEX [--level LEVEL]."},
    ),
    Variable(
        "level",
        ("realisation",),
        "int32",
        "1",
        "level of the plan",
        {
            "comment": "On whose cells it was simulated: 0 for the study's own, k for the k-th of its "
            "estimator.coarser_cells_m. A realisation has the same random numbers on every level."
        },
    ),
    Variable(
        "x",
        ("x",),
        "float64",
        "m",
        "horizontal position of the bin centre",
        {"axis": "X", "comment": "From the left side of the domain."},
        has_surface,
    ),
    Variable(
        "uncertain",
        ("uncertain",),
        "str",
        "",
        "key of an uncertain number",
        {"comment": "Dotted path in the study, lists by position."},
        is_uncertain,
    ),
)
