"""How far a campaign is: a bar on a terminal, now and then a line elsewhere; on standard error."""

import sys
import time
from datetime import timedelta

LINE_EVERY = 10.0  # seconds


class Progress:
    """Shows finished and failed realisations, their rate and the time left.

    The clock starts when its context is entered; the display appears at the first `show`.

    Args:
        total: realisations of the campaign, or of its plan so far.
        before: how many of them are finished.
        is_shown: False for silence.
    """

    def __init__(self, total: int, before: int, is_shown: bool = True):
        self.is_shown = is_shown
        self.bar = None
        self.started = self.last_line = time.monotonic()
        self.begin(total, before)

    def begin(self, total: int, before: int, expected: int | None = None) -> None:
        """Take up a round.

        Args:
            total: realisations that are planned so far.
            before: how many of them are finished.
            expected: how many there may be in the end; None where that is `total`, or is not known.
        """
        self.total, self.before, self.expected = total, before, expected
        self.is_complete = False

    def __enter__(self) -> "Progress":
        self.started = time.monotonic()
        return self

    def __exit__(self, *_) -> None:
        if self.bar is not None:
            self.bar.stop()
            self.bar = None

    def show(self, done: int, failed: int) -> None:
        """Bring the display up to date.

        Args:
            done: realisations finished in this run.
            failed: how many of those failed.
        """
        if not self.is_shown or self.is_complete:
            return
        self.is_complete = self.before + done == self.total
        if sys.stderr.isatty():
            self._show_bar(done, failed)
        elif (self.is_complete and self.expected is None) or time.monotonic() - self.last_line >= LINE_EVERY:
            self.last_line = time.monotonic()
            print(self.line(done, failed), file=sys.stderr, flush=True)

    def line(self, done: int, failed: int) -> str:
        """Write the state as one line; arguments as for `show`."""
        left = self.seconds_left(done)
        time_left = "time left unknown" if left is None else f"{timedelta(seconds=round(left))} left"
        rate = f"{self.per_minute(done):.3g} per minute"
        in_all = f" of this round, about {self.expected:,} in all" if self.expected is not None else ""
        return f"{self.before + done}/{self.total} realisations, {rate}, {time_left}{in_all}, {failed} failed"

    def seconds_left(self, done: int) -> float | None:
        """Estimate the time left from the rate of this run.

        Args:
            done: realisations finished in this run.

        Returns:
            Seconds, or None before the first one is finished.
        """
        if not done:
            return None
        return (self.total - self.before - done) * (time.monotonic() - self.started) / done

    def per_minute(self, done: int) -> float:
        """Rate of this run [1/min]; argument as for `seconds_left`."""
        return 60.0 * done / max(time.monotonic() - self.started, 1e-9)

    def _show_bar(self, done: int, failed: int) -> None:
        if self.bar is None:
            from rich import progress
            from rich.console import Console

            self.bar = progress.Progress(
                progress.BarColumn(),
                progress.MofNCompleteColumn(),
                progress.TextColumn("{task.fields[remark]}"),
                console=Console(stderr=True),
                refresh_per_second=2,
            )
            self.bar.add_task("realisations", total=self.total, remark="")
            self.bar.start()
        remark = self.line(done, failed).split(", ", 1)[1]
        self.bar.update(self.bar.task_ids[0], completed=self.before + done, remark=remark)
