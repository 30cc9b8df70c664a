"""Every total-stress simulation of the papers, run again: what they say, what is found, whether it agrees.

    python workflows/4_papers.py [CASE ...]

writes reports/papers/index.md and a page with pictures for each case; all of them if none is named.
"""

import argparse
from pathlib import Path

from rfmpm.benchmark.papers import CASES
from rfmpm.benchmark.papers.document import write

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="*", metavar="CASE", help=f"of {', '.join(CASES)}")
    names = parser.parse_args().case or list(CASES)
    if unknown := [name for name in names if name not in CASES]:
        parser.error(f"there is no case {', '.join(unknown)}: choose from {', '.join(CASES)}")
    write(names, Path(__file__).parents[1] / "reports" / "papers", "python workflows/4_papers.py", print)
