"""Fields for ParaView: a temporal VTKHDF file (unstructured grid, version 2.2), with the mesh stored once.

Points are the undeformed nodes; warp by ``displacement`` to see the deformed block.
Layout: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html (section VTKHDF).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import h5py
import numpy as np

from wrinklewave.dynamics.fields import FIELDS

if TYPE_CHECKING:
    from pathlib import Path

    from wrinklewave.experiments.recording import FieldFrame, FieldStore
    from wrinklewave.mesh.block import GridMesh

QUAD = 9
UNITS = {
    "displacement": "m",
    "velocity": "m/s",
    "strain_xx": "1",
    "strain_rate_xx": "1/s",
    "volume_ratio": "1",
}


def write_vtkhdf(path: Path, mesh: GridMesh, frames: FieldStore) -> None:
    """Gather all frames in one file; it appears whole or not at all."""
    partial = path.with_name(path.name + ".part")
    with h5py.File(partial, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 2])
        root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
        _write_mesh(root, mesh)
        _write_steps(root, mesh, frames)
    partial.replace(path)


def _write_mesh(root: h5py.Group, mesh: GridMesh) -> None:
    points = np.stack([mesh.X.ravel(), mesh.Y.ravel(), np.zeros(mesh.X.size)], axis=1)
    node = np.arange(mesh.X.size).reshape(mesh.X.shape)
    cells = np.stack([node[:-1, :-1], node[:-1, 1:], node[1:, 1:], node[1:, :-1]], axis=-1).reshape(-1, 4)
    root["NumberOfPoints"] = np.array([len(points)])
    root["NumberOfCells"] = np.array([len(cells)])
    root["NumberOfConnectivityIds"] = np.array([cells.size])
    root["Points"] = points
    root["Connectivity"] = cells.ravel()
    root["Offsets"] = np.arange(0, cells.size + 1, 4)
    root["Types"] = np.full(len(cells), QUAD, dtype=np.uint8)


def _write_steps(root: h5py.Group, mesh: GridMesh, frames: FieldStore) -> None:
    n, n_points, n_cells = len(frames), mesh.X.size, mesh.n_elements
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = n
    steps["Values"] = frames.times()
    steps["NumberOfParts"] = np.ones(n, dtype=np.int64)
    for name in ("PartOffsets", "PointOffsets"):
        steps[name] = np.zeros(n, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        steps[name] = np.zeros((n, 1), dtype=np.int64)
    points, cells = root.create_group("PointData"), root.create_group("CellData")
    for group, names, size in ((points, ("displacement", "velocity"), n_points), (cells, FIELDS, n_cells)):
        offsets = steps.create_group(group.name.split("/")[-1] + "Offsets")
        for name in names:
            shape = (n * size, 3) if group is points else (n * size,)
            group.create_dataset(name, shape, dtype=np.float32).attrs["units"] = UNITS.get(name, "Pa")
            offsets[name] = np.arange(n) * size
    for k in range(n):
        _write_frame(points, cells, k, frames[k])


def _write_frame(points: h5py.Group, cells: h5py.Group, k: int, frame: FieldFrame) -> None:
    n_points, n_cells = frame.nodal[0].size, frame.elements[0].size
    for name, first in (("displacement", 0), ("velocity", 2)):
        vectors = np.zeros((n_points, 3), dtype=np.float32)
        vectors[:, 0], vectors[:, 1] = frame.nodal[first].ravel(), frame.nodal[first + 1].ravel()
        points[name][k * n_points : (k + 1) * n_points] = vectors
    for field, name in enumerate(FIELDS):
        cells[name][k * n_cells : (k + 1) * n_cells] = frame.elements[field].ravel()
