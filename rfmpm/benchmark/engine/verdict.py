"""The prose of the report: what was measured, what is kept, what is dropped and why."""

HEAD = """# Run time against error

Made by `rfmpm benchmark engine` on the machine it describes. CPU time is that of the process, compilation
excluded; every run takes half of its critical step. All measurements are in [{table}]({table}).

Two codes run the same scenes. The *plain solver* (`rfmpm/mpm/solvers/reference`) does any shape, transfer and order in
the same slow way, so its points compare schemes. The *production engine* does what is kept, fast; where both do the
same scheme they agree to rounding (`tests/unit/mpm/test_reference.py`). Its vortex is missing: it knows no body force.
"""

VERDICT = """## What is kept, what is dropped

**Kept as the default: quadratic B-splines, FLIP with FMPM(2) at a slow rate, stress last.** No scheme is best on every
scene. This one is never far from the front, and it has no scene on which it fails.

**Shapes.** *Linear* shapes are best where no point leaves its cell (the bar). Once points cross cells their errors
grow on finer grids (the column, and with FLIP the vortex). They stay because published results were made with them.
*GIMP* converges, costs more than the quadratic spline and needs a second mapping; it stays for comparison. The
*quadratic B-spline* has the least error for its time in the vortex and does well on the column and the slope. On fine
columns its error levels off, and so does that of GIMP. The *cubic B-spline* is the only one whose error there keeps
falling; it is no better in the vortex and worse on the bar, dearer in every step, and it does not hold a body of one
point per cell: offered, not the default.

**Transfers.** *PIC* and *FMPM in every step* take a share of the motion in each step. It does not show where little
moves against the grid (column, vortex) and ruins the bar, where PIC loses about a quarter of the energy in a period
and FMPM(4) still several per cent; on the slope PIC misses the run-out by more than half of it. Dropped. *APIC* and
*TPIC* are as good as FLIP with splines on column and vortex, and better on the bar; with linear shapes they break down
on the column, and on the slope, with splines and GIMP, they are further from the run-out than FLIP: they dissipate in
each step, however short it is. Dropped: the engine is for run-out. *FLIP alone* errs as the default does, but nothing
damps what the grid cannot see: on the slope that jitter makes it take several times as long to come to rest with every
shape but the quadratic spline. *FLIP with FMPM(2) in 5 s* has neither fault, for a few per cent of the time. Kept;
FLIP alone is its limit for a rate of zero.

**Orders.** *Stress last* without a second mapping is all that splines need. Linear shapes and GIMP blow up with it in
an elastic block in the air, at any time step, and linear ones on the slope too, so they get *MUSL*. *Stress first*
breaks with linear shapes on the column. With quadratic splines it and MUSL cost the plain solver the same as stress
last, err less on a coarse column and lose less of the bar's energy; on the fine column, in the phase and in the vortex
there is no difference. So the figures do not rule them out for splines. Stress last stays for now because the engine
then needs one pass over the points in a step; stress first is what to try next in the engine.

**Points per cell.** Nine or sixteen instead of four lower the error of quadratic splines on the column by up to two
fifths, for two to four times the time, and change little on the bar. GIMP gets worse on the column. Four stay the
default.

**Slope.** Differences of run-out below its own uncertainty, which stands with the figure, decide nothing: that goes
for cubic against quadratic splines and for GIMP in the engine. The plain solver has neither means over cells nor a
softening length, so its points differ from the engine's by more than the transfer.

**Step.** `COURANT` in `rfmpm/mpm/shapes` is from elastic blocks in the air: cubic splines are stable at 1.0 of a cell
per wave's passage and not at 1.1. Quadratic splines, whose value there is 0.8, were stable at 0.7 for every place of
the block and every number of points tried, and not for all at 0.8; the default of half of it leaves room for that.

Errors and CPU times below are over those of quadratic B-splines with FLIP + FMPM(2) in 5 s, stress last, on the same
cells: geometric means over the grids, less than 1 is better.
"""

SPEED = """## Speed

Nanoseconds per point and step on the short slope with von Mises softening, one core, fresh from the start, and the
ratio to three plain loops (`rfmpm/benchmark/engine/plain_loop.py`) timed in turn with the others in the same run.
"""
