"""The tables of a study file for its random fields: each field, its layers and data, correlation between fields."""

from typing import Annotated, Literal

from pydantic import Field

from rfmpm.study.kinds import Length, NotNegative, Number, Positive, Table, Text
from rfmpm.study.schema import Hint

Property = Literal["cohesion", "residual_cohesion", "friction_angle"]


class FieldLayer(Table):
    """[[random_field.<variable>.layer]]: the soil below a line; what is left out is as in the soil above all lines"""

    top_m: Number = Field(description="Height of the layer's upper border at x = 0, the left side [m]")
    dip_deg: Number = Field(
        0.0, gt=-80, lt=80, description="Inclination of that border, anticlockwise from the x axis [degrees]"
    )
    mean_kpa: Positive | None = Field(None, description="Mean of a cohesion [kPa]; at the crest where it has a trend")
    mean_deg: Annotated[Number, Field(gt=0, le=80)] | None = Field(
        None, description="Angle whose tangent is the mean of the tangent of a friction angle [degrees]"
    )
    coefficient_of_variation: Annotated[Number, Field(gt=0, le=2)] | None = Field(
        None, description="Standard deviation over mean [1]"
    )
    scale_of_fluctuation_h_m: Positive | None = Field(None, description="Scale of fluctuation along the layer [m]")
    scale_of_fluctuation_v_m: Positive | None = Field(None, description="Scale of fluctuation across the layer [m]")
    rotation_deg: Annotated[Number, Field(ge=-180, le=180)] | None = Field(
        None,
        description="Rotation of the axes, anticlockwise [degrees]; left out: dip_deg, along the layer",
    )


class Datum(Table):
    """One measured value of a random variable"""

    x_m: Number = Field(description="Place [m]")
    y_m: Number = Field(description="Place, upwards [m]")
    value: Positive = Field(description="Measured value, in the unit of the material's own key: kPa for a cohesion")
    measurement_error: NotNegative | None = Field(
        None, le=2, description="Coefficient of variation of its error [1]. Default: that of the field"
    )


class OwnField(Table):
    """[material.random_field.<variable>] of the material in whose table it stands, about its own strength"""

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
        "local_kriging",
    ] = Field("auto", description="How the field is generated; auto: the fastest that is exact or errs by 5e-4 at most")
    karhunen_loeve_variance_share: Number | None = Field(
        None, gt=0, lt=1, description="Share of the variance that the modes of karhunen_loeve hold [1]. Default: 0.95"
    )
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


class _Materials(Table):
    material: Text = Field(description="Name of the material whose variable is random")
    shared_with: Annotated[tuple[Text, ...], Hint("names of materials")] | None = Field(
        None, description="Further materials through which the same field runs, about their own means; left out: none"
    )


class RandomField(OwnField, _Materials):
    """[random_field.<variable>] of the material that it names"""


class FieldCorrelation(Table):
    """[[random_field_correlation]] between two random fields of one material"""

    between: tuple[Property, Property] = Field(description="The two random fields")
    coefficient: Number = Field(gt=-1, lt=1, description="Correlation of their standard-normal fields at one point [1]")
