"""gcpdda.Result: files as tables and arrays."""

import shutil

import numpy as np
import pytest

import gcpdda
from gcpdda.joints import strength_laws, strength_used
from gcpdda.plot.layers import Shown
from gcpdda.plot.water import Pressure, waters
from gcpdda.result import trial_folder


def test_frames_and_tables(opening):
    assert opening.verdict == "failed"
    assert opening.times[0] == 0.0 and opening.times[-1] == opening.summary["time"]
    assert list(opening.stages["name"]) == ["weight", "opening", "arch", "too_wide", "fall"]
    assert list(opening.stages["kind"]) == ["settle", "excavate", "settle", "excavate", "run"]
    first, last = opening.frame("first"), opening.frame("last")
    assert len(first.blocks) - len(last.blocks) == opening.stages["removed"].sum() == 20
    assert len(last.blocks) == opening.summary["blocks"] + opening.summary["fixed_blocks"]
    assert opening.before("opening").time == opening.stages["end"][0]
    with pytest.raises(KeyError, match="weight, opening"):
        opening.before("nothing")
    with pytest.raises(KeyError, match="there are 0 to"):
        opening.frame(999)


def test_names_areas_and_centroids(opening):
    blocks = opening.frame("first").blocks
    assert blocks["name"][0] == "floor" and blocks["kind"][0] == "fixed"
    # 14 rows of 12 bricks of 0.5 x 0.25 m, every second row with halves at its ends: 13 bricks.
    assert list(blocks["name"].iloc[[1, 12, 13, 25, 26]]) == ["w.0.0", "w.0.11", "w.1.0", "w.1.12", "w.2.0"]
    assert blocks.loc[blocks["name"] == "w.4.6", ["x", "y", "area"]].values[0] == pytest.approx([3.25, 1.125, 0.125])
    assert blocks["area"][1:].sum() == pytest.approx(6.0 * 3.5)
    monitored = opening.history("w.4.6")
    last = opening.frame("last").blocks
    row = last[last["name"] == "w.4.6"].iloc[0]
    assert monitored["x[m]"].iloc[-1] == pytest.approx(row["x"], abs=1e-9)
    assert monitored["y[m]"].iloc[-1] == pytest.approx(row["y"], abs=1e-9)


def test_names_where_walls_and_pyramids_alternate(tmp_path):
    scene = tmp_path / "alternating.toml"
    bricks = 'material = "rock"\nrows = 2\nblock_size = [1.0, 0.5]\n'
    scene.write_text('[run]\nduration = 0.01\n[material.rock]\ndensity = 2600.0\n[joint.default]\n'
                     'normal_stiffness = 1e9\nfriction_angle_deg = 31.0\n'
                     f'[[wall]]\ncolumns = 2\norigin = [0, 0]\n{bricks}'
                     f'[[pyramid]]\nname = "p"\norigin = [5, 0]\n{bricks}'
                     f'[[wall]]\ncolumns = 3\norigin = [12, 0]\nbond = 0.0\n{bricks}'
                     '[[block]]\nmaterial = "rock"\nfixed = true\nvertices = [[-3, -1], [25, -1], [25, 0], [-3, 0]]\n'
                     '[[monitor]]\nblock = "p.1.0"\n[[monitor]]\nblock = "wall1.1.2"\n')
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    blocks = result.frame("first").blocks
    assert list(blocks["name"].iloc[[1, 6, 9]]) == ["wall0.0.0", "p.0.0", "wall1.0.0"]
    for name in ("p.1.0", "wall1.1.2"):
        start = result.history(name).iloc[0]
        assert blocks.loc[blocks["name"] == name, ["x", "y"]].values[0] == pytest.approx(start[["x[m]", "y[m]"]].values)


