"""Figures of a quasi-static test: the paper's 1A to E, S3 and S6; one module each, one registry."""

from wrinklewave.figures.compression import (  # noqa: F401 - each registers its figure, in this order
    fig_1abc,
    fig_1d,
    fig_1e,
    fig_s3,
    fig_s6,
)
from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs

__all__ = ["COMPRESSION_FIGURES", "CompressionInputs"]
