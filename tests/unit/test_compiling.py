"""Kernels compiled in a process beside this one: they meet in the cache, whatever becomes of either process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from support.elsewhere import environment

FIRST_RUN = """
{first}
import os
import numpy as np, numba
from wrinklewave import compiling
from wrinklewave.imaging.strips import strip_mean
compiling._core_is_free = lambda: {cores} > 1
call = strip_mean, (np.zeros((1, 1), np.float32), np.zeros(1), 1)
types = tuple(map(numba.typeof, call[1]))
before = compiling.is_kept(strip_mean, types)
try:
    with compiling.compiled_beside(call) as started:
        if {interrupted}:
            raise KeyboardInterrupt
except KeyboardInterrupt:
    pass
after = compiling.is_kept(strip_mean, types)
try:
    os.waitpid(-1, os.WNOHANG)
    children = True
except ChildProcessError:
    children = False
print(before, started, after, children, strip_mean(np.ones((2, 2), np.float32), np.zeros(2), 1))
"""


def first_run(cache: Path, *, first: str = "", cores: int = 2, interrupted: bool = False) -> str:
    """What a process with a cold cache says, which does ``first`` before all."""
    return subprocess.run(
        [sys.executable, "-c", FIRST_RUN.format(first=first, cores=cores, interrupted=interrupted)],
        env=environment() | {"NUMBA_CACHE_DIR": str(cache)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()


@pytest.mark.skipif(os.name != "posix", reason="asks for children as POSIX systems do")
def test_what_the_other_process_compiles_is_in_the_cache(tmp_path: Path) -> None:
    assert first_run(tmp_path) == "False True True False [1. 1.]"
    assert first_run(tmp_path) == "True False True False [1. 1.]"


@pytest.mark.skipif(os.name != "posix", reason="asks for children as POSIX systems do")
def test_an_interrupt_ends_the_other_process(tmp_path: Path) -> None:
    assert first_run(tmp_path, interrupted=True) == "False True False False [1. 1.]"


@pytest.mark.skipif(os.name != "posix", reason="asks for children as POSIX systems do")
def test_one_core_has_no_process_beside(tmp_path: Path) -> None:
    assert first_run(tmp_path, cores=1) == "False False False False [1. 1.]"


@pytest.mark.skipif(os.name != "posix", reason="asks for children as POSIX systems do")
def test_no_other_process_compiles_for_one_with_laws_of_its_own(tmp_path: Path) -> None:
    assert first_run(tmp_path) == "False True True False [1. 1.]"
    assert first_run(tmp_path, first="import support.new_law") == "False False False False [1. 1.]"
