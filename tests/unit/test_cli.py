"""The command line: what each command asks of the rooms below it, what it prints, and its exit codes."""

import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import rfmpm
from rfmpm import campaign_status
from rfmpm.cli import app
from rfmpm.study import Study
from rfmpm.variables import STATUS

CONFIGS = Path(__file__).parents[2] / "configs"
RANDOM = str(CONFIGS / "short_slope_random.toml")
HOMOGENEOUS = str(CONFIGS / "short_slope.toml")
SUMMARY = ["mean run-out 7 m (6 to 8)", "P(run-out > 5 m) 0.8 (0.7 to 0.9)", "cost 12 s per realisation, 0 failed"]


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def replace(monkeypatch):
    """Puts a stand-in in the place of a room of the package."""

    def put(name, **content):
        stand_in = ModuleType(f"rfmpm.{name}")
        stand_in.__dict__.update(content)
        monkeypatch.setitem(sys.modules, f"rfmpm.{name}", stand_in)
        monkeypatch.setattr(rfmpm, name, stand_in, raising=False)

    return put


class FolderMismatch(ValueError):
    pass


class LauncherMismatch(RuntimeError):
    pass


class Interrupted(RuntimeError):
    pass


class TooShort(Interrupted):
    pass


class CampaignFailed(RuntimeError):
    pass


class RowsDiffer(RuntimeError):
    pass


LEFT_OUT = {"repeat_failed": False, "indices": None, "allow_failed": None, "wall_time": None, "log_level": "warning"}


@pytest.fixture
def campaign(replace, monkeypatch):
    """A runner that notes how it was called and ends the way `campaign.end` says."""
    notes = SimpleNamespace(statuses=["ok"] * 40, end=None, launched=None)

    def run(study, directory, **options):
        notes.study, notes.directory, notes.options = study, directory, options
        if notes.end is not None:
            raise notes.end
        codes = np.array([STATUS[status] for status in notes.statuses], dtype="int8")
        return None if not notes.statuses else xr.Dataset({"status": ("realisation", codes)})

    errors = (FolderMismatch, LauncherMismatch, Interrupted, CampaignFailed, RowsDiffer, TooShort)
    replace("ensemble", run=run, **{error.__name__: error for error in errors})
    ranks = ModuleType("rfmpm.ensemble.mpi")
    ranks.launched_ranks = lambda: notes.launched
    monkeypatch.setitem(sys.modules, "rfmpm.ensemble.mpi", ranks)
    replace("report", write=lambda folder, out=None: folder / "report.html", summary_lines=lambda data, study: SUMMARY)
    return notes


# --- run


def test_run_ends_with_the_paths_and_three_lines(campaign, tmp_path):
    result = call("run", RANDOM, "--out", tmp_path)
    assert result.exit_code == 0
    assert result.stdout.splitlines() == [
        f"dataset: {tmp_path / 'ensemble.nc'}",
        f"report:  {tmp_path / 'report.html'}",
        *SUMMARY,
    ]


def test_run_takes_the_study_at_its_word(campaign):
    call("run", RANDOM)
    assert campaign.directory == Path("results/short_slope_random")
    assert campaign.study == rfmpm.load_study(RANDOM)
    assert campaign.options == {"realisations": 64, "workers": None, "fresh": False, **LEFT_OUT}


def test_options_of_run_override_the_study(campaign, tmp_path):
    call("run", RANDOM, "--realisations", 8, "--seed", 5, "--workers", 2, "--fresh", "--out", tmp_path)
    assert (campaign.study.study.seed, campaign.study.study.realisations) == (5, 8)
    assert campaign.options == {"realisations": 8, "workers": 2, "fresh": True, **LEFT_OUT}
    assert campaign.directory == tmp_path


def test_indices_of_run_are_passed_on(campaign, tmp_path):
    call("run", RANDOM, "--indices", "10:64", "--out", tmp_path)
    assert campaign.options["indices"] == (10, 64)


@pytest.mark.parametrize("text", ["10", "10:10", "12:3", "-1:5", "1:2:3", "a:b"])
def test_indices_that_are_no_range_are_an_error(campaign, tmp_path, text):
    result = call("run", RANDOM, "--indices", text, "--out", tmp_path)
    assert result.exit_code == 2
    assert f"{text}: must be A:B" in result.stderr


