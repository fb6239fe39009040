"""The temporal VTKHDF file, read by its specification (docs.vtk.org, VTKHDF file format)."""

import h5py
import numpy as np
import pytest

import gcpdda


def step_of(path, k):
    """Points, cells as lists of point numbers, and cell data of step k."""
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        steps = root["Steps"]
        part = steps["PartOffsets"][k]
        assert steps["NumberOfParts"][k] == 1
        sizes = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")
        points, cells, ids = (root[name][part] for name in sizes)
        begin = {name: steps[name][k] for name in ("PointOffsets", "CellOffsets", "ConnectivityIdOffsets")}
        # Every part has one offset more than cells.
        first = begin["CellOffsets"] + part
        offsets = root["Offsets"][first : first + cells + 1]
        connectivity = root["Connectivity"][begin["ConnectivityIdOffsets"] : begin["ConnectivityIdOffsets"] + ids]
        data = {}
        for name, values in root["CellData"].items():
            at = steps["CellDataOffsets"][name][k]
            data[name] = values[at : at + cells]
        assert len(root["Types"][begin["CellOffsets"] : begin["CellOffsets"] + cells]) == cells
        return (root["Points"][begin["PointOffsets"] : begin["PointOffsets"] + points],
                [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])], data)


# Blocks are excavated in this run, so that its topology changes.
@pytest.mark.parametrize("kind", ["blocks", "contacts"])
def test_every_step_is_its_frame(opening, tmp_path, kind):
    path = opening.to_vtkhdf(tmp_path / "all.vtkhdf", kind)
    prefix = "frame" if kind == "blocks" else kind
    frames = sorted((opening.path / "frames").glob(f"{prefix}_*.hdf"))
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert list(root.attrs["Version"]) == [2, 0] and root.attrs["Type"] == b"UnstructuredGrid"
        assert root["Steps"].attrs["NSteps"] == len(frames) > 10
        assert np.array_equal(root["Steps/Values"][()], opening.times)
        if kind == "blocks":
            assert 1 < len(root["NumberOfCells"]) < 5, "topologies, of which stages make new ones"
    for k, frame in enumerate(frames):
        points, cells, data = step_of(path, k)
        with h5py.File(frame) as file:
            part = file["VTKHDF"]
            assert np.array_equal(points, part["Points"][()])
            offsets, connectivity = part["Offsets"][()], part["Connectivity"][()]
            assert all(np.array_equal(cell, connectivity[a:b]) for cell, a, b in zip(cells, offsets[:-1], offsets[1:]))
            assert set(data) == set(part["CellData"])
            assert all(np.array_equal(data[name], values[()]) for name, values in part["CellData"].items())


def test_a_folder_without_bolts_is_told(opening):
    with pytest.raises(FileNotFoundError, match="no frames of bolts"):
        gcpdda.Result(opening.path).to_vtkhdf(kind="bolts")
