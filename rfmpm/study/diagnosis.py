"""Turns a refusal by pydantic into problems in the words of the study file."""

from collections.abc import Callable
from copy import deepcopy

from pydantic import BaseModel, ValidationError

from rfmpm.study.errors import Problem
from rfmpm.study.schema import (
    KeyPath,
    allowed,
    child,
    choices,
    chosen,
    field_at,
    keys_of,
    near_miss,
    one_of,
    shown,
    tables,
    tag_name,
    tag_of,
    value_at,
)

TAG_ERRORS = ("union_tag_invalid", "union_tag_not_found")
LIMIT_ERRORS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
UNKNOWN_KEY = "extra_forbidden"


class Diagnosis:
    """What single keys of a study are refused for.

    Args:
        model: the model of the whole study.
        data: the study as nested dicts and lists.
        validate: validates such data and raises pydantic's error.

    Attributes:
        problems: one for each wrong key.
        data: the study, with a likely value where a `kind` or `law` was wrong.
        doubtful: paths whose values no further check should use.
    """

    def __init__(self, model: type[BaseModel], data: dict, validate: Callable[[dict], object]):
        self.model, self.data = model, deepcopy(data)
        self.problems: list[Problem] = []
        self._settled: set[KeyPath] = set()  # a `kind` or `law` that was all but right
        self._guessed: set[KeyPath] = set()  # a table whose `kind` or `law` could be anything
        refusals = self._refusals(validate)
        if wrong_tags := [refusal for refusal in refusals if refusal["type"] in TAG_ERRORS]:
            # Behind a wrong `kind` or `law` pydantic looks at nothing: put a likely one there and look again.
            for refusal in wrong_tags:
                self._settle_tag(self._path_of(refusal["loc"]))
            refusals = self._refusals(validate)
        for refusal in refusals:
            self._explain(refusal["type"], refusal["loc"])
        meant = {(*problem.path[:-1], problem.meant) for problem in self.problems if problem.meant}
        self.problems = [problem for problem in self.problems if not (problem.is_missing and problem.path in meant)]

    @property
    def doubtful(self) -> set[KeyPath]:
        return ({problem.path for problem in self.problems} - self._settled) | self._guessed

    def _refusals(self, validate: Callable[[dict], object]) -> list:
        try:
            validate(self.data)
        except ValidationError as error:
            return error.errors(include_url=False)
        return []

    def _path_of(self, location: tuple) -> KeyPath:
        """The path in the file: pydantic's location without the tags it puts where one of several tables was chosen."""
        annotation, data, path = self.model, self.data, []
        for key in location:
            if key == "[key]":
                break
            if len(members := tables(annotation)) > 1:
                annotation = chosen(members, data)
                continue
            path.append(key)
            try:
                annotation, _ = child(annotation, data, key)
            except KeyError:
                break
            data = value_at(data, (key,), default={})
        return tuple(path)

    def _settle_tag(self, path: KeyPath) -> None:
        """Report a wrong or missing `kind` or `law` and replace it by a likely one."""
        members = tables(field_at(self.model, self.data, path)[0])
        name, table = tag_name(members), value_at(self.data, path)
        tags = [tag_of(member, name) for member in members]
        if name not in table:
            known = set().union(*(member.model_fields for member in members))
            if misspelt := near_miss(name, [key for key in table if key not in known]):
                table[name] = table.pop(misspelt)
                self._add((*path, misspelt), f"unknown key (did you mean {name}?)", table[name], name)
            else:
                self._add((*path, name), f"missing; must be {one_of(tags)}")
        elif table[name] not in tags:
            self._add((*path, name), f"must be {one_of(tags, table[name])}", table[name])
        if (tag := table.get(name)) not in tags:
            table[name] = near_miss(tag, tags) if isinstance(tag, str) else None
        self._settled.add((*path, name))
        if table[name] is None:
            self._guessed.add(path)
            table[name] = tag_of(max(members, key=lambda member: len(member.model_fields.keys() & table.keys())), name)

    def _explain(self, kind: str, location: tuple) -> None:
        path = self._path_of(location)
        if kind == "missing":
            if path[:-1] not in self._guessed:
                self._add(path, f"missing; must be {allowed(*field_at(self.model, self.data, path))}")
        elif kind == UNKNOWN_KEY or location[-1] == "[key]":
            if path[:-1] not in self._guessed:
                self._explain_unknown_key(path)
        else:
            self._explain_value(kind, path)

    def _explain_unknown_key(self, path: KeyPath) -> None:
        annotation, _ = field_at(self.model, self.data, path[:-1])
        table = value_at(self.data, path[:-1])
        keys = keys_of(annotation, table)
        absent = [key for key in keys if key not in table]
        meant = near_miss(path[-1], absent) or near_miss(path[-1], keys, likeness=0.85)
        if meant:
            text = f"unknown key (did you mean {meant}?)"
        else:
            chooser = tag_name(members) if len(members := tables(annotation)) > 1 else None
            where = f" where {chooser} = {shown(table[chooser])}" if chooser else ""
            text = f"unknown key{where} (allowed here: {', '.join(keys)})"
        self._add(path, text, table[path[-1]], meant)

    def _explain_value(self, kind: str, path: KeyPath) -> None:
        annotation, info = field_at(self.model, self.data, path)
        value = value_at(self.data, path)
        if options := choices(annotation):
            text = one_of(options, value)
        else:
            text = allowed(annotation, info, with_type=kind not in LIMIT_ERRORS)
        if kind == "finite_number":
            text = text.replace("a number", "a finite number")
        if isinstance(value, str) and kind in ("float_type", "int_type"):
            text += ", without quotes"
        self._add(path, f"must be {text}", value)

    def _add(self, path: KeyPath, text: str, *value_and_meant) -> None:
        problem = Problem(path, text, *value_and_meant)
        if problem not in self.problems:
            self.problems.append(problem)
