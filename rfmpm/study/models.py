"""The tables of a study file: types, ranges, units and defaults; what concerns several keys at once is in `checks`."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, Strict

from rfmpm.study.field_models import FieldCorrelation, OwnField, Property
from rfmpm.study.kinds import Inclination, Length, NotNegative, Number, Positive, Table, Text, whole
from rfmpm.study.question_models import LARGEST_COUNT, Question
from rfmpm.study.schema import Hint

LARGEST_SEED = 2**63 - 1  # what a NetCDF attribute holds


class Campaign(Table):
    """[study]"""

    name: Text = Field(description="Title of the study")
    seed: Annotated[int, Strict()] = Field(ge=0, le=LARGEST_SEED, description="Seed of every random stream")
    realisations: Annotated[int, Strict(), Field(ge=1, le=LARGEST_COUNT)] | None = Field(
        None, description="Number of realisations. Default: 1; or give until"
    )
    until: Question | None = Field(None, description="A question to be answered, instead of a number of realisations")

    def model_post_init(self, context: object) -> None:
        """Let a number of realisations that is not given be 1 where no question decides it."""
        if self.realisations is None and self.until is None:
            object.__setattr__(self, "realisations", 1)


class Discretisation(Table):
    """[discretisation]"""

    cell_m: Annotated[Number, Field(ge=1e-6, le=1e6)] = Field(description="Side of the square cells [m]")
    points_per_cell: Annotated[Literal[1, 4, 9, 16], BeforeValidator(whole)] = Field(
        description="Material points in a full cell"
    )
    shape: Literal["linear", "gimp", "quadratic_bspline", "cubic_bspline"] = Field(description="Shape function")
    volumetric_strain: Literal["cell_mean", "point"] | None = Field(
        None,
        description="Volumetric strain and pressure: mean over the points of a cell, or each point's own. "
        "Default: point for a law with friction, else cell_mean",
    )
    dissipation_time_s: Annotated[float, Strict(), Hint("inf for no dissipation")] = Field(
        5.0, gt=0, description="Time in which the transfer damps velocities below the grid's resolution [s]; inf = none"
    )


class FixedBoundary(Table):
    """A boundary on which nothing moves"""

    kind: Literal["fixed"]


class RollerBoundary(Table):
    """A boundary that prevents motion across it and nothing else"""

    kind: Literal["roller"]


class FrictionBoundary(Table):
    """A boundary with Coulomb friction"""

    kind: Literal["friction"]
    coefficient: NotNegative = Field(description="Coulomb friction coefficient [1]")


BoundaryKind = Annotated[FixedBoundary | RollerBoundary | FrictionBoundary, Field(discriminator="kind")]


class Boundary(Table):
    """[boundary]"""

    base: BoundaryKind = Field(description="The firm base under the slope")
    sides: BoundaryKind = Field(description="The two vertical sides of the domain")


class ElasticMaterial(Table):
    """[[material]] that never yields"""

    name: Text = Field(description="Name by which other tables refer to the material")
    law: Literal["elastic"]
    unit_weight_kn_m3: Positive = Field(description="Unit weight [kN/m3]")
    youngs_modulus_kpa: Positive = Field(description="Young's modulus [kPa]")
    poissons_ratio: Number = Field(ge=0, le=0.49, description="Poisson's ratio [1]")
    random_field: dict[Property, OwnField] | None = Field(
        None, description="Random variables of this material alone; left out: none but those of [random_field]"
    )
    random_field_correlation: tuple[FieldCorrelation, ...] | None = Field(
        None, description="Correlation between these; left out: they are independent"
    )


class VonMisesMaterial(ElasticMaterial):
    """[[material]] with an undrained strength that softens linearly to a residual"""

    law: Literal["von_mises"]
    cohesion_kpa: Positive = Field(description="Peak cohesion [kPa], or the mean of its random field")
    residual_cohesion_kpa: Positive | None = Field(
        None, description="Residual cohesion [kPa], at most the peak; scales with a random peak. Default: the peak"
    )
    softening_modulus_kpa: NotNegative = Field(
        0.0, description="Loss of cohesion per unit plastic shear strain invariant [kPa]"
    )
    softening_reference_cell_m: Length | None = Field(
        None, description="Cell size the softening modulus refers to [m]; left out: the modulus is not scaled"
    )
    softening_length_m: Length | None = Field(
        None, description="Length of the soil over which softening is averaged [m]; left out: each point by itself"
    )
    viscosity_kpa_s: NotNegative = Field(
        0.0, description="Strength gained per rate of plastic shear (engineering) [kPa s]"
    )
    strength_convention: Literal["sqrt_j2", "sqrt_3j2"] = Field(
        "sqrt_j2", description="Invariant that equals the cohesion at yield; sqrt_j2: undrained strength"
    )

    def model_post_init(self, context: object) -> None:
        """Let a residual that is not given equal the peak, without counting it among the given keys."""
        if self.residual_cohesion_kpa is None:
            object.__setattr__(self, "residual_cohesion_kpa", self.cohesion_kpa)


class FrictionalMaterial(ElasticMaterial):
    """[[material]] with a drained strength that softens linearly with plastic strain to a residual

    One strain ends the fall of cohesion and of both angles; a modulus in kPa could not speak for angles.
    """

    cohesion_kpa: NotNegative = Field(description="Peak cohesion [kPa], or the mean of its random field")
    residual_cohesion_kpa: NotNegative | None = Field(
        None, description="Residual cohesion [kPa], at most the peak; scales with a random peak. Default: the peak"
    )
    friction_angle_deg: Inclination = Field(description="Peak angle of friction [degrees]")
    residual_friction_angle_deg: Inclination | None = Field(
        None, description="Residual angle of friction [degrees], at most the peak. Default: the peak"
    )
    dilation_angle_deg: Inclination = Field(
        0.0, description="Peak angle of dilation [degrees], at most that of friction"
    )
    residual_dilation_angle_deg: Inclination | None = Field(
        None, description="Residual angle of dilation [degrees], at most the peak. Default: the peak"
    )
    tension_cutoff_kpa: NotNegative | None = Field(
        None,
        description="Largest tension [kPa]: principal stress for mohr_coulomb, mean stress for drucker_prager; "
        "left out: what cohesion and friction leave",
    )
    residual_plastic_strain: Positive | None = Field(
        None, description="Plastic shear strain invariant at which cohesion and angles reach their residuals [1]"
    )
    softening_reference_cell_m: Length | None = Field(
        None, description="Cell size that strain refers to [m]; left out: the strain is not scaled"
    )

    def model_post_init(self, context: object) -> None:
        """Let residuals that are not given equal the peaks, without counting them among the given keys."""
        for peak in ("cohesion_kpa", "friction_angle_deg", "dilation_angle_deg"):
            if getattr(self, f"residual_{peak}") is None:
                object.__setattr__(self, f"residual_{peak}", getattr(self, peak))


class MohrCoulombMaterial(FrictionalMaterial):
    """[[material]] with a drained strength: Mohr-Coulomb"""

    law: Literal["mohr_coulomb"]


class DruckerPragerMaterial(FrictionalMaterial):
    """[[material]] with a drained strength: Drucker-Prager, which equals Mohr-Coulomb in plane strain flow"""

    law: Literal["drucker_prager"]


Material = Annotated[
    ElasticMaterial | VonMisesMaterial | MohrCoulombMaterial | DruckerPragerMaterial, Field(discriminator="law")
]


class Time(Table):
    """[time]"""

    end_s: Positive = Field(description="Model time at which a realisation ends at the latest [s]")
    initial_stress: Literal["elastic", "k0", "gravity_ramp"] = Field(
        "elastic",
        description="How the initial stresses are found. elastic: one static solve. k0: level ground at rest. "
        "gravity_ramp: gravity is raised slowly, with the soil's peak strength",
    )
    k0: Positive | None = Field(
        None,
        description="Horizontal over vertical stress, for initial_stress = k0 [1]. "
        "Default: 1 - sin(friction angle), or nu/(1-nu) without friction",
    )
    scheme: Literal["explicit"] = Field("explicit", description="Time integration")
    step_fraction: Positive = Field(
        0.8, le=1, description="Time step over the critical time step, cell over wave and point speed [1]"
    )


class HistoryPoint(Table):
    """[[history]] of the material point that lies nearest to a place at the start"""

    name: Text = Field(description="Name of the point in results")
    x_m: NotNegative = Field(description="Horizontal position [m]")
    y_m: NotNegative = Field(description="Height above the base [m]")


def _absent_if_false(value: object) -> object:
    """A wish that is denied is as if it were not there: the study and its hash stay as they are."""
    return None if value is False else value


SafetyMethod = Literal["bishop", "spencer", "morgenstern_price", "strength_reduction", True]


class Quantities(Table):
    """[quantities]"""

    displacement_threshold_m: Positive = Field(0.5, description="Displacement beyond which a point has failed [m]")
    front_quantile: Number = Field(
        0.995, ge=0.5, le=1, description="Share of the failed mass that lies behind the front [1]"
    )
    block_plastic_strain: Positive = Field(0.2, description="Plastic strain below which a point belongs to a block [1]")
    block_minimum_area_m2: NotNegative = Field(0.5, description="Area below which a block is not counted [m2]")
    run_out_limit_m: NotNegative = Field(5.0, description="The limit l in P(run-out > l) [m]")
    factor_of_safety: Annotated[SafetyMethod | None, BeforeValidator(_absent_if_false)] = Field(
        None, description="Whether rows hold the factor of safety of their field, and by which method; true: bishop"
    )
    inundation_depth_m: Positive = Field(0.1, description="Depth from which a place counts as inundated [m]")

    @property
    def safety_method(self) -> str | None:
        """Name of the method by which the factor of safety of a row is found; None where rows have none."""
        return "bishop" if self.factor_of_safety is True else self.factor_of_safety


class Output(Table):
    """[output]"""

    directory: Text = Field(description="Folder of the results")
    surface_bin_m: Length | None = Field(
        None, description="Bin width of the final ground surface [m]; left out: no surface is kept"
    )
    history_interval_s: Positive | None = Field(
        None, description="Model time from one sample of the [[history]] points to the next [s]. Default: 0.02"
    )


class Failures(Table):
    """[failures]: what a campaign does about realisations that fail; no result depends on it"""

    action: Literal["record", "retry", "abort"] = Field(
        "record",
        description="record: keep the failed row and go on. retry: first repeat what could end otherwise (crashed by "
        "an exception, timeout); a run that diverged or left the grid would do so again. abort: end at the first one",
    )
    retries: Annotated[int, Strict()] = Field(2, ge=1, le=100, description="How often one is repeated by retry")
    max_failed_fraction: Annotated[Number, Field(ge=0, le=1)] = Field(
        0.05, description="Share of all realisations beyond which failed ones, ten or more, end the campaign early [1]"
    )
    realisation_time_limit_s: Positive | None = Field(
        None, description="Elapsed time after which a realisation is given up as timeout [s]; left out: no limit"
    )
