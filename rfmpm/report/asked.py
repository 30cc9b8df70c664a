"""What a study asks, as the page puts it: the quantity, and whether its mean, a quantile or an exceedance."""

from dataclasses import dataclass

from rfmpm.planning.questions import NOUNS, unit_of
from rfmpm.report import words

DEFINITIONS = {
    "run_out": "how far the soil travels beyond the toe",
    "retrogression_distance": "how far the failure eats back from the edge of the crest",
    "influence_distance": "from the back of the failure to the front of the deposit",
    "failure_volume": "soil that moves, per metre of slope",
    "initial_failure_volume": "soil that moves in the first slide, per metre of slope",
}
EXCEEDS = {
    "run_out": "How likely is the soil to travel more than {} beyond the toe?",
    "retrogression_distance": "How likely is the crest to fail more than {} back from its edge?",
    "influence_distance": "How likely is a slide to affect a stretch of more than {}?",
    "failure_volume": "How likely is more than {} of soil to fail?",
    "initial_failure_volume": "How likely is the first slide to bring down more than {} of soil?",
}
AMOUNTS = {
    "run_out": "How far does the soil travel beyond the toe{}?",
    "retrogression_distance": "How far back from its edge does the crest fail{}?",
    "influence_distance": "How long a stretch does a slide affect{}?",
    "failure_volume": "How much soil fails{}?",
    "initial_failure_volume": "How much soil does the first slide bring down{}?",
}


@dataclass(frozen=True)
class Asked:
    """The question of a study."""

    quantity: str
    limit: float | None = None  # asks for the probability of exceeding it [m or m3/m]
    quantile: float | None = None  # asks for the value that is not exceeded with this probability [-]

    @property
    def noun(self) -> str:
        """The quantity in words."""
        return NOUNS[self.quantity]

    @property
    def unit(self) -> str:
        """Unit of the quantity."""
        return unit_of(self.quantity).replace("m3", "m³")

    @property
    def is_probability(self) -> bool:
        """Whether the answer is a probability."""
        return self.limit is not None

    @property
    def answer_unit(self) -> str:
        """Unit of the answer; empty for a probability."""
        return "" if self.is_probability else self.unit

    @property
    def topic(self) -> str:
        """What the answer is the number of, e.g. "the mean run-out"."""
        if self.limit is not None:
            return f"the probability that the {self.noun} exceeds {self.limit:g} {self.unit}"
        if self.quantile is not None:
            return f"the {self.noun} that is exceeded in {_percent(1.0 - self.quantile)} of cases"
        return f"the mean {self.noun}"

    @property
    def sentence(self) -> str:
        """The question as a sentence."""
        if self.limit is not None:
            return EXCEEDS[self.quantity].format(f"{self.limit:g} {self.unit}")
        if self.quantile is not None:
            return AMOUNTS[self.quantity].format(f" in all but the worst {_percent(1.0 - self.quantile)} of cases")
        return AMOUNTS[self.quantity].format(" on average")


def _percent(share: float) -> str:
    return f"{words.number(100.0 * share, 2)} %"


def asked(question) -> Asked:
    """Turn a question of estimators into one that can be said.

    Args:
        question: a Question.

    Returns:
        The same question.
    """
    return Asked(question.quantity, question.limit, question.probability)
