"""Frictional soil against what was published: aluminium bars, granular columns.

    python workflows/3_frictional.py

writes reports/frictional.md with its pictures. It takes about ten minutes on one core.
"""

from pathlib import Path

from rfmpm.benchmark.frictional.document import write

if __name__ == "__main__":
    write(Path(__file__).parents[1] / "reports", "python workflows/3_frictional.py", print)
