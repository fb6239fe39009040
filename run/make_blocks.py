#!/usr/bin/python3
"""Write a block file for [blocks] file = "...": a running-bond wall of rows x columns bricks.

A sample of the format to start from: /points (n,2) vertices of all blocks in their order, /offsets (blocks+1) where
each block's vertices begin, /material index into the scene's materials, /fixed.
"""
import argparse

import h5py
import numpy


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("file")
    arguments.add_argument("--rows", type=int, default=100)
    arguments.add_argument("--columns", type=int, default=100)
    arguments.add_argument("--size", type=float, nargs=2, default=(1.0, 0.5), help="of a brick, m")
    wanted = arguments.parse_args()

    width, height = wanted.size
    row, column = numpy.mgrid[0 : wanted.rows, 0 : wanted.columns]
    left = ((column + 0.5 * (row % 2)) * width).ravel()
    bottom = (row * height).ravel()
    points = numpy.empty((left.size, 4, 2))
    points[:, :, 0] = left[:, None] + width * numpy.array([0, 1, 1, 0])
    points[:, :, 1] = bottom[:, None] + height * numpy.array([0, 0, 1, 1])
    with h5py.File(wanted.file, "w") as file:
        file["points"] = points.reshape(-1, 2)
        file["offsets"] = numpy.arange(0, 4 * left.size + 1, 4, dtype="i8")
        file["material"] = numpy.zeros(left.size, dtype="i4")
        file["fixed"] = numpy.zeros(left.size, dtype="u1")
    print(f"{wanted.file}: {left.size} blocks")


main()