def test_profiles_are_lines_of_points(leaning, opening):
    assert leaning.profiles == ["chain"] and "chain" not in leaning.histories and not opening.profiles
    table = leaning.history("chain")
    last = table[table["time[s]"] == leaning.reached]
    assert 2 < len(last) <= 12 and (np.diff(last["distance[m]"]) > 0.0).all()
    start = table[table["time[s]"] == 0.0]
    assert (start[["ux[m]", "uy[m]"]] == 0.0).all(axis=None)
    moved = last[["x[m]", "y[m]"]].to_numpy() - start[["x[m]", "y[m]"]].to_numpy()
    assert moved == pytest.approx(last[["ux[m]", "uy[m]"]].to_numpy(), abs=1e-12)
    blocks = leaning.frame("last").blocks
    assert (blocks.loc[last["block"], "sxx"].to_numpy() == last["sxx[Pa]"].to_numpy()).all()


def test_contact_forces_add_up_to_those_of_blocks(leaning):
    """Directions and signs: at rest, without dashpot forces, the contacts of a block give its contact_force."""
    frame = leaning.frame("last")
    sums = np.zeros((len(frame.ids), 2))
    np.add.at(sums, frame.contacts["block_a"], frame.contact_forces)
    np.add.at(sums, frame.contacts["block_b"], -frame.contact_forces)
    expected = frame.blocks[["fx", "fy"]].to_numpy()
    largest = np.abs(expected).max()
    assert largest > 1e6
    # What still moves: the dashpots' share is in contact_force alone.
    assert sums[~frame.fixed] == pytest.approx(expected[~frame.fixed], abs=1e-4 * largest)


def test_joints_open_and_shear_as_their_blocks_move(opening):
    first, last = opening.frame("first"), opening.frame("last")
    joints = first.joints
    # 13 beds with 24 half bricks each, the bed on the floor with 12 bricks, 11 or 12 heads in a row.
    assert len(joints) == 13 * 24 + 12 + 7 * 11 + 7 * 12
    assert np.abs(joints["opening"]).max() < 1e-12 and np.abs(joints["shear_displacement"]).max() < 1e-12
    assert set(joints["state"]) == {"unloaded"}

    names = last.blocks["name"]
    joints = last.joints
    a, b = last.blocks.loc[joints["block_a"]], last.blocks.loc[joints["block_b"]]
    # Between blocks that have hardly turned the opening is the difference of their motion across the joint.
    along = joints[["x1", "y1"]].to_numpy() - joints[["x0", "y0"]].to_numpy()
    along /= np.hypot(*along.T)[:, None]
    apart = b[["ux", "uy"]].to_numpy() - a[["ux", "uy"]].to_numpy()
    straight = (np.abs(a["rotation"].to_numpy()) < 1e-3) & (np.abs(b["rotation"].to_numpy()) < 1e-3)
    assert straight.sum() > 100
    across = apart[:, 0] * along[:, 1] - apart[:, 1] * along[:, 0]
    assert joints["opening"][straight].to_numpy() == pytest.approx(across[straight], abs=1e-3)
    assert joints["shear_displacement"][straight].to_numpy() == pytest.approx(np.sum(apart * along, axis=1)[straight],
                                                                              abs=1e-3)
    assert joints["opening"].max() > 0.1 and set(joints["state"]) == {"stick", "slip", "open"}
    assert not set(names[joints["block_a"]]) & {"w.0.4", "w.0.5"}  # excavated


