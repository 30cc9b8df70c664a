"""The words of probabilities.md."""

TEXT = """\
# What a probability costs: estimators against a reference

Made by `rfmpm benchmark probabilities`. The slope is that of `configs/short_slope_random.toml` with its fields on a
lattice of 0.25 m cells. Its rows are kept in `probabilities_rows.nc`: {rows}. A realisation on cells of 0.5 m takes
{ratio:.3f} of the processor time of one on 0.25 m (measured in turns here); all costs below are in realisations on
0.25 m cells.

The rows with both cell sizes are {population} realisations. They are taken as the whole population: estimators draw
from them *with* replacement, so that what all of them give is the truth without an error of its own, and no interval
is flattered by a population of which half is drawn. Copies of a realisation share a fold of the estimators, which would
otherwise learn from the rows that they predict, and the field's components are shifted and turned so that their known
means and covariances hold in the population. {repeats} repeats where coverage is measured, {fewer} for an error alone,
{quantiles} of quantiles.

![Root-mean-square error over cost](probabilities.png)

## Error over cost, cells of 0.25 m

Gain: cost of plain Monte Carlo over that of the estimator at equal root-mean-square error.

{gains}

{reached}

Where the gain comes from: {difference}
Multilevel and control variates meet these few as rarely as they occur. Double sampling ("two phases") parts the coarse
runs at the gaps of their run-out into three and repeats as many of each part on the fine cells, so that a third of
these runs goes where the coarse ones leave the answer open.

## Bias and coverage, cells of 0.25 m

Bias in standard errors of its measurement; coverage of the 95 % intervals, of which 0.93 to 0.97 is what is asked.
Where not one of those few slopes is among the runs, nothing in the rows tells of them, and an interval of the mean by
multilevel or control variates is too narrow; one of a probability is not, since it allows for one that differs.

{coverage}

Outside of what is asked (bias within 2 standard errors, coverage 0.93 to 0.97): {missed}. Coverages of quantiles have a
standard error of 0.03, of the others 0.01.

## Bias and coverage, cells of 0.5 m

Truth: {coarse_rows} independent realisations. Designs are drawn in whole replicates of {replicate} points that fix
{components} principal components; what all of their rows and those of the truth err is in the standard error of the
bias. Variance ratio: of plain Monte Carlo with as many realisations over the estimator's.

{coarse}

## A small probability

{small} Plain Monte Carlo needs {plain} realisations for a relative error of 30 % of it.

{rare}

### Subset simulation on the slope

Levels of {level_size} realisations, of which {level_probability:.0%} start the next one, at most {subset_most} in all:

{subsets}
"""

RARE = """\
### Stratified sampling on the slope

`method = "stratified"`, at most {at_most} realisations, cells of 0.5 m; rows in `probabilities_rare_rows.nc`.

{stratified}

### Model problems with known probabilities

{most} realisations at most, {repeats} campaigns of each; relative root-mean-square error and coverage of the 95 %
intervals. Quantities are functions of 51 standard-normal numbers, of which the features hold 50. Stratified sampling
errs least where one direction drives the quantity and the probability is not far below 1e-3; where none does it is as
plain Monte Carlo. Subset simulation, which needs no direction, is the choice there, where the limit state bends in
several directions, and for much smaller probabilities.

{problems}"""
