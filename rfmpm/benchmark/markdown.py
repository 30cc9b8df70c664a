"""Parts of the pages that benchmarks write."""

from collections.abc import Iterable


def table(head: str, rows: Iterable[str]) -> str:
    """A table of Markdown; its cells are told apart by |."""
    return "\n".join([f"| {head} |", "|" + "---|" * (head.count("|") + 1), *(f"| {row} |" for row in rows)])
