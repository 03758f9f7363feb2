"""Case files: TOML with units outside, typed frozen sections with SI floats inside.

``load_case("impact.toml", overrides=["drive.velocity=5 m/s"])`` reads, completes and checks one. Every mistake in it
is an :class:`wrinklewave.errors.InputError` that names the file, the key, the value, what is expected and the cure.
"""

from wrinklewave.config.case import Case
from wrinklewave.config.history import BoundaryHistory, read_history
from wrinklewave.config.reading import case_from_text, load_case

__all__ = ["BoundaryHistory", "Case", "case_from_text", "load_case", "read_history"]
