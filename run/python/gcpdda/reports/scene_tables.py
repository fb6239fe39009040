"""Sections of a report about what was computed: geometry, materials and laws, loads, provenance."""

import datetime
import hashlib
import pathlib
import subprocess

import numpy as np

from ..result import read_scene

GEOMETRY = ("region", "joint_set", "fault", "joint_map", "opening", "layer", "voronoi", "bricks", "wall", "pyramid",
            "blocks")
LOADS = ("water", "in_situ", "earthquake", "support", "bolt", "bolt_pattern", "liner")
NAMES = {"region": "Region", "joint_set": "Joint sets", "fault": "Faults", "joint_map": "Mapped traces",
         "opening": "Openings", "layer": "Layers", "voronoi": "Voronoi polygons", "bricks": "Masonry", "wall": "Walls",
         "pyramid": "Pyramids", "blocks": "Block file", "water": "Water", "in_situ": "In-situ stress",
         "earthquake": "Earthquake", "support": "Types of support", "bolt": "Bolts",
         "bolt_pattern": "Patterns of bolts", "liner": "Liners"}
UNITS = {"density": "kg/m3", "youngs_modulus": "Pa", "normal_stiffness": "Pa/m", "friction_angle_deg": "°",
         "cohesion": "Pa", "tension": "Pa", "residual_friction_angle_deg": "°", "residual_cohesion": "Pa",
         "dilation_angle_deg": "°", "dilation_limit": "m", "jcs": "Pa", "dip_deg": "°", "spacing": "m",
         "trace_length": "m", "gap": "m", "axial_stiffness": "N/m", "axial_rigidity": "N", "axial_yield": "N",
         "shear_stiffness": "N/m", "shear_yield": "N", "pretension": "N", "active_length": "m", "bond_strength": "N/m",
         "width": "m", "height": "m", "length": "m", "vertical_stress": "Pa", "level": "m", "duration": "s",
         "gravity": "m/s2", "gravity_ramp": "s", "limit": "s", "p_wave_speed": "m/s", "s_wave_speed": "m/s",
         "min_width": "m", "fixed_thickness": "m", "relax": "s"}


MOST_BLOCKS = 20


def with_units(rows):
    """Headings with units for the keys of some tables of a scene."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    return {key: f"{key} ({UNITS[key]})" if key in UNITS else key for key in keys}


def named(tables):
    return [{"name": name} | keys for name, keys in tables.items()]


def add_scene(page, scene, result=None):
    """Geometry, materials and laws, loads of a scene; with its first frame if there is a result."""
    page.section("Geometry")
    if result is not None and result.frames and len(result.frame("first").ids):
        page.table([{"part": name, "value": value} for name, value in sizes(result).items()])
    if scene.get("block"):
        page.heading("Single blocks")
        page.table([{"name": block.get("name", f"b{k}"), "material": block["material"],
                     "fixed": block.get("fixed", False), "corners": len(block["vertices"])}
                    for k, block in enumerate(scene["block"][:MOST_BLOCKS])])
        if len(scene["block"]) > MOST_BLOCKS:
            page.text(f"The first {MOST_BLOCKS} of {len(scene['block'])}; the scene below has all.", "note")
    for name in GEOMETRY:
        _tables(page, scene, name)
    page.section("Materials and laws")
    page.heading("Materials")
    rows = named(scene.get("material", {}))
    page.table(rows, with_units(rows))
    page.heading("Joint laws")
    rows = named(scene.get("joint", {}))
    page.table(rows, with_units(rows))
    page.text("A law takes the keys that it does not have from default. Other defaults are those of the list of keys.",
              "note")
    for name in LOADS:
        _tables(page, scene, name)
    page.heading("Run")
    page.keys({f"{key} ({UNITS[key]})" if key in UNITS else key: value for key, value in scene["run"].items()})


def _tables(page, scene, name):
    tables = scene.get(name)
    if not tables:
        return
    page.heading(NAMES[name])
    if isinstance(tables, list):
        page.table(tables, with_units(tables))
    elif name in ("water", "support"):
        rows = named(tables)
        page.table(rows, with_units(rows))
    else:
        page.keys({f"{key} ({UNITS[key]})" if key in UNITS else key: value for key, value in tables.items()})


def sizes(result):
    frame = result.frame("first")
    mobile = ~frame.fixed
    low, high = frame.points.min(axis=0), frame.points.max(axis=0)
    size = np.sqrt(frame.areas[mobile]) if mobile.any() else np.zeros(1)
    kinds = frame.values("kind")
    x, y = ([f"{end[axis]:.4g}" if abs(end[axis]) < 1e4 else f"{end[axis]:.10g}" for end in (low, high)]
            for axis in (0, 1))
    return {"extent": f"x {x[0]} to {x[1]} m, y {y[0]} to {y[1]} m",
            "blocks": f"{int((kinds == 1).sum())} rigid, {int((kinds == 2).sum())} deformable, "
                      f"{int(frame.fixed.sum())} fixed",
            "joints": f"{len(result.joint_traces.lines)}, where edges of two blocks lie on each other at the start",
            "block size (root of the area)": f"{size.min():.3g} to {size.max():.3g} m, median {np.median(size):.3g} m",
            "area of mobile blocks": f"{frame.areas[mobile].sum():.4g} m2"}


def add_provenance(page, folder, scene_file, facts, task="run"):
    """Where the results come from: version, command, hashes of inputs."""
    page.section("Provenance")
    rows = [{"what": name, "value": str(value)} for name, value in facts.items()]
    rows.append({"what": "result folder", "value": str(folder.path.resolve())})
    rows.append({"what": "report written", "value": datetime.datetime.now().astimezone().isoformat(timespec="seconds")})
    rows.append({"what": "version of the package that wrote the report", "value": version()})
    for path in [scene_file, *_inputs(scene_file)]:
        rows.append({"what": f"SHA-256 of {path.name}", "value": hashlib.sha256(path.read_bytes()).hexdigest()})
    page.table(rows)
    page.text("The scene below holds the values that were given, those of --set included; other keys had their "
              f"defaults. Compute it again with: gcpdda {task} {scene_file.name}", "note")
    page.details(f"The scene ({scene_file.name})", scene_file.read_text())


def _inputs(scene_file):
    """Files that the scene names and that are still there."""
    scene = read_scene(scene_file)
    names = [scene.get("blocks", {}).get("file"), scene.get("earthquake", {}).get("record")]
    names += [table.get("file") for table in scene.get("joint_map", [])]
    paths = [scene_file.parent / name for name in names if name]
    return [path for path in paths if path.is_file()]


def version():
    """`git describe` of the tree that holds this package, or that it is installed."""
    here = pathlib.Path(__file__).resolve().parent
    try:
        done = subprocess.run(["git", "-C", str(here), "describe", "--always", "--dirty"], capture_output=True,
                              text=True)
    except OSError:
        return "unknown"
    return done.stdout.strip() or "installed, without a repository"
