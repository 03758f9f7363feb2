"""CUDA kernels compiled for a device that is not there: what numba's simulator cannot see.

``python -m support.cuda_targets FILE.json`` in a process of its own. The backend works on arrays that only look like
those of a device, and every kernel that it launches is compiled for the types that it is launched with. Needs libNVVM,
as ``pip install "numba-cuda[cu13]"`` brings it; with ``ptxas`` (package nvidia-cuda-nvcc) it also says how many
registers a kernel takes, and how many bytes it spills.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import numpy as np
from numba import cuda
from numba.cuda import dispatcher, types
from numba.cuda.typing.typeof import typeof

from support.backend_models import MODELS
from support.models import build, distorted
from wrinklewave.dynamics.backends import March
from wrinklewave.dynamics.cuda import backend, kernels, row_kernels
from wrinklewave.dynamics.model import Model, subcycled
from wrinklewave.materials.moduli import Viscoelastic

CAPABILITY = (9, 0)
Resources = dict[str, int]


class _Array(np.ndarray):
    """A host's array with the methods of a device's."""

    def copy_to_host(self, out: np.ndarray | None = None, stream: Any = None) -> np.ndarray:
        return np.asarray(self)

    def copy_to_device(self, values: np.ndarray, stream: Any = None) -> None:
        self[...] = values


def _device_array(shape: tuple[int, ...], dtype: Any = np.float64) -> _Array:
    return np.zeros(shape, dtype).view(_Array)


def _plain(argument: Any) -> Any:
    """An argument with arrays as numba's typing knows them."""
    if isinstance(argument, _Array):
        return np.asarray(argument)
    if hasattr(argument, "_fields"):
        return type(argument)(*map(_plain, argument))
    return tuple(map(_plain, argument)) if isinstance(argument, tuple) else argument


class _Compiled:
    """Stands in for a kernel: a launch compiles it."""

    def __init__(self, kernel: Any, found: dict[str, Resources]) -> None:
        self._kernel, self._found = kernel, found
        self.typeof_pyval = lambda argument: argument

    def __getitem__(self, configuration: Any) -> Callable[..., None]:
        return self._launch

    def _launch(self, *arguments: Any) -> None:
        signature = types.void(*(typeof(_plain(argument)) for argument in arguments))
        name = self._kernel.py_func.__name__
        if name not in self._found:
            self._found[name] = resources(cuda.compile_ptx(self._kernel.py_func, signature, cc=CAPABILITY)[0])

    def compile(self, signature: Any) -> SimpleNamespace:
        """What the backend asks before a cooperative launch."""
        return SimpleNamespace(max_threads_per_block=256, max_cooperative_grid_blocks=lambda *arguments: 1)


def compiled(model: Model) -> dict[str, Resources]:
    """What every kernel that steps and reads a model takes, by name."""
    found: dict[str, Resources] = {}
    for (module, name), kernel in _KERNELS.items():
        setattr(module, name, _Compiled(kernel, found))
    backend.cuda = SimpleNamespace(  # type: ignore[assignment]
        to_device=lambda values, stream=None: np.array(values).view(_Array),
        device_array=_device_array,
        pinned_array=np.zeros,
        stream=MagicMock,
        event=MagicMock,
        current_context=lambda: None,
    )
    dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=CAPABILITY)
    (member,) = backend.Batch([model]).members()
    counts = None if model.row_steps is None else np.ones(model.mesh.shape[0], dtype=np.int64)
    member.march(March(3, 0.0, 0.0, 1e-6, counts))
    member.snapshot()()
    return found


_KERNELS = {
    (kernels, name): getattr(kernels, name) for name in ("steps", "sample", "snapshot", "stable_steps")
}
_KERNELS |= {(row_kernels, "row_steps"): row_kernels.row_steps}


def resources(ptx: str) -> Resources:
    """Registers of a kernel and bytes that it spills, as ptxas says; nothing if there is no ptxas.

    It must be that of the compilers in use, nvidia-cuda-nvcc beside them: an older one does not take what they make.
    """
    ptxas = next(Path(sys.prefix).rglob("ptxas"), None)
    if ptxas is None:
        return {}
    with TemporaryDirectory() as folder:
        file = Path(folder) / "kernel.ptx"
        file.write_text(ptx)
        command = [str(ptxas), "-arch=sm_90", "-v", "-c", str(file), "-o", str(file.with_suffix(".o"))]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return {
        "registers": int(re.findall(r"Used (\d+) registers", said)[0]),
        "spilled": sum(map(int, re.findall(r"(\d+) bytes spill", said))),
    }


def many_terms() -> Model:
    """Five Prony terms at four integration points each: the longest list of arguments that is likely."""
    shares = np.full(5, 1e5)
    solid = Viscoelastic(965.0, 44e3, 2e6, shares, shares, np.logspace(-6, -2, 5))
    return build(distorted(4, 3), solid, "mean-dilatation")


def many_terms_by_rows() -> Model:
    """The same with steps of their own for rows of elements."""
    return subcycled(many_terms())


def main(file: str) -> None:
    """Compile the kernels of all models."""
    models = (MODELS["struck"], many_terms, MODELS["filmed"], many_terms_by_rows)
    found = {f.__name__: compiled(f()) for f in models}
    Path(file).write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main(sys.argv[1])