def test_joints_between_blocks_of_very_different_sizes(tmp_path):
    """Bricks of 0.2 m beside blocks of 50 m, of which one flies up by 10 micrometres, and seams 0.1 m thick between
    these blocks, of which one does not reach all along them: joints are those of the edges that lie on each other."""
    def box(left, right, low, high):
        return [[left, low], [right, low], [right, high], [left, high]]

    scene = gcpdda.Scene(name="sizes", fidelity="rigid", duration=0.01, gravity=[0.0, 0.0])
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e10, friction_angle_deg=35)
    scene.block("floor", box(0, 200, -50, 0), "rock", fixed=True)
    for k in range(3):
        scene.block(f"big{k}", box(50 * k, 50 * k + 50, 0, 40), "rock")
    scene.block("seam0", box(0, 50, 40, 40.1), "rock")
    scene.block("cover0", box(0, 50, 40.1, 70), "rock")
    scene.block("seam2", box(100, 120, 40, 40.1), "rock")
    scene.block("cover2", box(100, 150, 40.1, 70), "rock")
    scene.block("brick0", box(160, 160.2, 0, 0.1), "rock")
    scene.block("brick1", box(160, 160.2, 0.1, 0.2), "rock", velocity=[0.0, 1e-3, 0.0])
    frame = gcpdda.run(scene, ranks=1, out=tmp_path / "sizes").frame("last")
    joints, names = frame.joints, frame.blocks["name"]
    states = dict(zip(zip(names[joints["block_a"]], names[joints["block_b"]]), joints["state"]))
    assert set(states) == {("floor", "big0"), ("floor", "big1"), ("floor", "big2"), ("big0", "big1"), ("big1", "big2"),
                           ("big0", "seam0"), ("seam0", "cover0"), ("big2", "seam2"), ("seam2", "cover2"),
                           ("floor", "brick0"), ("brick0", "brick1")}
    assert states.pop(("brick0", "brick1")) == "open" and set(states.values()) == {"unloaded"}
    lengths = np.hypot(joints["x1"] - joints["x0"], joints["y1"] - joints["y0"])
    assert sorted(lengths) == pytest.approx([0.2, 0.2, 20, 20, 40, 40, 50, 50, 50, 50, 50])


def test_strength_used_is_one_where_contacts_slip(opening):
    frame = opening.at(float(opening.stages["end"][2]))  # at rest: no dashpots
    used, state = strength_used(frame), frame.contacts["state"]
    assert used.max() <= 1.0 + 1e-9
    assert (used[state == "slip"] > 0.9).all()
    assert used[state == "stick"].mean() < 0.6


def bonded_block(shear, corner=-0.5):
    """A block of 1 m on a floor to which it is bonded, under 1 MN/m and a shear load in N/m; the floor has a corner of
    180 degrees at x = `corner`."""
    scene = gcpdda.Scene(name="bonded", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=35, cohesion=2e5, tension=1e5,
                residual_friction_angle_deg=30)
    scene.block("floor", [[-1, -1], [2, -1], [2, 0], [corner, 0], [-1, 0]], material="rock", fixed=True)
    press = {"point": [0.5, 1.0], "force": [0.0, -1e6]}
    scene.block("block", [[0, 0], [1, 0], [1, 1], [0, 1]], material="rock", load=[press])
    scene.stage("press", "settle", limit=2.0)
    scene.stage("shear", "settle", limit=2.0,
                set={"block.block.load": [press, {"point": [0.5, 0.0], "force": [shear, 0.0]}]})
    return scene


@pytest.mark.parametrize("corner, bonds", [(-0.5, 1), (0.4, 2)])
def test_bonds_use_the_friction_of_what_presses_on_them(tmp_path, corner, bonds):
    """T/(N tan phi + c l) of the joint, whose bonds carry T, one on each edge of the floor, and whose touching edges
    carry N, in a region for each bond."""
    scene = bonded_block(5e5, corner)
    frame = gcpdda.run(scene, ranks=1, out=tmp_path / "bonded").frame("last")
    is_bond = (frame.contacts["state"] == "bond").to_numpy()
    normal = 1e6 + 2600 * 9.81
    expected = 5e5 / (normal * np.tan(np.radians(35.0)) + 2e5)
    used = strength_used(frame)
    assert is_bond.sum() == bonds and (~is_bond).sum() == bonds
    assert used == pytest.approx(expected, rel=2e-3)  # the block turns a little: not all edges bear the mean pressure


