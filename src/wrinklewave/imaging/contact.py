"""Which frames show the striker touching: every frame's evidence for a gap, weighed with that of its neighbours."""

from __future__ import annotations

import numpy as np

from wrinklewave.imaging.arrays import Floats

GAP_GAIN = 4.0  # in chi squared, that a gap brings in every frame: noise alone brings more in one of forty
_CHANGE = 4.0  # and for every time that the faces meet or part


def touching_frames(gain: Floats) -> Floats:
    """1 where the striker touches, 0 where it does not, NaN where that cannot be known.

    The most likely sequence of both (Viterbi 1967): a narrow gap next to a wide one is believed more readily than
    one in the middle of a contact.

    Args:
        gain: by how much chi squared is smaller with a gap than without, in consecutive frames, shape [n_frames];
            NaN where no striker is in sight.
    """
    known = np.isfinite(gain) | np.isposinf(gain)
    cost = np.stack([np.where(known, GAP_GAIN, 0.0), np.where(known, np.clip(gain, 0.0, 1e6), 0.0)])
    came_from = np.zeros((2, gain.size), dtype=np.intp)
    total = cost[:, 0].copy() if gain.size else np.zeros(2)
    for frame in range(1, gain.size):
        arrived = total[:, None] + _CHANGE * (1.0 - np.eye(2))
        came_from[:, frame] = arrived.argmin(axis=0)
        total = arrived.min(axis=0) + cost[:, frame]
    states = np.full(gain.size, np.nan)
    state = int(total.argmin())
    for frame in range(gain.size - 1, -1, -1):
        states[frame] = state
        state = int(came_from[state, frame])
    return np.where(known, states, np.nan)
