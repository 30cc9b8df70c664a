"""What the README and its companions say is so: commands, paths, names and the Python example."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import typer
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from rfmpm.cli import app
from rfmpm.study import Study, load_study
from rfmpm.variables import PROVENANCE, VARIABLES

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
WORDS = re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```$", "", README, flags=re.MULTILINE | re.DOTALL))
COMMANDS = typer.main.get_command(app).commands
SECONDS = 240.0  # a guard against hanging, not a measure


def calls() -> list[tuple[str, list[str]]]:
    """Every `rfmpm command ...` in code: name and options."""
    code = "\n".join([*(text for _, text in BLOCKS), *WORDS])
    return [(name, re.findall(r"--[a-z-]+", rest)) for name, rest in re.findall(r"\brfmpm ([a-z]\w*)(.*)", code)]


def marked(name: str) -> str:
    """The code block below a mark."""
    return re.search(rf"^<!-- {name} command -->\n```bash\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)[1]


def section(title: str) -> str:
    return re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", README, re.MULTILINE | re.DOTALL)[1]


def test_two_commands_are_one_line_each_and_install_the_same():
    run, test = marked("run").splitlines(), marked("test").splitlines()
    assert len(run) == len(test) == 1
    assert run[0].rpartition(" && ")[0] == test[0].rpartition(" && ")[0]


def test_every_command_and_option_exists():
    assert {name for name, _ in calls()} == set(COMMANDS)
    for name, options in calls():
        assert set(options) <= {option for parameter in COMMANDS[name].params for option in parameter.opts}


def test_every_path_exists():
    links = [link for link in re.findall(r"\]\(([^)\s]+)\)", README) if "://" not in link]
    paths = [word for word in WORDS if re.fullmatch(r"[\w.]+(/[\w.]+)+/?", word) and not word.startswith("results/")]
    assert links
    assert paths
    assert [path for path in [*links, *paths] if not (ROOT / path).exists()] == []


def test_every_variable_of_a_result_is_named():
    table = "\n".join(line for line in section("What a result holds").splitlines() if line.startswith("| `"))
    assert set(re.findall(r"`(\w+)`", table)) == {*VARIABLES, *PROVENANCE, "realisation", "level"}


def test_every_table_of_a_study_is_named():
    tables = re.findall(r"^\| `\[+([\w.]+)\]+`", section("The study file"), re.MULTILINE)
    assert {table.partition(".")[0] for table in tables} == set(Study.model_fields)


def test_python_example_runs(tmp_path):
    """As a script of its own, on a slope of so few cells that it takes a moment."""
    coarse = {
        "discretisation.cell_m": 1.0,
        "geometry.crest_m": 4.0,
        "geometry.foreland_m": 8.0,
        "time.end_s": 1.0,
        "output.surface_bin_m": 1.0,
        "material.0.softening_length_m": 1.0,
    }
    config = "configs/short_slope_random.toml"
    (tmp_path / "configs").mkdir()
    (tmp_path / config).write_text(load_study(ROOT / config).with_changes(coarse).to_toml(), encoding="utf-8")
    (example,) = (text for language, text in BLOCKS if language == "python")
    assert config in example
    assert "realisations=32" in example
    script = tmp_path / "example.py"
    script.write_text(example.replace("realisations=32", "realisations=2"), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, script], cwd=tmp_path, capture_output=True, text=True, timeout=SECONDS, check=False
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 2
    assert (tmp_path / "results" / "tougher" / "ensemble.nc").is_file()


def test_constraints_are_names_and_versions_of_all_that_is_required():
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = dict(line.split("==") for line in lines if not line.startswith("#"))
    assert all(re.fullmatch(r"[\w.-]+", name) and re.fullmatch(r"[\w.]+", version) for name, version in pins.items())
    versions = {canonicalize_name(name): version for name, version in pins.items()}
    extras = PROJECT["optional-dependencies"].values()
    required = [*PROJECT["dependencies"], *(text for extra in extras for text in extra)]
    for requirement in map(Requirement, required):
        assert requirement.specifier.contains(versions[canonicalize_name(requirement.name)])


@pytest.mark.parametrize("pattern", [r"^version: (\S+)$", r"^license: (\S+)$"])
def test_citation_agrees_with_the_package(pattern):
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    key = pattern[1:].partition(":")[0]
    assert re.search(pattern, text, re.MULTILINE)[1] == PROJECT[key]
