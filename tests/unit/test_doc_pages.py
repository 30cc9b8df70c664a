"""Pages of the documentation about equations, quantities and estimators: none is missing, what they quote is so.

A page says in tables what is held against the program: `| variable | unit |` against the table of variables,
`| key | default |` against the models of a study, `| constant | value |` against the modules. Rows below a line that
starts with "From" and a link to a report stand in that report as they are.
"""

import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic.fields import FieldInfo

from rfmpm.estimators import ESTIMATORS
from rfmpm.quantities import QUANTITIES
from rfmpm.sampling import SAMPLERS
from rfmpm.study import Study
from rfmpm.study.question_models import DEFAULTS, Estimation
from rfmpm.study.schema import bare, choices, tables
from rfmpm.variables import PROVENANCE, VARIABLES

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {
    str(path.relative_to(DOCS)): path.read_text(encoding="utf-8")
    for folder in ("quantities", "estimators", "theory")
    for path in sorted((DOCS / folder).glob("*.md"))
}
LEFT_OUT = "left out"
BY_OTHERS = {"discretisation.volumetric_strain": "by the law"}  # defaults that other keys decide


def rows(text: str, *header: str) -> Iterator[list[str]]:
    """Cells of the rows of all tables whose first columns have these names, code marks taken off."""
    is_inside = False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            is_inside = False
        elif tuple(cells[: len(header)]) == header:
            is_inside = True
        elif is_inside and not set(cells[0]) <= {"-"}:
            yield [cell.strip("`") for cell in cells]


def wrong_defaults(text: str) -> list[str]:
    """Keys of tables of a page whose default is another."""
    found = []
    for key, quoted, *_ in rows(text, "key", "default"):
        actual = default_of(key)
        is_right = quoted == LEFT_OUT if actual is None else same(quoted, actual)
        if not is_right and BY_OTHERS.get(key) != quoted:
            found.append(f"{key} = {quoted}: {actual}")
    return found


def default_of(dotted: str) -> Any:
    """Default of a key of a study; None where it may be left out, KeyError where there is none."""
    models, info = [Study], None
    for name in dotted.split("."):
        info = next(model.model_fields[name] for model in models if name in model.model_fields)
        models = models_of(info)
    if info.is_required():
        raise KeyError(f"{dotted} has no default")
    value = info.get_default()
    return DEFAULTS.get(dotted.removeprefix("estimator.")) if value is None and "estimator." in dotted else value


def models_of(info: FieldInfo) -> list[type]:
    """Tables that a field may hold, alone or in a list."""
    annotation = bare(info.annotation)
    inner = [bare(entry) for entry in get_args(annotation) if entry is not Ellipsis]
    return tables(annotation) or [model for entry in inner for model in tables(entry)]


def wrong_constants(text: str) -> list[str]:
    """Constants of tables of a page that have another value in their module."""
    found = []
    for dotted, quoted, *_ in rows(text, "constant", "value"):
        module, _, name = dotted.rpartition(".")
        actual = getattr(import_module(f"rfmpm.{module}"), name)
        if not same(quoted, actual):
            found.append(f"{dotted} = {quoted}: {actual}")
    return found


def same(quoted: str, actual: Any) -> bool:
    """Whether the text says the value."""
    return quoted == actual if isinstance(actual, str) else float(quoted) == actual


def misquoted(text: str, folder: Path) -> list[str]:
    """Rows below a line that names a report first, which that report does not have."""
    found, report = [], None
    for line in text.splitlines():
        if link := re.match(r"From \[[^\]]*\]\(([^)#]+)", line):
            report = (folder / link[1]).resolve().read_text(encoding="utf-8").splitlines()
        elif line.startswith("#"):
            report = None
        elif report is not None and line.startswith("|") and not set(line) <= set("|- ") and line not in report:
            found.append(line)
    return found


@pytest.mark.parametrize("page", PAGES)
def test_defaults_are_those_of_the_study(page):
    assert wrong_defaults(PAGES[page]) == []


@pytest.mark.parametrize("page", PAGES)
def test_constants_are_those_of_the_modules(page):
    assert wrong_constants(PAGES[page]) == []


@pytest.mark.parametrize("page", PAGES)
def test_numbers_are_those_of_the_report(page):
    assert misquoted(PAGES[page], (DOCS / page).parent) == []


def test_every_variable_of_a_row_has_a_page_and_its_unit():
    told = {
        name: unit
        for page, text in PAGES.items()
        if page.startswith("quantities/")
        for name, unit, *_ in rows(text, "variable", "unit")
    }
    units = {name: variable.unit for name, variable in (VARIABLES | PROVENANCE).items()}
    of_its_own = {name for name in {*units, *QUANTITIES} if f"quantities/{name}.md" in PAGES}
    assert {*units, *QUANTITIES} - {*told, *of_its_own} == set()
    assert {name: unit for name, unit in told.items() if units.get(name) != unit} == {}


def test_every_estimator_and_sampling_has_a_page():
    pages = {method: page for method, page, *_ in rows(PAGES["estimators/index.md"], "estimator", "page")}
    methods, samplings = (set(choices(Estimation.model_fields[key].annotation)) for key in ("method", "sampling"))
    assert set(pages) == {*ESTIMATORS, *methods, *SAMPLERS, *samplings}
    links = {re.search(r"\]\(([^)]+)\)", page)[1] for page in pages.values()}
    assert {f"estimators/{link}" for link in links} <= set(PAGES)


def test_every_law_shape_correlation_and_method_of_a_field_is_on_a_page_of_theory():
    from rfmpm.mpm.boundary import WALLS
    from rfmpm.mpm.initial_stress import INITIAL_STRESSES
    from rfmpm.mpm.laws import LAWS
    from rfmpm.mpm.shapes import SHAPES
    from rfmpm.random_fields.correlation import CORRELATIONS
    from rfmpm.random_fields.marginals import MARGINALS
    from rfmpm.random_fields.methods import METHODS
    from rfmpm.stability.limit_equilibrium import ASSUMPTIONS

    theory = "\n".join(text for page, text in PAGES.items() if page.startswith("theory/"))
    named = [*LAWS, *WALLS, *INITIAL_STRESSES, *SHAPES, *CORRELATIONS, *MARGINALS, *METHODS, *ASSUMPTIONS]
    assert [name for name in named if f"`{name}`" not in theory] == []


# The readers themselves: each finds what is wrong.


def test_readers_find_what_is_wrong(tmp_path):
    text = "| key | default |\n|---|---|\n| `time.step_fraction` | 0.9 |\n| `estimator.pilot_size` | 100 |\n"
    assert wrong_defaults(text) == ["time.step_fraction = 0.9: 0.8"]
    text = "| constant | value |\n|---|---|\n| `mpm.scene.FILTER_INTERVAL` | 4 |\n"
    assert wrong_constants(text) == ["mpm.scene.FILTER_INTERVAL = 4: 8"]
    (tmp_path / "report.md").write_text("| a | 1 |\n", encoding="utf-8")
    text = "| a | 3 |\n\nFrom [it](report.md):\n\n| a | 1 |\n|---|---|\n| a | 2 |\n\n## Next\n\n| a | 4 |\n"
    assert misquoted(text, tmp_path) == ["| a | 2 |"]


def test_reader_of_defaults_refuses_a_key_that_is_none():
    with pytest.raises(StopIteration):
        default_of("time.nothing")
