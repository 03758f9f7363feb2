"""Modules run in processes of their own: numba decides when it is imported whether CUDA is simulated."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from wrinklewave.environment import gpus

TESTS = Path(__file__).parents[1]
SIMULATED = {"NUMBA_ENABLE_CUDASIM": "1", "NUMBA_DISABLE_JIT": "1"}


def environment() -> dict[str, str]:
    """That of this process, with the tests and this package to be imported from where they are."""
    path = os.pathsep.join([str(TESTS), str(TESTS.parent / "src"), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path}


def run_elsewhere(module: str, device: str, *arguments: str) -> None:
    """Run a module; its process simulates a GPU if it is asked for one and there is none."""
    simulated = SIMULATED if device == "cuda" and isinstance(gpus(), str) else {}
    command = [sys.executable, "-m", module, *arguments]
    subprocess.run(command, env=environment() | simulated, check=True)