def test_indices_beyond_the_study_are_an_error(campaign, tmp_path):
    result = call("run", RANDOM, "--indices", "10:65", "--out", tmp_path)
    assert result.exit_code == 2
    assert "--indices 10:65: the study has 64" in result.stderr


def test_overrides_are_validated(campaign, tmp_path):
    result = call("run", RANDOM, "--realisations", 0, "--seed", -1, "--out", tmp_path / "new")
    assert result.exit_code == 2
    assert "study.realisations = 0: must be at least 1" in result.stderr
    assert "study.seed = -1: must be at least 0" in result.stderr
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("end", "code"),
    [
        (FolderMismatch("results/x: holds results of another study"), 2),
        (LauncherMismatch("the launcher started 2 ranks"), 2),
        (RowsDiffer("realisation 1 has two different rows"), 2),
        (PermissionError(13, "Permission denied", "results/x"), 2),
        (Interrupted("stopped early with 3 of 64"), 75),
        (TooShort("not one was finished"), 2),
        (CampaignFailed("realisation 3 ended with status crashed"), 3),
        (KeyboardInterrupt(), 75),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else "",
)
def test_end_of_a_campaign_is_one_message_and_an_exit_code(campaign, tmp_path, end, code):
    campaign.end = end
    result = call("run", RANDOM, "--out", tmp_path)
    assert result.exit_code == code
    assert len(result.stderr.splitlines()) == 1
    assert (end.filename if isinstance(end, OSError) else str(end)) in result.stderr
    assert result.stdout == ""


def test_a_bug_is_not_hidden_behind_an_exit_code(campaign, tmp_path):
    campaign.end = ZeroDivisionError()
    assert isinstance(call("run", RANDOM, "--out", tmp_path).exception, ZeroDivisionError)


@pytest.mark.parametrize(
    ("failed", "options", "code"),
    [(2, [], 0), (3, [], 3), (3, ["--allow-failed", "0.1"], 0), (1, ["--allow-failed", "0"], 3)],
)
def test_too_many_failed_realisations_are_exit_code_3(campaign, tmp_path, failed, options, code):
    campaign.statuses = ["diverged"] * failed + ["not_at_rest"] * 20 + ["ok"] * (20 - failed)
    result = call("run", RANDOM, "--out", tmp_path, *options)
    assert result.exit_code == code
    assert result.stdout.splitlines()[-3:] == SUMMARY
    assert (f"{failed} of 40 realisations failed" in result.stderr) == (code == 3)


def test_allowed_share_of_failed_ones_is_the_study_s_unless_given(campaign, tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(Path(RANDOM).read_text() + "\n[failures]\nmax_failed_fraction = 0.5\n")
    campaign.statuses = ["diverged"] * 20 + ["ok"] * 20
    assert call("run", study, "--out", tmp_path).exit_code == 0
    assert call("run", study, "--out", tmp_path, "--allow-failed", 0.4).exit_code == 3
    assert campaign.options["allow_failed"] == 0.4


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("3600", 3600.0),
        ("90m", 5400.0),
        ("6h", 21600.0),
        ("1.5d", 129600.0),
        ("45 s", None),
        ("5:30:00", 19800.0),
        ("30:00", 1800.0),
        ("1-12:00:00", 129600.0),
        ("1-12:00", 129600.0),
        ("0", None),
        ("-5", None),
        ("soon", None),
    ],
)
def test_wall_time_is_read_as_people_write_it(campaign, tmp_path, text, seconds):
    result = call("run", RANDOM, "--out", tmp_path, f"--wall-time={text}")
    assert result.exit_code == (2 if seconds is None else 0)
    if seconds is None:
        assert "90m" in result.stderr
    else:
        assert campaign.options["wall_time"] == seconds


def test_only_the_first_rank_speaks(campaign, tmp_path, monkeypatch):
    campaign.statuses = []  # what other ranks are given
    result = call("run", RANDOM, "--out", tmp_path)
    assert (result.exit_code, result.output) == (0, "")
    monkeypatch.setenv("PMI_RANK", "1")
    result = call("run", RANDOM, "--seed", -1)
    assert (result.exit_code, result.output) == (2, "")
    monkeypatch.setenv("PMI_RANK", "0")
    assert "study.seed" in call("run", RANDOM, "--seed", -1).stderr
    monkeypatch.setenv("SLURM_PROCID", "1")  # of the launcher's own step: the ranks of MPI count
    assert "study.seed" in call("run", RANDOM, "--seed", -1).stderr
    monkeypatch.delenv("PMI_RANK")
    assert call("run", RANDOM, "--seed", -1).output == ""


