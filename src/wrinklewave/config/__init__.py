"""Case files: TOML with units outside, typed frozen sections with SI floats inside.

``load_case("impact.toml", overrides=["drive.velocity=5 m/s"])`` reads, completes and checks one. Every
mistake in it is an :class:`wrinklewave.errors.InputError` that names the file, the key, the value, what is
expected and the cure; all mistakes of a file come at once.
"""

from wrinklewave.config.case import Case
from wrinklewave.config.history import BoundaryHistory, SurfaceProfile, read_history, read_profile
from wrinklewave.config.reading import case_from_text, load_case

__all__ = [
    "BoundaryHistory",
    "Case",
    "SurfaceProfile",
    "case_from_text",
    "load_case",
    "read_history",
    "read_profile",
]
