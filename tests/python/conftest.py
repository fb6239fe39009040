"""Runs that the tests of the Python package share. The program is $GCPDDA, or that of the build folder."""

import pathlib
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "run" / "python"))

import gcpdda

SCENES = SOURCE / "run" / "scenes"


@pytest.fixture(scope="session")
def opening(tmp_path_factory):
    """Stages, excavation, contacts that slip and open: bricks fall into an opening, and frames show every motion."""
    solvers = {f"stage.{stage}.solver": "dynamic" for stage in ("weight", "arch")}
    return gcpdda.run(SCENES / "opening.toml", ranks=1, set=solvers, out=tmp_path_factory.mktemp("runs") / "opening")


@pytest.fixture(scope="session")
def leaning(tmp_path_factory):
    """Columns that lean on each other and come to rest, with cables between them, water and monitors."""
    scene = gcpdda.Scene.read(SCENES / "goodman_bray.toml")
    scene.table("run", duration=6.0)
    scene.table("support.cable", kind="anchored", axial_stiffness=1e7, pretension=1e5)
    scene.add("bolt", support="cable", **{"from": [3.83, 3.37], "to": [4.83, 1.63]})
    scene.table("water.low", phreatic=[[-20.0, 0.0], [140.0, 60.0]])
    scene.monitor(name="chain", along=[[3.83, 3.37], [60.0, 33.0]], points=12)
    return gcpdda.run(scene, ranks=1, out=tmp_path_factory.mktemp("runs") / "leaning")


@pytest.fixture(scope="session")
def lined(tmp_path_factory):
    """A square that hangs in a lined roof: one liner holds it, another one cracks and peels off."""
    scene = gcpdda.Scene()
    scene.table("run", fidelity="rigid")
    scene.table("material.rock", density=2600.0)
    scene.table("joint.default", normal_stiffness=1e9, friction_angle_deg=0.0)
    for name, low, high, fixed in (("left", -2.0, -0.5, True), ("loose", -0.5, 0.5, False), ("right", 0.5, 2.0, True)):
        scene.add("block", name=name, material="rock", fixed=fixed,
                  vertices=[[low, 0.0], [high, 0.0], [high, 1.0], [low, 1.0]])
    scene.table("support.layer", kind="liner", thickness=0.1, youngs_modulus=24e9, compressive_strength=30e6)
    scene.table("support.weak", kind="liner", thickness=0.02, youngs_modulus=24e9, tensile_strength=3e6,
                residual_tensile_strength=2.9e6, adhesion=1e3)
    scene.add("liner", name="strong", support="layer", points=[[-2.0, 0.0], [2.0, 0.0]])
    scene.add("liner", support="weak", points=[[-2.0, 0.0], [2.0, 0.0]])
    scene.table("output", interval=0.05)
    scene.add("stage", name="weight", kind="settle", limit=3.0, solver="dynamic")
    return gcpdda.run(scene, ranks=1, out=tmp_path_factory.mktemp("runs") / "lined")


@pytest.fixture(scope="session")
def search(tmp_path_factory):
    """A factor of safety."""
    return gcpdda.fos(SCENES / "deformable_slope.toml", ranks=1, out=tmp_path_factory.mktemp("runs") / "fos",
                      from_=1, to=1.5, tolerance=0.05)


@pytest.fixture(scope="session")
def members(tmp_path_factory):
    """A probability of failure."""
    return gcpdda.ensemble(SCENES / "plane_failure.toml", ranks=1, count=8,
                           out=tmp_path_factory.mktemp("runs") / "ensemble")