def test_workers_and_ranks_exclude_each_other(campaign, tmp_path):
    campaign.launched = 2
    result = call("run", RANDOM, "--workers", 2, "--out", tmp_path)
    assert result.exit_code == 2
    assert "--workers" in result.stderr


# --- status

NEWS = {
    "state": "stopped",
    "reason": "the limit of --wall-time was reached",
    "first": 0,
    "total": 400,
    "done": 120,
    "failed": {"crashed": 1, "diverged": 2},
    "running": [{"rank": 1, "host": "node7", "realisation": 121, "attempt": 1, "seconds": 75.2}],
    "rate_per_minute": 12.0,
    "seconds_left": 1400.0,
    "workers": 4,
    "host": "node7",
    "pid": 1,
    "started": "2026-01-01T00:00:00+00:00",
    "updated": "2026-01-01T00:10:00+00:00",
}


def test_status_of_a_stopped_campaign(tmp_path):
    campaign_status.write(tmp_path, NEWS)
    assert call("status", tmp_path).stdout.splitlines() == [
        f"{tmp_path}: stopped (4 workers, rank 0 on node7, started 2026-01-01T00:00:00+00:00)",
        "reason   the limit of --wall-time was reached",
        "done     120 of 400 realisations",
        "failed   1 crashed, 2 diverged",
        "estimate none yet: no finished realisations on disk without a gap",
    ]


def test_status_of_a_running_campaign_without_news_is_doubted(tmp_path):
    campaign_status.write(tmp_path, NEWS | {"state": "running", "reason": ""})
    lines = call("status", tmp_path).stdout.splitlines()
    assert lines[1].startswith("doubt    no sign of life since 2026-01-01T00:10:00+00:00")
    assert "rate     12 per minute, 0:23:20 left" in lines
    assert "running  121 for 0:01:15, rank 1 on node7" in lines


def test_status_as_json(tmp_path):
    campaign_status.write(tmp_path, NEWS)
    assert json.loads(call("status", tmp_path, "--json").stdout) == NEWS | {"doubt": "", "estimate": None}


def test_status_where_there_is_none(tmp_path):
    result = call("status", tmp_path)
    assert result.exit_code == 2
    assert "no status.json here" in result.stderr
    (tmp_path / "status.json").write_text("{")
    assert "is not the status of a campaign" in call("status", tmp_path).stderr


# --- simulate


@pytest.fixture
def simulation(replace):
    """One realisation, computed by nobody."""
    notes = SimpleNamespace(
        outcome=SimpleNamespace(
            quantities={
                "run_out": 7.4123,
                "retrogression_censored": np.int8(1),
                "block_count": 3,
                "time_at_rest": np.nan,
            },
            status="ok",
            reason="",
            step_count=12345,
            wall_time=8.25,
        ),
        written=[],
    )

    def simulate(prepared, index, **options):
        notes.prepared, notes.index, notes.options = prepared, index, options
        return notes.outcome

    def write(path):
        notes.written.append(path)

    replace("realisation", prepare=lambda study: ("prepared", study), simulate=simulate, threads_for=lambda prepared: 1)
    replace("results", write_simulation=lambda path, outcome, study: write(path))
    replace(
        "report",
        write_simulation_picture=lambda outcome, study, path: write(path),
        write_animation=lambda outcome, study, path: write(path),
    )
    words = ModuleType("rfmpm.report.words")
    words.duration = lambda seconds: f"{seconds:g} s"
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "rfmpm.report.words", words)
        yield notes


