"""The page: self-contained, complete, and made of the same numbers as report.json."""

import base64
import io
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image
from synthetic import make_ensemble, make_points, make_study

from rfmpm.report import write
from rfmpm.report.modes import NAMES
from rfmpm.results import write_dataset

CASES = {
    "ordinary": {"n": 24, "failed": (5,), "censored": (7,), "not_at_rest": (9,)},
    "one": {"n": 1},
    "one failed": {"n": 1, "failed": (0,)},
    "all failed": {"n": 5, "failed": range(5)},
    "no failure": {"n": 8, "still": range(8)},
    "all censored": {"n": 4, "censored": range(4)},
}
VOID = {"meta", "img"}


class Page(HTMLParser):
    """Collects what a page is made of, and that every element is closed."""

    def __init__(self, text: str):
        super().__init__()
        self.open, self.images, self.references, self.tags = [], [], [], []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.tags.append(tag)
        self.references += [attributes[key] for key in ("src", "href") if key in attributes]
        if tag == "img":
            self.images.append(attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def campaign(folder, study, **options):
    """A folder as a campaign leaves it, and a stand-in for the simulation that counts its calls."""
    ensemble = make_ensemble(study, **options)
    write_dataset(folder / "ensemble.nc", ensemble)
    (folder / "study.toml").write_text(study.to_toml(), encoding="utf-8")
    run_out = dict(zip(ensemble["realisation"].values.tolist(), ensemble["run_out"].values.tolist(), strict=True))
    calls = []

    def simulate(index):
        calls.append(index)
        return {**make_points(study, run_out[index], spacing=0.5), "run_out": run_out[index]}

    return simulate, calls


def check_page(path, images: int):
    """Whether a page needs nothing but itself, describes its pictures and shows no number that is none."""
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    assert all(reference.startswith("data:image/png;base64,") for reference in page.references)
    assert not re.search(r"https?://|@import|url\(", text)
    assert not {"script", "link", "iframe"} & set(page.tags)
    assert all(len(image["alt"]) > 40 for image in page.images)
    for image in page.images:
        Image.open(io.BytesIO(base64.b64decode(image["src"].partition(",")[2]))).verify()
    body = re.sub(r'src="[^"]*"', "", text.partition("</style>")[2])
    assert not re.search(r"\b(nan|inf|None)\b", body)
    assert len(text) < 800_000
    assert len(page.images) == images


@pytest.fixture(scope="module")
def ordinary(tmp_path_factory):
    """Folder of a report on a campaign with some of everything."""
    folder = tmp_path_factory.mktemp("ordinary")
    simulate, _ = campaign(folder, make_study(), **CASES["ordinary"])
    write(folder, simulate=simulate)
    return folder


@pytest.mark.parametrize("name", [name for name in CASES if name != "ordinary"])
def test_every_kind_of_campaign_gives_a_sound_page(tmp_path, name):
    simulate, _ = campaign(tmp_path, make_study(), **CASES[name])
    path = write(tmp_path, simulate=simulate)
    assert path == tmp_path / "report.html"
    images = {"one": 4, "one failed": 0, "all failed": 0, "no failure": 7, "all censored": 11}
    check_page(path, images[name])


def test_page_is_self_contained_and_every_picture_is_described(ordinary):
    check_page(ordinary / "report.html", images=14)


def test_page_and_json_say_the_same(ordinary):
    text = (ordinary / "report.html").read_text(encoding="utf-8")
    record = json.loads((ordinary / "report.json").read_text(encoding="utf-8"))
    assert f"The probability that the run-out exceeds 5 m is {record['exceedance']['value']:.2f}" in text
    mean = record["mean_run_out"]
    assert 1.0 <= mean["upper"] - mean["lower"] < 10.0  # so that its interval supports one decimal place
    assert f"The mean run-out is {mean['value']:.1f} m" in text
    assert record["headline"] in text.replace("\N{NO-BREAK SPACE}", " ")
    assert record["question"] == "How likely is the soil to travel more than 5 m beyond the toe?"
    assert sum(mode["count"] for mode in record["modes"]) == record["completed"] == 23
    assert sum(mode["at_edge"] for mode in record["modes"]) > 0
    assert "met an edge of the model and might have gone on" in text
    assert (
        f"Not found: {', '.join(NAMES[mode['name']].lower() for mode in record['modes'] if not mode['count'])}." in text
    )
    assert record["reasons"] == [
        {"realisation": 5, "status": "diverged", "reason": "energy grew at step 4005"},
        {"realisation": 9, "status": "not_at_rest", "reason": "kinetic energy still 0.4 % of its peak"},
    ]
    for sentence in ("1 realisation of 24 did not complete", "In 1 realisation the soil reached the far wall"):
        assert sentence in text
    assert "1 realisation had not come to rest" in text
    assert "energy grew at step 4005" in text
    assert "residual_cohesion_kpa = 4.0" in text
    assert record["provenance"]["physics_hash"] == make_study().physics_hash


def test_a_second_report_is_the_same_page_without_simulating(tmp_path):
    simulate, calls = campaign(tmp_path, make_study(), n=1)
    first = write(tmp_path, simulate=simulate).read_text(encoding="utf-8")
    assert write(tmp_path, simulate=simulate).read_text(encoding="utf-8") == first
    assert calls == [0]
    assert "bit for bit" in first


def test_all_failed_says_so(tmp_path):
    simulate, calls = campaign(tmp_path, make_study(), **CASES["all failed"])
    text = write(tmp_path, simulate=simulate).read_text(encoding="utf-8")
    assert "No realisation completed" in text
    assert calls == []
    assert json.loads((tmp_path / "report.json").read_text())["exceedance"]["value"] is None


def test_a_study_without_randomness_or_surface(tmp_path):
    study = make_study(random_field={}, **{"output.surface_bin_m": None})
    simulate, _ = campaign(tmp_path, study, n=1)
    text = write(tmp_path, simulate=simulate).read_text(encoding="utf-8")
    assert "Nothing is random in this study" in text
    assert "inundated" not in text


def test_texts_from_outside_cannot_become_markup(tmp_path):
    study = make_study(**{"study.name": "slope <script>alert(1)</script> & co"})
    simulate, _ = campaign(tmp_path, study, **CASES["all failed"])
    assert "script" not in Page(write(tmp_path, simulate=simulate).read_text(encoding="utf-8")).tags


def test_out_names_the_page_and_the_numbers_go_beside_it(tmp_path):
    simulate, _ = campaign(tmp_path, make_study(), **CASES["all failed"])
    path = write(tmp_path, out=tmp_path / "elsewhere" / "page.html", simulate=simulate)
    assert path == tmp_path / "elsewhere" / "page.html"
    assert path.is_file()
    assert path.with_name("page.json").is_file()
    assert not (tmp_path / "report.html").exists()


def test_a_repetition_that_differs_is_owned_up_to(tmp_path):
    simulate, _ = campaign(tmp_path, make_study(), n=1)

    def differing(index):
        state = simulate(index)
        return state | {"run_out": np.nextafter(state["run_out"], 99.0)}

    text = write(tmp_path, simulate=differing).read_text(encoding="utf-8")
    assert "not exactly the realisation on record" in text
    assert "bit for bit" not in text
    pictured = json.loads((tmp_path / "report.json").read_text())["pictured"]
    assert pictured[0]["run_out_recorded"] != pictured[0]["run_out_repeated"]
