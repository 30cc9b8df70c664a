"""The runner's own dispatcher, for schedules in which nothing is computed: one place that knows how to talk to it."""

from collections.abc import Callable

from rfmpm.ensemble.books import Books
from rfmpm.ensemble.dispatcher import Dispatcher, Todo
from rfmpm.ensemble.progress import Progress
from rfmpm.ensemble.worker import Ended, Report
from rfmpm.variables import STATUS

Answer = Callable[[int, int | None], int | None]  # (worker, what it has just finished) -> what it runs next


class Unwritten:
    """A journal of which nothing is kept."""

    def write(self, event: str, **details: object) -> None:
        """Forget the event."""


def open_desk(count: int) -> Answer:
    """Open a desk that hands out the realisations 0 to count - 1.

    Args:
        count: of realisations.

    Returns:
        Function of a worker and the realisation that it has finished (None at its start), which gives its next one, or
        None where nothing is left.
    """
    books, progress = Books(count, {}, "record", 1.0), Progress(count, 0, is_shown=False)
    dispatcher = Dispatcher(Todo([range(count)]), {}, books, Unwritten(), progress)

    def answer(worker: int, finished: int | None) -> int | None:
        ended = None if finished is None else Ended(finished, STATUS["ok"], "", 0.0)
        task = dispatcher.answer(worker, Report(ended))
        return None if task is None else task.code

    return answer
