"""Pictures: that each is drawn with axes, units and content, and that its scale means what it says."""

import pathlib
import shutil
import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import SOURCE
from matplotlib.quiver import QuiverKey

import gcpdda
from gcpdda.plot import ARROWS, FIELDS, HISTORIES, JOINTS, style
from gcpdda.plot.layers import Arrows, Blocks, Crosses, JointLines, Shown
from gcpdda.plot.over_time import PROFILES


def texts_of(figure):
    """Labels of all axes of a figure, colour bars among them."""
    return [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def check_map(figure):
    figure.canvas.draw()
    texts = texts_of(figure)
    assert "x (m)" in texts and "y (m)" in texts
    panels = [axes for axes in figure.axes if axes.get_ylabel() == "y (m)"]
    assert panels and all(axes.get_title().startswith("t = ") and axes.collections for axes in panels)
    plt.close(figure)
    return texts


@pytest.mark.parametrize("field", [field for field in FIELDS if field != "permanent"])
def test_fields(opening, field):
    texts = check_map(opening.plot.field(field, frame=["first", "last"]))
    assert any(text.endswith(")") and "(m)" not in text for text in texts) or field in ("kind", "none", "displacement")


@pytest.mark.parametrize("quantity", JOINTS)
def test_joints(opening, quantity):
    texts = check_map(opening.plot.joints(quantity, frame=["first", 8, "last"]))
    assert quantity == "state" or len(texts) >= 3


@pytest.mark.parametrize("quantity", ARROWS)
def test_arrows(opening, quantity):
    check_map(opening.plot.vectors(quantity, since="fall" if quantity == "permanent" else None))


def test_other_maps(leaning, opening):
    for draw in (leaning.plot.chains, leaning.plot.crosses, leaning.plot.water, leaning.plot.forces,
                 leaning.plot.strength):
        check_map(draw())
    check_map(opening.plot.field("permanent", since="fall"))
    with pytest.raises(ValueError, match="give since=NAME"):
        opening.plot.field("permanent")
    check_map(opening.plot.before_after("stress"))
    assert any("tension of a bolt" in text for text in check_map(leaning.plot.field()))


def extents(figure, artists):
    figure.canvas.draw()
    return [artist.get_window_extent(figure.canvas.get_renderer()) for artist in artists]


def test_keys_do_not_lie_on_each_other(opening):
    """Those of arrows and crosses above panels that are beside each other, and the titles of the panels."""
    figure = opening.plot.map("stress", arrows="displacement", crosses=True, frame=["first", 8, "last"])
    panels = [axes for axes in figure.axes if axes.get_title()]
    keys = []
    for axes in panels:
        arrows = [child for child in axes.get_children() if isinstance(child, QuiverKey)]
        keys += [axes.title, *axes.texts, *(arrow.text for arrow in arrows)]
        assert len(axes.texts) + len(arrows) == 2
    boxes = extents(figure, keys)
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k])
    plt.close(figure)


def test_axes_in_map_coordinates(tmp_path):
    """Labels have all their digits, no factor above the axes, and room beside each other."""
    scene = gcpdda.Scene(name="far", fidelity="rigid", duration=0.01)
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    corner = np.array([5450000.0, 4999990.0])
    scene.block("floor", corner + [[0, 0], [30, 0], [30, 10], [0, 10]], "rock", fixed=True)
    scene.block("block", corner + [[0, 10], [30, 10], [30, 20], [0, 20]], "rock")
    figure = gcpdda.run(scene, ranks=1, out=tmp_path / "far").plot.crosses(frame=["first", "last", "last"])
    figure.canvas.draw()
    for axes in (axes for axes in figure.axes if axes.get_title()):
        for axis in (axes.xaxis, axes.yaxis):
            assert axis.get_offset_text().get_text() == ""
        shown = [label for label in axes.get_xticklabels() if label.get_text() and label.get_visible()]
        boxes = extents(figure, shown)
        assert all(left.x1 < right.x0 for left, right in zip(boxes, boxes[1:]))
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert "5000000" in labels
    plt.close(figure)


def test_liners(lined, opening):
    def legend_of(figure):
        return [text.get_text() for legend in figure.legends for text in legend.texts]

    figure = lined.plot.map()
    assert "liner broken" in legend_of(figure)
    assert any("thrust of liners" in text for text in check_map(figure))
    for quantity in ("moment", "shear", "strength_used"):
        figure = lined.plot.map(liners=quantity, moments=True)
        assert any(text.startswith("moment on the side in tension") for text in legend_of(figure))
        check_map(figure)
    plt.close(lined.plot.liners())
    with pytest.raises(ValueError, match="no history of liners"):
        opening.plot.liners()