def test_rollers_have_a_law_and_names(tmp_path):
    """Rock between two rollers with the law that the program adds, and with one of the scene."""
    scene = gcpdda.Scene(name="rollers", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=31.0)
    scene.table("in_situ", level=4, k0=0.5)
    scene.table("region", material="rock", polygon=[[0, 0], [4, 0], [4, 4], [0, 4]], fixed=["bottom"],
                roller=["left", "right"])
    scene.add("bricks", block_size=[2, 1], bond=0.0)
    for side in ("left", "right"):
        scene.monitor(block=f"roller.{side}")
    scene.stage("weight", "settle", limit=3.0)
    for given in (False, True):
        if given:
            scene.joint("roller", friction_angle_deg=1.0)
        result = gcpdda.run(scene, ranks=1, out=tmp_path / str(given))
        frame = result.frame("last")
        assert list(frame.blocks["name"][:3]) == ["roller.left", "roller.right", "b2"]
        assert frame.blocks["x"][1] == pytest.approx(result.history("roller.right")["x[m]"].iloc[-1])
        contacts = frame.contacts
        assert set(contacts["joint"]) == {"default", "roller"}
        assert ((contacts["joint"] == "roller") == (contacts["block_a"] < 2)).all()
        rolls = (contacts["joint"] == "roller").to_numpy()
        used = strength_used(frame)[rolls]
        assert (used == 0.0).all() if not given else used.max() <= 1.0
    assert gcpdda.report(tmp_path / "False", frames=0).exists()


def test_strength_follows_the_stages_and_the_trial(opening, search):
    scene = dict(opening.scene)
    scene["stage"] = [dict(stage) for stage in scene["stage"]]
    scene["stage"][2]["set"] = {"joint.default.friction_angle_deg": 10.0}
    copy = gcpdda.Result(opening.path)
    copy.__dict__["scene"] = scene
    assert strength_laws(copy, float(opening.stages["begin"][2]))["default"]["friction_angle_deg"] == 35.0
    assert strength_laws(copy, opening.summary["time"])["default"]["friction_angle_deg"] == 10.0
    failing = search.mechanism
    assert failing.weakened == (search.fails, ["bedding"])
    used = strength_used(failing.frame("last"))
    # Bedding slips with its strength divided; without the division it would seem to use 1/factor at most.
    bedding = (failing.frame("last").contacts["joint"] == "bedding").to_numpy()
    assert used[bedding].max() == pytest.approx(1.0, abs=0.05)


def test_runs_of_a_search_know_by_what_strengths_are_divided(search, tmp_path):
    """Also those that confirm a trial, states settled with strengths divided by fos.from, and runs without fos.json."""
    confirmed = gcpdda.Result(search.mechanism.path / "confirm")
    assert confirmed.weakened == (search.fails, ["bedding"]) and search.settled.weakened == (1.0, [])
    shutil.copytree(search.mechanism.path, tmp_path / "trial")
    assert gcpdda.Result(tmp_path / "trial").weakened == (search.fails, ["bedding"])
    weak = tmp_path / "weak"
    shutil.copytree(search.settled.path, weak)
    text = (weak / "scene.toml").read_text()
    (weak / "scene.toml").write_text(f"# settled by gcpdda fos: strengths as below divided by 0.5\n{text}")
    result = gcpdda.Result(weak)
    assert result.weakened == (0.5, ["bedding"])
    full, used = strength_used(search.settled.frame("last")), strength_used(result.frame("last"))
    bedding = (result.frame("last").contacts["joint"] == "bedding").to_numpy()
    assert used[bedding] == pytest.approx(0.5 * full[bedding]) and used[~bedding] == pytest.approx(full[~bedding])


