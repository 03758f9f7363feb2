"""The kernels that measure frames, compiled on a machine's first run: half of them in a process beside this one."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numba import typeof

from wrinklewave.compiling import compiled_beside
from wrinklewave.imaging.boundary import _find, _View
from wrinklewave.imaging.corner import follow_to_face
from wrinklewave.imaging.edges.coarse import coarse_edge
from wrinklewave.imaging.edges.columns import Columns, find_columns
from wrinklewave.imaging.edges.detect import RoughEdge, _fine, _fit, _Regularisation, _rough
from wrinklewave.imaging.edges.levels import Levels, find_levels
from wrinklewave.imaging.faces import fit_faces
from wrinklewave.imaging.strips import Greys

_Call = tuple[Any, tuple[Any, ...]]


@cache
def compile_kernels() -> None:
    """Compile what takes longest; what calls it finds it in the cache.

    The two halves hardly meet: the fit of the surface, which the other process begins with, is in the cache when this
    one comes to what calls it; if it is not, it is compiled here as well.
    """
    here, beside = kernel_calls()
    with compiled_beside(*beside) as started:
        if started:
            for kernel, arguments in here:
                kernel.compile(tuple(map(typeof, arguments)))


def kernel_calls() -> tuple[list[_Call], list[_Call]]:
    """Kernels with arguments of the types that they are called with: for this process, and for the one beside it."""
    image, row, flags, table = (
        np.zeros((1, 1), np.float32),
        np.zeros(1),
        np.zeros(1, np.bool_),
        np.zeros((1, 1)),
    )
    levels = Levels(row, row, np.zeros((1, 1, 1)), table, table, row, flags, flags, 0.0)
    by = _Regularisation(0.0, table, 0.0)
    greys = Greys(0.0, 0.0, row, row, row, row)
    here: list[_Call] = [
        (coarse_edge, (image, 0.0)),
        (find_levels, (image, row, row, 0, 0)),
        (find_columns, (image, row, row, levels, flags, 0.0)),
        (_rough, (image, row, 0, 0, by)),
        (_fine, (image, RoughEdge(row, row, row, levels), flags, by)),
    ]
    beside: list[_Call] = [
        (_fit, (Columns(row, row), row, row, by)),
        (fit_faces, (table, 0, row, row, row, 0.0, 0.0)),
        (follow_to_face, (image, row, row, row, flags, 0.0, 0.0, 0.0, 0.0, 0.0)),
        (_find, (image, row, greys, 0.0, _View(0.0, 0.0, 0.0, 0, 0.0))),
    ]
    return here, beside
