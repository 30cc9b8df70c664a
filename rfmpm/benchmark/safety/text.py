"""What the report says around its tables."""

REPORT = """# How right is the factor of safety, and what does it say?

Made by `rfmpm benchmark safety`.

## Against known factors

A factor divides the whole strength. On circles: the least over circular surfaces. Any shape: the least over circles and
over lines of twelve corners that start from circles, whole or cut off at a level, and are moved where the factor falls.
In brackets the error against the known factor, or against the nearer end of its range. Milliseconds: processor time of
one search on one core, the fastest of three, as beside every realisation of a campaign.

| case | known from | known | method | on circles | any shape | ms |
|---|---|---|---|---|---|---|
{cases}

- Taylor's numbers are read from a chart to three digits: 1 %. No public text that holds them was found, so that they
  are from memory. The spiral is an upper bound through the toe (Chen 1975).
- The referees' factors (Giam and Donald 1989) and those of Slide are as
  [XSLOPE's documentation]({source}) cites them, problems 1, 2, 3, 7 and 8 there: 1.00, 1.65, 1.39, 1.24 to 1.27; Slide
  itself has 0.987, 1.596, 1.405 by Bishop, 1.246 and 1.275 on 3a and 1.277 and 1.262 on 3b (Spencer, Morgenstern-Price;
  the referees' own 1.34 for 3b is not what any program there finds). On 1b Slide and XSLOPE come to 4 % less than here.
- Without friction all methods give one factor on one circle. Where cohesion pulls at the upper end of a steep surface,
  Spencer and Morgenstern-Price have no solution in which every slice holds back the one above it; such surfaces are
  left out, and the least of what is left can be too high. At 60 degrees with a friction of 10 degrees no circle whose
  factor is less than 10 % above the spiral's has one, and with ratios of shear to thrust down to -1 none less than 7 %,
  so that this is no fault of the search. Use Bishop there, which is the default; it leaves circles out on whose base
  pull takes more than 2 % of the resistance (with them it came to 2.4 % too low).
- Surfaces of any shape turn sharply only where the strength along them changes. With sharp corners anywhere
  Morgenstern-Price came to 4.8 % below the spiral and 2.4 and 2.8 % below 1a and 1c, though the line of thrust of
  these surfaces is no worse than that of circles: to ask that it stay inside the mass leaves 1a and 1c as they are and
  puts slopes of 60 degrees 11 to 18 % above the spiral. What such surfaces lack is the shear within the body above a
  corner. In soil with a thin weak seam surfaces of any shape are the only ones that find the slide.
- On a base with friction, surfaces run along it where they would cross it. Its friction, where it is less than the
  strength of the soil, is not divided by the factor. Where a circle meets the base the soil shears on the vertical
  above: Bishop's method counts the cohesion there.

On the short slope (5 m at 45 degrees, 20 kPa, without friction):

| friction of the base | limit analysis | bishop |
|---|---|---|
{bases}

## Beside another package

{peer}

## Against the simulation: {count} random fields of the short slope

Cells of 0.5 m; cohesion lognormal, mean 20 kPa, coefficient of variation 0.25, scales 6 m and 1 m. Bishop's factor of
the peak strength on circles; a slope has moved where a material point has by more than 0.5 m. The rows are in
[safety_rows.csv](safety_rows.csv). {origin}

P(factor < 1) = {weak}, P(displacement > 0.5 m) = {moved}. Above 1 and moved: {safe_but_moved} of all; below 1 and still
there: {weak_but_still}. The highest factor of a slope that moved is {highest_that_moved}, the lowest of one that stood
is {lowest_that_stood}.

![Factor of safety against largest displacement in four scenes](safety.png)

| displacement [m] | probability that it is exceeded |
|---|---|
{displacements}

Two things can be taken away, each alone and both: the friction of 0.3 on the base, of which the factor knows, and the
loss of strength from 20 to 4 kPa, of which it does not. The first fields, the same in each scene:

| scene | fields | P(factor < 1) | P(displacement > 0.5 m) | above 1, moved | below 1, still | parted best at |
|---|---|---|---|---|---|---|
{scenes}

Parted best at: the factor that most of those that moved are below and most of those that did not are above. Where
strength stays it is near 1, on either base: the two judge one slope. With both taken away who is below 1 without moving
half a metre has a factor of {lowest_that_stopped} or more: a slope that keeps its strength stops as its face flattens.
Where strength is lost, they differ by what the factor leaves out:

- Peak strength against progressive failure. The factor adds up the peak of every place on the surface, as if all were
  reached at once. Here a place that has reached its peak loses strength before the others reach theirs, and hands its
  load on. Where strength stays, slopes that move do so by about a metre; where it is lost, by ten, and there is hardly
  anything in between: a slope stays as it is or goes all the way.

Which strength to put into the factor, then? Residual strength is a fifth of the peak at every point here. On the base
that holds the factor is proportional to strength, so that the factors are those of the peak times 1, 0.6 and 0.2:

| strength | mean factor | P(factor < 1) |
|---|---|---|
{strengths}

The peak is too favourable, residual strength and the mean of both condemn every slope. At {share} % of the peak as many
have a factor below 1 there as move; that share belongs to this soil, and no factor says how far a slope goes.

![Fields that the two judge differently: strength with the critical circle, and where they ended](safety_examples.png)

The safest of the slopes that moved. Left the strength and the critical circle, right the end: {examples}.
"""
