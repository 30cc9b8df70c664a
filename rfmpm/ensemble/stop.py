"""How a worker is asked to end: by a signal, by a limit of wall-clock time, by a file in the folder."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf
from pathlib import Path

SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGUSR1") if hasattr(signal, name)]
HAS_TIMER = hasattr(signal, "setitimer")
LOOK_EVERY = 1.0  # seconds from one look at clock and file to the next


class Abandoned(BaseException):
    """Raised inside a realisation that is given up; a BaseException so that nobody takes it for a failure."""


class Stop:
    """Notices what asks for a clean end.

    Args:
        deadline: end then, on the clock of time.monotonic [s].
        look_every: seconds between two looks at the clock and the file.
    """

    def __init__(self, deadline: float = inf, look_every: float = LOOK_EVERY):
        self.deadline, self.look_every = deadline, look_every
        self.file: Path | None = None  # its appearance asks for the end
        self.on_look: Callable[[], None] | None = None
        self.count = 0
        self.reason = ""
        self._is_interruptible = False

    def __getstate__(self) -> dict:
        return {**self.__dict__, "on_look": None}

    @property
    def is_requested(self) -> bool:
        return self.count > 0

    def __call__(self, number: int, *_) -> None:
        """Take a signal."""
        self._request(f"the signal {signal.Signals(number).name} asked for the end")

    def look(self, *_) -> None:
        """Look at the clock and for the file."""
        if self.on_look is not None:
            self.on_look()
        if self.is_requested:
            return
        if time.monotonic() >= self.deadline:
            self._request("the limit of --wall-time was reached")
        elif self.file is not None and self.file.exists():
            self._request(f"the file {self.file.name} asked for the end")

    def _request(self, reason: str) -> None:
        self.count += 1
        self.reason = self.reason or reason
        if self._is_interruptible:
            self._is_interruptible = False  # once: what follows is the writing of finished rows
            raise Abandoned

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Take signals and look around while the body runs; outside the main thread, which alone may, do nothing."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        earlier = {number: signal.signal(number, self) for number in SIGNALS}
        if HAS_TIMER:
            earlier[signal.SIGALRM] = signal.signal(signal.SIGALRM, self.look)
            timer = signal.setitimer(signal.ITIMER_REAL, self.look_every, self.look_every)
        try:
            yield
        finally:
            if HAS_TIMER:  # before its handler goes
                signal.setitimer(signal.ITIMER_REAL, *timer)
            for number, handler in earlier.items():
                signal.signal(number, handler)

    def abandon_if_requested(self) -> None:
        """Raise Abandoned if something has asked for the end."""
        if self.is_requested:
            raise Abandoned

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Let what asks for the end raise Abandoned in the body; at once if it asked before.

        Not around compiled code: an exception that a signal raises while arguments go in or out may crash it.
        """
        try:
            self._is_interruptible = True
            if self.is_requested:
                raise Abandoned
            yield
        finally:
            self._is_interruptible = False
