"""The tables of a study file for its geometry: slopes, blocks, and regions of any shape."""

from typing import Annotated, Literal

from pydantic import Field

from rfmpm.study.kinds import Length, NotNegative, Number, Table, Text
from rfmpm.study.schema import Hint

Place = tuple[Number, Number]
Corners = Annotated[tuple[Place, ...], Hint("[x, y] in m, three or more, in order around it")]
AT_SLOPES = (
    "[m]; left out: found from the ground surface, the face being what is at least half as steep as the steepest"
)


class Cut(Table):
    """[[geometry.cut]]: soil that is there when the initial stresses are found, and gone when the run begins"""

    corners_m: Corners = Field(description="Corners of what is cut or excavated")


class Layer(Table):
    """[[geometry.layer]] of a slope: horizontal, from the crest down; below the last one lies the first material"""

    material: Text = Field(description="Name of its material")
    thickness_m: Length = Field(description="Thickness [m]")


class Bench(Table):
    """[[geometry.bench]]: a level step in the face of a slope"""

    height_m: Length = Field(description="Height above the toe [m]")
    width_m: Length = Field(description="Width of the step [m]")


class SlopeGeometry(Table):
    """[geometry] of a slope on a firm base at the level of its toe, or on a foundation"""

    kind: Literal["slope"]
    height_m: Length = Field(description="Height of the slope [m], a whole number of cells, at least 4")
    crest_m: Length = Field(description="Width of the crest [m], a whole number of cells, at least 2")
    angle_deg: Number = Field(ge=0.01, le=90, description="Inclination of the slope face [degrees]")
    foreland_m: Length = Field(description="Free length in front of the toe [m]")
    foundation_m: Length | None = Field(None, description="Depth of soil below the level of the toe [m]")
    foundation_material: Text | None = Field(None, description="Name of its material. Default: the first material")
    layer: tuple[Layer, ...] | None = Field(None, description="Layers from the crest down")
    bench: tuple[Bench, ...] | None = Field(None, description="Steps in the face")
    cut: tuple[Cut, ...] | None = Field(None, description="Soil that is removed when the run begins")


class BlockGeometry(Table):
    """[geometry] of a rectangular body against the left side"""

    kind: Literal["block"]
    width_m: Length = Field(description="Width of the block [m], a whole number of cells")
    height_m: Length = Field(description="Height of the block [m], a whole number of cells")
    foreland_m: NotNegative = Field(le=1e6, description="Free length in front of the block [m]; 0 confines it")


class Region(Table):
    """[[geometry.region]]: a polygon of one soil"""

    name: Text = Field(description="Name of the region")
    material: Text = Field(description="Name of its material")
    corners_m: Corners | None = Field(None, description="Its corners, in any sense of rotation; or give file")
    file: Text | None = Field(
        None,
        description="A polygon: .geojson or .json, .csv with a header x_m, y_m, or .dxf (a closed polyline); beside "
        "the study file; of several polygons that of the region's name. Becomes corners_m when the study is loaded",
    )


class RegionsGeometry(Table):
    """[geometry] of polygons: x from the left side, y from the base up, the slope descending to the right"""

    kind: Literal["regions"]
    region: Annotated[tuple[Region, ...], Hint("written [[geometry.region]]")] = Field(
        description="The regions of soil"
    )
    foreland_m: NotNegative = Field(
        le=1e6, description="Free length to the right of the regions [m]; 0: they end at a wall"
    )
    headroom_m: Length | None = Field(
        None, description="Free height above the highest ground [m]. Default: half its height, at least four cells"
    )
    toe_m: NotNegative | None = Field(None, description=f"x of the toe, from which run-out is measured {AT_SLOPES}")
    crest_edge_m: NotNegative | None = Field(
        None, description=f"x of the edge of the crest, from which retrogression is measured {AT_SLOPES}"
    )
    cut: tuple[Cut, ...] | None = Field(None, description="Soil that is removed when the run begins")


class Load(Table):
    """[[load]]: a pressure on the ground, there from the start, initial stresses included; it moves with the soil"""

    from_m: NotNegative = Field(description="x of its left end [m]")
    to_m: NotNegative = Field(description="x of its right end [m]")
    pressure_kpa: Annotated[Number, Field(gt=0)] = Field(description="Pressure [kPa]")


class Obstacle(Table):
    """[[obstacle]]: a rigid wall or building, into which soil does not move"""

    corners_m: Corners = Field(description="Corners of its section")
    friction: NotNegative = Field(0.0, description="Coulomb friction coefficient of its faces [1]")


Geometry = Annotated[SlopeGeometry | BlockGeometry | RegionsGeometry, Field(discriminator="kind")]
