"""The words of probabilities.md."""

TEXT = """\
# What a probability costs: estimators against a reference

Made by `rfmpm benchmark probabilities`. The slope is that of `configs/short_slope_random.toml` with its fields on a
lattice of 0.25 m cells. Its rows are kept in `probabilities_rows.nc`: {rows}. A realisation on cells of 0.5 m takes
{ratio:.3f} of the processor time of one on 0.25 m (measured in turns here); all costs below are in realisations on
0.25 m cells. Estimators draw realisations from these rows, without putting them back, {repeats} times each
(quantiles {fewer}).

![Root-mean-square error over cost](probabilities.png)

## Error over cost, cells of 0.25 m

Gain: cost of plain Monte Carlo over that of the estimator at equal root-mean-square error; corrected for drawing
without putting back. Reference: control variates on all rows, which the draws share, so that errors look smaller than
they are by what the reference itself errs (in the table). Plain Monte Carlo, whose gain is 1 by definition, shows how
far such figures are off: few rows end differently on the two cell sizes, and these make most of the difference.

{gains}

## Bias and coverage, cells of 0.25 m

Bias in standard errors, the reference's own error included; coverage of the 95 % intervals, of which 0.93 to 0.97 is
what is asked; realisations on 0.25 m cells.

{coverage}

## Bias and coverage, cells of 0.5 m

Reference: {coarse_rows} independent realisations. Designs are drawn in whole replicates of {replicate} points that fix
{components} principal components. Variance ratio: of plain Monte Carlo with as many realisations over the estimator's.

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
