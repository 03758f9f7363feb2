"""Every number that a verification test of the solver checks passes through ``verified``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from support.ledger import Verified


@pytest.fixture
def verified(record_property: Callable[[str, Any], None]) -> Verified:
    """Assert numbers and keep them for the table of verification."""
    return Verified(record_property)
