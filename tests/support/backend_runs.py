"""Short runs of small models, of every drive, edge and element, on one device; their results as a file.

    python -m tests.support.backend_runs DEVICE FILE.npz

A process of its own, since numba decides at import whether CUDA is simulated. There it runs plain Python: nothing is
compiled, so the kernels of the GPU and the functions that they share with the processor are both read as written.
"""

from __future__ import annotations
