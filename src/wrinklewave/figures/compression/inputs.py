"""What figures of a quasi-static test are drawn from, and the registry of these figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.detections import Detection
from wrinklewave.figures.registry import Registry
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    from wrinklewave.experiments.quasi_static_test import QuasiStaticTest


@dataclass(frozen=True)
class CompressionInputs:
    """What figures are drawn from: the test, and a few images of it if there are any."""

    test: QuasiStaticTest
    images: tuple[Detection, ...] = ()

    @property
    def largest_strain(self) -> float:
        """Of all series."""
        return max(float(test.series.strain.max()) for test in self.test.tests)

    def fine_strains(self) -> Array:
        """Strains for smooth curves."""
        return np.linspace(0.0, self.largest_strain, 800)


COMPRESSION_FIGURES: Registry[CompressionInputs] = Registry(
    "wrinklewave.figures.compression:COMPRESSION_FIGURES"
)