def test_curves(opening, leaning):
    for quantity in HISTORIES:
        figure = opening.plot.history(quantity)
        assert any(text.endswith(")") for text in texts_of(figure)) and "time (s)" in texts_of(figure)
        plt.close(figure)
    figure = opening.plot.energy()
    # The stages are marked: a label above the axes for each, those that begin together share one.
    labels = [label.get_text() for axes in figure.axes for child in axes.child_axes
              for label in child.get_xticklabels()]
    assert "weight" in labels and any("arch" in label for label in labels)
    plt.close(figure)
    plt.close(leaning.plot.bolts())
    with pytest.raises(ValueError, match="no history of bolts"):
        opening.plot.bolts()
    with pytest.raises(ValueError, match="run.rayleigh"):
        opening.plot.rayleigh()


def test_profiles(leaning, opening):
    for quantity in PROFILES:
        figure = leaning.plot.profile("chain", quantity, times=None if quantity == "x" else [0.0, leaning.reached])
        assert "distance along chain (m)" in texts_of(figure)
        assert len(figure.axes[0].lines) == (6 if quantity == "x" else 3)  # and the line at zero
        plt.close(figure)
    with pytest.raises(ValueError, match="no profile"):
        opening.plot.profile()


def test_profiles_of_whole_numbers(opening, tmp_path):
    """Distances of 0, 1 and 2 m, with a gap at 1 m at the second time; and a profile of which no row is written."""
    folder = tmp_path / "copy"
    shutil.copytree(opening.path, folder)
    header = "time[s],distance[m],x[m],y[m],ux[m],uy[m],vx[m/s],vy[m/s],sxx[Pa],syy[Pa],sxy[Pa],block\n"
    rows = [f"{time},{at},{at},0,{time},0,0,0,0,0,0,1\n" for time, at in ((0, 0), (0, 1), (0, 2), (1, 0), (1, 2))]
    (folder / "history" / "line.csv").write_text(header + "".join(rows))
    (folder / "history" / "none.csv").write_text(header)
    figure = gcpdda.Result(folder).plot.profile("line")
    distances = figure.axes[0].lines[0].get_xdata()
    assert distances == pytest.approx([0.0, np.nan, 2.0], nan_ok=True)
    plt.close(figure)
    with pytest.raises(ValueError, match="no rows"):
        gcpdda.Result(folder).plot.profile("none")


def test_blocks_that_are_gone(opening, tmp_path):
    """Permanent displacement of blocks that are excavated before the stage; frames without any block."""
    figure = opening.plot.field("permanent", since="fall", frame=["first", "last"])
    check_map(figure)
    scene = gcpdda.Scene(name="gone", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    scene.block("ground", [[-5, -1], [5, -1], [5, 0], [-5, 0]], material="rock", fixed=True)
    scene.block("block", [[-1, 0], [1, 0], [1, 2], [-1, 2]], material="rock")
    scene.stage("weight", "settle", limit=1.0)
    scene.stage("all", "excavate", region=[[-9, -9], [9, -9], [9, 9], [-9, 9]])
    scene.stage("rest", "run", duration=0.05)
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "gone")
    last = result.frame("last")
    assert not len(last.blocks) and not len(last.joints) and not last.polygons
    check_map(result.plot.field(frame=["first", "last"], scale=2.0))
    with pytest.raises(ValueError, match="no blocks to draw"):
        result.plot.field()
    assert "No block is left" in gcpdda.report(result.path, frames=2).read_text()
    for frame in result.frames[:-1]:
        frame.path.unlink()
    alone = gcpdda.Result(result.path)
    assert not len(alone.frame("first").joints)
    assert "No block is left" in gcpdda.report(result.path, frames=0).read_text()


def test_bolts_with_a_single_row_have_a_marker(tmp_path):
    scene = gcpdda.Scene(name="bolted", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    scene.block("ground", [[-5, -1], [5, -1], [5, 0], [-5, 0]], material="rock", fixed=True)
    scene.block("block", [[-1, 0], [1, 0], [1, 2], [-1, 2]], material="rock")
    scene.table("support.bar", kind="anchored", axial_stiffness=1e7, pretension=1e3)
    for name, x, active in (("early", -0.5, True), ("late", 0.5, False)):
        scene.add("bolt", name=name, support="bar", active=active, **{"from": [x, 1.0], "to": [x, -0.5]})
    scene.stage("weight", "settle", limit=1.0)
    scene.stage("bolt", "change", set={"bolt.late.active": True})
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "bolted")
    (axes,) = result.plot.bolts().axes
    markers = {line.get_label(): line.get_marker() for line in axes.lines}
    assert markers["late"] == "o" and markers["early"] != "o"


