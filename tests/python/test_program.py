"""gcpdda.run, sweep and Scene: what reaches the program, and what its exit codes become."""

import pathlib
import re
import subprocess
import sys
import tomllib

import numpy as np
import pytest
from conftest import SCENES, SOURCE

import gcpdda
from gcpdda.errors import error_of
from gcpdda.program import _outcome_of_search
from gcpdda.result import path_parts


def sliding_block(**run):
    """A block on a plane of 30 degrees that it slides down without friction."""
    scene = gcpdda.Scene(name="slider", **({"duration": 0.2} | run))
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=np.float64(0.0))
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    turn = np.array([[c, s], [-s, c]])
    scene.block("plane", np.array([[-5, -1], [5, -1], [5, 0], [-5, 0]]) @ turn, material="rock", fixed=True)
    scene.block("slider", np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ turn, material="rock")
    scene.monitor(block="slider")
    return scene


def test_a_scene_built_in_code_runs(tmp_path):
    result = gcpdda.run(sliding_block(), ranks=1, out=tmp_path / "slide")
    assert result.verdict == "completed"
    assert (tmp_path / "slide.toml").exists()
    history = result.history("slider")
    time = history["time[s]"].iloc[-1]
    moved = np.hypot(history["x[m]"] - history["x[m]"][0], history["y[m]"] - history["y[m]"][0]).iloc[-1]
    assert time == 0.2
    # g sin 30 t^2/2; at first the block sinks in by its weight over k_n, 2e-5 m, across the plane.
    assert moved == pytest.approx(0.5 * 9.81 * 0.5 * time**2, abs=1e-4)


def test_ranks_give_the_same_frames(tmp_path):
    one = gcpdda.run(SCENES / "opening.toml", ranks=1, out=tmp_path / "one")
    two = gcpdda.run(SCENES / "opening.toml", ranks=np.int64(2), out=tmp_path / "two")
    assert two.summary["ranks"] == 2
    assert one.frame("last").blocks.equals(two.frame("last").blocks)


@pytest.mark.parametrize("ranks", [0, -1, 2.0, True, "2", None])
def test_ranks_are_a_positive_whole_number(tmp_path, ranks):
    for start in (gcpdda.run, gcpdda.fos, gcpdda.ensemble,
                  lambda scene, **options: gcpdda.sweep(scene, {"joint.default.friction_angle_deg": [30]}, **options)):
        with pytest.raises(ValueError, match="try ranks=1"):
            start(sliding_block(), ranks=ranks, out=tmp_path / "run")
    assert not list(tmp_path.iterdir())


def test_toml_holds_what_was_put_in():
    scene = gcpdda.Scene(duration=1, gravity=(0, -9.81))
    scene.material('a "b"', density=1e3)
    scene.table("region", material="rock", polygon=np.eye(3, 2))
    scene.table("region.slope", toe_length=2.5)
    scene.add("joint_set", dip_deg=35, spacing_scatter={"kind": "normal", "deviation": 0.2})
    scene.stage("weak", "settle", limit=5, set={"joint.default.friction_angle_deg": 25.0, "water.low.active": True})
    read = tomllib.loads(scene.toml())
    assert read["run"] == {"duration": 1, "gravity": [0, -9.81]}
    assert read["material"] == {'a "b"': {"density": 1000.0}}
    assert read["region"] == {"material": "rock", "polygon": [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]],
                              "slope": {"toe_length": 2.5}}
    assert read["joint_set"] == [{"dip_deg": 35, "spacing_scatter": {"kind": "normal", "deviation": 0.2}}]
    assert read["stage"][0]["set"] == {"joint.default.friction_angle_deg": 25.0, "water.low.active": True}


def test_names_with_dots_and_lists_in_tables():
    scene = sliding_block()
    scene.material("rock.hard", density=2700)
    scene.joint("j.b", cohesion=1.0, materials=["rock", "rock.hard"])
    scene.table("ensemble", count=3)
    for key in ("joint.default.cohesion", "material.rock.density"):
        scene.add("ensemble.vary", key=key, kind="uniform", low=1.0, high=2.0)
    read = tomllib.loads(scene.toml())
    assert read["material"] == {"rock": {"density": 2600}, "rock.hard": {"density": 2700}}
    assert read["joint"]["j.b"]["cohesion"] == 1.0
    assert read["ensemble"]["count"] == 3
    assert [entry["key"] for entry in read["ensemble"]["vary"]] == ["joint.default.cohesion", "material.rock.density"]
    del scene.tables["ensemble"]
    scene.tables["block"][1]["material"] = "rock.hard"
    gcpdda.inspect(scene)
    assert path_parts('joint."j.b".cohesion') == path_parts("joint.'j.b'.cohesion") == ("joint", "j.b", "cohesion")


