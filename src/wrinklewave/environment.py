"""What this machine has: versions, processors, threads, GPU; for ``doctor`` and the summary of runs."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wrinklewave.errors import InputError
from wrinklewave.processes import usable_cores

if TYPE_CHECKING:
    from wrinklewave.dynamics.backends import Device

REQUIRED = (
    *("numpy", "scipy", "numba", "xarray", "h5netcdf", "h5py", "pydantic", "pint"),
    *("typer", "rich", "matplotlib", "jinja2", "tifffile", "threadpoolctl"),
)
OPTIONAL = {
    "video": ("av", "cine-handler"),
    "cuda": ("numba-cuda",),
    "view": ("pyvista",),
    "cluster": ("dask", "dask-jobqueue"),
}
"""Packages that the extras of the same names bring."""


DEVICES = ("cpu", "cuda", "auto")
"""What may be asked for."""


@dataclass(frozen=True)
class Processor:
    """The processor that runs this process.

    Args:
        name: as the system has it.
        cores: logical cores of the machine.
        usable: logical cores that this process may use.
        memory: bytes of main memory; None where the system does not say.
    """

    name: str
    cores: int
    usable: int
    memory: int | None


@dataclass(frozen=True)
class Gpu:
    """A CUDA device.

    Args:
        name: of the model.
        compute_capability: major and minor.
        memory: bytes.
    """

    name: str
    compute_capability: tuple[int, int]
    memory: int


SIMULATOR = Gpu("numba's simulator (NUMBA_ENABLE_CUDASIM)", (0, 0), 0)
"""Runs kernels as Python: for tests on small meshes."""


@dataclass(frozen=True)
class Threading:
    """How kernels run on several cores.

    Args:
        threads: that a run uses unless told otherwise.
        vector_width: bits of the widest vectors that kernels are compiled for.
        cache: folder of the compiled kernels.
    """

    threads: int
    vector_width: int
    cache: str


def versions() -> dict[str, str]:
    """Return the versions of this package, Python and the required packages, by name."""
    from wrinklewave import __version__

    found = {"wrinklewave": __version__, "python": platform.python_version()}
    return found | {name: version_of(name) for name in REQUIRED}


def version_of(package: str) -> str:
    """Return the version of an installed package, without importing it; "missing" if it is not there."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "missing"


def processor() -> Processor:
    """Return the processor that runs this process."""
    return Processor(_processor_name(), os.cpu_count() or 1, usable_cores(), _memory())


def gpus() -> list[Gpu] | str:
    """Return the CUDA devices, or the reason why there are none that can be used."""
    if version_of("numba-cuda") == "missing":
        return 'numba-cuda is not installed: pip install "wrinklewave[cuda]"'
    try:
        from numba import config, cuda

        if config.ENABLE_CUDASIM:  # type: ignore[attr-defined]  # made when numba is imported
            return [SIMULATOR]
        if not cuda.is_available():
            return "no CUDA driver or no device"
        require_cuda_compilers()
        return [_gpu(device) for device in cuda.gpus]
    except Exception as error:  # a broken driver raises whatever it likes; doctor is there to say so
        return f"CUDA does not start: {type(error).__name__}: {error}".splitlines()[0]


def require_cuda_compilers() -> None:
    """Raise whatever numba-cuda raises where it finds no compilers for GPUs."""
    from numba.cuda.cudadrv import nvrtc, nvvm

    nvvm.NVVM()
    nvrtc.get_supported_ccs()


def choose_device(wish: str) -> Device:
    """Return the device that a wish (``cpu``, ``cuda`` or ``auto``: the GPU if there is one) leads to.

    Raises:
        InputError: if there is no such device.
    """
    if wish not in DEVICES:
        raise InputError(f'"{wish}"', key="device", expected=", ".join(DEVICES))
    if wish == "cpu":
        return "cpu"
    found = gpus()
    if not isinstance(found, str):
        return "cuda"
    if wish == "auto":
        return "cpu"
    raise InputError(
        f"no GPU that can be used ({found})", key="device", cure="cpu or auto; wrinklewave doctor"
    )


def threading() -> Threading:
    """Return how kernels run on several cores; imports numba with the options of this package."""
    import llvmlite.binding as llvm
    import numba

    from wrinklewave import _jit  # sets the options as well

    config: Any = numba.config  # its attributes are made when it is imported
    features = config.CPU_FEATURES or llvm.get_host_cpu_features().flatten()
    wide = "+avx512f" in features and "-prefer-256-bit" in features
    width = 512 if wide else 256 if "+avx2" in features else 128
    cache = str(_jit.cache_folder())
    return Threading(processor().usable, width, cache)


def _gpu(device: object) -> Gpu:
    from numba import cuda

    with device:  # type: ignore[attr-defined]
        memory = cuda.current_context().get_memory_info()[1]
    name = device.name  # type: ignore[attr-defined]
    text = name.decode() if isinstance(name, bytes) else str(name)
    return Gpu(text, tuple(device.compute_capability), int(memory))  # type: ignore[attr-defined]


def _processor_name() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _memory() -> int | None:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None