def test_joints_of_trials_are_those_of_the_settled_state(search, tmp_path):
    """Beds that fail slide by what their blocks have moved against each other, and joints behind them open; also where
    the state is that of another search, and in the run that confirms the trial."""
    other = tmp_path / "other"
    shutil.copytree(search.path, other, ignore=shutil.ignore_patterns("settled"))
    confirmed = search.mechanism.path / "confirm"
    far = search.blocks["motion[m]"].max()
    for path in (confirmed, other / confirmed.relative_to(search.path), search.mechanism.path):
        result = gcpdda.Result(path)
        joints = result.frame("last").joints
        assert result.start.path.samefile(search.settled.frame("last").path)
        # Of centroids: where blocks touch, turning by 1e-4 adds less than a hundredth of the way.
        moved = dict(zip(result.start.ids, result.frame("last").values("displacement")[:, :2]
                         - result.start.values("displacement")[:, :2]))
        slips = joints[joints["state"] == "slip"]
        along = (slips[["x1", "y1"]].to_numpy() - slips[["x0", "y0"]].to_numpy())
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        slides = [(moved[a] - moved[b]) @ t for a, b, t in zip(slips["block_a"], slips["block_b"], along)]
        assert slips["shear_displacement"].abs().to_numpy() == pytest.approx(np.abs(slides), abs=1e-2 * far)
        assert np.abs(slides).max() > 0.1 * far
        assert "open" in set(joints["state"]) and joints["opening"].max() > 0.1 * far
        assert result.before("trial") is result.start
        with pytest.raises(ValueError, match="no frame of"):
            result.at(0.0)
        moved = Shown(result.frame("last"), 10.0).points - result.start.points
        assert moved == pytest.approx(10.0 * (result.frame("last").points - result.start.points))
    shutil.rmtree(other / "trials" / "F1")
    (other / "fos.json").unlink()
    with pytest.raises(FileNotFoundError, match="settled state"):
        gcpdda.Result(other / search.mechanism.path.relative_to(search.path)).start


def test_bolts(leaning):
    frame = leaning.frame("last")
    assert list(frame.bolts["support"]) == ["cable"] and list(frame.bolts["state"]) == ["elastic"]
    assert frame.bolts["axial_force"][0] == pytest.approx(leaning.bolts["axial[N]"].iloc[-1])


def test_liners(lined, leaning):
    frame = lined.frame("last")
    table = frame.liners
    assert list(table["liner"]) == ["strong", "strong", "liner1", "liner1"]
    assert list(table["state"]) == ["elastic", "elastic", "broken", "broken"]
    assert list(table["support"]) == ["layer", "layer", "weak", "weak"] and not table["cracked"][:2].any()
    weight = 2600.0 * 9.81
    assert table["shear_force"][:2].abs().sum() == pytest.approx(weight, rel=1e-3)
    # The moment at the nodes is Q L/2 with L = 1.25 m.
    assert table["moment_begin"][0] == pytest.approx(-table["moment_end"][0])
    assert abs(table["moment_begin"][0]) == pytest.approx(0.5 * weight * 0.5 * 1.25, rel=0.01)
    # The loose block sags into the void: tension is on the side of the rock over the fixed blocks.
    assert table["moment_begin"][0] > 0.0 > table["moment_end"][0] and table["shear_force"][0] > 0.0
    assert table["moment_begin"][1] < 0.0 < table["moment_end"][1] and table["shear_force"][1] < 0.0
    # The rock lies on the right of the way, whichever way the points were given.
    assert (frame.liner_lines[:, 1, 0] < frame.liner_lines[:, 0, 0]).all()
    last = lined.liners[lined.liners["time[s]"] == lined.liners["time[s]"].max()].set_index("liner")
    assert last["shear[N/m]"]["strong"] == pytest.approx(0.5 * weight, rel=1e-3)
    assert list(last["broken"]) == [0, 2]
    assert [load["name"] for load in lined.summary["liners"]] == ["strong", "liner1"]
    assert lined.histories == []
    assert lined.to_vtkhdf(lined.path / "elements.vtkhdf", kind="liners").stat().st_size > 1000
    assert not len(leaning.liners) and not len(leaning.frame("last").liners)


def test_results_are_read_while_a_run_goes_on(opening, tmp_path):
    """What a folder holds in the middle of a run: no summary, fewer frames, and a row that is being written."""
    folder = tmp_path / "running"
    shutil.copytree(opening.path, folder)
    (folder / "summary.json").unlink()
    for path in sorted((folder / "frames").glob("*_00001*.hdf")):
        path.rename(tmp_path / path.name)
    energy = folder / "history" / "energy.csv"
    rows = energy.read_text().splitlines(keepends=True)
    energy.write_text("".join(rows[:5]) + rows[5][:40])

    result = gcpdda.Result(folder)
    assert result.verdict is None
    assert len(result.frames) == 10
    assert len(result.energy) == 4 and result.reached == result.energy["time[s]"].iloc[-1]
    result.plot.joints("state", out=tmp_path / "running.png")
    for path in tmp_path.glob("*_00001*.hdf"):
        path.rename(folder / "frames" / path.name)
    assert len(result.frames) == len(opening.frames)
    assert gcpdda.Result(tmp_path / "empty").reached == 0.0