def test_states_of_joints_need_contacts(tmp_path):
    result = gcpdda.run(SOURCE / "run" / "scenes" / "incline.toml", ranks=1, out=tmp_path / "run",
                        set={"output.contacts": False})
    check_map(result.plot.joints("opening"))
    for draw in (result.plot.joints, result.plot.strength):
        with pytest.raises(FileNotFoundError, match="output.contacts = false"):
            draw()


def test_energies_balance(opening, leaning):
    """What is stored, lost and taken by stages is the work from outside and the residual."""
    from gcpdda.plot.over_time import energy_parts
    parts = energy_parts(leaning.energy)
    assert np.abs(parts["taken"]).max() < 1e-9 * np.abs(parts["gravity"]).max()
    table = opening.energy
    taken = energy_parts(table)["taken"]
    begin = opening.stages["begin"][1], opening.stages["begin"][3]
    assert np.abs(taken[table["time[s]"] <= begin[0]]).max() < 1e-5  # J/m: what still moved
    changes = np.abs(np.diff(taken)) > 1e-3  # J/m: only when blocks are taken out
    assert changes.sum() == 2
    assert table["time[s]"][:-1][changes].to_numpy() == pytest.approx(begin)


def test_colours_fit_the_window(opening):
    shown = [Shown(opening.frame("last"))]
    whole, part = (np.array([[-1.0, -1.0], [7.0, 4.0]]), np.array([[0.0, 3.0], [2.0, 4.0]]))
    tops = []
    for window in (whole, part):
        layer = Blocks("displacement")
        layer.prepare(shown, tuple(window))
        tops.append(layer.scale.norm.vmax / layer.factor)
    moved = opening.frame("last").blocks
    assert tops[0] == pytest.approx(moved["displacement"].max())
    assert tops[1] < 0.5 * tops[0]
    assert layer.extend == "max"  # the colour bar says that there is more outside


