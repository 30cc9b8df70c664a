"""StudyError, and one problem of a study: the key's path in the file, its value and what is allowed."""

from dataclasses import dataclass
from typing import Any

from rfmpm.study.schema import KeyPath, shown

ABSENT = object()


class StudyError(ValueError):
    """A study that cannot be run; `problems` lists everything that is wrong with it.

    Args:
        problems: one sentence each, "path = value: what is allowed (did you mean ...?)".
        source: the file the study was read from, if it was read from one.
    """

    def __init__(self, problems: list[str], source: str = ""):
        super().__init__(problems, source)
        self.problems = list(problems)
        self.source = source

    def __str__(self) -> str:
        head = f"{self.source}: " if self.source else ""
        if len(self.problems) == 1:
            return head + self.problems[0]
        return "\n  ".join([f"{head}{len(self.problems)} problems", *self.problems])


@dataclass(frozen=True)
class Problem:
    """What is wrong with one key; `meant` is the key it was probably meant to be, if it is an unknown one."""

    path: KeyPath
    text: str
    value: Any = ABSENT
    meant: str | None = None

    @property
    def is_missing(self) -> bool:
        return self.value is ABSENT

    def __str__(self) -> str:
        dotted = ".".join(str(key) for key in self.path)
        return f"{dotted}: {self.text}" if self.is_missing else f"{dotted} = {shown(self.value)}: {self.text}"