def test_files_of_scenes_are_kept(tmp_path):
    """The file that a scene was read from, and the one beside results whose run is not replaced."""
    mine = tmp_path / "mine.toml"
    text = "# a comment\n" + sliding_block().toml()
    mine.write_text(text)
    scene = gcpdda.Scene.read(mine)
    assert gcpdda.run(scene, ranks=1, out=tmp_path / "mine").verdict == "completed"
    scene.joint("default", friction_angle_deg=11)
    with pytest.raises(FileExistsError, match="choose another"):
        gcpdda.run(scene.copy(), ranks=1, out=tmp_path / "mine", overwrite=True)
    assert mine.read_text() == text

    gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    kept = (tmp_path / "run.toml").read_text()
    scene.joint("default", friction_angle_deg=12)
    with pytest.raises(gcpdda.FileError):
        gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    assert (tmp_path / "run.toml").read_text() == kept
    (tmp_path / "run.toml").unlink()
    with pytest.raises(gcpdda.FileError):
        gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    assert not (tmp_path / "run.toml").exists()


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_scenes_survive_reading_and_writing(path, tmp_path):
    written = gcpdda.Scene.read(path).write(tmp_path / "copy.toml")
    before, after = tomllib.loads(path.read_text()), tomllib.loads(written.read_text())
    for scene in (before, after):  # paths of files become absolute
        scene.get("earthquake", {}).pop("record", None)
        for table in scene.get("joint_map", []):
            table.pop("file")
    assert before == after


def test_scenes_with_a_byte_order_mark_are_read(tmp_path):
    """As some editors write it, and as the program reads it."""
    path = tmp_path / "marked.toml"
    path.write_bytes(b"\xef\xbb\xbf" + ("# höchste\r\n" + sliding_block().toml()).encode())
    scene = gcpdda.Scene.read(path)
    assert scene.tables == tomllib.loads(sliding_block().toml())
    assert gcpdda.run(scene, ranks=1, out=tmp_path / "marked").verdict == "completed"
    assert gcpdda.run(path, ranks=1, out=tmp_path / "path").verdict == "completed"
    for text in (b"[run]\nduration = \n", b"# \xff\n"):
        path.write_bytes(text)
        with pytest.raises(tomllib.TOMLDecodeError, match="marked.toml: "):
            gcpdda.Scene.read(path)


def test_files_of_a_scene_are_found_from_its_new_place(tmp_path):
    scene = gcpdda.Scene.read(SCENES / "seismic_slope.toml")
    gcpdda.inspect(scene)
    written = tomllib.loads(scene.write(tmp_path / "copy.toml").read_text())
    assert written["earthquake"]["record"] == str(SCENES / "seismic_slope.csv")


