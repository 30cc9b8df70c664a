"""A range of indices on the command line."""

import re

import typer


def index_range(text: str | None) -> tuple[int, int] | None:
    """Read "A:B", from A up to B, itself not included.

    Args:
        text: as given; None if it was not.

    Returns:
        The two numbers, or None.

    Raises:
        BadParameter: for anything else, or if B is not larger than A.
    """
    if text is None:
        return None
    found = re.fullmatch(r"(\d+):(\d+)", text)
    if not found or int(found[1]) >= int(found[2]):
        raise typer.BadParameter(f"{text}: must be A:B, from A up to but not including B, such as 0:100")
    return int(found[1]), int(found[2])
