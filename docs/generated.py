"""The parts of the pages that program and reports tell themselves: keys, commands, variables, pictures of papers."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, get_args, get_origin

import typer
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rfmpm.cli import app
from rfmpm.report.modes import MEANINGS, NAMES
from rfmpm.study import Study
from rfmpm.study.schema import allowed, bare, shown, tables, tag_name, tag_of
from rfmpm.variables import (
    COORDINATES,
    HISTORY_VARIABLES,
    MOTION_VARIABLES,
    POINT_VARIABLES,
    PROVENANCE,
    VARIABLES,
    Variable,
)

UNIT = re.compile(r" ?\[(m|m2|m3/m|s|1|degrees|kPa|kPa s|kPa/m|kN/m3|unit of the key)\]")
SETTING = re.compile(r"\{study\.([\w.]+)(?::g)?\}(?: m2?)?")  # a value in the text of a file, with its unit
COMMANDS = typer.main.get_command(app)


def fill(text: str) -> str:
    """Put what the program tells in the place of its marks, such as `<!-- study keys -->`."""
    return re.sub(r"^<!-- ([a-z ]+) -->$", lambda mark: _told(mark[1]) or mark[0], text, flags=re.MULTILINE)


def _told(name: str) -> str | None:
    return "\n".join(MARKS[name]()) if name in MARKS else None


def study_keys() -> Iterator[str]:
    """Every table of a study file, with its keys."""
    told: dict[tuple, str] = {}
    for name, info in Study.model_fields.items():
        yield from _chapter(*_table_at(name, info), told, 2)


def _chapter(written: str, annotation: Any, meaning: str, told: dict[tuple, str], depth: int) -> Iterator[str]:
    """One table of a study file under a heading, in all of its kinds, and those within it; no table is told twice."""
    members = tuple(tables(annotation))
    like = told.setdefault(members, written)
    yield from ("", f"{'#' * depth} `{written}`", "", meaning if like == written else f"{meaning} As `{like}`.")
    if like != written:
        return
    within: dict[str, tuple[str, Any, str]] = {}
    for member in members:
        if len(members) > 1:
            name = tag_name(members)
            yield from ("", f'{"#" * (depth + 1)} `{written}` with `{name} = "{tag_of(member, name)}"`')
        yield from ("", _own_words(member), "", "| key | holds | unit | default | meaning |", "|---|---|---|---|---|")
        for key, info in member.model_fields.items():
            yield _key_row(key, info)
            if (inner := _table_at(f"{written.strip('[]')}.{key}", info)) is not None:
                within[inner[0]] = inner
    for inner in within.values():
        yield from _chapter(*inner, told, min(depth + 1, 4))


def _table_at(path: str, info: FieldInfo) -> tuple[str, Any, str] | None:
    """How the table under a key is written, what it may be, and what it means; None where no table is."""
    annotation, meaning = bare(info.annotation), _sentence(info.description)
    arguments, origin = get_args(annotation), get_origin(annotation)
    if origin is dict:
        return f"[{path}.VARIABLE]", arguments[1], f"{meaning} VARIABLE is {allowed(arguments[0], None)}."
    if origin is tuple:
        return (f"[[{path}]]", arguments[0], meaning) if tables(arguments[0]) else None
    return (f"[{path}]", annotation, meaning) if tables(annotation) else None


def _own_words(member: type[BaseModel]) -> str:
    """What a table says of itself, unless that is its name alone."""
    words = re.sub(r"^(\[+[^\]]+\]+( until)?)", r"`\1`", member.__doc__.splitlines()[0])
    return "" if re.fullmatch(r"`[^`]*`", words) else _sentence(words)


def _key_row(key: str, info: FieldInfo) -> str:
    meaning = info.description or "Which of the kinds"
    units = UNIT.findall(meaning)
    default = "needed" if info.is_required() else "" if info.default is None else f"`{shown(info.default)}`"
    holds = "a table, below" if tables(info.annotation) else allowed(info.annotation, info)
    cells = (f"`{key}`", holds, units[0] if units else "", default, UNIT.sub("", meaning))
    return _row(cells)


def commands() -> Iterator[str]:
    """Every command with its arguments and options."""
    yield from _command("rfmpm", COMMANDS, 1)


def _command(name: str, command: Any, depth: int) -> Iterator[str]:
    context = typer.Context(command, info_name=name)
    if depth > 1:
        yield from ("", f"{'#' * depth} `{name}`", "", command.help)
    records = filter(None, (parameter.get_help_record(context) for parameter in command.params))
    if rows := [_row((f"`{word.removesuffix(' <list[Path]>')}`", meaning)) for word, meaning in records]:
        yield from ("", "| argument or option | meaning |", "|---|---|", *rows)
    for inner in getattr(command, "commands", {}).values():
        yield from _command(f"{name} {inner.name}", inner, depth + 1)


def result_variables() -> Iterator[str]:
    """Every variable of the files that a campaign and a simulation write."""
    yield from ("", "## `ensemble.nc`")
    yield from _variable_table([*COORDINATES.values(), *VARIABLES.values(), *PROVENANCE.values()])
    yield from ("", "## `simulation.nc`")
    yield from _variable_table([*POINT_VARIABLES.values(), *HISTORY_VARIABLES.values(), *MOTION_VARIABLES.values()])


def kinds_of_failure() -> Iterator[str]:
    """The kinds of failure that a report tells apart."""
    yield from ("| kind | is |", "|---|---|")
    yield from (_row((name.lower(), MEANINGS[key])) for key, name in NAMES.items())


def papers() -> Iterator[str]:
    """The first picture of every paper that was run again, with what it shows and the command that makes it."""
    for path in sorted((Path(__file__).parents[1] / "reports" / "papers").glob("*.md")):
        text = path.read_text(encoding="utf-8")
        title, picture = re.search(r"^# (.+)$", text, re.MULTILINE), re.search(r"!\[(.*?)\]\((.+?)\)", text)
        made = re.search(r"`(python workflows/[^`]+)`", text)
        if title and picture and made:
            yield from ("", f"![{picture[1]}](../reports/papers/{picture[2]})", "")
            yield f"{_sentence(title[1])} {picture[1]} `{made[1]}`, [report](../reports/papers/{path.name})"


def _variable_table(variables: list[Variable]) -> Iterator[str]:
    yield from ("", "| variable | dimensions | unit | meaning |", "|---|---|---|---|")
    for variable in variables:
        comment = SETTING.sub(r"`\1`", variable.attributes.get("comment", ""))
        comment = comment.replace("quantities.safety_method", "quantities.factor_of_safety")
        flags = variable.attributes.get("flag_meanings", "").split()
        states = ", ".join(
            f"{value} {name}" for value, name in zip(variable.attributes.get("flag_values", ()), flags, strict=True)
        )
        meaning = " ".join(filter(None, (_sentence(variable.long_name), comment, states and f"{states}.")))
        yield _row((f"`{variable.name}`", ", ".join(variable.dims), variable.unit, meaning))


def _row(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _sentence(text: str | None) -> str:
    """A description as a sentence: with a capital and a full stop."""
    return f"{text[0].upper()}{text[1:].rstrip('.')}." if text else ""


MARKS: dict[str, Callable[[], Iterator[str]]] = {
    "study keys": study_keys,
    "commands": commands,
    "result variables": result_variables,
    "kinds of failure": kinds_of_failure,
    "papers": papers,
}