def set_back(result, folder, stage, restart=""):
    """A copy of a folder as it was while a stage went on."""
    shutil.copytree(result.path, folder)
    (folder / "summary.json").unlink()
    lines = result.log.splitlines(keepends=True)
    end = next(k for k, line in enumerate(lines) if line.startswith(f"stage '{stage}'"))
    (folder / "run.log").write_text("".join(lines[:end]) + restart)
    return gcpdda.Result(folder)


def test_stages_are_known_while_a_run_goes_on(opening, tmp_path):
    running = set_back(opening, tmp_path / "running", "fall")
    shown, whole = running.stages, opening.stages
    assert list(shown["name"]) == list(whole["name"]) and list(shown["kind"]) == list(whole["kind"])
    assert list(shown["verdict"]) == [*whole["verdict"][:4], "goes on"]
    assert list(shown["begin"]) == list(whole["begin"]) and list(shown["removed"][:4]) == list(whole["removed"][:4])
    assert running.before("fall").number == opening.before("fall").number
    assert "Stage arch" in gcpdda.report(running.path, frames=0).read_text()
    # A restart from before the end of a stage does it again.
    restart = f"restart from c.h5: t = {whole['begin'][2]:.9g} s, step 57, 3 frames\n"
    again = set_back(opening, tmp_path / "again", "fall", restart)
    assert list(again.stages["name"]) == ["weight", "opening", "arch"]
    assert list(again.stages["verdict"])[2] == "goes on"
    scene = gcpdda.Result(tmp_path / "none")
    scene.__dict__["scene"] = {}
    assert not len(scene.stages) and {"name", "begin", "end", "steps"} <= set(scene.stages.columns)


def test_strengths_and_water_of_stages_are_known_while_a_run_goes_on(tmp_path):
    scene = bonded_block(1e5)
    scene.tables["joint"]["default"] = {"normal_stiffness": 1e9, "friction_angle_deg": 35}
    scene.table("water.low", phreatic=[[-10.0, -5.0], [10.0, -5.0]])
    scene.stage("weak", "change", set={"joint.default.friction_angle_deg": 20.0,
                                       "water.low.phreatic": [[-10.0, -2.0], [10.0, -2.0]]})
    scene.stage("wait", "run", duration=0.1)
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    running = set_back(result, tmp_path / "running", "wait")
    for one in (result, running):
        before, last = one.before("weak"), one.frame("last")
        for frame, friction, level in ((before, 35.0, -5.0), (last, 20.0, -2.0)):
            used = 1e5 / ((1e6 + 2600 * 9.81) * np.tan(np.radians(friction)))
            assert strength_used(frame) == pytest.approx(used, rel=0.01)  # what still moves
            assert waters(one, frame.time)["low"]["phreatic"][0][1] == level


@pytest.mark.parametrize("last_stage", ["weak", "stone"])
def test_the_last_frame_shows_what_closing_stages_set(tmp_path, last_stage):
    """The run ends with a stage of kind change, or with an excavation after it: their frame has the time of the one
    before."""
    scene = bonded_block(1e5)
    scene.tables["joint"]["default"] = {"normal_stiffness": 1e9, "friction_angle_deg": 35}
    scene.table("water.low", phreatic=[[-10.0, 0.5], [10.0, 0.5]])
    scene.block("stone", [[1.4, 0], [1.6, 0], [1.6, 0.2], [1.4, 0.2]], material="rock")
    scene.stage("weak", "change", set={"joint.default.friction_angle_deg": 20.0, "water.low.active": False})
    if last_stage == "stone":
        scene.stage("stone", "excavate", blocks=["stone"])
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    before, last = result.frames[-2:]
    assert before.time == last.time and len(before.ids) - len(last.ids) == (last_stage == "stone")
    assert result.at_end_of("shear") is before and result.before("weak") is before
    assert result.at_end_of(last_stage) is last and result.at(last.time) is last
    for frame, active, friction in ((before, True, 35.0), (last, False, 20.0)):
        assert waters(result, frame)["low"].get("active", True) == active
        assert strength_laws(result, frame)["default"]["friction_angle_deg"] == friction
        assert bool(len(Pressure().lines(Shown(frame))[0])) == active
    assert not waters(result, last.time)["low"]["active"]
    ratio = strength_used(last)[0] / strength_used(before)[0]
    assert ratio == pytest.approx(np.tan(np.radians(35.0)) / np.tan(np.radians(20.0)), rel=1e-9)


