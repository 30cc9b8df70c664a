"""Bad input on the command line: one clear message, exit code 2, no traceback."""

import subprocess
import sys
import tomllib
from copy import deepcopy
from pathlib import Path

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from rfmpm.cli import app
from rfmpm.study import StudyError, load_study

TABLES = tomllib.loads((Path(__file__).parents[2] / "configs" / "short_slope_random.toml").read_text())
MISTAKES = {
    "misspelt key": ("material.0.poisons_ratio", 0.33, "unknown key (did you mean poissons_ratio?)"),
    "text for a number": ("material.0.cohesion_kpa", "20", "must be a number greater than 0, without quotes"),
    "negative modulus": ("material.0.youngs_modulus_kpa", -1000.0, "must be greater than 0"),
    "Poisson's ratio 0.5": ("material.0.poissons_ratio", 0.5, "must be at least 0 and at most 0.49"),
    "zero scale": ("random_field.cohesion.scale_of_fluctuation_v_m", 0.0, "must be greater than 0"),
    "negative scale": ("random_field.cohesion.scale_of_fluctuation_h_m", -6.0, "must be greater than 0"),
    "no variation": ("random_field.cohesion.coefficient_of_variation", 0, "leave the random_field table out"),
    "variation of 5": ("random_field.cohesion.coefficient_of_variation", 5, "greater than 0 and at most 2"),
    "residual above the peak": ("material.0.residual_cohesion_kpa", 25.0, "at most the peak, cohesion_kpa = 20"),
    "field of no material": ("random_field.cohesion.material", "sand", 'names no material; must be "clay"'),
    "crest of zero width": ("geometry.crest_m", 0.0, "must be greater than 0"),
    "slope that does not fit its cells": ("geometry.height_m", 5.1, "nearest: 5 or 5.25"),
}
COMMANDS = ["check", "run", "simulate", "field", "estimate"]


def with_mistake(path, value):
    tables = deepcopy(TABLES)
    *parents, key = [int(part) if part.isdecimal() else part for part in path.split(".")]
    table = tables
    for parent in parents:
        table = table[parent]
    if key == "poisons_ratio":
        del table["poissons_ratio"]
    table[key] = value
    return tables


def write(folder, tables):
    path = folder / "study.toml"
    path.write_text(tomli_w.dumps(tables))
    return str(path)


@pytest.mark.parametrize("mistake", MISTAKES)
def test_one_clear_message_and_exit_code_2(tmp_path, mistake):
    path, value, said = MISTAKES[mistake]
    result = CliRunner().invoke(app, ["check", write(tmp_path, with_mistake(path, value))])
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 1
    assert f"study.toml: {path} = " in result.stderr
    assert said in result.stderr
    assert result.stdout == ""


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_refuses_a_wrong_study_before_it_writes_anything(tmp_path, monkeypatch, command):
    path, value, _ = MISTAKES["negative modulus"]
    study = write(tmp_path, with_mistake(path, value))
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, [command, study])
    assert result.exit_code == 2
    assert "youngs_modulus_kpa = -1000.0" in result.stderr
    assert [entry.name for entry in tmp_path.iterdir()] == ["study.toml"]


def test_all_mistakes_at_once_are_all_reported(tmp_path):
    tables = deepcopy(TABLES)
    tables["material"][0] |= {"youngs_modulus_kpa": -1.0, "residual_cohesion_kpa": 25.0, "poissons_ratio": 0.5}
    tables["geometry"] |= {"height_m": 5.1, "crest_m": 0.0}
    tables["random_field"]["cohesion"] |= {"material": "sand", "coefficient_of_variation": 5}
    tables["time"]["end"] = tables["time"].pop("end_s")
    result = CliRunner().invoke(app, ["check", write(tmp_path, tables)])
    assert result.exit_code == 2
    assert "8 problems" in result.stderr
    for key in ["youngs_modulus_kpa", "residual_cohesion_kpa", "poissons_ratio", "height_m", "crest_m", "material = "]:
        assert key in result.stderr
    assert "coefficient_of_variation = 5" in result.stderr
    assert "did you mean end_s?" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["check"],
        ["check", "no_such.toml"],
        ["check", "."],
        ["run", "--workers", "0", "x.toml"],
        ["simulate", "--index", "-1", "x.toml"],
        ["run", "--realisations", "many", "x.toml"],
        ["report", "no_such_folder"],
        ["unheard_of"],
        ["run", "--unheard-of"],
        ["run"],
    ],
    ids=" ".join,
)
def test_wrong_command_line_is_exit_code_2(arguments):
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 2
    assert result.stderr
    assert "Traceback" not in result.stderr


def test_real_process_ends_with_the_code_and_without_traceback(tmp_path):
    study = write(tmp_path, with_mistake(*MISTAKES["misspelt key"][:2]))
    command = [sys.executable, "-c", "from rfmpm.cli import main; main()", "check", study]
    process = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert process.returncode == 2
    assert "did you mean poissons_ratio?" in process.stderr
    assert "Traceback" not in process.stderr


# --- any misspelling of any key


def key_paths(value, path=()):
    for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
        if isinstance(key, str):
            yield (*path, key)
        if isinstance(entry, dict | list):
            yield from key_paths(entry, (*path, key))


@st.composite
def misspellings(draw):
    """A key's path in the study, and the key with one letter dropped, doubled, replaced or swapped with the next."""
    path = draw(st.sampled_from(list(key_paths(TABLES))))
    key = path[-1]
    place = draw(st.integers(0, len(key) - 2))
    letter = draw(st.sampled_from("abcdefghijklmnopqrstuvwxyz_ABC"))
    wrong = draw(
        st.sampled_from(
            [
                key[:place] + key[place + 1 :],
                key[:place] + letter + key[place:],
                key[:place] + letter + key[place + 1 :],
                key[:place] + key[place + 1] + key[place] + key[place + 2 :],
            ]
        ).filter(lambda word: word != key)
    )
    return path, wrong


@settings(max_examples=300, deadline=None)
@given(misspellings())
def test_any_misspelt_key_is_refused_with_the_right_suggestion(misspelling):
    path, wrong = misspelling
    tables = deepcopy(TABLES)
    table = tables
    for key in path[:-1]:
        table = table[key]
    table[wrong] = table.pop(path[-1])
    with pytest.raises(StudyError) as refusal:
        load_study(tables)
    (problem,) = refusal.value.problems
    assert problem.startswith(".".join(map(str, (*path[:-1], wrong))))
    assert f"did you mean {path[-1]}?" in problem


# --- any rubbish anywhere

RUBBISH = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.just([]), st.just({}), st.just([{}])
)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(list(key_paths(TABLES))), RUBBISH), min_size=1, max_size=3))
def test_rubbish_is_refused_in_words_or_accepted_but_never_ends_in_another_error(replacements):
    tables = deepcopy(TABLES)
    for path, rubbish in sorted(replacements, key=lambda entry: -len(entry[0])):
        table = tables
        for key in path[:-1]:
            table = table[key]
        table[path[-1]] = deepcopy(rubbish)
    problems = []
    try:
        load_study(tables)
    except StudyError as refusal:
        problems = refusal.problems
    assert not [problem for problem in problems if "Input should" in problem]
