"""The numbers that verification tests check: asserted, and kept for the table in the documentation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Entry:
    """One verified number: what it is, what was found, what was required, and whether it holds."""

    what: str
    found: str
    required: str
    holds: bool


@dataclass(frozen=True)
class Verified:
    """Asserts that a number is right, and remembers it.

    Args:
        remember: takes a name and a value; pytest's ``record_property``.
    """

    remember: Callable[[str, Any], None]

    def error(self, what: str, error: float, limit: float) -> None:
        """``error`` is not above ``limit``."""
        self._keep(Entry(what, f"{error:.2g}", f"≤ {limit:.2g}", bool(0 <= error <= limit)), error)

    def value(self, what: str, found: float, exact: float, *, relative: float, unit: str = "") -> None:
        """``found`` is ``exact`` to within a ``relative`` error."""
        error = found / exact - 1
        shown = f"{found:.6g} {unit} ({100 * error:+.2g} %)".replace("  ", " ")
        required = f"{exact:.6g} {unit} ± {100 * relative:.2g} %".replace("  ", " ")
        self._keep(Entry(what, shown, required, bool(abs(error) <= relative)), found)

    def between(self, what: str, found: float, low: float, high: float) -> None:
        """``found`` lies in a range; an observed order of convergence, for instance."""
        self._keep(Entry(what, f"{found:.3g}", f"{low:.3g} to {high:.3g}", bool(low <= found <= high)), found)

    def _keep(self, entry: Entry, found: float) -> None:
        self.remember("verified", entry)
        assert entry.holds, f"{entry.what}: {found!r}, required {entry.required}"


def order(errors: list[float], ratio: float = 2.0) -> float:
    """Observed order of convergence from the last two errors of a refinement by ``ratio``."""
    return float(np.log(errors[-2] / errors[-1]) / np.log(ratio))
