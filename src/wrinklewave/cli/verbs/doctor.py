"""``wrinklewave doctor``: what this machine has, and what would run where."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wrinklewave.environment import Gpu, Processor, Threading


def doctor() -> None:
    """Say what is installed, which processors and GPUs there are, and what would run where."""
    from wrinklewave import environment

    for name, version in environment.versions().items():
        print(f"{name:14} {version}")
    print()
    for extra, packages in environment.OPTIONAL.items():
        found = ", ".join(f"{package} {environment.version_of(package)}" for package in packages)
        print(f"{'[' + extra + ']':14} {found}")
    print()
    processor, threading, gpus = environment.processor(), environment.threading(), environment.gpus()
    for line in (*_processor(processor), *_kernels(threading), *_gpus(gpus), *_verdict(threading, gpus)):
        print(line)


def _processor(processor: Processor) -> list[str]:
    memory = f"{processor.memory / 2**30:.1f} GiB" if processor.memory else "of unknown size"
    return [
        f"processor      {processor.name}",
        f"cores          {processor.usable} of {processor.cores} usable by this process",
        f"memory         {memory}",
    ]


def _kernels(threading: Threading) -> list[str]:
    return [
        f"threads        {threading.threads}",
        f"vectors        {threading.vector_width} bit",
        f"kernel cache   {threading.cache}",
    ]


def _gpus(gpus: list[Gpu] | str) -> list[str]:
    if isinstance(gpus, str):
        return [f"GPU            none ({gpus})"]
    return [
        f"GPU {number}          {gpu.name}, {gpu.memory / 2**30:.1f} GiB, compute capability "
        f"{gpu.compute_capability[0]}.{gpu.compute_capability[1]}"
        for number, gpu in enumerate(gpus)
    ]


def _verdict(threading: Threading, gpus: list[Gpu] | str) -> list[str]:
    cpu = f"the processor, {threading.threads} threads"
    gpu = (
        []
        if isinstance(gpus, str)
        else [f"               the GPU with --device cuda or auto ({gpus[0].name})"]
    )
    return ["", f"simulate       {cpu}", *gpu, f"measure        {cpu}"]
