"""The tables of a study file: types, ranges, units and defaults; what concerns several keys at once is in `checks`."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, Strict

from rfmpm.study.field_models import FieldLayer
from rfmpm.study.kinds import Inclination, Length, NotNegative, Number, Positive, Table, Text, whole
from rfmpm.study.schema import Hint

LARGEST_SEED = 2**63 - 1  # what a NetCDF attribute holds


class Campaign(Table):
    """[study]"""

    name: Text = Field(description="Title of the study")
    seed: Annotated[int, Strict()] = Field(ge=0, le=LARGEST_SEED, description="Seed of every random stream")
    realisations: Annotated[int, Strict()] = Field(1, ge=1, le=10_000_000, description="Number of realisations")


class SlopeGeometry(Table):
    """[geometry] of a slope on a firm base at the level of its toe"""

    kind: Literal["slope"]
    height_m: Length = Field(description="Height of the slope [m], a whole number of cells, at least 4")
    crest_m: Length = Field(description="Width of the crest [m], a whole number of cells, at least 2")
    angle_deg: Number = Field(ge=0.01, le=90, description="Inclination of the slope face [degrees]")
    foreland_m: Length = Field(description="Free length in front of the toe [m]")


class BlockGeometry(Table):
    """[geometry] of a rectangular body against the left side"""

    kind: Literal["block"]
    width_m: Length = Field(description="Width of the block [m], a whole number of cells")
    height_m: Length = Field(description="Height of the block [m], a whole number of cells")
    foreland_m: NotNegative = Field(le=1e6, description="Free length in front of the block [m]; 0 confines it")


Geometry = Annotated[SlopeGeometry | BlockGeometry, Field(discriminator="kind")]


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


class Datum(Table):
    """One measured value of a random variable"""

    x_m: Number = Field(description="Place [m]")
    y_m: Number = Field(description="Place, upwards [m]")
    value: Positive = Field(description="Measured value, in the unit of the material's own key: kPa for a cohesion")
    measurement_error: NotNegative | None = Field(
        None, le=2, description="Coefficient of variation of its error [1]. Default: that of the field"
    )


class RandomField(Table):
    """[random_field.<variable>]"""

    material: Text = Field(description="Name of the material whose variable is random")
    distribution: Literal["lognormal", "normal_truncated", "beta", "bounded_tanh", "gamma", "weibull", "empirical"] = (
        Field(description="Marginal distribution")
    )
    coefficient_of_variation: Annotated[Number, Hint("leave the random_field table out for no variation")] = Field(
        gt=0, le=2, description="Standard deviation over mean [1]"
    )
    lower_over_mean: NotNegative | None = Field(
        None, lt=1, description="Lower bound of a bounded distribution over the mean [1]. Default: 0"
    )
    upper_over_mean: Number | None = Field(
        None, gt=1, description="Upper bound of a bounded distribution over the mean [1]"
    )
    sample_file: Text | None = Field(
        None,
        description="Measured values that give an empirical distribution its shape: a CSV file with a header and a "
        "column value; beside the study file. Becomes `sample` when the study is loaded",
    )
    sample: Annotated[tuple[Positive, ...], Hint("in any unit")] | None = Field(
        None, description="Measured values that give an empirical distribution its shape; or give sample_file"
    )
    correlation: Literal[
        "markov_separable",
        "markov_ellipsoidal",
        "gaussian",
        "spherical",
        "matern",
        "second_order_markov",
        "cosine_exponential",
    ] = Field(description="Correlation")
    matern_nu: Number | None = Field(
        None, ge=0.05, le=20, description="Smoothness of the Matern correlation [1]: 0.5 rough, 2.5 smooth"
    )
    correlation_space: Literal["gaussian", "physical"] = Field(
        "gaussian",
        description="Whose correlation it is: that of the standard-normal field below the distribution (for a "
        "lognormal: of the logarithm), or of the variable itself",
    )
    nugget: NotNegative = Field(
        0.0, lt=1, description="Share of the variance that differs from point to point without correlation [1]"
    )
    scale_of_fluctuation_h_m: Positive = Field(description="Horizontal scale of fluctuation [m]")
    scale_of_fluctuation_v_m: Positive = Field(description="Vertical scale of fluctuation [m]")
    rotation_deg: Number = Field(0.0, ge=-180, le=180, description="Rotation of the axes, anticlockwise [degrees]")
    method: Literal[
        "auto",
        "cholesky",
        "kronecker",
        "ar1",
        "circulant",
        "karhunen_loeve",
        "local_average_subdivision",
        "nufft",
    ] = Field("auto", description="How the field is generated; auto: the fastest that is exact or errs by 5e-4 at most")
    averaging: Literal["point", "volume"] = Field(
        "point", description="What a value stands for: the field at the point, or its average over the point's volume"
    )
    data_file: Text | None = Field(
        None,
        description="Measured values that every realisation agrees with: a CSV file with a header x_m, y_m, value and, "
        "if errors differ, measurement_error; beside the study file. Becomes `data` when the study is loaded",
    )
    data: Annotated[tuple[Datum, ...], Hint("x_m, y_m and value each")] | None = Field(
        None, description="Measured values that every realisation agrees with; or give data_file"
    )
    measurement_error: NotNegative | None = Field(
        None, le=2, description="Coefficient of variation of the error of the data [1]. Default: exact"
    )
    trend_kpa_per_m: Number | None = Field(
        None, description="Gain of the mean per metre below the level of the crest [kPa/m]; left out: no trend"
    )
    standard_deviation_trend_kpa_per_m: Number | None = Field(
        None,
        description="Gain of the standard deviation per metre below the crest [kPa/m]; 0: the same at every depth; "
        "left out: proportional to the mean",
    )
    layer: tuple[FieldLayer, ...] | None = Field(
        None, description="Layers below the soil that the keys above describe, from the top down"
    )
    reference_cell_m: Length | None = Field(
        None, description="Cell size whose points carry the field, the same for every cell_m; left out: cell_m's own"
    )
    reference_value: Literal["mean", "point"] | None = Field(
        None, description="What a larger cell's point takes of the reference: mean over its square (default), or point"
    )


class Time(Table):
    """[time]"""

    end_s: Positive = Field(description="Model time at which a realisation ends at the latest [s]")
    initial_stress: Literal["elastic"] = Field("elastic", description="How the initial stresses are found")
    scheme: Literal["explicit"] = Field("explicit", description="Time integration")
    step_fraction: Positive = Field(
        0.8, le=1, description="Time step over the critical time step, cell over wave and point speed [1]"
    )


class Quantities(Table):
    """[quantities]"""

    displacement_threshold_m: Positive = Field(0.5, description="Displacement beyond which a point has failed [m]")
    front_quantile: Number = Field(
        0.995, ge=0.5, le=1, description="Share of the failed mass that lies behind the front [1]"
    )
    block_plastic_strain: Positive = Field(0.2, description="Plastic strain below which a point belongs to a block [1]")
    block_minimum_area_m2: NotNegative = Field(0.5, description="Area below which a block is not counted [m2]")
    run_out_limit_m: NotNegative = Field(5.0, description="The limit l in P(run-out > l) [m]")
    inundation_depth_m: Positive = Field(0.1, description="Depth from which a place counts as inundated [m]")


class Output(Table):
    """[output]"""

    directory: Text = Field(description="Folder of the results")
    surface_bin_m: Length | None = Field(
        None, description="Bin width of the final ground surface [m]; left out: no surface is kept"
    )
