"""Scenes of the statics study: what is loaded, and how slowly it can be.

A case is a scene file, its stages and the load that slow loading lets in over many steps. `SETTLE` in a stage
stands for the keys that choose the way to rest.
"""

import math
from pathlib import Path

import numpy

SCENES = Path(__file__).resolve().parent.parent / "scenes"
LIMIT = 100.0  # s, of a settle stage
WATER_PARTS = 20  # stages in which slow loading lets the water in


def settle(name, more=""):
    return f'{{name = "{name}", kind = "settle", limit = {LIMIT}, SETTLE{more}}}'


class Case:
    """A scene, its stages, and `slow`: what makes its load slow, as a function of the time (s) that it takes."""

    def __init__(self, file, stages, slow, sets=()):
        self.file, self.stages, self.slow, self.sets = Path(file), stages, slow, list(sets)

    def arguments(self, keys, seconds=0.0):
        """--set arguments of a way to rest; load that comes at once for 0 seconds."""
        stages, sets = self.slow(self.stages, seconds) if seconds > 0.0 else (self.stages, [])
        text = "stage=[" + ", ".join(stage.replace("SETTLE", keys) for stage in stages) + "]"
        every = ["run.gravity_ramp=0.0", "output.contacts=true", "output.interval=50.0", "output.history_interval=50.0",
                 *self.sets, text, *sets]
        return [word for setting in every for word in ("--set", setting)]


def slow_gravity(stages, seconds):
    return stages, [f"run.gravity_ramp={seconds!r}"]


def slow_excavation(stages, seconds):
    return [stage.replace("relax = 0.0", f"relax = {seconds!r}") for stage in stages], []


def slow_water(stages, seconds):
    """Gravity over the time, then the density of the water in parts, each until the rock is nearly at rest."""
    weight, low = stages
    rising = [f'{{name = "rise{k}", kind = "settle", limit = {LIMIT}, tolerance = 1e-4, local_damping = 0.8, '
              f'set = {{"water.low.active" = true, "water.low.density" = {1000.0 * (k + 1) / WATER_PARTS}}}}}'
              for k in range(WATER_PARTS - 1)]
    return [weight, *rising, low], [f"run.gravity_ramp={seconds!r}"]


HEAD = """[run]
fidelity = "{fidelity}"
[material.rock]
density = 2600.0
youngs_modulus = {modulus}
poissons_ratio = 0.25
[joint.default]
normal_stiffness = {stiffness}
friction_angle_deg = {friction}
[[stage]]
kind = "settle"
limit = 100.0
"""


def pile(work, kind, rows):
    """A wall of bricks, twice as many as rows in each, or a pyramid of squares, on a fixed floor."""
    wide = 2 * rows if kind == "wall" else rows
    size = "[1.0, 0.5]" if kind == "wall" else "[1.0, 1.0]"
    columns = f"columns = {wide}\n" if kind == "wall" else ""
    text = HEAD.format(fidelity="rigid", modulus=40e9, stiffness=1e9, friction=35.0) + (
        f'[[block]]\nname = "floor"\nmaterial = "rock"\nfixed = true\n'
        f"vertices = [[-2, -2], [{wide + 2}, -2], [{wide + 2}, 0], [-2, 0]]\n"
        f'[[{kind}]]\nname = "{kind}"\nmaterial = "rock"\norigin = [0.0, 0.0]\nrows = {rows}\n{columns}'
        f"block_size = {size}\n")
    file = Path(work) / f"{kind}_{rows}.toml"
    file.write_text(text)
    return Case(file, [settle("weight")], slow_gravity)


def cases(work, quick):
    """The scenes whose equilibrium is compared with that of slow loading, by name."""
    slope = Case(SCENES / "slope_jointed.toml", [settle("weight")], slow_gravity)
    found = {"wall": pile(work, "wall", 10 if quick else 50), "pyramid": pile(work, "pyramid", 15 if quick else 60)}
    if quick:
        return found | {"slope_seeds": Case(SCENES / "slope_seeds.toml", [settle("weight")], slow_gravity)}
    excavation = [settle("in_situ"), '{name = "tunnel", kind = "excavate", openings = ["tunnel"], relax = 0.0}',
                  settle("around_it")]
    water = [settle("weight"), settle("low_water", ', set = {"water.low.active" = true, "water.low.density" = 1000.0}')]
    deformable = ["run.fidelity=deformable", "material.rock.youngs_modulus=10e9", "material.rock.poissons_ratio=0.25"]
    return found | {
        "slope_jointed": slope,
        "wet_slope": Case(SCENES / "wet_slope.toml", water, slow_water),
        "tunnel_jointed": Case(SCENES / "tunnel_jointed.toml", excavation, slow_excavation),
        "deformable_tunnel": Case(SCENES / "deformable_tunnel.toml", excavation, slow_excavation),
        "slope_jointed, 10 GPa": Case(SCENES / "slope_jointed.toml", [settle("weight")], slow_gravity, deformable),
        "tunnel_jointed, 10 GPa": Case(SCENES / "tunnel_jointed.toml", excavation, slow_excavation, deformable),
        "deformable_slope, 1e11 Pa/m": Case(SCENES / "deformable_slope.toml", [settle("weight")], slow_gravity,
                                            [f"joint.{name}.normal_stiffness=1e11" for name in ("default", "bedding", "cross")]),
    }