def test_files_in_values_to_set_are_found_from_the_folder_of_the_scene(tmp_path):
    """The record of a sweep, a table of an earthquake, mapped traces and a file of blocks."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    for name, speed in (("slow", 0.1), ("fast", 0.2)):
        (folder / f"{name}.csv").write_text(f"0,0\n0.1,{speed}\n")
    slider = sliding_block()
    slider.table("output", interval=0.1)
    slider.write(folder / "slider.toml")
    scene = gcpdda.Scene.read(folder / "slider.toml")
    scene.table("earthquake", record="slow.csv")
    tables = []
    for number, one in enumerate((scene, scene.write(folder / "path.toml"))):
        values = {"earthquake.record": ["slow.csv", pathlib.Path("fast.csv")]}
        tables.append(gcpdda.sweep(one, values, ranks=1, out=tmp_path / str(number)))
        assert list(tables[-1]["message"]) == ["", ""] and list(tables[-1]["verdict"]) == ["completed"] * 2
    moved = [list(table["largest_displacement"]) for table in tables]
    assert moved[0] == moved[1] and moved[0][0] != moved[0][1]
    gcpdda.inspect(scene, set={"earthquake": {"record": "fast.csv"}})

    bench = gcpdda.Scene.read(SCENES / "jointed_bench.toml")
    traces = bench.tables.pop("joint_map")
    assert traces[0]["file"] == "jointed_bench_traces.csv"
    found = bench.values_to_set({"joint_map": traces, "blocks.file": "b.h5"})
    assert found["joint_map"] == [traces[0] | {"file": str(SCENES / traces[0]["file"])}]
    assert found["blocks.file"] == str(SCENES / "b.h5") and traces[0]["file"] == "jointed_bench_traces.csv"


def test_faults_of_a_scene_are_an_exception_with_their_lines(tmp_path):
    scene = sliding_block()
    scene.joint("default", friction_angle_deg=95.0)
    scene.table("output", intervall=0.1)
    with pytest.raises(gcpdda.SceneError) as caught:
        gcpdda.run(scene, ranks=2, out=tmp_path / "faulty")
    assert caught.value.exit_code == 3
    assert len(caught.value.faults) == 2
    lines = (tmp_path / "faulty.toml").read_text().splitlines()
    assert {lines[fault.line - 1].split(" ")[0] for fault in caught.value.faults} == {"friction_angle_deg", "intervall"}
    assert "friction_angle_deg" in str(caught.value)
    assert not (tmp_path / "faulty").exists()
    with pytest.raises(gcpdda.SceneError) as caught:
        gcpdda.inspect(sliding_block(), set={"joint.default.friction_angle_deg": 95})
    assert [fault.line for fault in caught.value.faults] == [None]
    assert "below 90" in caught.value.faults[0].message


def test_exit_codes_are_exceptions(tmp_path):
    scene = sliding_block()
    gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    with pytest.raises(gcpdda.FileError, match="overwrite"):
        gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    gcpdda.run(scene, ranks=1, out=tmp_path / "run", overwrite=True)

    scene.stage("rest", "settle", limit=0.001)
    del scene.tables["run"]["duration"]
    with pytest.raises(gcpdda.Undecided) as caught:
        gcpdda.run(scene, ranks=1, out=tmp_path / "undecided")
    assert gcpdda.Result(caught.value.path).verdict == "undecided"

    with pytest.raises(gcpdda.FileError):
        gcpdda.run(tmp_path / "missing.toml", ranks=1, out=tmp_path / "missing")
    with pytest.raises(FileNotFoundError, match="nowhere"):
        gcpdda.run(scene, ranks=1, program=tmp_path / "nowhere")


def test_a_search_without_a_bracket_says_what_came_out(tmp_path):
    """A block on a plane of 30 degrees with a friction angle of 10 degrees slides with its strength; it holds with
    strengths divided by 0.2 and by 0.3."""
    scene = sliding_block(fidelity="rigid")
    scene.joint("default", friction_angle_deg=10.0)
    del scene.tables["run"]["duration"]
    scene.stage("weight", "settle", limit=2.0)
    for ranks in (1, 2):
        with pytest.raises(gcpdda.Undecided) as caught:
            gcpdda.fos(scene, ranks=ranks, out=tmp_path / str(ranks), from_=0.2, to=0.3)
        assert "\nfailed: stage 'weight' has failed" in caught.value.output  # the run with the full strength
        assert str(caught.value) == "the blocks still hold at 0.3, no factor tried made them fail"
    with pytest.raises(gcpdda.FileError, match="/1 holds a search for the factor of safety already"):
        gcpdda.fos(scene, ranks=1, out=tmp_path / "1", from_=0.2, to=0.3)
    with pytest.raises(gcpdda.Undecided, match="^the blocks fail already at 1, the smallest factor tried$"):
        gcpdda.fos(scene, ranks=1, out=tmp_path / "1", from_=1, to=2, overwrite=True)


def test_the_outcome_of_a_search_is_not_that_of_an_earlier_one(tmp_path):
    earlier = "the blocks fail already at 1, the smallest factor tried\nstrengths divided: friction of all\n"
    (tmp_path / "fos.txt").write_text(earlier)
    output = "failed: stage 'a' has failed\nthe blocks do not settle\n" + 70 * "-" + "\nPrimary job  terminated\n" \
        + 70 * "-"
    assert _outcome_of_search(tmp_path, output) == "the blocks do not settle"


def test_exit_codes_are_those_of_the_program():
    """The list that `gcpdda --help` prints from its own table: each code but 0 has one exception, and no other has."""
    help_text = subprocess.run([gcpdda.program(), "--help"], capture_output=True, text=True, check=True).stdout
    listed = dict(re.findall(r"^  (\d+)  (.+)$", help_text.split("Exit codes:")[1], re.M))
    raised = {code: error_of(int(code), "", None) for code in listed if code != "0"}
    classes = {code: type(error) for code, error in raised.items()}
    assert len(set(classes.values())) == len(classes) == len(gcpdda.GcpddaError.__subclasses__())
    # A word of each meaning, so that two codes that change places are noticed.
    words = {gcpdda.InternalError: "internal", gcpdda.UsageError: "command line", gcpdda.SceneError: "scene",
             gcpdda.FileError: "files", gcpdda.NumericalError: "numerical", gcpdda.Stopped: "stopped",
             gcpdda.Undecided: "undecided"}
    for code, error_class in classes.items():
        assert words[error_class] in listed[code]
        assert f"Exit code {code}" in error_class.__doc__
        assert str(raised[code]) == f"the program ended with exit code {code}"


def test_progress_is_told(tmp_path):
    told = []
    gcpdda.run(SCENES / "opening.toml", ranks=1, out=tmp_path / "run",
               progress=lambda time, line: told.append((time, line)))
    lines = [line for _, line in told if line is not None]
    assert any("stage 'weight' settled" in line for line in lines)
    assert all(later >= earlier for (earlier, _), (later, _) in zip(told, told[1:]))


def test_a_sweep_has_a_row_for_every_combination(tmp_path):
    table = gcpdda.sweep(sliding_block(), {"joint.default.friction_angle_deg": [10.0, 40.0, 95.0],
                                           "run.gravity_ramp": [0.0, 0.05]}, ranks=1, out=tmp_path / "sweep")
    assert list(table["joint.default.friction_angle_deg"]) == [10.0, 10.0, 40.0, 40.0, 95.0, 95.0]
    assert list(table["exit_code"]) == [0, 0, 0, 0, 3, 3]
    assert "friction_angle_deg" in table["message"][4]
    # tan 10 < tan 30 < tan 40: the first slides, the third stays but for the closing of the joint.
    assert table["largest_displacement"][0] > 0.05 > 1e-3 > table["largest_displacement"][2]
    assert table["result"][1].summary["time"] == 0.2


def test_a_sweep_has_no_results_of_earlier_runs(tmp_path):
    path = "joint.default.friction_angle_deg"
    gcpdda.sweep(sliding_block(), {path: [10.0, 40.0]}, ranks=1, out=tmp_path / "sweep")
    table = gcpdda.sweep(sliding_block(), {path: [20.0, 95.0]}, ranks=1, out=tmp_path / "sweep")
    assert list(table["exit_code"]) == [4, 3] and list(table["result"]) == [None, None]
    assert list(table["verdict"]) == [None, None] and table["largest_displacement"].isna().all()
    scene = sliding_block()
    scene.stage("rest", "settle", limit=0.001)
    del scene.tables["run"]["duration"]
    table = gcpdda.sweep(scene, {path: [0.0]}, ranks=1, out=tmp_path / "undecided")
    assert table["exit_code"][0] == 7 and table["verdict"][0] == table["result"][0].verdict == "undecided"


def test_the_installed_package_finds_the_installed_program(tmp_path):
    build = pathlib.Path(gcpdda.program()).parent
    subprocess.run(["cmake", "--install", str(build), "--prefix", str(tmp_path)], check=True, capture_output=True)
    packages = tmp_path / "lib" / "python3" / "dist-packages"
    said = subprocess.run([sys.executable, "-c", "import gcpdda; print(gcpdda.__file__); print(gcpdda.program())"],
                          cwd=tmp_path, env={"PYTHONPATH": str(packages)}, capture_output=True, text=True,
                          check=True).stdout.splitlines()
    assert said == [str(packages / "gcpdda" / "__init__.py"), str(tmp_path / "bin" / "gcpdda")]


def test_importing_is_quick():
    code = "import sys, gcpdda; print(any(name in sys.modules for name in ('pandas', 'matplotlib', 'h5py')))"
    said = subprocess.run([sys.executable, "-c", code], env={"PYTHONPATH": str(SOURCE / "run" / "python")},
                          capture_output=True, text=True, check=True).stdout
    assert said.strip() == "False"
