"""Fields for ParaView: a temporal VTKHDF file (unstructured grid, version 2.2), with the mesh stored once.

Points are the undeformed nodes; warp by ``displacement`` to see the deformed block.
Layout: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html (section VTKHDF).

The file is made with room for all frames before the first step, and closed as an HDF5 file. Frames are then written to
their places in it as plain bytes: nothing is gathered at the end, and a kill at any moment leaves a sound file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import h5py
import numpy as np

from wrinklewave.dynamics.fields import FIELDS

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from wrinklewave.mesh.block import GridMesh

QUAD = 9
UNITS = {
    "displacement": "m",
    "velocity": "m/s",
    "strain_xx": "1",
    "strain_rate_xx": "1/s",
    "volume_ratio": "1",
}
VECTORS = ("displacement", "velocity")
NUMBER = np.dtype("<f4")


@dataclass(frozen=True, eq=False)
class FieldFrame:
    """Nodal and element fields at one time, in single precision.

    Args:
        time: [s].
        nodal: u_x, u_y [m], v_x, v_y [m/s], shape [4, n_rows + 1, n_columns + 1].
        elements: shape [len(FIELDS), n_rows, n_columns].
    """

    time: float
    nodal: NDArray[np.float32]
    elements: NDArray[np.float32]


class FieldFile:
    """A VTKHDF file whose frames are written in any order, and any number of times.

    Args:
        path: of the file; one that is there is kept as it is.
        mesh: undeformed.
        times: of all frames [s].
    """

    def __init__(self, path: Path, mesh: GridMesh, times: NDArray[np.float64]) -> None:
        self.path = path
        self._shape = mesh.shape
        self._vectors = np.zeros((mesh.X.size, 3), NUMBER)
        if not path.exists():
            self._make(mesh, times)
        with h5py.File(path) as file:
            self.times = file["VTKHDF/Steps/Values"][()]
            self._places = {name: file[_where(name)].id.get_offset() for name in (*VECTORS, *FIELDS)}

    def write(self, k: int, frame: FieldFrame) -> None:
        """Put frame ``k`` in its place."""
        vectors = self._vectors
        with self.path.open("r+b", buffering=0) as stream:
            for name, first in zip(VECTORS, (0, 2), strict=True):
                vectors[:, 0], vectors[:, 1] = frame.nodal[first].ravel(), frame.nodal[first + 1].ravel()
                _write(stream, self._places[name] + k * vectors.nbytes, vectors)
            for name, values in zip(FIELDS, frame.elements, strict=True):
                _write(stream, self._places[name] + k * values.nbytes, values)

    def read(self, k: int) -> FieldFrame:
        """Frame ``k``."""
        rows, columns = self._shape
        points, cells = len(self._vectors), rows * columns
        with h5py.File(self.path) as file:
            vectors = [file[_where(name)][k * points : (k + 1) * points, :2] for name in VECTORS]
            elements = [file[_where(name)][k * cells : (k + 1) * cells] for name in FIELDS]
        nodal = np.concatenate([v.T for v in vectors]).reshape(4, rows + 1, columns + 1)
        return FieldFrame(float(self.times[k]), nodal, np.stack(elements).reshape(-1, rows, columns))

    def rename(self, path: Path) -> None:
        """Give the file, now finished, its name."""
        self.path = self.path.replace(path)

    def _make(self, mesh: GridMesh, times: NDArray[np.float64]) -> None:
        partial = self.path.with_name(self.path.name + ".part")
        with h5py.File(partial, "w") as file:
            root = file.create_group("VTKHDF")
            root.attrs["Version"] = np.array([2, 2])
            root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
            _write_mesh(root, mesh)
            _make_steps(root, mesh, times)
        partial.replace(self.path)


def _where(name: str) -> str:
    return f"VTKHDF/{'PointData' if name in VECTORS else 'CellData'}/{name}"


def _write(stream: object, place: int, values: NDArray[np.float32]) -> None:
    left = np.ascontiguousarray(values, NUMBER).data.cast("B")
    stream.seek(place)  # type: ignore[attr-defined]
    while left:
        left = left[stream.write(left) :]  # type: ignore[attr-defined]


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


def _make_steps(root: h5py.Group, mesh: GridMesh, times: NDArray[np.float64]) -> None:
    n = times.size
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = n
    steps["Values"] = times
    steps["NumberOfParts"] = np.ones(n, dtype=np.int64)
    for name in ("PartOffsets", "PointOffsets"):
        steps[name] = np.zeros(n, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        steps[name] = np.zeros((n, 1), dtype=np.int64)
    points, cells = root.create_group("PointData"), root.create_group("CellData")
    for group, names, size in ((points, VECTORS, mesh.X.size), (cells, FIELDS, mesh.n_elements)):
        offsets = steps.create_group(group.name.split("/")[-1] + "Offsets")
        for name in names:
            _make_room(group, name, (n * size, 3) if group is points else (n * size,))
            offsets[name] = np.arange(n) * size


def _make_room(group: h5py.Group, name: str, shape: tuple[int, ...]) -> None:
    """A dataset that has its place in the file from the start."""
    properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    properties.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    properties.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    kind, space = h5py.h5t.py_create(NUMBER), h5py.h5s.create_simple(shape)
    h5py.h5d.create(group.id, name.encode(), kind, space, dcpl=properties)
    group[name].attrs["units"] = UNITS.get(name, "Pa")
