"""A solid that the package does not have, stepped on one device: ``python -m support.new_law DEVICE FILE.npz``.

A law is a pure function of the strain; nothing else is written for it, for the processor or for a GPU. It takes
the neo-Hookean solid's place before the kernels are made.
"""

from __future__ import annotations

import sys

from wrinklewave._jit import scalar
from wrinklewave.materials import neo_hookean

_of_neo_hookean = neo_hookean.isochoric_shape


@scalar
def stiffening_shape(C11, C22, C12, Ji2):
    """Isochoric stress per shear modulus that grows with the strain: 1 + 20 (tr C - 3)² times the neo-Hookean one."""
    s11, s22, s12, s33 = _of_neo_hookean(C11, C22, C12, Ji2)
    strain = C11 + C22 - 2.0
    factor = 1.0 + 20.0 * strain * strain
    return factor * s11, factor * s22, factor * s12, factor * s33


if __name__ == "__main__":
    neo_hookean.isochoric_shape = stiffening_shape

    import numpy as np

    from support.backend_models import run, struck

    sys.setswitchinterval(1e-4)  # as in support.backend_runs
    np.savez(sys.argv[2], **run(struck(), "cuda" if sys.argv[1] == "cuda" else "cpu"))
