"""The tables of a study file for what is asked of a campaign and how it is answered: [study] until, [estimator]."""

from typing import Annotated, Literal

from pydantic import Field, Strict

from rfmpm.study.kinds import NotNegative, Number, Positive, Table

Count = Annotated[int, Strict()]
LARGEST_COUNT = 10_000_000  # of realisations


class Question(Table):
    """[study] until: what is asked, and how well it is to be known; at 95 % confidence"""

    quantity: Literal[
        "run_out", "retrogression_distance", "influence_distance", "failure_volume", "initial_failure_volume"
    ] = Field(description="The quantity in question")
    exceeds_m: NotNegative | None = Field(
        None, description="Ask for the probability that a distance exceeds this [m]; left out with quantile: the mean"
    )
    exceeds_m3_per_m: NotNegative | None = Field(
        None, description="Ask for the probability that a volume exceeds this [m3/m]"
    )
    quantile: Annotated[Number, Field(gt=0, lt=1)] | None = Field(
        None, description="Ask for the value that is not exceeded with this probability [1]"
    )
    half_width: Annotated[Number, Field(gt=0, lt=0.5)] | None = Field(
        None, description="Go on until the interval of a probability is this close to its middle [1]"
    )
    half_width_m: Positive | None = Field(None, description="Such, of the mean or quantile of a distance [m]")
    half_width_m3_per_m: Positive | None = Field(None, description="Such, of the mean or quantile of a volume [m3/m]")
    relative_half_width: Annotated[Number, Field(gt=0, lt=10)] | None = Field(
        None, description="Such, as a share of the estimate [1]"
    )
    at_most: Annotated[Count, Field(ge=1, le=LARGEST_COUNT)] | None = Field(
        None, description="End with so many simulations of the study's own cells, answered or not"
    )

    @property
    def limit(self) -> float | None:
        """What the quantity is asked to exceed, in its unit; None where that is not the question."""
        return self.exceeds_m if self.exceeds_m is not None else self.exceeds_m3_per_m

    @property
    def width(self) -> float | None:
        """Half width of the interval to be reached, in the unit of the answer; None if none or a relative one is."""
        return next((w for w in (self.half_width, self.half_width_m, self.half_width_m3_per_m) if w is not None), None)


class Estimation(Table):
    """[estimator]: how a campaign answers; left out: plain Monte Carlo"""

    method: Literal["monte_carlo", "multilevel", "control_variate", "two_phase", "stratified", "subset_simulation"] = (
        Field("monte_carlo", description="What the answer is made of")
    )
    sampling: Literal["random", "latin_hypercube", "sobol", "saltelli"] = Field(
        "random", description="How the random variables of monte_carlo are chosen: independent, or by a design"
    )
    coarser_cells_m: tuple[Positive, ...] | None = Field(
        None, description="Cell sizes of coarser, cheaper simulations of the same fields, ascending [m]"
    )
    replicate_size: Annotated[Count, Field(ge=2, le=LARGEST_COUNT)] | None = Field(
        None, description="Points of one independent randomisation of a design. Default: 64"
    )
    principal_components: Annotated[Count, Field(ge=1, le=10_000)] | None = Field(
        None,
        description="Leading components of the fields that a design fixes, two_phase takes or stratified looks for its "
        "direction in (default: 32), or that control_variate takes (default: none)",
    )
    pilot_size: Annotated[Count, Field(ge=20, le=LARGEST_COUNT)] | None = Field(
        None, description="Plain realisations from which stratified finds its first direction. Default: 100"
    )
    level_size: Annotated[Count, Field(ge=10, le=LARGEST_COUNT)] | None = Field(
        None, description="Realisations of one level of subset_simulation. Default: 500"
    )
    level_probability: Annotated[Number, Field(gt=0, le=0.5)] | None = Field(
        None, description="Share of a level of subset_simulation from which the next one starts [1]. Default: 0.1"
    )

    @property
    def fair_size(self) -> int | None:
        """First realisations that are a fair sample where later ones are chosen by what came before; None: all are."""
        fair = {
            "two_phase": FIRST_OF_TWO_PHASES,
            "stratified": self.pilot_size,
            "subset_simulation": self.level_size,
        }
        return fair.get(self.method)

    def model_post_init(self, context: object) -> None:
        """Fill in what the method reads and is not given, without counting it among the given keys."""
        for key, default in DEFAULTS.items():
            if (
                getattr(self, key) is None
                and reads(key, self.method, self.sampling)
                and self.method != "control_variate"
            ):
                object.__setattr__(self, key, default)


DEFAULTS = {
    "replicate_size": 64,
    "principal_components": 32,
    "pilot_size": 100,
    "level_size": 500,
    "level_probability": 0.1,
}
TOWARDS_LIMIT = ("stratified", "subset_simulation")  # methods whose realisations follow from others, nearer the limit
FIRST_OF_TWO_PHASES = 32
READERS = {
    "coarser_cells_m": ("multilevel", "control_variate", "two_phase"),
    "replicate_size": ("latin_hypercube", "sobol"),
    "principal_components": ("latin_hypercube", "sobol", "control_variate", "two_phase", "stratified"),
    "pilot_size": ("stratified",),
    "level_size": ("subset_simulation",),
    "level_probability": ("subset_simulation",),
}


def reads(key: str, method: str, sampling: str) -> bool:
    """Whether a method, or how it samples, reads a key of [estimator]."""
    return method in READERS[key] or sampling in READERS[key]