def test_dark_joints_are_seen_on_every_colour():
    """Contrast of block outlines with the darkest colours (WCAG asks 3 for lines): zero is light, the end is not
    black."""
    def luminance(colour):
        c = np.array(plt.matplotlib.colors.to_rgb(colour))
        c = np.where(c <= 0.03928, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
        return float(c @ [0.2126, 0.7152, 0.0722])

    def contrast(a, b):
        low, high = sorted((luminance(a), luminance(b)))
        return (high + 0.05) / (low + 0.05)

    assert contrast(style.SEQUENTIAL(0.0), style.EDGE) > 12
    assert contrast(style.SEQUENTIAL(1.0), style.EDGE) > 1.5
    assert contrast(style.SIGNED(0.5), style.EDGE) > 12


def test_pictures_keep_their_colours(leaning):
    """256 colours are enough: also those of a few pixels, such as a short line in a legend, stay what they are."""
    import io

    from PIL import Image

    from gcpdda.plot import png
    figure = leaning.plot.joints("state")
    exact = io.BytesIO()
    figure.savefig(exact, format="png", dpi=100, bbox_inches="tight", pad_inches=0.06)
    few = np.asarray(Image.open(io.BytesIO(png(figure, 100))).convert("RGB")).astype(int)
    assert np.abs(few - np.asarray(Image.open(exact).convert("RGB"))).max() < 32  # of 255
    plt.close(figure)


def test_crosses_are_principal_stresses(leaning):
    shown = Shown(leaning.frame("last"))
    window = tuple(np.array([[-100.0, -100.0], [200.0, 200.0]]))
    at, values, directions = Crosses().principal(shown, window)
    stress = leaning.frame("last").values("stress")[~shown.fixed]
    assert len(at) == len(stress)
    rebuilt = np.einsum("nk,nki,nkj->nij", values, directions, directions)
    assert rebuilt[:, 0, 0] == pytest.approx(stress[:, 0]) and rebuilt[:, 0, 1] == pytest.approx(stress[:, 2])


def test_forces_act_on_the_upper_block(leaning):
    """Columns on a base that rises to the right: the base pushes every column up."""
    shown = Shown(leaning.frame("last"))
    window = tuple(np.array([[-100.0, -100.0], [200.0, 200.0]]))
    frame = shown.frame
    _, forces = Arrows("force").vectors(shown, window)
    on_base = frame.fixed[np.searchsorted(frame.ids, frame.contacts["block_a"])]
    assert on_base.sum() >= 16 and (forces[on_base][:, 1] > 0.0).all()


def test_magnified_motion_moves_contacts_along(leaning):
    """Lines follow the block they lie on: an edge of a block stays its edge."""
    frame = leaning.frame("last")
    shown = Shown(frame, 100.0)
    edges = np.stack([frame.points[frame.offsets[:-1]], frame.points[frame.offsets[:-1] + 1]], axis=1)
    drawn = np.stack([shown.points[frame.offsets[:-1]], shown.points[frame.offsets[:-1] + 1]], axis=1)
    assert np.abs(drawn - edges).max() > 0.1
    assert shown.moved(edges, frame.ids) == pytest.approx(drawn, abs=1e-9)
    lines, _ = JointLines("normal_force").lines(shown)
    plain, _ = JointLines("normal_force").lines(Shown(frame))
    assert np.abs(lines - plain).max() > 0.1


def test_animations_last_as_long_as_asked(leaning, tmp_path):
    from PIL import Image
    frames = len(leaning.frames)
    for name, options, length in (("all.gif", {}, 8.0), ("quick.gif", {"fps": 20}, frames / 20)):
        leaning.plot.animate(tmp_path / name, dpi=40, **options)
        movie = Image.open(tmp_path / name)
        seconds = 0.0
        for number in range(movie.n_frames):
            movie.seek(number)
            seconds += movie.info["duration"] / 1000.0
        assert seconds == pytest.approx(length, rel=0.15)


def test_command_line(opening, tmp_path):
    def plot(*words):
        return subprocess.run([str(SOURCE / "run" / "plot.py"), str(opening.path), *words, "--out",
                               str(tmp_path / "picture.png")], capture_output=True, text=True)

    for words in (["--frame", "0,last", "--field", "stress", "--scale", "3", "--compare", "first"],
                  ["--joints", "state"], ["--field", "permanent", "--since", "fall"],
                  ["--crosses", "--arrows", "velocity", "--window=0,0,6,4"],
                  ["--history", "speed", "--monitors", "w.4.6"], ["--energy"],
                  ["--liners", "moment", "--moments"]):
        done = plot(*words)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "picture.png").stat().st_size > 10_000
        (tmp_path / "picture.png").unlink()
    for words, reason in ((["--frame", "77"], "no frame 77"), (["--field", "permanent"], "belong together"),
                          (["--since", "x", "--field", "permanent"], "no stage x"), (["--window=1,2"], "four numbers"),
                          (["--bolts"], "no history of bolts"),
                          (["--liner-history"], "no history of liners"), (["--joints", "colour"], "invalid choice")):
        done = plot(*words)
        assert done.returncode != 0 and reason in done.stderr, done.stderr
        assert "Traceback" not in done.stderr


def test_paraview_script_draws_blocks_and_bolts(leaning, tmp_path):
    """With a ParaView that only notes what is asked of it; CTest draws with the real one where it is installed."""
    fake = tmp_path / "paraview"
    fake.mkdir()
    (fake / "__init__.py").write_text("")
    (fake / "simple.py").write_text("""
import unittest.mock
source = unittest.mock.MagicMock(TimestepValues=[0.0, 1.0])
source.GetDataInformation().GetNumberOfCells.return_value = 1
opened = []
def OpenDataFile(path):
    print("opens", path)
    return source
def SaveScreenshot(path, view):
    print("saves", path)
ColorBy = CreateView = ExtractSurface = GetColorTransferFunction = GetScalarBar = Render = Show = Triangulate = source
""")
    done = subprocess.run([sys.executable, str(SOURCE / "run" / "paraview.py"), str(leaning.path), "picture.png"],
                          env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert f"opens {leaning.path / 'run.hdf.series'}" in done.stdout
    assert f"opens {leaning.path / 'bolts.hdf.series'}" in done.stdout and "1 lines of bolts" in done.stdout
    assert "saves picture.png" in done.stdout


def test_every_file_says_what_it_is_for():
    for path in pathlib.Path(SOURCE / "run" / "python" / "gcpdda").rglob("*.py"):
        assert path.read_text().startswith('"""'), path
