#!/usr/bin/python3
"""A ground motion like that of an earthquake, as CSV for [earthquake]: sines of random phases with a peak at one
frequency, under a rise and a decay, without velocity or displacement at the end. The same seed makes the same record.

    run/make_record.py --duration 8 --peak 0.25 --frequency 1.5 --out record.csv
"""

import argparse
import math
import pathlib

import numpy as np


def above_0(text):
    number = float(text)
    if not 0.0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return number


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--duration", type=above_0, default=8.0, help="s")
parser.add_argument("--interval", type=above_0, default=0.01, help="s, between rows")
parser.add_argument("--peak", type=above_0, default=0.25, help="largest velocity, m/s")
parser.add_argument("--frequency", type=above_0, default=1.5, help="Hz, where it is strongest")
parser.add_argument("--vertical", type=float, default=0.5, help="vertical motion over horizontal motion")
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--out", type=pathlib.Path, required=True, help="FILE.csv: time, vx, vy")
arguments = parser.parse_args()
if not math.isfinite(arguments.vertical):
    parser.error(f"--vertical {arguments.vertical} is no number")
if arguments.duration < 10.0 * arguments.interval:
    parser.error(f"--duration {arguments.duration:g} s has fewer than ten intervals of {arguments.interval:g} s, "
                 "which make no motion: try --interval 0.01")

random = np.random.default_rng(arguments.seed)
t = np.arange(round(arguments.duration / arguments.interval) + 1) * arguments.interval
share = t / arguments.duration
envelope = (np.minimum(1.0, share / 0.2) * np.minimum(1.0, (1.0 - share) / 0.5)) ** 2
frequencies = arguments.frequency * np.linspace(0.3, 4.0, 60)
ratio = frequencies / arguments.frequency
weights = ratio * np.exp(1.0 - ratio)


def motion():
    phases = random.uniform(0.0, 2.0 * np.pi, len(frequencies))
    v = envelope * (weights * np.sin(2.0 * np.pi * np.outer(t, frequencies) + phases)).sum(axis=1)
    v -= envelope * v.sum() / envelope.sum()  # the ground ends where it began
    return v * arguments.peak / np.abs(v).max()


x, y = motion(), arguments.vertical * motion()
np.savetxt(arguments.out, np.column_stack([t, x, y]), fmt=["%.4f", "%.6f", "%.6f"], delimiter=",",
           header="time[s],vx[m/s],vy[m/s]", comments="")
