"""Random fields of several materials in a study file: what is accepted, what is refused, in which words."""

from copy import deepcopy
from pathlib import Path

import pytest
from three_soils import CLAY, FIELD, ROCK, SAND

import rfmpm
from rfmpm.study import StudyError

CONFIGS = Path(__file__).parents[3] / "configs"
OWN = "material.1.random_field"


def tables(**more):
    regions = [
        {"name": "up", "material": "clay", "corners_m": [[0, 4], [6, 4], [4, 6], [0, 6]]},
        {"name": "middle", "material": "sand", "corners_m": [[0, 2], [8, 2], [6, 4], [0, 4]]},
        {"name": "down", "material": "rock", "corners_m": [[0, 0], [20, 0], [20, 2], [0, 2]]},
    ]
    return deepcopy(
        {
            "study": {"name": "three soils", "seed": 1},
            "geometry": {"kind": "regions", "foreland_m": 0.0, "region": regions},
            "discretisation": {"cell_m": 0.5, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": {"kind": "fixed"}, "sides": {"kind": "roller"}},
            "material": [
                CLAY | {"random_field": {"cohesion": FIELD}},
                SAND | {"random_field": {"cohesion": FIELD, "friction_angle": FIELD}},
                ROCK,
            ],
            "time": {"end_s": 1.0},
            "output": {"directory": "results"},
        }
        | more
    )


@pytest.fixture
def study():
    return rfmpm.load_study(tables())


def problems_of(study, changes):
    with pytest.raises(StudyError) as refusal:
        study.with_changes(changes)
    return refusal.value.problems


def test_fields_are_those_of_the_study_then_each_material_s_own(study):
    whole = study.with_changes({"random_field.residual_cohesion": FIELD | {"material": "clay"}, **SOFTENING})
    found = [(one.name, one.variable, one.path, one.materials) for one in whole.fields]
    assert found == [
        ("residual_cohesion", "residual_cohesion", "random_field.residual_cohesion", (0,)),
        ("cohesion of clay", "cohesion", "material.0.random_field.cohesion", (0,)),
        ("cohesion of sand", "cohesion", "material.1.random_field.cohesion", (1,)),
        ("friction_angle of sand", "friction_angle", "material.1.random_field.friction_angle", (1,)),
    ]


SOFTENING = {"material.0.residual_cohesion_kpa": 4.0, "material.0.softening_modulus_kpa": 50.0}


def test_a_shared_field_lists_its_materials_that_of_the_table_first():
    shared = {"random_field": {"cohesion": FIELD | {"material": "sand", "shared_with": ["clay"]}}}
    (field,) = rfmpm.load_study(tables(material=[CLAY, SAND, ROCK], **shared)).fields
    assert (field.name, field.materials) == ("cohesion", (1, 0))


def test_it_survives_being_written_and_read(study):
    again = rfmpm.load_study(study.to_toml())
    assert again == study
    assert again.physics_hash == study.physics_hash


def test_what_is_left_out_leaves_no_trace_in_the_hash():
    """A campaign that was begun before there were such keys is continued by its hash."""
    content = rfmpm.load_study(CONFIGS / "drained_cross_correlated.toml").model_dump(exclude_none=True)
    assert not {"random_field", "random_field_correlation"} & content["material"][0].keys()
    assert "shared_with" not in content["random_field"]["cohesion"]


def test_a_path_changes_one_material_s_field(study):
    changed = study.with_changes({f"{OWN}.cohesion.coefficient_of_variation": 0.4})
    assert [one.settings.coefficient_of_variation for one in changed.fields] == [0.25, 0.4, 0.25]


def test_everything_wrong_is_said_at_once(study):
    problems = problems_of(
        study,
        {
            "material.0.random_field.cohesion.coefficient_of_variation": 0.0,
            f"{OWN}.cohesion.corelation": "gaussian",
            f"{OWN}.friction_angle.coefficient_of_variation": 0.9,
            "material.2.random_field.cohesion": FIELD,
        },
    )
    assert [text.split(":")[0] for text in problems] == [
        "material.0.random_field.cohesion.coefficient_of_variation = 0.0",
        f'{OWN}.cohesion.corelation = "gaussian"',
        "material.2.random_field.cohesion",
        f"{OWN}.friction_angle.coefficient_of_variation = 0.9",
    ]


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (
            {"material.2.random_field.cohesion": FIELD},
            'material.2.random_field.cohesion: is of a material with law = "elastic", which has no cohesion',
        ),
        (
            {"random_field.cohesion": FIELD | {"material": "clay"}},
            "material.0.random_field.cohesion: is a second one: random_field.cohesion is of clay, too; leave one out",
        ),
        (
            {f"{OWN}.cohesion.material": "sand"},
            f'{OWN}.cohesion.material = "sand": unknown key',
        ),
        (
            {f"{OWN}.cohesoin": FIELD},
            f"{OWN}.cohesoin = {{...}}: unknown key (did you mean ",
        ),
        (
            {f"{OWN}.cohesion.reference_cell_m": 0.3},
            f"{OWN}.cohesion.reference_cell_m = 0.3: must be discretisation.cell_m = 0.5 over a whole number",
        ),
        (
            {f"{OWN}.cohesion.distribution": "beta"},
            f'{OWN}.cohesion.upper_over_mean: missing; distribution = "beta" needs a number greater than 1',
        ),
        (
            {f"{OWN}.cohesion.layer": [{"top_m": 9.0}]},
            f"{OWN}.cohesion.layer.0.top_m = 9.0: must be greater than 2 and at most 4, to have points above and below",
        ),
        (
            {f"{OWN}.cohesion.data": [{"x_m": 1.0, "y_m": 3.0, "value": 1e6}]},
            f"{OWN}.cohesion.data.0.value = 1000000.0: at x_m = 1, y_m = 3: must be greater than",
        ),
        (
            {"material.1.cohesion_kpa": 0.0},
            "material.1.cohesion_kpa = 0.0: must be greater than 0, the mean of its random field",
        ),
        (
            {
                "material.1.random_field_correlation": [
                    {"between": ["cohesion", "residual_cohesion"], "coefficient": 0.5}
                ]
            },
            'material.1.random_field_correlation.0.between.1 = "residual_cohesion": is not random in this study: add '
            f"the table {OWN}.residual_cohesion, or leave this one out",
        ),
        (
            {
                "material.1.random_field_correlation": [
                    {"between": ["cohesion", "friction_angle"], "coefficient": 0.5}
                ],
                f"{OWN}.friction_angle.scale_of_fluctuation_h_m": 3.0,
            },
            f"{OWN}.friction_angle.scale_of_fluctuation_h_m = 3.0: must be that of {OWN}.cohesion, with which it is "
            "correlated: 6.0",
        ),
        (
            {"uncertain": [{"key": f"{OWN}.cohesion.coefficient", "distribution": "uniform", "low": 0.1, "high": 0.2}]},
            f"(did you mean {OWN}.cohesion.coefficient_of_variation?)",
        ),
    ],
)
def test_refused_with_the_path_and_the_remedy(study, changes, problem):
    problems = problems_of(study, changes)
    assert len(problems) == 1
    assert problem in problems[0]


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"shared_with": ["snad"]}, 'shared_with.0 = "snad": names no material; must be one of'),
        (
            {"shared_with": ["rock"]},
            'shared_with.0 = "rock": is a material with law = "elastic", which has no cohesion',
        ),
        ({"shared_with": ["clay"]}, 'shared_with.0 = "clay": is named twice; leave it out'),
        ({"shared_with": []}, ""),
        ({"layer": [{"top_m": 5.0}]}, "layer: must be left out where there is shared_with: give each material a field"),
        ({"trend_kpa_per_m": 0.5}, "trend_kpa_per_m: must be left out where there is shared_with: a gain in kPa is"),
        ({"data": [{"x_m": 1.0, "y_m": 5.0, "value": 15.0}]}, "data: must be left out where there is shared_with: the"),
    ],
)
def test_what_a_shared_field_may_not_have(changes, problem):
    field = FIELD | {"material": "clay", "shared_with": ["sand"]} | changes
    content = tables(material=[CLAY, SAND, ROCK], random_field={"cohesion": field})
    if not problem:
        assert len(rfmpm.load_study(content).fields[0].materials) == 1
        return
    with pytest.raises(StudyError) as refusal:
        rfmpm.load_study(content)
    (found,) = refusal.value.problems
    assert found.startswith(f"random_field.cohesion.{problem}")


def test_a_number_of_one_material_s_field_may_be_uncertain(study):
    entry = {"key": f"{OWN}.cohesion.coefficient_of_variation", "distribution": "uniform", "low": 0.1, "high": 0.4}
    assert (
        study.with_changes({"uncertain": [entry]}).with_values([0.2]).fields[1].settings.coefficient_of_variation == 0.2
    )


def test_files_that_one_material_s_field_names_are_read_beside_the_study(tmp_path, study):
    (tmp_path / "data.csv").write_text("x_m,y_m,value\n1.0,3.0,5.0\n")
    table, path = "[material.random_field.cohesion]\n", tmp_path / "study.toml"
    head, of_sand = study.to_toml().rsplit(table, 1)
    path.write_text(f'{head}{table}data_file = "data.csv"\n{of_sand}')
    (datum,) = rfmpm.load_study(path).fields[1].settings.data
    assert (datum.x_m, datum.value) == (1.0, 5.0)
    path.write_text(path.read_text().replace("data.csv", "none.csv"))
    with pytest.raises(
        StudyError, match=r'material\.1\.random_field\.cohesion\.data_file = "none.csv": cannot be read'
    ):
        rfmpm.load_study(path)
