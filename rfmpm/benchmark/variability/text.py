"""The words of random_field_study.md."""

PAGE = """\
# The short slope over variation, vertical scale and anisotropy of its strength

Made by `{command}`, which continues where it was stopped. Rows and summary
are in [{name}.nc]({name}.nc).

Slope, softening and cells are those of the main study (`configs/{name}.toml`): 5 m high, 45 degrees, cells of
{cell:g} m. Peak cohesion is lognormal with a mean of {mean:g} kPa, the residual {residual:g} / {mean:g} of the peak at
every point, the correlation separable Markov. Varied are the coefficient of variation ({variations}), the vertical
scale of fluctuation ({scales} m) and the ratio of the horizontal to the vertical scale ({ratios}).

Size: {combinations} combinations with {each} realisations each, {total} in all, of which {failed} failed. Plain Monte
Carlo. {hours} of one core, {per:.2f} s a realisation on a shared machine (15-minute load {load}).

How to read it:

- Intervals are 95 %: Student's t for means, Bonett's for standard deviations, order statistics for quantiles, Clopper
  and Pearson's for probabilities. The upper end of a 95 % quantile takes 72 realisations; it is unbounded ("?" in the
  map) with fewer.
- Realisation i has the same random numbers in every combination, so differences between combinations are taken pair by
  pair (Student's t; Agresti and Min for probabilities). The run-outs of such pairs, isotropic against not, correlate by
  {correlation} (median).
- A difference is called secure, and is bold in the tables, if 0 lies outside of an interval that allows for all
  differences of its column (Bonferroni: less than one false alarm in twenty such columns).
- The crest is {crest:g} m wide. In {lost} of the realisations the failure takes all of it: retrogression and volume are
  lower bounds there. They count as exceeding every threshold; means and standard deviations take them at their value.
  {far}

## What it means for a designer

{findings}

These hold for this slope, which fails with the mean strength, and for this softening.

## Effects on average

Each value against the first one of its dimension, on average over all combinations of the others. The average is taken
realisation by realisation, which makes it surer than any pair of combinations.

{effects}

## Mean and spread

![Mean of the three quantities over the coefficient of variation]({name}_mean.png)

![Standard deviation of the three quantities over the coefficient of variation]({name}_spread.png)

## Probability of more

![Exceedance curves of the run-out]({name}_run_out.png)

![Exceedance curves of the retrogression]({name}_retrogression_distance.png)

![Exceedance curves of the failure volume]({name}_failure_volume.png)

The curves of retrogression and volume end at the share of slopes that lose the whole crest.

## Failure and characteristic run-out at a glance

![P(run-out > {limit:g} m) and characteristic run-out of every combination]({name}_maps.png)

## Run-out in numbers

{run_out}

Stand: nothing moves beyond the toe.

## Retrogression and volume in numbers

{others}

## Differences

### Anisotropy: against a ratio of {first_scale_ratio} at the same variation and vertical scale

{anisotropy}

### Variation: against {first_coefficient_of_variation} at the same scales

{variation}

### Vertical scale: against {first_vertical_scale} m at the same variation and ratio

{scale}
"""