def test_simulate_prints_quantities_with_units_and_the_paths(simulation, tmp_path):
    result = call("simulate", RANDOM, "--index", 3, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    lines = [" ".join(line.split()) for line in result.stdout.splitlines()]
    assert lines[0] == "status ok"
    assert "run-out distance 7.412 m" in lines
    assert "retrogression is a lower bound yes" in lines
    assert "number of blocks 3" in lines
    assert "model time at which the body came to rest unknown" in lines
    assert lines[-4:-2] == ["steps 12,345", "wall time 8.25 s"]
    assert lines[-2:] == [str(tmp_path / "simulation.nc"), str(tmp_path / "simulation.png")]
    assert (simulation.index, simulation.options) == (
        3,
        {"frames": 0, "homogeneous": False, "xi": None, "threads": 1},
    )


def test_simulate_takes_as_many_threads_as_it_is_told(simulation, tmp_path):
    call("simulate", RANDOM, "--out", tmp_path, "--threads", 3)
    assert simulation.options["threads"] == 3
    assert call("simulate", RANDOM, "--out", tmp_path, "--threads", 0).exit_code == 2


def test_a_campaign_has_no_threads_to_share_a_step(tmp_path):
    assert call("run", RANDOM, "--out", tmp_path, "--threads", 2).exit_code == 2


@pytest.mark.parametrize(
    ("options", "frames", "animated"),
    [([], 0, False), (["--frames", 7], 7, False), (["--animate"], 60, True), (["--animate", "--frames", 9], 9, True)],
)
def test_animation_implies_frames(simulation, tmp_path, options, frames, animated):
    call("simulate", RANDOM, "--out", tmp_path, *options)
    assert simulation.options["frames"] == frames
    assert (tmp_path / "simulation.gif" in simulation.written) == animated


def test_simulate_has_a_folder_for_each_realisation(simulation, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call("simulate", RANDOM, "--index", 3)
    call("simulate", RANDOM, "--homogeneous")
    assert simulation.options["homogeneous"]
    folders = [path.parent.name for path in simulation.written[::2]]
    assert folders == ["simulation_3", "simulation_homogeneous"]


def test_status_of_a_simulation_is_said_with_its_reason(simulation, tmp_path):
    simulation.outcome.status, simulation.outcome.reason = "not_at_rest", "still moving at 40.5 s"
    result = call("simulate", RANDOM, "--out", tmp_path)
    assert result.exit_code == 0
    assert "not_at_rest: still moving at 40.5 s" in result.stdout
    simulation.outcome.status, simulation.outcome.reason = "diverged", "energy grew at 3.2 s"
    result = call("simulate", RANDOM, "--out", tmp_path)
    assert result.exit_code == 3
    assert "diverged, energy grew at 3.2 s" in result.stderr


def test_folder_that_cannot_be_made_is_refused_before_the_simulation(simulation, tmp_path):
    (tmp_path / "file").touch()
    result = call("simulate", RANDOM, "--out", tmp_path / "file")
    assert result.exit_code == 2
    assert str(tmp_path / "file") in result.stderr
    assert not hasattr(simulation, "index")


def test_xi_of_a_file_gives_the_realisation_it_was_written_of(tmp_path):
    coarse = tmp_path / "coarse.toml"
    study = rfmpm.load_study(CONFIGS.parent / "tests" / "robustness" / "coarse.toml")
    coarse.write_text(study.with_changes({"time.end_s": 0.3}).to_toml())
    file = tmp_path / "five.npy"
    result = call("field", coarse, "--index", 5, "--out", tmp_path, "--write-xi", file)
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines()[-1] == str(file)
    expected = rfmpm.realise_fields(coarse, index=5)["cohesion"]
    assert rfmpm.realise_fields(coarse, xi=np.load(file))["cohesion"].tobytes() == expected.tobytes()
    result = call("simulate", coarse, "--xi", file, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    with xr.open_dataset(tmp_path / "simulation.nc") as simulation:
        np.testing.assert_array_equal(simulation["cohesion"], expected)
    np.save(file, np.zeros(3))
    result = call("simulate", coarse, "--xi", file, "--out", tmp_path)
    assert result.exit_code == 2
    assert "fields take" in result.stderr


@pytest.mark.parametrize("arguments", [[HOMOGENEOUS], [RANDOM, "--homogeneous"]])
def test_xi_without_a_field_is_refused(simulation, tmp_path, arguments):
    result = call("simulate", *arguments, "--xi", tmp_path / "xi.npy", "--out", tmp_path)
    assert result.exit_code == 2
    assert "--xi: there is nothing random" in result.stderr


# --- the other commands


def test_field_prints_its_lines(replace, tmp_path):
    replace("report", write_field=lambda study, index, folder: [f"mean of {index}"])
    result = call("field", RANDOM, "--index", 4, "--out", tmp_path)
    assert result.stdout.splitlines() == ["mean of 4"]


def test_field_of_a_homogeneous_study_is_refused():
    result = call("field", HOMOGENEOUS)
    assert result.exit_code == 2
    assert "random_field: this study has none" in result.stderr


def test_check_says_that_nothing_is_wrong():
    assert call("check", RANDOM).stdout == f"{RANDOM}: nothing is wrong\n"


def test_check_prints_the_schema_alone_on_standard_output():
    assert json.loads(call("check", "--schema").stdout) == Study.json_schema()
    assert json.loads(call("check", "--schema", RANDOM).stdout) == Study.json_schema()


def test_estimate_prints_what_the_campaign_would_cost(replace):
    costs = {"points": 4040, "time_step_s": 0.00123, "total_s": 100.0, "memory_bytes": 3.2e7, "disk_bytes": 2.5e9}
    replace("cost", estimate=lambda study, ranks: costs)
    lines = [" ".join(line.split()) for line in call("estimate", RANDOM).stdout.splitlines()]
    assert lines == ["points 4,040", "time step 0.00123 s", "total 100 s", "memory 32 MB", "disk 2.5 GB"]


def test_report_passes_folder_and_file_on(replace, tmp_path):
    replace("report", write=lambda folder, out=None: out or folder / "report.html")
    assert call("report", tmp_path).exit_code == 2  # no ensemble.nc
    (tmp_path / "ensemble.nc").touch()
    assert call("report", tmp_path).stdout.strip() == str(tmp_path / "report.html")
    assert call("report", tmp_path, "--out", "x.html").stdout.strip() == "x.html"


def test_warmup_compiles(replace):
    replace("cost", warmup=lambda: iter(["1/2  first", "2/2  second"]))
    result = call("warmup")
    assert result.exit_code == 0
    assert result.stdout.splitlines() == ["1/2  first", "2/2  second"]


def test_version():
    assert call("--version").stdout.strip() == rfmpm.__version__


@pytest.mark.parametrize("command", ["help", "check", "status"])
def test_light_commands_load_nothing_heavy(command, tmp_path):
    campaign_status.write(tmp_path, NEWS)
    arguments = {"help": ["--help"], "check": ["check", RANDOM], "status": ["status", str(tmp_path)]}[command]
    heavy = {"numba", "matplotlib", "xarray", "netCDF4", "mpi4py", "scipy", "pandas"}
    code = (
        "import sys\nfrom rfmpm.cli import app\n"
        f"try: app({arguments!r})\nexcept SystemExit as end: assert end.code == 0\n"
        f"print('loaded:', sorted({heavy!r} & sys.modules.keys()))"
    )
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert process.stdout.splitlines()[-1] == "loaded: []"


# --- public names of the package


def test_public_names_are_found_and_others_are_not():
    assert {"Study", "StudyError", "load_study", "simulate", "run_ensemble"} <= set(dir(rfmpm))
    assert rfmpm.Study is Study
    with pytest.raises(AttributeError, match="no attribute 'realize_fields'"):
        _ = rfmpm.realize_fields


def test_python_functions_take_anything_that_is_a_study(replace, campaign, tmp_path):
    replace(
        "realisation",
        prepare=lambda study: study,
        simulate=lambda prepared, index, **options: (prepared, index, options),
        threads_for=lambda prepared: 2,
        realise_fields=lambda study, index, level, xi: (study, index, level),
    )
    study = rfmpm.load_study(RANDOM)
    assert rfmpm.simulate(RANDOM, index=2, frames=3) == (
        study,
        2,
        {"level": 0, "frames": 3, "homogeneous": False, "xi": None, "threads": 2},
    )
    assert rfmpm.realise_fields(RANDOM, index=1) == (study, 1, 0)
    rfmpm.run_ensemble(RANDOM, realisations=32, directory=tmp_path, workers=1)
    assert campaign.study.study.realisations == 32
    assert campaign.directory == tmp_path
    assert campaign.options == {"realisations": 32, "workers": 1, "fresh": False, "indices": None}
    with pytest.raises(rfmpm.StudyError, match=r"study\.realisations = 0"):
        rfmpm.run_ensemble(study, realisations=0)
