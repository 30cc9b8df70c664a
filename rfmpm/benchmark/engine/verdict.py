"""The prose of the report: what was measured, what is kept, what is dropped and why."""

HEAD = """# Run time against error

Made by `rfmpm benchmark engine` on the machine it describes. CPU time is that of the process, compilation
excluded; every run takes half of its critical step. All measurements are in [{table}]({table}).

Two codes run the same scenes. The *plain solver* (`rfmpm/mpm/solvers/reference`) does any shape, transfer and order in
the same slow way, so its points compare schemes. The *production engine* does what is kept, fast; where both do the
same scheme they agree to rounding (`tests/unit/mpm/test_reference.py`). Its vortex is missing: it knows no body force.
"""

VERDICT = """## What is kept, what is dropped

The production engine keeps one transfer, FLIP with a slow relaxation towards FMPM(2), and four shapes.

- PIC and FMPM in each step dissipate per step: they damp the swinging bar within a few periods and hold the slope back
  by more than a metre (PIC). APIC and TPIC serve the bar well and hold back the slope. All are left to the
  plain solver.
- FLIP without a filter is as close as with it where nothing jitters for long; the filter costs a few per cent and is
  what brings a slope to rest.
- Linear shapes have the least error of the bar, where points stay in their cells, and do not converge in the column,
  where points cross them. They are kept for speed and comparison.
- Quadratic B-splines are the default: on the front of the slope, with stress last and no second mapping. Cubic ones
  are closer in the column and cost more; GIMP lies between, and its small error of the slope on 0.5 m is a crossing of
  signs, since it grows on 0.25 m.
- Stress first is cheapest with linear shapes, on the front of the bar, and has their error in the column.

Errors and CPU times below are over those of quadratic B-splines with FLIP + FMPM(2) in 5 s, stress last, on the same
cells: geometric means over the grids, less than 1 is better.
"""

SPEED = """## Speed

Nanoseconds per point and step on the short slope with von Mises softening, one core, fresh from the start, and the
ratio to three plain loops (`rfmpm/benchmark/engine/plain_loop.py`) timed in turn with the others in the same run.
"""
