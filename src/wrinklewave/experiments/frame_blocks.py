"""Measured frames in blocks: as many as are held at a time, and what an interrupted measurement goes on from."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wrinklewave.environment import processor
from wrinklewave.errors import InputError
from wrinklewave.experiments.interruption import interruptible
from wrinklewave.experiments.run_folder import write_text
from wrinklewave.imaging.arrays import Flags, Floats
from wrinklewave.imaging.boundary import StruckEnd
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.frame_measuring import FrameMeasurement, FrameMeasurer
from wrinklewave.imaging.frames import FrameSource
from wrinklewave.imaging.wires import WireSightings

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment
    from wrinklewave.imaging.prepared import PreparedSource

MOST_FRAMES = 64
MOST_BYTES = 64e6
"""Frames of a block: at most so many, and no more bytes of grey values (but at least four frames)."""

_SIGHTING = WireSightings._fields
_LOCKING = ("count", "total", "squares")


@dataclass(frozen=True)
class MeasuringProgress:
    """Where a measurement is.

    Args:
        frames: done.
        n_frames: of the recording.
        per_second: frames, since it was started or resumed.
    """

    frames: int
    n_frames: int
    per_second: float

    @property
    def share(self) -> float:
        """Of the whole that is done."""
        return self.frames / self.n_frames

    def __str__(self) -> str:
        left = (self.n_frames - self.frames) / self.per_second if self.per_second > 0 else float("nan")
        return f"frame {self.frames} of {self.n_frames}, {self.per_second:.0f} frames/s, {left:.0f} s left"


@dataclass(frozen=True)
class FrameBlock:
    """What was measured in some consecutive frames; arrays of shape [n_frames, ...], in pixels and grey values.

    Attributes:
        frame: which frames these are, unreadable ones left out.
        rows, sigma, valid: the surface, [..., n_columns], as in ``Edge``.
        end: fields of ``StruckEnd``, [..., 17].
        wires: fields of ``WireSightings``, [..., n_seen, 5], NaN after the last.
        locking: sums over the block's frames, [3, n_bins], as in ``PixelLocking``.
        contrast, noise: of each frame.
    """

    frame: NDArray[np.int64]
    rows: Floats
    sigma: Floats
    valid: Flags
    end: Floats
    wires: Floats
    locking: Floats
    contrast: Floats
    noise: Floats

    @classmethod
    def of(cls, frames: Sequence[int], found: Sequence[FrameMeasurement], n_columns: int) -> FrameBlock:
        """Gather what was measured in ``frames``."""
        edges = [f.edge for f in found]
        locking = sum((f.locking for f in found), start=PixelLocking.none())
        return cls(
            frame=np.array(frames, dtype=np.int64),
            rows=np.array([edge.rows for edge in edges]).reshape(-1, n_columns),
            sigma=np.array([edge.sigma for edge in edges]).reshape(-1, n_columns),
            valid=np.array([edge.valid for edge in edges], dtype=bool).reshape(-1, n_columns),
            end=np.array([f.end for f in found], dtype=float).reshape(-1, len(StruckEnd._fields)),
            wires=_padded([f.wires for f in found]),
            locking=np.array([getattr(locking, name) for name in _LOCKING]),
            contrast=np.array([edge.contrast for edge in edges]),
            noise=np.array([edge.noise for edge in edges]),
        )

    @property
    def sightings(self) -> Iterator[WireSightings]:
        """Of the wires, frame by frame."""
        for seen in self.wires:
            yield WireSightings(*seen[np.isfinite(seen[:, 0])].T.copy())

    @property
    def pixel_locking(self) -> PixelLocking:
        """Residuals against the sub-pixel phase."""
        return PixelLocking(*self.locking)


def _padded(sightings: Sequence[WireSightings]) -> Floats:
    most = max((seen.column.size for seen in sightings), default=0)
    table = np.full((len(sightings), most, len(_SIGHTING)), np.nan)
    for frame, seen in enumerate(sightings):
        for k, name in enumerate(_SIGHTING):
            table[frame, : seen.column.size, k] = getattr(seen, name)
    return table


class BlockStore:
    """Blocks in a folder, each a file that is there whole or not at all.

    Args:
        folder: made if it is not there.
        origin: what is measured and how; blocks of another origin are not gone on from.
    """

    def __init__(self, folder: Path, origin: str) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self._origin = folder / "origin.txt"
        if not self._origin.exists():
            write_text(self._origin, origin)
        elif self._origin.read_text(encoding="utf-8") != origin:
            raise InputError(
                "was begun with another experiment file or another recording",
                file=folder.parent,
                cure="--overwrite measures everything again, --out takes another folder",
            )

    def __contains__(self, number: int) -> bool:
        return self._file(number).exists()

    def put(self, number: int, block: FrameBlock) -> None:
        """Store a block."""
        partial = self._file(number).with_suffix(".part")
        with partial.open("wb") as stream:
            np.savez(stream, **{field.name: getattr(block, field.name) for field in fields(block)})
        partial.replace(self._file(number))

    def get(self, number: int) -> FrameBlock:
        """Read a block."""
        with np.load(self._file(number)) as arrays:
            return FrameBlock(**arrays)

    def blocks(self, source: FrameSource) -> Iterator[FrameBlock]:
        """Read all blocks of a recording, one after the other."""
        return (self.get(number) for number in range(len(block_bounds(source))))

    def remove(self) -> None:
        """Delete all blocks, and the folder."""
        for file in self.folder.iterdir():
            file.unlink()
        self.folder.rmdir()

    def _file(self, number: int) -> Path:
        return self.folder / f"block-{number:06d}.npz"


def block_bounds(source: FrameSource) -> list[tuple[int, int]]:
    """First frame and one past the last of every block; the same for a recording whenever it is measured."""
    size = source.shape[0] * source.shape[1] * source.dtype.itemsize
    n = int(min(max(MOST_BYTES // size, 4), MOST_FRAMES))
    return [(first, min(first + n, source.n_frames)) for first in range(0, source.n_frames, n)]


def measure_block(
    source: FrameSource, first: int, stop: int, measurer: FrameMeasurer, pool: ThreadPoolExecutor
) -> FrameBlock:
    """Measure frames: one thread reads, those of the ``pool`` measure."""
    pending = [(index, pool.submit(measurer.measure, image)) for index, image in source.frames(first, stop)]
    frames = [index for index, _ in pending]
    return FrameBlock.of(frames, [future.result() for _, future in pending], source.shape[1])


def origin(experiment: Experiment, source: PreparedSource) -> str:
    """What measured frames depend on: the experiment file and the recording."""
    return f"{experiment.to_toml()}\n# {source.n_frames} frames of {source.shape[1]} x {source.shape[0]} px\n"


def measure_frames(
    source: PreparedSource,
    measurer: FrameMeasurer,
    store: BlockStore,
    threads: int | None = None,
    progress: Callable[[MeasuringProgress], None] = lambda state: None,
) -> bool:
    """Measure what is not in the ``store`` yet; False if an interrupt came before the last block."""
    begin, measured = time.perf_counter(), 0
    with ThreadPoolExecutor(threads or processor().usable) as pool, interruptible() as wished:
        for number, (first, stop) in enumerate(block_bounds(source)):
            if number in store:
                continue
            store.put(number, measure_block(source, first, stop, measurer, pool))
            measured += stop - first
            progress(MeasuringProgress(stop, source.n_frames, measured / (time.perf_counter() - begin)))
            if wished() and stop < source.n_frames:
                return False
    return True
