#!/usr/bin/python3
"""Write a block file for [blocks] file = "...": what the generators of a scene do not make.

wall     running bond of rows x columns bricks
pyramid  rows of bricks, each shorter by one than that below
pile     rows x columns convex polygons, falling and spinning, in a fixed box
heap     the same on a floor without walls: it collapses to both sides
slope    a wall turned by 30 degrees on a fixed slope, its foot free: it slides

A sample of the format to start from: /points (n,2) vertices of all blocks in their order, /offsets (blocks+1) where
each block's vertices begin, /material index into the scene's materials, /fixed, /velocity (blocks,3).
"""
import argparse

import h5py
import numpy


def rectangle(left, bottom, right, top):
    return numpy.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def bricks(rows, columns, size, overlap, is_pyramid):
    width, height = size
    row, column = (index.ravel() for index in numpy.mgrid[0:rows, 0:columns])
    if is_pyramid:
        row, column = row[column < rows - row], column[column < rows - row]
    left = (column + 0.5 * (row if is_pyramid else row % 2)) * width
    bottom = row * height
    points = numpy.empty((left.size, 4, 2))
    points[:, :, 0] = left[:, None] + width * numpy.array([0, 1, 1, 0]) + overlap * numpy.array([0, 1, 1, 0])
    points[:, :, 1] = bottom[:, None] + height * numpy.array([0, 0, 1, 1]) - overlap * numpy.array([1, 1, 0, 0])
    return points.reshape(-1, 2), numpy.full(left.size, 4)


def grains(rows, columns, random):
    """Polygons of 5 to 8 vertices on circles around the places of a grid of 1 m."""
    row, column = (index.ravel() for index in numpy.mgrid[0:rows, 0:columns])
    count = row.size
    centre = numpy.stack([1.0 * column, 0.5 + 1.0 * row], axis=1) + random.uniform(-0.005, 0.005, (count, 2))
    vertices = random.integers(5, 9, count)
    radius = random.uniform(0.47, 0.494, count)
    start = random.uniform(0.0, 2.0 * numpy.pi, count)
    begin = numpy.concatenate([[0], numpy.cumsum(vertices)])
    block = numpy.repeat(numpy.arange(count), vertices)
    number = numpy.arange(begin[-1]) - begin[block]
    jitter = random.uniform(-0.3, 0.3, begin[-1])
    angle = start[block] + (number + jitter) * 2.0 * numpy.pi / vertices[block]
    points = centre[block] + radius[block, None] * numpy.stack([numpy.cos(angle), numpy.sin(angle)], axis=1)
    velocity = random.uniform([-2.0, -2.0, -3.0], [2.0, 0.0, 3.0], (count, 3))
    return points, vertices, velocity


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("file")
    arguments.add_argument("--shape", choices=["wall", "pyramid", "pile", "heap", "slope"], default="wall")
    arguments.add_argument("--rows", type=int, default=100)
    arguments.add_argument("--columns", type=int, default=100)
    arguments.add_argument("--size", type=float, nargs=2, default=(1.0, 0.5), help="of a brick, m")
    arguments.add_argument("--overlap", type=float, default=0.0,
                           help="of neighbouring bricks, m: joints under pressure")
    wanted = arguments.parse_args()
    if min(wanted.rows, wanted.columns) < 1:
        arguments.error(f"{wanted.rows} rows of {wanted.columns} blocks are none: --rows and --columns are at least 1")
    if not (min(wanted.size) > 0.0 and max(wanted.size) < float("inf")):
        arguments.error("--size: both sides of a brick are above 0")
    if not 0.0 <= wanted.overlap < min(wanted.size):
        arguments.error(f"--overlap {wanted.overlap:g} is not between 0 and the sides of a brick")

    fixed = []
    velocity = None
    if wanted.shape in ("wall", "pyramid", "slope"):
        columns = wanted.rows if wanted.shape == "pyramid" else wanted.columns
        points, vertices = bricks(wanted.rows, columns, wanted.size, wanted.overlap, wanted.shape == "pyramid")
    else:
        points, vertices, velocity = grains(wanted.rows, wanted.columns, numpy.random.default_rng(20261121))
    width, height = points.max(axis=0)
    if wanted.shape == "pile":
        fixed = [rectangle(-3.0, -2.0, width + 3.0, 0.0), rectangle(-3.0, 0.0, -0.8, 2.0 * height),
                 rectangle(width + 0.3, 0.0, width + 3.0, 2.0 * height)]
    if wanted.shape == "heap":
        fixed = [rectangle(-3.0 * (width + height), -2.0, 4.0 * (width + height), 0.0)]
    if wanted.shape in ("pyramid", "slope"):
        fixed = [rectangle(-1.0, -2.0, width + 1.0, 0.0)]
    if fixed:
        points = numpy.concatenate([points, *fixed])
    if wanted.shape == "slope":
        sine, cosine = 0.5, 0.75**0.5
        points = points @ numpy.array([[cosine, sine], [-sine, cosine]])
    mobile = vertices.size
    vertices = numpy.concatenate([vertices, numpy.full(len(fixed), 4)]).astype("i8")
    blocks = vertices.size
    with h5py.File(wanted.file, "w") as file:
        file["points"] = points
        file["offsets"] = numpy.concatenate([[0], numpy.cumsum(vertices)]).astype("i8")
        file["material"] = numpy.zeros(blocks, dtype="i4")
        file["fixed"] = (numpy.arange(blocks) >= mobile).astype("u1")
        if velocity is not None:
            file["velocity"] = numpy.concatenate([velocity, numpy.zeros((len(fixed), 3))])
    print(f"{wanted.file}: {mobile} mobile and {len(fixed)} fixed blocks")


main()
