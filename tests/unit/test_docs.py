"""What README, documentation and reports say is so: links, commands, parts of studies, Python.

The tool that makes the site of them is not needed.
"""

import re
import subprocess
import sys

import pages
import pytest
from page_claims import (
    COMMANDS,
    lines_of,
    study_of,
    wrong_command,
    wrong_links,
    wrong_messages,
    wrong_names,
    wrong_words,
)
from pages import ROOT, Block

from rfmpm.cli.endings import STOPPED_EARLY, TOO_MANY_FAILED, WRONG_STUDY
from rfmpm.study import Study, StudyError, load_study
from rfmpm.variables import STATUS, VARIABLES

NAMES = {str(path.relative_to(ROOT)): pages.text_of(path) for path in pages.pages()}
BLOCKS = [block for name, text in NAMES.items() for block in pages.blocks(text, name)]
READ, UNREAD = {"bash", "toml", "python"}, {"", "text", "csv", "bibtex"}
COMMAND = re.compile(r"^[$ ]*(\.venv/bin/)?(rfmpm|mpirun|sbatch|qsub) ", re.MULTILINE)
COARSE = {
    "discretisation.cell_m": 1.0,
    "geometry.crest_m": 4.0,
    "geometry.foreland_m": 8.0,
    "time.end_s": 1.0,
    "output.surface_bin_m": 1.0,
    "material.0.softening_length_m": 1.0,
}


@pytest.mark.parametrize("page", NAMES)
def test_links_lead_somewhere(page):
    assert list(wrong_links(page, NAMES[page])) == []


@pytest.mark.parametrize("page", NAMES)
def test_words_of_code_are_commands_and_options_that_exist(page):
    assert list(wrong_words(NAMES[page])) == []


@pytest.mark.parametrize("page", [page for page, text in NAMES.items() if "\n| message |" in text])
def test_messages_are_those_of_the_program(page):
    assert list(wrong_messages(NAMES[page])) == []


def test_no_command_hides_in_a_block_that_is_not_read():
    others = [block for block in BLOCKS if block.language not in READ and not block.language.startswith("{")]
    assert [f"{block}: {block.language}" for block in others if block.language not in UNREAD] == []
    assert [str(block) for block in others if COMMAND.search(block.text)] == []


@pytest.mark.parametrize("block", [block for block in BLOCKS if block.language == "bash"], ids=str)
def test_lines_of_the_shell_are_right(block):
    assert [wrong for words in lines_of(block.text) if (wrong := wrong_command(words))] == []


@pytest.mark.parametrize("block", [block for block in BLOCKS if block.language == "toml"], ids=str)
def test_parts_of_studies_are_right(block):
    assert isinstance(study_of(block), Study)


@pytest.mark.parametrize("block", [block for block in BLOCKS if block.language == "python"], ids=str)
def test_python_compiles_and_imports_what_is_there(block):
    compile(block.text, str(block), "exec")
    assert list(wrong_names(block.text)) == []


@pytest.mark.parametrize("page", sorted({block.page for block in BLOCKS if block.mark == "runs"}))
def test_python_runs(page, tmp_path):
    """The blocks of a page that say so, as one script, on a slope of so few cells that it takes a moment."""
    for config in ("short_slope.toml", "short_slope_random.toml"):
        (tmp_path / "configs").mkdir(exist_ok=True)
        coarse = load_study(ROOT / "configs" / config).with_changes(COARSE).to_toml()
        (tmp_path / "configs" / config).write_text(coarse, encoding="utf-8")
    script = tmp_path / "page.py"
    code = "\n".join(block.text for block in BLOCKS if block.page == page and block.mark == "runs")
    script.write_text(re.sub(r"realisations=\d+", "realisations=2", code), encoding="utf-8")
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_what_the_program_tells_has_every_key_command_and_variable():
    told = NAMES["docs/reference/study_keys.md"]
    assert not [name for name in Study.model_fields if f"`[{name}" not in told and f"`[[{name}]]`" not in told]
    assert not [name for name in COMMANDS.commands if f"## `rfmpm {name}`" not in NAMES["docs/reference/commands.md"]]
    assert not [name for name in VARIABLES if f"| `{name}` |" not in NAMES["docs/reference/results.md"]]


def test_every_status_and_exit_code_is_explained():
    page = NAMES["docs/guide/12_troubleshooting.md"]
    assert not [name for name in STATUS if f"\n| `{name}` |" not in page]
    assert not [code for code in (0, WRONG_STUDY, TOO_MANY_FAILED, STOPPED_EARLY) if f"\n| {code} |" not in page]


# The readers themselves: each finds what is wrong.


def test_reader_of_links():
    text = "# A b\n[a](#a-b) [b](#b) [c](LICENSE) [d](LICENCE) [e](https://x) [f](https://example.org/x) `[g](h)`"
    assert list(wrong_links("README.md", text)) == ["#b: no such heading", "LICENCE: no such file", "https://x"]


@pytest.mark.parametrize(
    "line",
    [
        "rfmpm chek configs/short_slope.toml",
        "rfmpm run configs/short_slope.toml --output x",
        "rfmpm run configs/shortslope.toml",
        "mpirun -n 4 rfmpm run configs/short_slope.toml --workers two",
        "rfmpm benchmark slopes",
        "rfmpm stability configs/short_slope.toml --method bishops",
        "rfmpm sweep configs/short_slope.toml --vary cohesion_kpa=1,2",
        "OMP_NUM_THREADS=1 python workflows/9_nothing.py",
        "sbatch workflows/slurm.sh",
        "rfmp run configs/short_slope.toml",
    ],
)
def test_reader_of_shell_lines(line):
    assert [wrong_command(words) for words in lines_of(f"rfmpm --version && {line}  # a comment")][1]


def test_reader_of_words():
    assert list(
        wrong_words("`rfmpm run DIR --nothing` `rfmpm runs` `rfmpm run STUDY` `rfmpm benchmark slope --quick`")
    ) == [
        "rfmpm run DIR --nothing",
        "rfmpm runs",
    ]


def test_reader_of_messages():
    right, wrong = "the launcher started 8 ranks, but the MPI library sees 1", "the launcher found 8 ranks"
    assert list(wrong_messages(f"| message | do |\n|---|---|\n| `{right}` | |\n| `{wrong}` | |\n")) == [wrong]


@pytest.mark.parametrize(
    ("mark", "text"),
    [
        ("", "[time]\nend_s = 1.0"),
        ("into configs/short_slope.toml", "[time]\nends_s = 1.0"),
        ("into configs/short_slope_random.toml", '[study]\nuntil = { quantity = "run_out", half_width_m = 1.0 }'),
    ],
)
def test_reader_of_studies(mark, text):
    with pytest.raises(StudyError):
        study_of(Block("", 1, "toml", text, mark))


def test_reader_of_python():
    assert list(wrong_names("import rfmpm\nfrom rfmpm import nothing\nrfmpm.simulated(1)")) == [
        "rfmpm.nothing",
        "rfmpm.simulated",
    ]
