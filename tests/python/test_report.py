"""Reports: that they hold what they promise, in one file without links to elsewhere, and that a browser shows them."""

import base64
import html
import html.parser
import io
import json
import os
import pathlib
import re
import shutil
import subprocess

import browser
import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import SCENES, SOURCE
from PIL import Image

import gcpdda
from gcpdda.reports.ensemble import draw_factors
from gcpdda.reports.page import Page, text_of
from gcpdda.reports.run import residual_share


class Reader(html.parser.HTMLParser):
    """Links, anchors, pictures, players and headings of a page; that its elements are closed in order."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.images, self.players, self.headings, self.open = [], set(), [], [], [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.links += [attributes[name] for name in ("href", "src") if name in attributes]
        self.anchors |= {attributes["id"]} if "id" in attributes else set()
        if tag == "img" and "src" in attributes:
            self.images.append(base64.b64decode(attributes["src"].split(",", 1)[1]))
        if tag not in ("meta", "link", "img", "input"):
            self.open.append((tag, attributes))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open and self.open[-1][0] == "h2":
            self.headings.append(data)
        if self.open and self.open[-1][1].get("type") == "application/json":
            self.players.append(json.loads(data))


def check(path):
    """What holds for every report; returns its headings, the frames of its players and its text."""
    text = path.read_text()
    reader = Reader(text)
    for link in reader.links:
        assert link.startswith("data:") or link.startswith("#") and link[1:] in reader.anchors, link[:80]
    without_images = re.sub(r"[A-Za-z0-9+/=]{100,}", "", text)
    assert not re.search(r"https?:|//cdn|@import|url\(", without_images)
    frames = [frame for player in reader.players for frame in player]
    images = reader.images + [base64.b64decode(frame["image"]) for frame in frames]
    assert images
    for image in images:
        pixels = np.asarray(Image.open(io.BytesIO(image)).convert("L"))
        assert pixels.shape[0] > 100 and pixels.std() > 2.0  # not blank
    for player in reader.players:
        assert len({Image.open(io.BytesIO(base64.b64decode(frame["image"]))).size for frame in player}) == 1
    assert path.stat().st_size < 10_000_000
    return reader.headings, frames, text


def test_of_a_run_in_stages(opening, tmp_path):
    headings, frames, text = check(gcpdda.report(opening.path, tmp_path / "opening.html", frames=8))
    assert headings == ["Motion", "Warnings", "Geometry", "Materials and laws", "Stages", "State at the end",
                        "Histories", "Energy", "Speed", "Provenance"]
    assert 2 <= len(frames) <= 8 and float(frames[-1]["time"]) == pytest.approx(opening.summary["time"], rel=1e-3)
    assert "has failed at t" in text and "Stage arch: settled" in text
    import hashlib
    assert hashlib.sha256((opening.path / "scene.toml").read_bytes()).hexdigest() in text
    assert opening.summary["version"] in text and opening.summary["command"] in html.unescape(text)


def test_of_stages_that_end_at_the_same_time(tmp_path):
    """The stage `after` takes no time, since no block is left that can move: its frame has the time of `low`."""
    scene = gcpdda.Scene(name="emptied", fidelity="rigid")
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    scene.block("ground", [[-5, -1], [5, -1], [5, 0], [-5, 0]], material="rock", fixed=True)
    scene.block("lower", [[-1, 0], [1, 0], [1, 1], [-1, 1]], material="rock")
    scene.block("upper", [[-1, 1], [1, 1], [1, 2], [-1, 2]], material="rock")
    scene.stage("weight", "settle", limit=1.0)
    scene.stage("top", "excavate", blocks=["upper"], relax=0.1, set={"joint.default.friction_angle_deg": 35.0})
    scene.stage("low", "settle", limit=1.0)
    scene.stage("all", "excavate", region=[[-9, 0], [9, 0], [9, 9], [-9, 9]])
    scene.stage("after", "settle", limit=1.0)
    result = gcpdda.run(scene, ranks=1, out=tmp_path / "emptied")
    ends = list(result.stages["end"])
    assert ends[2] == ends[4] == result.frames[-1].time == result.frames[-2].time
    assert [len(result.at_end_of(name).ids) for name in ("weight", "low", "after")] == [3, 2, 1]
    assert [len(result.before(name).ids) for name in ("top", "all")] == [3, 2]
    _, _, text = check(gcpdda.report(result.path, frames=2))
    assert "excavates blocks upper; relax = 0.1 s; joint.default.friction_angle_deg = 35" in text
    assert "excavates the blocks in region (-9, 0) (9, 0) (9, 9) (-9, 9)" in text


def test_of_searches_and_ensembles_that_have_not_ended(tmp_path):
    """run/report.py and `gcpdda report` say what the folder is and what to do."""
    for name, there, words in (("search", "trials", "has not ended.*--overwrite"),
                               ("ensemble", "ensemble.toml", "has not ended.*repeat its call")):
        folder = tmp_path / name
        (folder / there).mkdir(parents=True)
        said = subprocess.run([SOURCE / "run" / "report.py", folder], capture_output=True, text=True)
        assert said.returncode == 4 and re.search(words, said.stderr), said.stderr
        assert not (folder / "report.html").exists()


def test_of_a_run_with_bolts_and_water(leaning, tmp_path):
    headings, _, text = check(gcpdda.report(leaning.path, tmp_path / "leaning.html", frames=4))
    assert "Bolts" in headings and "cable" in text and "Water pressure" in text


def test_of_a_run_with_liners(lined, tmp_path):
    headings, _, text = check(gcpdda.report(lined.path, tmp_path / "lined.html", frames=4))
    assert "Liners" in headings and "strong" in text and "largest thrust (N/m)" in text
    tension = float(re.search(r"liners: .*largest tension (\S+) N/m in 'strong'", lined.log)[1])
    assert tension == pytest.approx(max(liner["largest_tension"] for liner in lined.summary["liners"]), rel=1e-3)


def test_of_a_search(search, tmp_path):
    headings, _, text = check(gcpdda.report(search.path, tmp_path / "fos.html", frames=4))
    assert headings[:2] == ["Trials", "Mechanism"] and "Factor of safety" in text
    assert f"{len(search.summary['moving'])} blocks move" in text


def verdicts(page):
    return re.findall(r'<p class="verdict (\w+)">([^<]*)</p>', html.unescape(page.read_text()))


def test_of_a_search_whose_confirmations_are_undecided(search, tmp_path):
    folder = changed(search, tmp_path / "unconfirmed", holds=None, fails=None, found=0, static_holds=1.2064,
                     static_fails=None)
    kind, words = verdicts(gcpdda.report(folder))[0]
    assert kind == "open" and "by the static solver alone the blocks hold at 1.2064, and" in words


def changed(search, folder, **values):
    """A copy of a search with other values in fos.json."""
    shutil.copytree(search.path, folder)
    path = folder / "fos.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | values))
    return folder


@pytest.mark.parametrize("values, kind, said", [
    ({"found": 0, "undecided": [1.28]}, "open", "hold when strengths are divided by .* and fail at .* undecided"),
    ({"found": 0}, "open", "lies anywhere between two trials.* the search ended before"),
    ({"found": 0, "fails": None, "factor": None}, "open", "still hold at 1.2[0-9]+; no factor tried"),
    ({"found": 0, "holds": None, "factor": None}, "open", "fail already at 1.3[0-9]*, the smallest"),
    ({"found": 0, "holds": None, "fails": None, "factor": None}, "open", "No trial came to a verdict"),
])
def test_of_a_search_that_knows_a_part(search, tmp_path, values, kind, said):
    page = gcpdda.report(changed(search, tmp_path / "fos", **values), frames=0)
    (shown, text), = verdicts(page)
    assert shown == kind and re.search(said, text)


def test_of_a_search_with_a_first_block_and_a_weak_settled_state(search, tmp_path):
    settled = search.summary["settled"] | {"factor": 0.5}
    folder = changed(search, tmp_path / "fos", first_block_holds=1.0, first_block_fails=1.02, settled=settled)
    scene = folder / "settled" / "scene.toml"
    scene.write_text(scene.read_text() + '\n[earthquake]\nrecord = "shaking.csv"\n')
    page = gcpdda.report(folder, frames=0)
    text = html.unescape(page.read_text())
    assert verdicts(page)[1] == ("good", "First block: factor 1.01, holds at 1 and fails at 1.02.")
    assert "rest with strengths divided by 0.5." in text and "blocks that were never shaken" in text
    assert "<th>decided by</th>" in text and "static solver and dynamic step" in text
    assert "<th>displacement in x (m)</th>" in text


def test_of_a_search_that_fails_before_its_first_trial(search, tmp_path):
    settled = search.summary["settled"] | {"factor": 0.5, "verdict": "failed", "message": "they fail even so"}
    folder = changed(search, tmp_path / "fos", found=0, holds=None, fails=0.5, factor=None, trials=[], moving=[],
                     settled=settled)
    page = gcpdda.report(folder, frames=0)
    (shown, text), = verdicts(page)
    assert shown == "bad" and "fail already at 0.5" in text and "they fail even so" in page.read_text()
    assert "have not settled with strengths divided by 0.5" in page.read_text()


def test_of_a_search_after_a_slide(search, tmp_path):
    slide = {"stage": "weight", "block": "b", "slide": 0.1, "distance": 0.2, "blocks": 1, "words": "block 'b' slid"}
    folder = changed(search, tmp_path / "fos", earlier_slides=[slide])
    assert "Block 'b' slid. The factor is that of the place" in html.unescape(gcpdda.report(folder).read_text())


def test_of_a_bound(tmp_path):
    folder = tmp_path / "bound"
    subprocess.run([gcpdda.program(), "fos", str(SCENES / "plane_failure.toml"), "--bound", "--out", str(folder)],
                   check=True, capture_output=True)
    search = gcpdda.open_folder(folder)
    page = gcpdda.report(folder, frames=0)
    (kind, text), = verdicts(page)
    assert kind == "open" and f"at most {search.bound:.5g}, by limit analysis" in text and 1.9 < search.bound < 2.0
    assert "Trials" not in Reader(page.read_text()).headings


def test_of_a_trial(search, tmp_path):
    headings, _, text = check(gcpdda.report(search.mechanism.path, tmp_path / "trial.html", frames=0))
    assert "Stage trial: failed" in text and "State of the joints" in text


def test_of_an_ensemble(members, tmp_path):
    headings, _, text = check(gcpdda.report(members.path, tmp_path / "ensemble.html"))
    assert headings[0] == "Members" and "Probability of failure" in text


def test_of_an_ensemble_of_which_not_all_run_and_have_a_factor(members, tmp_path):
    """Shares are those of ensemble.txt: members that cannot run have no part; factors are those of brackets."""
    folder = tmp_path / "ensemble"
    shutil.copytree(members.path, folder)
    (folder / "ensemble.json").write_text(json.dumps(
        members.summary | {"done": 8, "holds": 3, "fails": 1, "undecided": 0, "cannot_run": 4, "measure": "factor",
                           "probability_of_failure": 0.25, "factors": 2, "mean": 1.1, "deviation": 0.1, "skewness": 0.0,
                           "least": 1.0, "most": 1.2}))
    table = members.members
    table["holds"], table["fails"] = [1.0, 1.1, 1.2, *[np.nan] * 5], [1.1, 1.3, np.nan, 0.5, *[np.nan] * 4]
    table.to_csv(folder / "ensemble_members.csv", index=False)
    text = gcpdda.report(folder).read_text()
    assert "1 of 4 members fail" in text and "Factors of safety of the 2 members with" in text
    figure = draw_factors(gcpdda.open_folder(folder).members)
    assert sum(patch.get_height() for patch in figure.axes[0].patches) == 2
    plt.close(figure)


def test_of_a_run_that_goes_on(opening, tmp_path):
    folder = tmp_path / "running"
    shutil.copytree(opening.path, folder)
    (folder / "summary.json").unlink()
    _, _, text = check(gcpdda.report(folder, frames=2))
    assert "The run goes on, or was killed" in text


def test_of_a_run_that_fails_at_once(tmp_path):
    """Before the first row of energy.csv is written."""
    scene = gcpdda.Scene(name="fast", fidelity="rigid", duration=1.0, time_step=1e-3)
    scene.material("rock", density=2600)
    scene.joint("default", normal_stiffness=1e9, friction_angle_deg=30)
    scene.block("ground", [[-5, -1], [5, -1], [5, 0], [-5, 0]], material="rock", fixed=True)
    scene.block("block", [[-1, 1], [1, 1], [1, 3], [-1, 3]], material="rock", velocity=[0, -1e5, 0])
    scene.monitor(block="block")
    with pytest.raises(gcpdda.NumericalError) as caught:
        gcpdda.run(scene, ranks=1, out=tmp_path / "fast")
    result = gcpdda.Result(caught.value.path)
    assert not len(result.energy)
    headings, _, text = check(gcpdda.report(result.path))
    assert "Energy" not in headings and "could pass through a block" in text
    with pytest.raises(ValueError, match="no rows"):
        result.plot.energy()


def test_of_a_run_without_contacts_and_histories(tmp_path):
    result = gcpdda.run(SCENES / "incline.toml", ranks=1, out=tmp_path / "run",
                        set={"output.contacts": False, "monitor": []})
    headings, _, text = check(gcpdda.report(result.path, frames=2))
    assert "Histories" not in headings and "output.contacts = false" in text


def test_the_residual_is_judged(opening, tmp_path):
    """A ledger that does not balance is reported, one that does is not."""
    assert residual_share(opening) < 0.01
    folder = tmp_path / "unbalanced"
    shutil.copytree(opening.path, folder)
    path = folder / "history" / "energy.csv"
    header, *rows = path.read_text().splitlines()
    column = header.split(",").index("residual[J/m]")
    changed = [row.split(",") for row in rows]
    changed[-1][column] = "1000"
    path.write_text("\n".join([header, *(",".join(row) for row in changed)]) + "\n")
    text = gcpdda.report(folder, frames=0).read_text()
    assert "the energy residual is" in text and "That is large" in text


def test_text_of_users_is_escaped(tmp_path):
    page = Page("<b>title</b> & more")
    page.section("A <i>section</i>")
    page.table([{"name": "</script><script>alert(1)</script>", "value": 0.5}])
    text = page.html()
    assert "<b>title" not in text and "alert(1)</script>" not in text and "&lt;/script&gt;" in text


def test_numbers_are_short():
    assert [text_of(value) for value in (0.0, 2.0, 1 / 3, 123456.7, 2.5e9, 1e-7, True, None, float("nan"), 7)] == [
        "0", "2", "0.3333", "123,457", "2.5e+09", "1e-07", "yes", "", "", "7"]
    assert text_of([[0, 1], [2.5, 3]]) == "(0, 1), (2.5, 3)"


def test_command_line(search, tmp_path):
    out = tmp_path / "report.html"
    done = subprocess.run([str(SOURCE / "run" / "report.py"), str(search.path), "--out", str(out), "--title",
                           "My slope", "--frames", "0"], capture_output=True, text=True)
    assert done.returncode == 0 and str(out) in done.stdout, done.stderr
    assert "<title>My slope</title>" in out.read_text()
    done = subprocess.run([str(SOURCE / "run" / "report.py"), str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 4 and "not a result folder" in done.stderr and "Traceback" not in done.stderr


def cut(path, part):
    """Keeps the first bytes of a file, as many as the part says."""
    whole = path.read_bytes()
    path.write_bytes(whole[:int(part * len(whole))])


@pytest.mark.parametrize("kind, name, damage", [
    ("search", "fos.json", lambda path: cut(path, 0)),
    ("search", "fos.json", lambda path: cut(path, 0.5)),
    ("search", "settled/scene.toml", lambda path: cut(path, 0.01)),
    ("search", "settled/scene.toml", lambda path: path.write_text(path.read_text() + "[run")),
    ("members", "ensemble.json", lambda path: path.write_text("[]")),
    ("members", "ensemble.toml", lambda path: cut(path, 0.05)),
    ("members", "ensemble.toml", lambda path: path.write_text(path.read_text().split("[ensemble]")[0])),
    ("members", "ensemble_members.csv", lambda path: path.write_text(re.sub(r"\.(\d)", r".x\1", path.read_text()))),
    ("members", "ensemble_members.csv", lambda path: cut(path, 0)),
    ("leaning", "scene.toml", lambda path: path.write_bytes(b"\xff" + path.read_bytes())),
    ("leaning", "summary.json", lambda path: cut(path, 0.9)),
    ("leaning", "history/energy.csv", lambda path: path.write_text(path.read_text().replace("e-0", "f-0")))])
def test_damaged_results_are_named(kind, name, damage, request, tmp_path):
    folder = tmp_path / "results"
    shutil.copytree(request.getfixturevalue(kind).path, folder)
    damage(folder / name)
    done = subprocess.run([str(SOURCE / "run" / "report.py"), str(folder), "--frames", "0"], capture_output=True,
                          text=True)
    assert done.returncode == 4, done.stderr
    assert str(folder / name) in done.stderr and "is damaged" in done.stderr and "Traceback" not in done.stderr


def test_the_folder_may_have_any_name(members, tmp_path):
    """Names of files are bytes, and those of no text in particular."""
    folder = os.fsencode(tmp_path) + b"/bad\xff\xfe"
    shutil.copytree(os.fsencode(members.path), folder)
    done = subprocess.run([str(SOURCE / "run" / "report.py"), folder], capture_output=True)
    assert done.returncode == 0, done.stderr
    check(pathlib.Path(os.fsdecode(folder)) / "report.html")


def test_in_a_browser(opening, tmp_path):
    """Chromium runs the script without an error and shows the last frame; nothing is fetched."""
    page = gcpdda.report(opening.path, tmp_path / "opening.html", frames=5)
    dom, console = browser.open_page(page, tmp_path, "--dump-dom")
    assert console == []
    assert f"<output>t = {opening.summary['time']:.4g} s</output>" in dom
    picture = tmp_path / "page.png"
    browser.open_page(page, tmp_path, f"--screenshot={picture}")
    assert np.asarray(Image.open(picture).convert("L")).std() > 10.0


def test_the_browser_tells_what_scripts_report(tmp_path):
    """The test above would notice an error of a script."""
    page = tmp_path / "broken.html"
    page.write_text("<!doctype html><p>text</p><script>missing_function()</script>")
    dom, console = browser.open_page(page, tmp_path, "--dump-dom")
    assert "<p>text</p>" in dom
    assert len(console) == 1 and "missing_function" in console[0]
