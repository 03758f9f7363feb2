"""What a loop over a row of elements has at hand before it begins, so that no iteration reads it from memory again.

A loop with a mask reads what all its lanes share once for every lane: numbers are handed to it, not places of them.
"""

from __future__ import annotations

from numba.extending import overload
from numba.np.unsafe.ndarray import to_fixed_tuple

from wrinklewave._jit import INLINED, VECTOR_BYTES, uintp


def lanes(field):
    """How many numbers of a field are computed at a time; known when compiled."""
    return VECTOR_BYTES // field.itemsize


@overload(lanes, jit_options=INLINED)
def choose_lanes(field):
    """What numba compiles in place of :func:`lanes`."""
    n = VECTOR_BYTES // (field.dtype.bitwidth // 8)
    return lambda field: n


def numbers(values):
    """The five moduli of a layer, or the five factors of a Prony term, as a tuple."""
    return tuple(values[:5])


@overload(numbers, jit_options=INLINED)
def choose_numbers(values):
    """What numba compiles in place of :func:`numbers`."""
    return lambda values: to_fixed_tuple(values, 5)


def numbers_of_terms(factors, terms):
    """:func:`numbers` of each Prony term, as a tuple."""
    return tuple(numbers(factors[m]) for m in range(len(terms)))


@overload(numbers_of_terms, jit_options=INLINED)
def choose_numbers_of_terms(factors, terms):
    """What numba compiles in place of :func:`numbers_of_terms`."""
    last = terms.count - 1
    if last < 0:
        return lambda factors, terms: ()
    return lambda factors, terms: (*numbers_of_terms(factors, terms[1:]), numbers(factors[last]))


def heights(Y, j):
    """Heights below and above element row ``j`` if ``Y`` [n_rows] has them by row; else ``Y``, those of every node."""
    return (Y[j], Y[j + 1]) if Y.ndim == 1 else Y


@overload(heights, jit_options=INLINED)
def choose_heights(Y, j):
    """What numba compiles in place of :func:`heights`."""
    if Y.ndim == 1:
        return lambda Y, j: (Y[j], Y[j + uintp(1)])
    return lambda Y, j: Y
