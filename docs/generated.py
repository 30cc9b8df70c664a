"""The parts of the pages that the program itself tells: keys of a study, commands, variables of a result."""


def fill(text: str) -> str:
    """Put what the program tells in the place of its marks, such as `<!-- study keys -->`."""
    return text
