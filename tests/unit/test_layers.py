"""The house's floors: who may import whom, read from the sources themselves, imports inside functions included."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "rfmpm"

# Higher may import lower; on one floor only what shares a room, the part before the first dot.
# A name stands for a module, or for a package with everything in it; the longest one that fits counts.
FLOORS = {
    7: ("cli",),
    6.5: ("rfmpm", "benchmark"),  # the public names; what measures the whole house
    6.2: ("cost",),
    6: ("ensemble", "report"),
    5.5: ("campaign_status",),
    5.2: ("planning",),
    5: ("realisation", "results", "field_influence"),
    4.7: ("outcome", "preparation"),
    4.5: ("observer", "initial_state"),
    4.4: ("motion",),
    4.2: ("sampling",),  # chains follow the plan of their estimator
    4: ("quantities", "estimators", "stability"),
    3.5: ("random_fields.properties", "random_fields.comparison", "random_fields.principal_components"),
    3.2: ("uncertainty", "random_fields.property"),
    3: ("mpm.scene", "mpm.solvers", "mpm.equilibrium", "random_fields.field", "random_fields.statistics"),
    2.5: (
        *("mpm.geometry", "mpm.energy", "mpm.initial_stress", "mpm.soils", "mpm.placing"),
        *("random_fields.store", "random_fields.trend", "random_fields.law"),
    ),
    2.2: ("mpm.transfer", "random_fields.averaging", "random_fields.gaussian_space"),
    2: (
        *(
            "mpm.attachments",
            "mpm.stages",
            "mpm.cells",
            "mpm.nonlocal_softening",
            "mpm.boundary",
            "mpm.contact",
            "mpm.laws",
            "mpm.shapes",
        ),
        *("random_fields.methods", "random_fields.correlation", "random_fields.marginals"),
        *("random_fields.conditioning", "random_fields.measurements"),
        *("random_fields.sounding", "random_fields.estimation", "random_fields.variance_function"),
        *("random_fields.layers", "random_fields.common", "random_fields.kinds"),
        *("random_fields.cross_correlation", "random_fields.site"),
    ),
    1: ("mpm.state", "mpm.protocols", "random_fields.lattice", "study", "variables", "seeds"),
    0: ("kernel_tools", "columns", "ground", "failure_modes"),
}
FLOOR_OF = {name: floor for floor, names in FLOORS.items() for name in names}
NAMESPACES = {"mpm", "random_fields"}  # rooms on several floors: their __init__ imports nothing and offers nothing
STRANGERS = ({"mpm", "random_fields"}, {"mpm", "variables"}, {"random_fields", "variables"})
ONLY_IMPORTER = {"numba": "kernel_tools", "llvmlite": "kernel_tools", "mpi4py": "ensemble"}


def name_of(path: Path, package: Path = PACKAGE) -> str:
    """Name of a module below the package; the package's own __init__ is called by the package's name."""
    parts = path.relative_to(package).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__") or package.name


MODULES = {name_of(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def imports_of(source: str, module: str, is_package: bool, modules=MODULES) -> set[str]:
    """Every module that a source imports, at any depth: ours by the names of MODULES, others in full."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                here = ("rfmpm." + module).split(".") if module != "rfmpm" else ["rfmpm"]
                kept = len(here) - node.level + is_package
                base = ".".join(here[:kept] + ([node.module] if node.module else []))
            # `from package import name`: a module of that name, or something that the package itself offers
            for alias in node.names:
                full = f"{base}.{alias.name}"
                found.add(full if full.removeprefix("rfmpm.") in modules else base)
    return {name.removeprefix("rfmpm.") for name in found}


def is_ours(name: str) -> bool:
    return name.split(".")[0] in {module.split(".")[0] for module in MODULES}


IMPORTS = {
    name: imports_of(path.read_text(encoding="utf-8"), name, path.name == "__init__.py")
    for name, path in MODULES.items()
}


def place_of(module: str) -> str:
    """The entry of FLOORS that a module belongs to."""
    parts = module.split(".")
    for length in range(len(parts), 0, -1):
        if (name := ".".join(parts[:length])) in FLOOR_OF:
            return name
    raise LookupError(f"rfmpm.{module} has no floor: give it one in the architecture and in FLOORS of {__file__}")


