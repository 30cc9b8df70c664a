"""The repository's Markdown as its readers meet it: pages, blocks of code, words of code, links and headings."""

import importlib.util
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
_spec = importlib.util.spec_from_file_location("generated", ROOT / "docs" / "generated.py")
generated = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(generated)

FENCE = re.compile(r"^( *)(```+|~~~+)([^\n`]*)\n(.*?)^\1\2 *$", re.MULTILINE | re.DOTALL)
MARK = re.compile(r"<!-- ([^\n]*?) -->\n+\Z")
LINK = re.compile(r"(?<!\\)\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)")
HEADING = re.compile(r"^#{1,6} +(.+?) *#*$", re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A block of code: its language, the text, and the comment above it, empty if there is none."""

    page: str
    line: int
    language: str
    text: str
    mark: str

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"


def pages() -> list[Path]:
    """The README, the documentation and the reports."""
    folders = (ROOT / "docs", ROOT / "reports")
    found = [path for folder in folders for path in folder.rglob("*.md") if "_build" not in path.parts]
    return [ROOT / "README.md", *sorted(found)]


@cache
def text_of(path: Path) -> str:
    """A page with what the program itself tells."""
    return generated.fill(path.read_text(encoding="utf-8"))


def blocks(text: str, page: str) -> list[Block]:
    """The blocks of code of a page."""
    found = []
    for fence in FENCE.finditer(text):
        mark = MARK.search(text[: fence.start()])
        line = text.count("\n", 0, fence.start()) + 1
        found.append(Block(page, line, fence[3].strip(), fence[4], mark[1] if mark else ""))
    return found


def prose(text: str) -> str:
    """A page without its blocks and comments."""
    return re.sub(r"<!--.*?-->", "", FENCE.sub("", text), flags=re.DOTALL)


def words(text: str) -> list[str]:
    """Code between the words of a page; a line break in it is a space."""
    return [" ".join(word.split()) for word in re.findall(r"(?<!`)`([^`]+)`(?!`)", prose(text))]


def links(text: str) -> list[str]:
    """Where the links and pictures of a page lead."""
    return LINK.findall(re.sub(r"(?<!`)`[^`]+`(?!`)", "", prose(text)))


def anchors(text: str) -> set[str]:
    """The anchors of the headings of a page, as GitHub and MyST make them."""
    found: dict[str, int] = {}
    for heading in HEADING.findall(FENCE.sub("", text)):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
        anchor = re.sub(r"[^\w\- ]", "", plain.strip().lower()).replace(" ", "-")
        count = found[anchor] = found.get(anchor, -1) + 1
        if count:
            found[f"{anchor}-{count}"] = 0
    return set(found)
