"""What the report says around its tables."""

REPORT = """# How right is the factor of safety, and what does it say?

Made by `rfmpm benchmark safety`.

## Against known factors

A factor divides the whole strength. On circles: the least over circular surfaces. Any shape: the least over circles and
over lines of twelve corners that start from circles, whole or cut off at a level, and are moved where the factor falls.
In brackets the error against the known factor, or against the nearer end of its range. Milliseconds: processor time of
one search, which reads the soil of its points from nothing but three arrays, as beside every realisation of a campaign.

| case | known from | known | method | on circles | any shape | ms |
|---|---|---|---|---|---|---|
{cases}

- Taylor's numbers are read from a chart to three digits: 1 %. The spiral is an upper bound through the toe (Chen 1975).
  The referees' factors are given to two or three digits.
- Without friction all methods give one factor on one circle. Where cohesion pulls at the upper end of a steep surface,
  Spencer and Morgenstern-Price have no solution in which every slice holds back the one above it; such surfaces are
  left out, and the least of what is left can be too high. Use Bishop there, which is the default.
- Surfaces of any shape come out up to 5 % below the spiral where the same pull is large: limit equilibrium is no
  bound. In soil with a thin weak seam they are the only ones that find the slide.
- What slides on the firm base itself is not looked for: soil there is taken to hold by its own strength, so that a base
  with little friction makes a slope weaker than its factor says.

## Beside another package

{peer}

## Against the simulation: {count} random fields of the short slope

Cells of 0.5 m; cohesion lognormal, mean 20 kPa, coefficient of variation 0.25, scales 6 m and 1 m. Bishop's factor of
the peak strength on circles; a slope has moved where a material point has by more than 0.5 m. The rows are in
[safety_rows.csv](safety_rows.csv).

P(factor < 1) = {weak}, P(displacement > 0.5 m) = {moved}. Above 1 and moved: {safe_but_moved} of all. Below 1 and still
there: {weak_but_still}. The highest factor of a slope that moved is {highest_that_moved}, the lowest of one that stood
{lowest_that_stood}.

![Factor of safety against largest displacement in four scenes](safety.png)

| displacement [m] | probability that it is exceeded |
|---|---|
{displacements}

Two things that the simulation knows and the factor does not can be taken away, each alone and both: the friction of 0.3
on the base, and the loss of strength from 20 to 4 kPa. The first fields, the same in each scene:

| scene | fields | P(factor < 1) | P(displacement > 0.5 m) | above 1, moved | below 1, still |
|---|---|---|---|---|---|
{scenes}

The fall from one row to the next is what each of the two explains; what then still disagrees is close to a factor of 1,
or comes from the sudden release, from the shape of the surface (no circle is the worst one in a random field), and from
strength lost to the cells.

Which strength to put into the factor? Residual strength is a fifth of the peak at every point here, and without
friction the factor is proportional to strength, so that the three factors are those of the peak times 1, 0.6 and 0.2:

| strength | mean factor | P(factor < 1) |
|---|---|---|
{strengths}

The peak is not reached everywhere at once: soil at the toe has softened before that at the crest has yielded. The mean
strength is none of the soil's, but shows the side on which the truth lies.

![Fields that the two judge differently: strength with the critical circle, and where they ended](safety_examples.png)

Left the strength and the critical circle, right the end of the simulation. {examples}.
"""