def test_pictures_use_the_gravity_and_damping_that_stages_set(tmp_path):
    """The pressure of water at the bottom of a block, 2 m below the phreatic line."""
    scene = gcpdda.Scene(name="heavy", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e10, friction_angle_deg=35)
    scene.block("floor", [[0, -1], [4, -1], [4, 0], [0, 0]], "rock", fixed=True)
    scene.block("block", [[1, 0], [2, 0], [2, 1], [1, 1]], "rock")
    scene.table("water.low", phreatic=[[0, 2], [4, 2]])
    scene.stage("light", "settle", limit=3)
    scene.stage("heavy", "settle", limit=3, set={"run.gravity": [0.0, -98.1], "water.low.density": 1100.0,
                                                 "run.rayleigh": {"ratio": 0.05, "frequency": 5.0}})
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "run")
    for frame, expected in ((result.before("heavy"), 1000 * 9.81 * 2), (result.frame("last"), 1100 * 98.1 * 2)):
        assert Pressure().lines(Shown(frame))[1].max() == pytest.approx(expected, rel=1e-4)
    assert result.plot.rayleigh().axes[0].texts[0].get_text() == "0.05 at 5 Hz"


def test_frames_of_a_run_that_goes_on_are_complete(leaning, lined, tmp_path):
    """The program writes the files of a frame one after the other: blocks, contacts, bolts, liners."""
    for one, kinds in ((leaning, ("contacts", "bolts")), (lined, ("contacts", "liners"))):
        folder = tmp_path / one.path.name
        shutil.copytree(one.path, folder)
        (folder / "summary.json").unlink()
        last = one.frame("last").number
        for kind in kinds:
            (folder / "frames" / f"{kind}_{last:06}.hdf").rename(folder / kind)
            result = gcpdda.Result(folder)
            assert result.frame("last").number == last - 1 and len(result.frames) == last
            (folder / kind).rename(folder / "frames" / f"{kind}_{last:06}.hdf")
            assert result.frame("last").number == last
    # Where the frame before has no contacts either, they are not waited for.
    for k in (last - 1, last):
        (folder / "frames" / f"contacts_{k:06}.hdf").rename(folder / f"{k}")
    assert len(gcpdda.Result(folder).frames) == last + 1
    for k in (last - 1, last):
        (folder / f"{k}").rename(folder / "frames" / f"contacts_{k:06}.hdf")
    # Files that are gone from the middle, or from the end of a run that has ended, hide no frame.
    (folder / "frames" / f"contacts_{last - 1:06}.hdf").unlink()
    assert len(gcpdda.Result(folder).frames) == last + 1
    shutil.copy(lined.path / "summary.json", folder)
    (folder / "frames" / f"contacts_{last:06}.hdf").unlink()
    with pytest.raises(FileNotFoundError, match="has been removed"):
        gcpdda.Result(folder).frame("last").contacts


