"""The prose of the report: what was measured, what is kept, what is dropped and why."""

HEAD = """# Run time against error

Made by `rfmpm benchmark engine` on the machine it describes. CPU time is that of the process, compilation
excluded; every run takes half of its critical step. All measurements are in [{table}]({table}).

Two codes run the same scenes. The *plain solver* (`rfmpm/mpm/solvers/reference`) does any shape, transfer and order in
the same slow way, so its points compare schemes. The *production engine* does what is kept, fast; where both do the
same scheme they agree to rounding (`tests/unit/mpm/test_reference.py`). Its vortex is missing: it knows no body force.
"""

VERDICT = """## What is kept, what is dropped

To be written from the figures.

Errors and CPU times below are over those of quadratic B-splines with FLIP + FMPM(2) in 5 s, stress last, on the same
cells: geometric means over the grids, less than 1 is better.
"""

SPEED = """## Speed

Nanoseconds per point and step on the short slope with von Mises softening, one core, fresh from the start, and the
ratio to three plain loops (`rfmpm/benchmark/engine/plain_loop.py`) timed in turn with the others in the same run.
"""
