"""The parts of the pages that the program itself tells: keys of a study, commands, variables of a result."""

import re
from collections.abc import Callable, Iterator
from typing import Any, get_args, get_origin

import typer
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rfmpm.cli import app
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
    for name, info in Study.model_fields.items():
        annotation = bare(info.annotation)
        kind = get_args(annotation)
        if name == "random_field":
            written, meaning = f"[{name}.VARIABLE]", f"VARIABLE is {allowed(kind[0], None)}. {info.description}."
            annotation = kind[1]
        else:
            is_list = get_origin(annotation) is tuple
            written, meaning = f"[[{name}]]" if is_list else f"[{name}]", _sentence(info.description)
            annotation = kind[0] if is_list else annotation
        yield from _chapter(written, annotation, meaning)


def _chapter(written: str, annotation: Any, meaning: str, depth: int = 2) -> Iterator[str]:
    """One table of a study file under a heading, in all of its kinds, and those within it."""
    yield from ("", f"{'#' * depth} `{written}`", "", meaning)
    members = tables(annotation)
    within: dict[str, tuple[Any, str]] = {}
    for member in members:
        if len(members) > 1:
            name = tag_name(members)
            yield from ("", f'{"#" * (depth + 1)} `{written}` with `{name} = "{tag_of(member, name)}"`')
        yield from ("", _own_words(member), "", "| key | holds | unit | default | meaning |", "|---|---|---|---|---|")
        for key, info in member.model_fields.items():
            yield _key_row(key, info)
            within |= _tables_within(written, key, info)
    for inner, (table, words) in within.items():
        like = next(name for name, (other, _) in within.items() if other == table)
        if like == inner:
            yield from _chapter(inner, table, words, depth + 1)
        else:
            yield from ("", f"{'#' * (depth + 1)} `{inner}`", "", f"{words} As `{like}`.")


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


def _tables_within(written: str, key: str, info: FieldInfo) -> dict[str, tuple[Any, str]]:
    annotation = bare(info.annotation)
    path = f"{written.strip('[]')}.{key}"
    if get_origin(annotation) is tuple and tables(get_args(annotation)[0]):
        return {f"[[{path}]]": (get_args(annotation)[0], _sentence(info.description))}
    return {f"[{path}]": (annotation, _sentence(info.description))} if tables(annotation) else {}


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
}
