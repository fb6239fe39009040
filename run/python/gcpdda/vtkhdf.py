"""All frames of a run in one file that ParaView 5.12 and later animates: temporal VTKHDF, version 2.0.

Layout (docs.vtk.org, VTKHDF file format, temporal data): the arrays of all steps stand behind one another, and the
group Steps says where those of a step begin. Outlines of blocks stay the same until a stage removes some: their
topology is written once, and the steps that share it have the same offsets into it.
"""

import pathlib

import h5py
import numpy as np

KINDS = {"blocks": "frame", "contacts": "contacts", "bolts": "bolts", "liners": "liners"}
TOPOLOGY = ("Connectivity", "Offsets", "Types")
LEAST_CHUNK, MOST_CHUNK = 256, 65536  # rows


def append(group, name, values):
    """Behind what stands there; returns where they begin."""
    values = np.asarray(values)
    if name not in group:
        rows = min(max(values.shape[0], LEAST_CHUNK), MOST_CHUNK)
        group.create_dataset(name, data=values, maxshape=(None, *values.shape[1:]), chunks=(rows, *values.shape[1:]))
        return 0
    data = group[name]
    begin = data.shape[0]
    data.resize(begin + values.shape[0], axis=0)
    data[begin:] = values
    return begin


class Writer:
    """One file; steps are added in the order of time."""

    def __init__(self, path):
        self.file = h5py.File(path, "w")
        self.root = self.file.create_group("VTKHDF")
        self.root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        self.root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", len(b"UnstructuredGrid")))
        self.steps = self.root.create_group("Steps")
        self.last = None  # topology of the step before, and where it begins

    def add(self, frame, time):
        """A step from an open frame file."""
        part = frame["VTKHDF"]
        topology = [part[name][()] for name in TOPOLOGY]
        if self.last is None or not all(np.array_equal(a, b) for a, b in zip(topology, self.last[0])):
            begin = {"PartOffsets": append(self.root, "NumberOfCells", part["NumberOfCells"][()])}
            for name in ("NumberOfPoints", "NumberOfConnectivityIds"):
                append(self.root, name, part[name][()])
            begin["ConnectivityIdOffsets"] = append(self.root, "Connectivity", topology[0])
            append(self.root, "Offsets", topology[1])
            begin["CellOffsets"] = append(self.root, "Types", topology[2])
            self.last = topology, begin
        points = append(self.root, "Points", part["Points"][()])
        row = dict(self.last[1], Values=time, NumberOfParts=1, PointOffsets=points)
        for name, value in row.items():
            append(self.steps, name, np.array([value], dtype=np.float64 if name == "Values" else np.int64))
        for name, data in part["CellData"].items():
            begin = append(self.root.require_group("CellData"), name, data[()])
            append(self.steps.require_group("CellDataOffsets"), name, np.array([begin], dtype=np.int64))

    def close(self):
        self.steps.attrs["NSteps"] = np.int64(self.steps["Values"].shape[0])
        self.file.close()


def write(directory, out=None, kind="blocks"):
    """Writes DIRECTORY/run.vtkhdf, or contacts.vtkhdf, bolts.vtkhdf or liners.vtkhdf, or `out`; returns the path.

    @raises FileNotFoundError  where the folder has no frames of this kind
    """
    directory = pathlib.Path(directory)
    frames = sorted((directory / "frames").glob(f"{KINDS[kind]}_??????.hdf"))
    if not frames:
        raise FileNotFoundError(f"{directory} has no frames of {kind}")
    out = pathlib.Path(out) if out else directory / f"{'run' if kind == 'blocks' else kind}.vtkhdf"
    writer = Writer(out)
    for path in frames:
        with h5py.File(path) as frame:
            writer.add(frame, float(frame["VTKHDF"].attrs["time"]))
    writer.close()
    return out
