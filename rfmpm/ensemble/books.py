"""The books of a campaign: how many realisations ended how, and whether its failure policy lets it go on."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

from rfmpm.ensemble import codes
from rfmpm.variables import FAILED_CODES, STATUS, STATUS_NAMES

FEWEST = 10  # failures that end a campaign early; fewer are judged when it is complete


class CampaignFailed(RuntimeError):
    """A campaign that its failure policy ended; what is finished is on disk, and another policy continues it."""


class Books:
    """Counts rows by status, those of earlier runs included.

    Args:
        total: realisations of the campaign.
        before: rows by status that earlier runs have written.
        action: of the study's failure policy.
        allowed: share of failed realisations that is allowed.
        examples: codes of failed realisations of earlier runs by status, with their reasons.
    """

    def __init__(
        self,
        total: int,
        before: Mapping[int, int],
        action: str,
        allowed: float,
        examples: Mapping[int, tuple[int, str]] | None = None,
    ):
        self.total, self.action, self.allowed = total, action, allowed
        self.counts = Counter(before)
        self.before = sum(self.counts.values())
        self.done = self.failed = 0  # in this run
        self.examples = dict(examples or {})

    def enter(self, ended: Any) -> None:
        """Count a realisation that has ended.

        Args:
            ended: its code, status and reason.
        """
        self.counts[ended.status] += 1
        self.done += 1
        if ended.status in FAILED_CODES:
            self.failed += 1
            self.examples.setdefault(ended.status, (ended.code, ended.reason))

    def failures(self) -> dict[str, int]:
        """Count failed realisations, those of earlier runs included, by the name of their status."""
        return {
            STATUS_NAMES[code]: count for code, count in sorted(self.counts.items()) if code in FAILED_CODES and count
        }

    def why_not(self) -> str:
        """Say why the failure policy does not let the campaign go on; empty if it does."""
        failures = self.failures()
        failed = sum(failures.values())
        if failed and self.action == "abort":
            return (
                f'{self._example(next(iter(failures)))}, and failures.action = "abort"; mend what made it fail and run '
                "it once more (--repeat-failed, where a crash or a time limit ended it), or set failures.action to "
                '"record" or "retry" and run the same command again'
            )
        if failed > max(self.allowed * self.total, FEWEST - 1):
            commonest = max(failures, key=failures.__getitem__)
            return (
                f"{failed} of {self.total} realisations have failed, more than the allowed {self.allowed:.3g} of them "
                f"({', '.join(f'{count} {name}' for name, count in failures.items())}); most often: "
                f"{self._example(commonest)}; mend what made them fail and run them once more (--repeat-failed, where "
                "crashes or a time limit ended them), or raise failures.max_failed_fraction or --allow-failed and run "
                "the same command again to continue"
            )
        return ""

    def _example(self, name: str) -> str:
        code, reason = self.examples.get(STATUS[name], (None, ""))
        which = "a realisation" if code is None else codes.in_words(code)
        return f"{which} ended with status {name}" + (f": {reason}" if reason else "")
