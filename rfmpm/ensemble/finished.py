"""Which realisations of a campaign have a row, and where it lies."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from rfmpm import results
from rfmpm.ensemble import codes
from rfmpm.variables import BY_CHANCE, FAILED_CODES

PLACES = np.dtype(
    [
        *(("code", "i8"), ("segment", "i4"), ("row", "i4"), ("status", "i1")),
        *(("value", "f8"), ("is_censored", "?"), ("step_count", "i4")),  # of the quantity in question; -1: unknown
    ]
)


class RowsDiffer(RuntimeError):
    """Two rows of one realisation that are not the same, though neither ended by chance: no campaign produces those."""


@dataclass(frozen=True)
class Segment:
    """A valid segment."""

    path: Path
    origin: str  # machine and versions that computed its rows
    is_whole: bool  # whether its rows have all that the study asks for


@dataclass(frozen=True)
class Finished:
    """Which realisations have a row and where it lies; 30 bytes each, the rows themselves stay on the disk."""

    segments: tuple[Segment, ...]
    places: np.ndarray  # one for each realisation on record, sorted; also of rows that lack what the study asks for

    @cached_property
    def _whole(self) -> np.ndarray:
        is_whole = np.array([segment.is_whole for segment in self.segments], bool)
        return self.places[is_whole[self.places["segment"]]]

    @cached_property
    def codes(self) -> np.ndarray:
        """Codes of the finished realisations, sorted, shape (n,)."""
        return np.ascontiguousarray(self._whole["code"])

    @cached_property
    def status(self) -> np.ndarray:
        """Code of STATUS of each of `codes`, shape (n,)."""
        return np.ascontiguousarray(self._whole["status"])

    @property
    def count(self) -> int:
        """Number of finished realisations."""
        return len(self.codes)

    @property
    def failed(self) -> int:
        """How many of them failed."""
        return int(np.isin(self.status, list(FAILED_CODES)).sum())

    def at(self, wanted: np.ndarray) -> np.ndarray:
        """Places of those among the wanted codes that are finished, sorted."""
        return self._whole[np.isin(self.codes, wanted, assume_unique=True)]


NOTHING = Finished((), np.empty(0, PLACES))


def one_each(segments: list[Segment], places: np.ndarray) -> np.ndarray:
    """Sort by realisation and keep one row each: a whole one before another, then one that did not end by chance
    before one that did (a crash, a time limit), then that of the segment found first.

    Args:
        segments: in which the rows lie.
        places: of the rows, shape (n,), dtype PLACES.

    Returns:
        Places sorted by realisation, shape (k,).

    Raises:
        RowsDiffer: if two rows of one realisation are not the same and neither ended by chance.
    """
    is_whole = np.array([segment.is_whole for segment in segments], bool)
    is_by_chance = np.isin(places["status"], list(BY_CHANCE))
    order = np.lexsort((places["segment"], is_by_chance, ~is_whole[places["segment"]], places["code"]))
    places, is_by_chance = places[order], is_by_chance[order]
    is_repeat = np.concatenate([[False], places["code"][1:] == places["code"][:-1]])[: len(places)]
    repeats = np.flatnonzero(is_repeat)
    kept = np.flatnonzero(~is_repeat)[np.cumsum(~is_repeat)[repeats] - 1]
    is_to_agree = ~(is_by_chance[kept] | is_by_chance[repeats])
    kept, repeats = kept[is_to_agree], repeats[is_to_agree]
    if len(repeats):
        pairs, group = np.unique(places["segment"][[kept, repeats]], axis=1, return_inverse=True)
        order = np.argsort(group.ravel(), kind="stable")
        of_pairs = np.split(order, np.searchsorted(group.ravel()[order], np.arange(1, pairs.shape[1])))
        for pair, at in zip(pairs.T, of_pairs, strict=True):
            _compare([segments[number] for number in pair], places[kept[at]], places[repeats[at]])
    return places[~is_repeat]


def _compare(pair: list[Segment], left: np.ndarray, right: np.ndarray) -> None:
    rows = zip((results.read_rows(segment.path) for segment in pair), (left["row"], right["row"]), strict=True)
    first, second = ({name: values[at] for name, values in stored.columns.items()} for stored, at in rows)
    for name, is_different in results.differences(first, second).items():
        at = int(np.argmax(is_different))
        raise RowsDiffer(
            f"{codes.in_words(left['code'][at])} has two different rows: {name} is {first[name][at]} in "
            f"{pair[0].path} and {second[name][at]} in {pair[1].path}"
        )
