"""wrinklewave: a laboratory for waves and wrinkles in soft layered materials."""

from wrinklewave._version import __version__

__all__ = ["__version__"]
