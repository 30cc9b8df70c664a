"""What a page claims and is not so, in words: links, commands, parts of studies, names of Python."""

import ast
import importlib
import re
import shlex
import tomllib
from collections.abc import Iterator
from contextlib import chdir
from functools import cache
from itertools import groupby
from pathlib import Path
from urllib.parse import urlsplit

import pages
import typer
from pages import ROOT, Block

from rfmpm.cli import app
from rfmpm.cli.sweep import read_axis
from rfmpm.ensemble.sweep import cells
from rfmpm.stability import METHODS
from rfmpm.study import Study, StudyError, load_study

COMMANDS = typer.main.get_command(app)
LAUNCHERS = {"mpirun", "srun"}
OTHERS = {"export", "sbatch", "qsub", "squeue", "scancel", "touch", "cd", "git", "cp", "kill", "ncdump"}
WRITTEN_BY_THE_READER = "my_slope.toml"


def wrong_links(page: str, text: str) -> Iterator[str]:
    """Links that lead nowhere; of the world outside, their form alone."""
    for link in pages.links(text):
        target, _, anchor = link.partition("#")
        if "://" in link or link.startswith("mailto:"):
            if not (link.startswith(("https://", "http://")) and "." in urlsplit(link).netloc):
                yield link
            continue
        path = (ROOT / page).parent / target if target else ROOT / page
        if not path.exists():
            yield f"{link}: no such file"
        elif anchor and anchor not in pages.anchors(text if not target else pages.text_of(path.resolve())):
            yield f"{link}: no such heading"


def lines_of(text: str) -> Iterator[list[str]]:
    """The commands of a shell block, as words; assignments before them are left out."""
    for line in text.replace("\\\n", " ").splitlines():
        parts = shlex.split(line, comments=True)
        for is_end, group in groupby(parts, lambda word: word in ("&&", "||", "|", ";", "&")):
            command = list(group)
            while command and re.match(r"\w+=", command[0]):
                del command[0]
            if command and not is_end:
                yield command


def wrong_command(words: list[str]) -> str | None:
    """What is wrong with one command."""
    program = Path(words[0]).name
    if program in LAUNCHERS:
        place = next((i for i, word in enumerate(words) if Path(word).name == "rfmpm"), None)
        return "starts no rfmpm" if place is None else wrong_command(words[place:])
    if program == "rfmpm":
        return wrong_call(COMMANDS, words[1:])
    if program in ("python", "python3", "sbatch", "qsub", "cp"):
        missing = [word for word in words[1:] if word.startswith("workflows/") and not (ROOT / word).is_file()]
        return f"no {missing[0]}" if missing else None
    return None if program in OTHERS else f"{program}: not a command of these pages"


def wrong_call(command, arguments: list[str]) -> str | None:
    """What the command line would say to the arguments, without doing anything."""
    if hasattr(command, "commands"):
        name, *rest = arguments or [""]
        if name in ("--version", "--help"):
            return None
        return wrong_call(command.commands[name], rest) if name in command.commands else f"no command {name}"
    try:
        given = command.make_context(command.name, list(arguments)).params
    except typer.Exit:
        return None
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    study = given.get("study")
    is_there = study is None or (ROOT / study).is_file() or str(study) == WRITTEN_BY_THE_READER
    if not is_there and study.parts[0] != "results":
        return f"no study {study}"
    if given.get("method") not in (None, *METHODS):
        return f"no method {given['method']}"
    return _wrong_sweep(study, given["vary"]) if "vary" in given else None


def _wrong_sweep(study: Path, vary: list[str]) -> str | None:
    try:
        cells(load_study(ROOT / study), [read_axis(text) for text in vary])
    except (StudyError, typer.Exit) as error:
        return str(error)
    return None


def wrong_words(text: str) -> Iterator[str]:
    """Calls between the words: command and options, whose values may be left out or stand for others."""
    for word in pages.words(text):
        if not word.startswith("rfmpm "):
            continue
        command, rest = COMMANDS, word.split()[1:]
        while rest and rest[0] in getattr(command, "commands", {}):
            command = command.commands[rest.pop(0)]
        options = {option for parameter in command.params for option in parameter.opts} | {"--help"}
        is_group = command is COMMANDS and not set(rest) <= {"COMMAND", "...", "--help", "--version"}
        if is_group or not set(re.findall(r"--[a-z-]+", " ".join(rest))) <= options:
            yield word


def study_of(block: Block) -> Study:
    """The study that a block of TOML is, or is a part of."""
    own = tomllib.loads(block.text)
    found = re.fullmatch(r"into (\S+?)(?: without (.+))?", block.mark)
    base = ROOT / found[1] if found else ROOT / "study.toml"
    whole = tomllib.loads(base.read_text(encoding="utf-8")) if found else {}
    for path in (found[2] or "").split() if found else ():
        *tables, key = path.split(".")
        table = whole
        for name in tables:
            table = table[int(name) if name.isdecimal() else name]
        del table[key]
    with chdir(base.parent):  # to which the names of files are relative
        return load_study(_put_into(whole, own))


def _put_into(whole: dict, part: dict) -> dict:
    """Keys of a part replace those of the whole, table by table; a list is replaced as a whole."""
    merged = dict(whole)
    for key, value in part.items():
        both = isinstance(value, dict) and isinstance(whole.get(key), dict)
        merged[key] = _put_into(whole[key], value) if both else value
    return merged


def wrong_names(source: str) -> Iterator[str]:
    """What a Python block imports, or takes from a module it imports, and is not there."""
    modules = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                modules[alias.asname or alias.name.partition(".")[0]] = importlib.import_module(alias.name)
        elif isinstance(node, ast.ImportFrom):
            module = importlib.import_module(node.module)
            yield from (f"{node.module}.{alias.name}" for alias in node.names if not hasattr(module, alias.name))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            module = modules[node.value.id]
            if not hasattr(module, node.attr):
                yield f"{module.__name__}.{node.attr}"


@cache
def texts_of_the_program() -> str:
    """Every text in the sources of the program, and every piece of one between the values put into it."""
    sources = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "rfmpm").rglob("*.py"))]
    nodes = (node for source in sources for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Constant))
    return "\n".join(node.value for node in nodes if isinstance(node.value, str))


def wrong_messages(text: str) -> Iterator[str]:
    """Messages, first in the rows of a table of messages, that the program cannot say; numbers stand for others."""
    for table in re.findall(r"^\| message \|.*\n\|[-|]+\n((?:\|.*\n)+)", text, re.MULTILINE):
        for message in re.findall(r"^\| `([^`]+)`", table, re.MULTILINE):
            if not all(piece.strip() in texts_of_the_program() for piece in re.split(r"\d+", message)):
                yield message