def slope_of_benches(benches, start):
    """slope_large.toml with so many benches; its joints begin at gap 0 or under in-situ stress."""
    bench = "height = 20.0, face_angle_deg = 72.0"
    sets = ["region.slope.bench=[" + f"{{{bench}, width = 7.0}}, " * (benches - 1) + f"{{{bench}}}]",
            f"region.slope.toe_length={8.0 * benches}",
            f"region.slope.crest_length={17.0 * benches}", f"region.slope.depth={5.0 * benches}",
            "output.contacts=false"]
    if start == "in situ":
        sets.append(f"in_situ={{level = {20.0 * benches}, vertical_stress = 0.0, k0 = 0.5}}")
    return Case(SCENES / "slope_large.toml", [settle("weight")], slow_gravity, sets)


def rock_mass(work, seed):
    """A slope (odd seeds) or a box with a free top, in two random joint sets; every third has deformable blocks.

    Between 200 and 800 blocks. The flat set dips by less than its friction angle out of a slope, or a plane would
    slide.
    """
    random = numpy.random.default_rng(seed)
    is_slope, is_deformable = seed % 2 == 1, seed % 3 == 0
    flat = random.uniform(-30.0, 25.0)
    steep = flat + random.uniform(60.0, 110.0)
    steep = steep - 180.0 if steep > 90.0 else steep
    blocks, ratio = random.uniform(280.0, 650.0), random.uniform(0.7, 1.4)
    friction, stiffness = random.uniform(30.0, 45.0), 10.0 ** random.uniform(9.0, 10.0)
    if is_slope:
        height, face = random.uniform(15.0, 25.0), random.uniform(55.0, 75.0)
        region = (f"[region.slope]\ntoe_length = {0.4 * height}\ncrest_length = {0.85 * height}\n"
                  f"depth = {0.3 * height}\n"
                  f"[[region.slope.bench]]\nheight = {height}\nface_angle_deg = {face}\n")
        foot = height / math.tan(math.radians(face))
        area = 0.3 * height * (1.25 * height + foot) + height * (0.85 * height + 0.5 * foot)
    else:
        wide, high = random.uniform(15.0, 25.0), random.uniform(10.0, 20.0)
        region, area = "", wide * high
    crossing = abs(math.sin(math.radians(steep - flat)))
    spacing = math.sqrt(area * crossing / blocks / ratio)
    polygon = "" if is_slope else f"polygon = [[0, 0], [{wide}, 0], [{wide}, {high}], [0, {high}]]\n"
    text = HEAD.format(fidelity="deformable" if is_deformable else "rigid", modulus=float(random.uniform(5e9, 30e9)),
                       stiffness=float(stiffness), friction=float(friction)) + (
        f'[region]\nmaterial = "rock"\n{polygon}fixed = ["bottom", "left", "right"]\nfixed_thickness = 2.0\n'
        f"min_width = {0.15 * spacing}\n{region}"
        f'[[joint_set]]\nname = "flat"\ndip_deg = {flat}\nspacing = {spacing}\n'
        f'spacing_scatter = {{kind = "lognormal", deviation = {random.uniform(0.1, 0.3) * spacing}}}\nseed = {seed}\n'
        f'[[joint_set]]\nname = "steep"\ndip_deg = {steep}\ndip_scatter = {{kind = "normal", deviation_deg = 3.0}}\n'
        f"spacing = {ratio * spacing}\nspacing_scatter = {{kind = \"normal\", deviation = {0.15 * ratio * spacing}}}\n"
        f"trace_length = {random.uniform(4.0, 12.0) * spacing}\ngap = {random.uniform(0.5, 1.5) * spacing}\n"
        f"seed = {seed + 1000}\n")
    file = Path(work) / f"rock_mass_{seed}.toml"
    file.write_text(text)
    return Case(file, [settle("weight")], slow_gravity), {"kind": "slope" if is_slope else "box",
                                                           "fidelity": "deformable" if is_deformable else "rigid"}