def test_without_contacts_the_last_frame_is_complete(opening, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(opening.path, folder)
    (folder / "summary.json").unlink()
    for path in (folder / "frames").glob("contacts_*"):
        path.unlink()
    scene = folder / "scene.toml"
    scene.write_text(scene.read_text().replace("[output]\n", "[output]\ncontacts = false\n"))
    assert "contacts = false" in scene.read_text()
    last = gcpdda.Result(folder).frame("last")
    assert last.number == opening.frame("last").number
    with pytest.raises(FileNotFoundError, match="unless the scene has output.contacts = false"):
        last.contacts


def test_monitors_by_the_names_of_supports(opening, leaning, lined, tmp_path):
    """Only the tables of the program are no histories: a scene without bolts may have a point of this name."""
    scene = gcpdda.Scene(name="named", fidelity="rigid", duration=0.05)
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    scene.block("floor", [[-5, -1], [5, -1], [5, 0], [-5, 0]], "rock", fixed=True)
    scene.block("block", [[-1, 0], [1, 0], [1, 2], [-1, 2]], "rock")
    for name in ("bolts", "liners"):
        scene.monitor(name=name, point=[0.5, 0.5])
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "named")
    assert result.histories == ["bolts", "liners"]
    assert "x[m]" in result.history("bolts")
    assert result.bolts.empty and result.liners.empty
    with pytest.raises(ValueError, match="no history of bolts"):
        result.plot.bolts()
    for one, there in ((opening, []), (leaning, ["bolts"]), (lined, ["liners"])):
        assert one.supports == there and not {"energy", "bolts", "liners"} & set(one.histories)
        assert [len(one.bolts) > 0, len(one.liners) > 0] == ["bolts" in there, "liners" in there]


def test_searches_and_ensembles_that_have_not_ended(search, members, tmp_path):
    """What is there when the program was killed: trials and the settled state, members, but no result."""
    folder = tmp_path / "search"
    (folder / "trials").mkdir(parents=True)
    shutil.copytree(search.path / "settled", folder / "settled")
    found = gcpdda.open_folder(folder)
    assert isinstance(found, gcpdda.Safety) and found.summary is None
    assert found.settled.verdict == "settled" and len(found.settled.frame("last").blocks)
    parts = ("factor", "holds", "fails", "bound", "trials", "blocks", "mechanism")
    advice = f"has not ended.*--out {folder} --overwrite.*--settled {folder}/settled"
    for name in parts:
        with pytest.raises(FileNotFoundError, match=advice):
            getattr(found, name)
    (folder / "settled" / "summary.json").unlink()
    with pytest.raises(FileNotFoundError, match="--overwrite$"):
        found.factor
    for name in parts:
        with pytest.raises(FileNotFoundError, match="not the folder of a search"):
            getattr(gcpdda.Safety(tmp_path / "nothing"), name)

    folder = tmp_path / "ensemble"
    folder.mkdir()
    shutil.copy(members.path / "ensemble.toml", folder)
    found = gcpdda.open_folder(folder)
    assert isinstance(found, gcpdda.Ensemble) and found.summary is None
    for name in ("members", "probability_of_failure"):
        with pytest.raises(FileNotFoundError, match="has not ended.*repeat its call"):
            getattr(found, name)
        with pytest.raises(FileNotFoundError, match="not the folder of an ensemble"):
            getattr(gcpdda.Ensemble(tmp_path / "nothing"), name)


def test_fos_and_ensemble(search, members):
    assert search.holds < search.factor < search.fails
    assert search.mechanism.verdict == "failed"
    for trial in search.summary["trials"]:
        assert search.trial(trial["factor"]).path.is_dir()
    assert trial_folder(1.9498344959999998) == "F1.9498345", "as the program writes it"
    assert len(search.trials) == len(search.summary["trials"])
    assert search.blocks["moves"].sum() == len(search.summary["moving"])
    assert len(members.members) == 8 == members.summary["done"]
    assert isinstance(gcpdda.open_folder(search.path), gcpdda.Safety)
    assert isinstance(gcpdda.open_folder(members.path), gcpdda.Ensemble)
    assert isinstance(gcpdda.open_folder(search.path / "settled"), gcpdda.Result)
    with pytest.raises(FileNotFoundError, match="not a result folder"):
        gcpdda.open_folder(members.path / "members")


def test_fos_that_begins_with_the_state_of_another_search(search, tmp_path):
    shutil.copy(search.path / "fos.json", tmp_path)
    assert gcpdda.open_folder(tmp_path).settled.path.samefile(search.path / "settled")
