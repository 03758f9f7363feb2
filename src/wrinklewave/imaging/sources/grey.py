"""Grey values of pictures that come in colour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.frames import Image

LUMA_PER_MILLE = (299, 587, 114)
"""Red, green and blue in grey (ITU-R BT.601). Sum 1000: grey stored as colour is unchanged."""

COLOUR_NOTE = "colour frames are measured by their luma (0.299 R + 0.587 G + 0.114 B)"


def luma(colour: NDArray[np.unsignedinteger]) -> Image:
    """Grey values [height, width] of a picture [height, width, 3 or more], rounded, in its own type."""
    red, green, blue = LUMA_PER_MILLE
    wide = colour.astype(np.uint32)
    grey = (red * wide[..., 0] + green * wide[..., 1] + blue * wide[..., 2] + 500) // 1000
    return grey.astype(colour.dtype)
