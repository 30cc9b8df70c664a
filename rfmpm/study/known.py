"""The values of a study as far as they are right in themselves, for the checks that look at several of them."""

from typing import Any

from pydantic import BaseModel

from rfmpm.study.errors import Problem
from rfmpm.study.schema import KeyPath, field_at, value_at


class Unknown(LookupError):
    """A value that a check needs is missing or wrong."""


class Known:
    """The values of a study that are right in themselves, defaults filled in, looked up by dotted path.

    Args:
        model: the model of the whole study.
        data: the study as nested dicts and lists.
        doubtful: paths of the values that are wrong.
    """

    def __init__(self, model: type[BaseModel], data: dict, doubtful: set[KeyPath]):
        self.model, self.data, self.doubtful = model, data, doubtful

    def __getitem__(self, dotted: str) -> Any:
        path = path_of(dotted)
        if any(path[:length] in self.doubtful for length in range(1, len(path) + 1)):
            raise Unknown(dotted)
        value = value_at(self.data, path, default=...)
        if value is not ...:
            return value
        try:
            _, info = field_at(self.model, self.data, path)
        except (KeyError, TypeError):
            raise Unknown(dotted) from None
        if info is None or info.is_required():
            raise Unknown(dotted)
        return info.get_default(call_default_factory=True)


def path_of(dotted: str) -> KeyPath:
    """'material.0.name' as ('material', 0, 'name')."""
    return tuple(int(key) if key.isdecimal() else key for key in dotted.split("."))


def problem(known: Known, dotted: str, text: str) -> Problem:
    """What is wrong with the value at a dotted path."""
    return Problem(path_of(dotted), text, known[dotted])
