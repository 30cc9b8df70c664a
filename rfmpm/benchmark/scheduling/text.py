"""The words of scheduling.md."""

TEXT = """\
# How well a campaign keeps its workers busy, and what it will cost

Made by `rfmpm benchmark scheduling` on two cores that other programs used too (load {load:.1f} at the end: so many
processes wanted a processor). Processor times are therefore what is compared; wall times are given beside them.

![Efficiency over ranks, and bias of stopping early](scheduling.png)

## What `rfmpm estimate` says, and what `rfmpm run` took

Steps come from trial realisations that run to rest, the time of a step from two workers side by side in the true scene.
Processor time counts everything from start to report; the campaign's wall time assumes processors that do nothing else.
Ranges of a realisation are the shortest and the longest.

{predictions}

## Overhead, measured

Realisations that sleep. Lost: time between two realisations of a worker (report, row, next index) over time in them.
Ideal: an even share for each worker, or the longest realisation. In order, nothing lost: what handing out one after the
other in order of index takes if everything else takes no time; the difference to ideal is the end, when some workers
have nothing left. A worker starts late by what it has to load once rank 0 has prepared the study, once per campaign.

{losses}

A claim that waits in line takes rank 0 {service:.3f} ms (message, dispatcher, journal, answer).

## 1000 ranks, simulated

{measured} realisations of the short slope (cells of 0.5 m) were measured; their times vary by a coefficient of
{variation:.2f}, the longest is {longest:.1f} times the mean. They are replayed, drawn at random and scaled, by the
runner's own dispatcher, which serves one claim at a time. Efficiency: an even share for each rank over what it takes.
With a mean of 10 s:

{tails}

The end of the campaign costs about half a realisation of every rank, whatever hands them out: with 10 per rank no
schedule that does not know the times beforehand reaches 95 %. What the desk costs is in the last column.

Where the desk is the limit, with 50 realisations per rank: it hands out one index every {service:.3f} ms, so that
ranks / mean time must stay below {most:.0f} per second.

{breaks}

## Stopping early

{campaigns} simulated campaigns of each kind, {ranks} ranks, stopped once {wanted} realisations are finished. Estimates
of the probability of failing (in the measured case {failing:.0f} % exceed the run-out limit) rest on the first {wanted}
finished; on the indices 0, 1, 2, ... without a gap at that moment, as a report of an unfinished campaign does; or on
the indices 0 to {last} once all of them are finished, as the estimate of a finished campaign does.

{biases}

The first finished are not a fair sample: the quick ones are among them. The indices without a gap are nearly one; what
is left is that the gap itself is likelier a slow realisation. A number of realisations fixed beforehand has no bias.
"""
