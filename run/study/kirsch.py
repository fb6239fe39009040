#!/usr/bin/python3
"""Stress around a circular opening in a fine blocky medium, beside Kirsch's solution for a plate.

    run/study/kirsch.py GCPDDA OUT_DIR [--quick] [--friction | --deformable]

Rigid square blocks of side L under an in-situ stress without gravity, in a fixed square box; a circle is taken out of
them and they settle. Joints have cohesion enough not to slip. Such a medium has E = k_n L, no Poisson ratio and, since
each joint bears half of a shear strain while the blocks keep their angle, G = k_t L/2: with k_t = k_n that is E/2, as in
an isotropic plate. With --friction joints have a friction angle of 35 degrees and no cohesion, and the wall yields.
The stress of a block is the mean over its contact forces.
Kirsch (1898), sigma_v along y, sigma_h along x, rho = a/r, theta from the x axis:
    sigma_r = (sh + sv)/2 (1 - rho^2) + (sh - sv)/2 (1 - 4 rho^2 + 3 rho^4) cos 2 theta
    sigma_t = (sh + sv)/2 (1 + rho^2) - (sh - sv)/2 (1 + 3 rho^4) cos 2 theta
It does not depend on the elastic constants. The box does not follow when the opening closes: for sigma_h = sigma_v and a
circular box of radius R (Lame, no Poisson ratio) sigma_r falls by (1 - rho^2) and sigma_t by (1 + rho^2) times
sigma_v a^2/(a^2 + R^2); R of a circle as large as the box is printed beside what the blocks differ by. Writes kirsch.csv and kirsch.png and prints mean and scatter of the
difference in rings about the opening.

--deformable takes run/scenes/deformable_tunnel.toml instead, whose plate is loaded from outside, with blocks of several
sizes and k_n L/E as it ships, and the smallest blocks with stiffer joints. A plate of radius R under sigma_v = sigma_h has (Lame) R^2/(R^2 - a^2) times the stresses of
an endless one; R is again that of a circle as large as the plate. Writes kirsch_deformable.csv and kirsch_deformable.png.
"""

import argparse
import json
import os
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

RADIUS = 3.0
VERTICAL = 2.6e6
SCENE = """[run]
gravity = [0, 0]
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = {stiffness}
tangential_ratio = 1.0
{strength}
[in_situ]
vertical_stress = {vertical}
k0 = {k0}
[region]
material = "rock"
polygon = [[-{half}, -{half}], [{half}, -{half}], [{half}, {half}], [-{half}, {half}]]
fixed = ["bottom", "left", "right", "top"]
min_width = {sliver}
[[bricks]]
block_size = [{size}, {size}]
bond = 0.0
[[opening]]
name = "hole"
shape = "circle"
centre = [0.0, 0.0]
width = {width}
chords = 48
[output]
interval = 0.05
[[stage]]
name = "in_situ"
kind = "settle"
limit = 2.0
[[stage]]
name = "hole"
kind = "excavate"
openings = ["hole"]
relax = 0.1
[[stage]]
name = "around_it"
kind = "settle"
limit = 5.0
"""


def kirsch(points, k0):
    r = np.hypot(*points.T)
    rho2 = (RADIUS / r) ** 2
    twice = np.cos(2.0 * np.arctan2(points[:, 1], points[:, 0]))
    mean, half = 0.5 * VERTICAL * (k0 + 1.0), 0.5 * VERTICAL * (k0 - 1.0)
    return (mean * (1.0 - rho2) + half * (1.0 - 4.0 * rho2 + 3.0 * rho2**2) * twice,
            mean * (1.0 + rho2) - half * (1.0 + 3.0 * rho2**2) * twice)


def last_frame(folder):
    frames = sorted(f for f in os.listdir(os.path.join(folder, "frames")) if f.startswith("frame_"))
    with h5py.File(os.path.join(folder, "frames", frames[-1])) as file:
        grid = file["VTKHDF"]
        points, offsets = grid["Points"][:, :2], grid["Offsets"][:]
        corners = points[grid["Connectivity"][:]]
        mobile = grid["CellData/kind"][:] != 0
        stress = -grid["CellData/stress"][:]
    centroids, areas = [], []
    for begin, end in zip(offsets[:-1], offsets[1:]):
        p = corners[begin:end]
        q = np.roll(p, -1, axis=0)
        cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
        areas.append(0.5 * cross.sum())
        centroids.append(((p + q) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum()))
    return np.array(centroids)[mobile], np.array(areas)[mobile], stress[mobile]


