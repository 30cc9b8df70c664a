"""The prose of the report: what was measured, what is kept, what is dropped and why."""

HEAD = """# Run time against error

Made by `rfmpm benchmark engine` on the machine it describes. CPU time is that of the process, compilation
excluded; every run takes half of its critical step. All measurements are in [{table}]({table}).

Two codes run the same scenes. The *plain solver* (`rfmpm/mpm/solvers/reference`) does any shape, transfer and order in
the same slow way, so its points compare schemes. The *production engine* does what is kept, fast; where both do the
same scheme they agree to rounding (`tests/unit/mpm/test_reference.py`). Its vortex is missing: it knows no body force.
"""

VERDICT = """## What is kept, what is dropped

The default is quadratic B-splines, FLIP with a slow relaxation towards FMPM(2), and MUSL. No scheme is best on every
scene; this one is never far from the front and fails on none. The reasons, with their figures in the table below:

- *Linear* shapes do best where points stay in their cells (the bar), and do not converge where points cross them (the
  column). Kept because published results were made with them.
- *GIMP* converges, with a larger error than the quadratic spline on column and vortex. Kept for
  comparison.
- *Cubic B-splines* alone go on converging on the finest columns. They are dearer in every step, no better in vortex and
  bar, and do not hold a body of one point per cell. Kept as a choice.
- *PIC* and *FMPM in every step* take a share of the motion in each step, however short it is. That ruins the bar, and
  PIC holds the slope back. Dropped.
- *APIC* and *TPIC* are as good as FLIP with splines on column and vortex and better on the bar, but dissipate in each
  step too: with splines they hold the slope back, with linear shapes they break on it. Dropped: the engine is for
  run-out.
- *FLIP alone* has the errors of the default, but nothing damps what the grid does not see, so that a slope takes longer
  to rest. Kept as the limit of the default at a rate of zero.
- *Orders*: with *MUSL* the points are strained by their updated velocities, mapped to the grid once more; with splines
  a fifth of the grid's own velocity is mixed in, without which noise drives thin soil on fine cells. With *stress
  last* linear shapes and GIMP blow up in an elastic block in the air, quadratic splines bear half the step, and the
  run-out of the slope falls as the step grows. *Stress first* is as good as MUSL in the air, and makes energy where
  soil slides on a wall. So the engine has MUSL alone, whose second pass the longer step more than pays for.
- *More points per cell* than four lower the error of splines on the column for a multiple of the time, raise that of
  linear shapes and GIMP there, and change little on the bar.

Differences of run-out below its own uncertainty, which stands with its figure, decide nothing. The plain solver has no
means over cells, so there its points differ from the engine's by more than the transfer.

Errors and CPU times below are over those of quadratic B-splines with FLIP + FMPM(2) in 5 s, MUSL, on the same cells:
geometric means over the grids, less than 1 is better.
"""

SPEED = """## Speed

Nanoseconds per point and step on the short slope with von Mises softening, one core, fresh from the start, and the
ratio to three plain loops (`rfmpm/benchmark/engine/plain_loop.py`) timed in turn with the others in the same run.
"""
