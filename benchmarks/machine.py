"""What a machine can do at most, and what it is: measured in the same run as what is held against it."""

from __future__ import annotations

import argparse
import datetime
import json
import os
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from wrinklewave._jit import uintp, vector
from wrinklewave.environment import gpus, processor, versions

REPOSITORY = Path(__file__).parents[1]
TIMING = 0.15
"""Seconds that a measurement of the processor takes."""


def description() -> dict[str, Any]:
    """Machine, date, commit and versions, for a file of results."""
    found = gpus()
    return {
        "date": str(datetime.date.today()),
        "commit": _commit(),
        "processor": processor().name,
        "cores": processor().usable,
        "compiled_for": os.environ.get("NUMBA_CPU_NAME", "this processor"),
        "gpu": found if isinstance(found, str) else found[0].name,
        "versions": versions(),
    }


def offer_to_keep(parser: argparse.ArgumentParser) -> None:
    """Let a benchmark be told where its numbers go."""
    parser.add_argument("--out", type=Path, help="also write the numbers as JSON")


def keep(numbers: dict[str, Any], path: Path | None) -> None:
    """Write what was measured, and on what, if there is a ``path`` for it."""
    if path:
        path.write_text(json.dumps(description() | numbers, indent=1) + "\n", encoding="utf-8")


def _commit() -> str:
    command = ["git", "-C", str(REPOSITORY), "describe", "--always", "--dirty"]
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def copy_bandwidth(n_bytes: float, threads: int) -> float:
    """Bytes per second, read and written, of copies that touch ``n_bytes`` in all, again and again."""
    n = max(int(n_bytes / 16 / threads), 1)
    arrays = [(np.ones(n), np.ones(n)) for _ in range(threads)]

    def copy(part: int) -> int:
        source, target = arrays[part]
        stop, done = time.perf_counter() + TIMING, 0
        while time.perf_counter() < stop:
            np.copyto(target, source)
            done += 2 * source.nbytes
        return done

    return _per_second(copy, threads)


CHAIN = 32
"""Multiply-adds on each number between its load and its store."""


@vector
def _multiply_add(x, a, b, times):
    # two chains side by side: one alone does not keep all units of the processor busy
    half = uintp(x.size // 2)
    for _ in range(times):
        for i in range(half):
            y, z = x[i], x[i + half]
            for _ in range(CHAIN):
                y = y * a + b
                z = z * a + b
            x[i], x[i + half] = y, z


def arithmetic_rate(threads: int) -> float:
    """Additions and multiplications per second that the processor makes of numbers at hand."""

    def work(part: int) -> int:
        x, done, stop = np.ones(1024), 0, time.perf_counter() + TIMING
        while time.perf_counter() < stop:
            _multiply_add(x, 0.999, 1e-3, 100)
            done += 100 * 2 * x.size * CHAIN
        return done

    _multiply_add(np.ones(8), 0.999, 1e-3, 1)
    return _per_second(work, threads)


def _per_second(work: Any, threads: int) -> float:
    """Best of three tries, all threads together."""
    best = 0.0
    with ThreadPoolExecutor(threads) as pool:
        for _ in range(3):
            begin = time.perf_counter()
            best = max(best, sum(pool.map(work, range(threads))) / (time.perf_counter() - begin))
    return best