def polar(points, stress):
    r = np.hypot(*points.T)
    c, s = points.T / r
    xx, yy, xy = stress.T
    return c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy


def summary_of(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def run(gcpdda, out, name, **values):
    scene = os.path.join(out, name + ".toml")
    with open(scene, "w") as file:
        file.write(SCENE.format(vertical=VERTICAL, width=2 * RADIUS, **values))
    folder = os.path.join(out, name)
    subprocess.run([gcpdda, "run", scene, "--out", folder, "--overwrite"], check=True, stderr=subprocess.DEVNULL)
    return folder, summary_of(folder)


def run_deformable(gcpdda, out, size, k0, half, ratio, modulus=10e9):
    folder = os.path.join(out, f"kirsch_deformable_{size:g}_{k0:g}_{ratio:g}")
    corners = [[-half, -half], [half, -half], [half, half], [-half, half]]
    sets = [f"region.polygon={corners}", f"bricks=[{{block_size=[{size}, {size}], bond=0.0}}]", f"in_situ.k0={k0}",
            f"region.min_width={0.2 * size}", f"joint.default.normal_stiffness={ratio * modulus / size}"]
    scene = os.path.join(os.path.dirname(__file__), "..", "scenes", "deformable_tunnel.toml")
    subprocess.run([gcpdda, "run", scene, "--out", folder, "--overwrite", *(word for s in sets for word in ("--set", s))],
                   check=True, stderr=subprocess.DEVNULL)
    return folder, summary_of(folder)


def draw(ax, points, radial, hoop, k0, half):
    r = np.hypot(*points.T)
    for values, colour, label in ((hoop, "#b5482f", "hoop"), (radial, "#2f6db5", "radial")):
        for angle, marker, where in ((0.0, "o", "beside"), (0.5 * np.pi, "^", "above and below")):
            along = np.abs(np.sin(np.arctan2(points[:, 1], points[:, 0]) - angle)) < np.sin(np.radians(12.0))
            ax.plot(r[along] / RADIUS, values[along] / VERTICAL, marker, color=colour, ms=5, mew=1.0,
                    mfc=colour if angle == 0.0 else "white", label=f"{label}, {where}")
            line = np.linspace(RADIUS, half, 200)
            exact = kirsch(np.outer(line, (np.cos(angle), np.sin(angle))), k0)[0 if label == "radial" else 1]
            ax.plot(line / RADIUS, exact / VERTICAL, "-" if angle == 0.0 else "--", color=colour, lw=1.2)
    ax.set_xlabel("distance from the centre over radius")
    ax.set_xlim(1.0, half / RADIUS)
    ax.grid(alpha=0.3)


def deformable(gcpdda, out, quick):
    """Convergence with the size of the blocks, stiffer joints, and a picture of the finest at two ratios of stress."""
    half = 9.0 if quick else 15.0
    sizes = (1.0, 0.75) if quick else (1.0, 0.75, 0.5)
    shipped, stiffer = 3.0, (50.0,) if quick else (10.0, 50.0, 200.0)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True)
    rows = []
    for k0, ax in ((1.0, axes[0]), (0.5, axes[1])):
        cases = [(size, shipped) for size in sizes] + [(sizes[-1], ratio) for ratio in stiffer]
        for size, ratio in cases if k0 == 1.0 else [(sizes[-1], shipped)]:
            folder, summary = run_deformable(gcpdda, out, size, k0, half, ratio)
            points, areas, stress = last_frame(folder)
            radial, hoop = polar(points, stress)
            plate = 1.0 / (1.0 - RADIUS**2 / (4.0 * half**2 / np.pi))
            r = np.hypot(*points.T)
            near = (r > RADIUS) & (r < 2.0 * RADIUS)
            exact = kirsch(points, k0)
            errors = [float(np.sqrt(np.average((got - plate * want)[near] ** 2, weights=areas[near]))) / VERTICAL
                      for got, want in zip((radial, hoop), exact)]
            rows.append((k0, size / RADIUS, ratio, summary["blocks"], summary["verdict"], *errors))
            print(f"K0 = {k0:g}, L/a = {size / RADIUS:.3f}, k_n L/E = {ratio:g}: {summary['blocks']} blocks "
                  f"{summary['verdict']}, 1 to 2 radii: rms difference over sigma_v radial {errors[0]:.3f}, "
                  f"hoop {errors[1]:.3f}", flush=True)
            if (size, ratio) == (sizes[-1], shipped):
                draw(ax, points, radial, hoop, k0, half)
                ax.set_title(f"$K_0$ = {k0:g}, {summary['blocks']} deformable blocks left")
    axes[0].set_ylabel("compressive stress over $\\sigma_v$")
    axes[0].legend(fontsize=8, title="markers: blocks; lines: Kirsch, endless plate,\nsolid beside, dashed above and below")
    figure.tight_layout()
    figure.savefig(os.path.join(out, "kirsch_deformable.png"), dpi=100)
    with open(os.path.join(out, "kirsch_deformable.csv"), "w") as file:
        file.write("k0,L/a,k_n L/E,blocks,verdict,rms radial,rms hoop\n")
        for row in rows:
            file.write(",".join(x if isinstance(x, str) else f"{x:.6g}" for x in row) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gcpdda", metavar="GCPDDA")
    parser.add_argument("out", metavar="OUT_DIR")
    parser.add_argument("--quick", action="store_true")
    kinds = parser.add_mutually_exclusive_group()
    kinds.add_argument("--friction", action="store_true")
    kinds.add_argument("--deformable", action="store_true")
    arguments = parser.parse_args()
    gcpdda, out, quick = arguments.gcpdda, arguments.out, arguments.quick
    if arguments.deformable:
        os.makedirs(out, exist_ok=True)
        deformable(gcpdda, out, quick)
        return
    size, half = (0.6, 12.0) if quick else (0.4, 18.0)
    strength = "friction_angle_deg = 35.0" if arguments.friction else "friction_angle_deg = 45.0\ncohesion = 1e9"
    os.makedirs(out, exist_ok=True)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True)
    rows = []
    for ax, k0 in zip(axes, (1.0, 0.5)):
        folder, summary = run(gcpdda, out, f"kirsch_{k0:g}", k0=k0, size=size, half=half, strength=strength,
                              stiffness=VERTICAL / (3e-4 * size), sliver=0.2 * size)
        points, areas, stress = last_frame(folder)
        r = np.hypot(*points.T)
        radial, hoop = polar(points, stress)
        exact_radial, exact_hoop = kirsch(points, k0)
        print(f"K0 = {k0:g}: {summary['blocks']} blocks, verdict {summary['verdict']}, {summary['steps']} steps")
        for inner in np.arange(RADIUS, 3.0 * RADIUS, 0.25 * RADIUS):
            ring = (r > inner) & (r < inner + 0.25 * RADIUS)
            w = areas[ring] / areas[ring].sum()
            difference = [(radial - exact_radial)[ring], (hoop - exact_hoop)[ring]]
            means = [float((w * d).sum()) / VERTICAL for d in difference]
            scatter = [float(np.sqrt((w * d**2).sum())) / VERTICAL for d in difference]
            rows.append((k0, inner / RADIUS, int(ring.sum()), *means, *scatter))
            middle = (RADIUS / (inner + 0.125 * RADIUS)) ** 2
            box = -(RADIUS**2) / (RADIUS**2 + 4.0 * half**2 / np.pi)
            lame = f"; by the box {box * (1 - middle):+.3f}, {box * (1 + middle):+.3f}" if k0 == 1.0 else ""
            print(f"  r/a {inner / RADIUS:.2f} to {inner / RADIUS + 0.25:.2f}: {ring.sum():4} blocks, difference over "
                  f"sigma_v: radial {means[0]:+.3f}, hoop {means[1]:+.3f}; rms {scatter[0]:.3f}, {scatter[1]:.3f}{lame}")
        draw(ax, points, radial, hoop, k0, half)
        ax.set_title(f"$K_0$ = {k0:g}, {summary['blocks']} blocks left")
    axes[0].set_ylabel("compressive stress over $\\sigma_v$")
    axes[0].legend(fontsize=8, title="markers: blocks; lines: Kirsch,\nsolid beside, dashed above and below")
    figure.tight_layout()
    figure.savefig(os.path.join(out, "kirsch.png"), dpi=100)
    with open(os.path.join(out, "kirsch.csv"), "w") as file:
        file.write("k0,r/a from,blocks,mean radial,mean hoop,rms radial,rms hoop\n")
        for row in rows:
            file.write(",".join(f"{x:.6g}" for x in row) + "\n")


if __name__ == "__main__":
    main()
