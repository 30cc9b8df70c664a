"""Records of several kinds for points that follow each other, such as a law for the points of each soil."""

from itertools import pairwise
from typing import NamedTuple


class Ranges(NamedTuple):
    """A record for each range of points; None where there is nothing for it."""

    records: tuple
    bounds: tuple  # first point of each range, and one after the last

    def each(self):
        """List record, first point and one after the last of each range."""
        return [(record, *ends) for record, ends in zip(self.records, pairwise(self.bounds), strict=True)]


def mapped(function, record):
    """The record that a function makes of one, or the Ranges of those it makes of each; None stays None."""
    if isinstance(record, Ranges):
        return Ranges(tuple(mapped(function, own) for own in record.records), record.bounds)
    return None if record is None else function(record)


def each_record(record):
    """The records of all ranges, or the one record, without what is None."""
    own = record.records if isinstance(record, Ranges) else (record,)
    return [one for one in own if one is not None]


def join(records, counts):
    """Join the records of ranges of so many points; a single one stays as it is, and nothing is None."""
    if all(record is None for record in records):
        return None
    if len(records) == 1:
        return records[0]
    bounds = [0]
    for count in counts:
        bounds.append(bounds[-1] + count)
    return Ranges(tuple(records), tuple(bounds))