def wrongs(module: str, imported: set[str]) -> list[str]:
    """What a module imports of ours and may not."""
    here, room = FLOOR_OF[place_of(module)], module.split(".")[0]
    found = []
    for name in sorted(filter(is_ours, imported)):
        if name in NAMESPACES:
            found.append(f"{module} imports the bare {name}: import a module of it")
            continue
        there = FLOOR_OF[place_of(name)]
        if there > here or (there == here and name.split(".")[0] != room):
            found.append(f"{module} (floor {here}) imports {name} (floor {there})")
    return found


@pytest.mark.parametrize("module", MODULES)
def test_every_module_has_a_floor(module):
    assert module in NAMESPACES or place_of(module) in FLOOR_OF


@pytest.mark.parametrize("module", [module for module in MODULES if module not in NAMESPACES])
def test_imports_go_downwards_only(module):
    assert not wrongs(module, IMPORTS[module])


@pytest.mark.parametrize("module", sorted(NAMESPACES))
def test_a_room_on_several_floors_offers_nothing_itself(module):
    body = ast.parse(MODULES[module].read_text(encoding="utf-8")).body
    assert all(isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) for node in body)


@pytest.mark.parametrize("module", MODULES)
def test_strangers_do_not_meet(module):
    room = module.split(".")[0]
    rooms = {name.split(".")[0] for name in IMPORTS[module]}
    for pair in STRANGERS:
        assert not (room in pair and rooms & (pair - {room})), f"{module} of {pair}"


def test_engine_and_fields_meet_in_the_realisation_alone():
    drive_both = {
        module
        for module, imported in IMPORTS.items()
        if any(name.startswith("mpm.solvers") for name in imported) and any("random_fields" in n for n in imported)
    }
    assert drive_both == {"realisation"}


@pytest.mark.parametrize(("library", "room"), ONLY_IMPORTER.items())
def test_one_door_to_a_library(library, room):
    importers = {
        module.split(".")[0]
        for module, imported in IMPORTS.items()
        if any(name.split(".")[0] == library for name in imported)
    }
    assert importers == {room}


def test_nothing_is_imported_behind_the_parser_s_back():
    names = {"import_module", "__import__"}
    users = {
        module
        for module, path in MODULES.items()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", None)) in names
    }
    assert users <= {"rfmpm"}  # the public names load late; few modules stand above them


# The reader itself.


@pytest.mark.parametrize(
    ("source", "imported"),
    [
        ("import numba.core", {"numba.core"}),
        ("from rfmpm.mpm import scene as scenes", {"mpm.scene"}),
        ("from rfmpm.mpm.state import Axes, Grid", {"mpm.state"}),
        ("from rfmpm import seeds, load_study", {"seeds", "rfmpm"}),
        ("import rfmpm.study", {"study"}),
        ("def f():\n    if True:\n        from rfmpm import realisation", {"realisation"}),
        ("class A:\n    def f(self):\n        import mpi4py", {"mpi4py"}),
        ("from . import laws", {"mpm.laws"}),
        ("from .state import Axes", {"mpm.state"}),
        ("from ..study import Study", {"study"}),
    ],
)
def test_reader_finds_imports_at_any_depth(source, imported):
    assert imports_of(source, "mpm.scene", is_package=False) == imported


def test_reader_knows_where_a_package_stands():
    assert imports_of("from .elastic import Elastic", "mpm.laws", is_package=True) == {"mpm.laws.elastic"}


@pytest.mark.parametrize(
    ("module", "imported", "is_wrong"),
    [
        ("mpm.scene", "mpm.solvers.explicit", False),  # one floor, one room
        ("mpm.scene", "random_fields.field", True),  # one floor, two rooms
        ("mpm.laws.elastic", "mpm.scene", True),
        ("mpm.scene", "mpm.laws.elastic", False),
        ("study.load", "kernel_tools", False),
        ("study.load", "seeds", True),
        ("results.netcdf", "ensemble.runner", True),
        ("quantities.run_out", "rfmpm", True),
        ("realisation", "mpm", True),
        ("cli", "cost", False),
        ("ensemble.runner", "report", True),
    ],
)
def test_rule(module, imported, is_wrong):
    assert bool(wrongs(module, {imported})) == is_wrong


def test_a_module_without_a_floor_says_so():
    with pytest.raises(LookupError, match=r"rfmpm\.mpm\.plasma has no floor"):
        place_of("mpm.plasma")
