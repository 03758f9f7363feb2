"""Short names for the arrays that the image kernels pass to each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.float32]
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
