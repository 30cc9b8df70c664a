"""The page: frictional.md with its pictures."""

from collections.abc import Callable
from pathlib import Path

from rfmpm.benchmark.frictional import columns_page, pile_page
from rfmpm.benchmark.markdown import table

SECTIONS = (pile_page.section, columns_page.planar)


def write(folder: Path, command: str, tell: Callable[[str], None]) -> Path:
    """Run everything and write the page.

    Args:
        folder: where frictional.md and its pictures go; made if missing.
        command: that makes the page, to be named in it.
        tell: is told what each section comes to, line by line.

    Returns:
        The page's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    texts, findings = [], []
    for section in SECTIONS:
        found = section(folder)
        texts.append(found.text)
        findings += found.findings
        for line in found.findings:
            tell(line)
    path = folder / "frictional.md"
    head = HEAD.format(command=command, rows=table("what | published or asked | ours | ", findings))
    path.write_text("\n".join([head, *texts]), encoding="utf-8")
    return path


HEAD = """# Frictional soil against what was published

Made by `{command}`.

{rows}

The column of 2268 points and the slope of Toro Rojas et al. are among the [papers](papers/index.md).
"""
