"""Multi-page TIFF stacks, read page by page (tifffile).

A stack written in one piece (ImageJ, tifffile) holds its frames one after the other: these are read straight
from the file. Of a stack cut short, every frame that is whole is read and the missing ones are named.
"""

from __future__ import annotations

import logging
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameError, FrameSource, Image
from wrinklewave.imaging.sources.grey import COLOUR_NOTE, luma

if TYPE_CHECKING:
    from tifffile import TiffFile, TiffPage

CUT_SHORT = "the file ends before it"
SEPARATE_PLANES = 2


class Contiguous(NamedTuple):
    """Frames that lie one after the other from ``offset``, of ``dtype`` (with its byte order)."""

    offset: int
    dtype: np.dtype


class TiffSource(FrameSource):
    """A TIFF stack of 8 or 16 bit grey (or colour) pages of one size.

    Raises:
        InputError: if the file is no TIFF, or its pages are of no supported kind.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self._tiff = _open(path)
        self._bytes = path.stat().st_size
        with _quiet():
            page = _first_page(self._tiff, path)
            metadata = _metadata(self._tiff)
            pages = len(self._tiff.pages)
        self.shape = (page.imagelength, page.imagewidth)
        self._colour = page.samplesperpixel > 1
        self._separate_planes = page.planarconfig == SEPARATE_PLANES
        self.bit_depth = _bit_depth(page, path)
        self.white_level = (1 << self.bit_depth) - 1
        self.notes = (COLOUR_NOTE,) if self._colour else ()
        self.description = f"TIFF stack, {_compression(page)}"
        declared = _declared_frames(metadata, page)
        self._contiguous = _contiguous(self._tiff, page, declared)
        if self._contiguous:
            self._expect(declared, self._whole_frames())
        else:
            self._expect(max(declared, pages + _has_lost_pages(self._tiff, pages, self._bytes)), pages)
            self._check_last_page(pages)
        self._set_clock(metadata)

    def _read(self, index: int) -> Image:
        if self._contiguous:
            return self._read_contiguous(index, self._contiguous)
        with _quiet():
            try:
                page = self._tiff.pages[index]
                _check_within(page, self._bytes, index)
                image = page.asarray()
                if self._colour and self._separate_planes:
                    image = np.moveaxis(image, 0, -1)
            except FrameError:
                raise
            except Exception as error:  # the decoders of damaged data raise whatever they stumble over
                raise FrameError(index, _reason(error), source=self.path) from error
        return self._as_grey(image, index)

    def close(self) -> None:
        self._tiff.close()

    def _read_contiguous(self, index: int, data: Contiguous) -> Image:
        height, width = self.shape
        image = np.empty((height, width), dtype=data.dtype)
        handle = self._tiff.filehandle
        handle.seek(data.offset + index * image.nbytes)
        if handle.readinto(image.reshape(-1).view(np.uint8)) != image.nbytes:  # type: ignore[arg-type]
            raise FrameError(index, CUT_SHORT, source=self.path)
        return image.astype(self.dtype, copy=False)

    def _as_grey(self, image: Any, index: int) -> Image:
        grey = luma(image) if self._colour else image
        if grey.shape != self.shape or grey.dtype != self.dtype:
            reason = f"it is {grey.shape[::-1]} {grey.dtype}, the first one {self.shape[::-1]} {self.dtype}"
            raise FrameError(index, reason, source=self.path)
        return grey

    def _whole_frames(self) -> int:
        assert self._contiguous is not None
        size = self.shape[0] * self.shape[1] * self._contiguous.dtype.itemsize
        return max(0, (self._bytes - self._contiguous.offset) // size)

    def _expect(self, declared: int, present: int) -> None:
        self.n_frames = declared
        self._unreadable.update(dict.fromkeys(range(min(present, declared), declared), CUT_SHORT))

    def _check_last_page(self, pages: int) -> None:
        """In a file that was cut short, the last page may lack its data: find that out at once."""
        try:
            with _quiet():
                _check_within(self._tiff.pages[pages - 1], self._bytes, pages - 1)
        except FrameError as error:
            self._unreadable[error.index] = error.reason
        except Exception as error:  # a page directory cut in two
            self._unreadable[pages - 1] = f"{CUT_SHORT} ({error})"

    def _set_clock(self, metadata: dict[str, Any]) -> None:
        interval = float(metadata.get("finterval") or 0)
        rate = float(metadata.get("frame_rate") or (1 / interval if interval > 0 else 0))
        if rate > 0:
            self.frame_rate, self.clock = rate, "camera"
            self.times = np.arange(self.n_frames) / rate


def read_tiff_image(path: Path) -> Image:
    """The first page of a TIFF file as grey values [height, width].

    Raises:
        InputError: if it cannot be read.
    """
    with TiffSource(path) as source:
        return source.frame(0)


@contextmanager
def _quiet() -> Iterator[None]:
    """Damage is reported by frame, so tifffile's own log lines would only say it twice."""
    logger = logging.getLogger("tifffile")
    before, logger.disabled = logger.disabled, True
    try:
        yield
    finally:
        logger.disabled = before


def _open(path: Path) -> TiffFile:
    from tifffile import TiffFile

    try:
        with _quiet():
            return TiffFile(path)
    except Exception as error:  # tifffile raises many kinds on damaged headers
        raise _unreadable_file(path, error) from error


def _first_page(tiff: TiffFile, path: Path) -> TiffPage:
    try:
        page = tiff.pages.first
    except Exception as error:
        raise _unreadable_file(path, error) from error
    if page.dtype is None or page.dtype.kind != "u" or page.dtype.itemsize > 2 or page.samplesperpixel == 2:
        raise InputError(
            f"pages of {page.samplesperpixel} x {page.bitspersample} bits ({page.dtype})",
            file=path,
            expected="8 or 16 bit unsigned grey values (or colour)",
            cure="export the recording as 8 or 16 bit TIFF",
        )
    return page


def _unreadable_file(path: Path, error: Exception) -> InputError:
    return InputError(
        f"begins like a TIFF file but cannot be read ({error})",
        file=path,
        expected="a TIFF stack",
        cure="copy or export it again; not even the first frame is left",
    )


def _reason(error: Exception) -> str:
    reason = str(error) or type(error).__name__
    return (
        f"{reason}: pip install imagecodecs, or save it uncompressed" if "imagecodecs" in reason else reason
    )


def _metadata(tiff: TiffFile) -> dict[str, Any]:
    """What the writing program noted in the first page: ImageJ's or tifffile's own key-value pairs."""
    if tiff.imagej_metadata:
        return dict(tiff.imagej_metadata)
    shaped = tiff.shaped_metadata
    return dict(shaped[0]) if shaped else {}


def _compression(page: TiffPage) -> str:
    from tifffile import COMPRESSION

    return (
        "uncompressed" if page.compression == COMPRESSION.NONE else COMPRESSION(page.compression).name.lower()
    )


def _bit_depth(page: TiffPage, path: Path) -> int:
    """Significant bits: those stored, or fewer if the tag MaxSampleValue is 2**n - 1."""
    stored = int(page.bitspersample)
    tag = page.tags.get("MaxSampleValue")
    values = np.atleast_1d(tag.value) if tag is not None else np.array([0])
    largest = int(values.max())
    noted = largest.bit_length() if largest & (largest + 1) == 0 else 0
    return noted if 2 < noted < stored else stored


def _declared_frames(metadata: dict[str, Any], page: TiffPage) -> int:
    """Number of frames that the writing program noted, or 0."""
    if "images" in metadata:
        return int(metadata["images"])
    samples = int(np.prod(metadata.get("shape") or (0,)))
    return samples // (page.imagelength * page.imagewidth * page.samplesperpixel)


def _contiguous(tiff: TiffFile, page: TiffPage, declared: int) -> Contiguous | None:
    """Where the frames lie if the stack was written in one piece, told by where the second page begins."""
    if declared < 2 or not page.is_contiguous or page.samplesperpixel > 1 or page.dtype is None:
        return None
    offset, size = page.dataoffsets[0], page.imagelength * page.imagewidth * page.dtype.itemsize
    following = _next_directory(tiff, page.offset)
    if following and following < offset + declared * size:
        return None
    return Contiguous(offset, page.dtype.newbyteorder(tiff.byteorder))


def _has_lost_pages(tiff: TiffFile, pages: int, size: int) -> bool:
    """Whether the last page found points to one beyond the end of the file."""
    try:
        return _next_directory(tiff, tiff.pages[pages - 1].offset) >= size
    except Exception:  # the last directory itself is cut
        return False


def _next_directory(tiff: TiffFile, directory: int) -> int:
    """Offset of the page directory after the one at ``directory`` (0: there is none; TIFF 6.0, section 2)."""
    form, handle = tiff.tiff, tiff.filehandle
    handle.seek(directory)
    (tags,) = struct.unpack(form.tagnoformat, handle.read(form.tagnosize))
    handle.seek(directory + form.tagnosize + tags * form.tagsize)
    (following,) = struct.unpack(form.offsetformat, handle.read(form.offsetsize))
    return int(following)


def _check_within(page: Any, size: int, index: int) -> None:
    if any(start + count > size for start, count in zip(page.dataoffsets, page.databytecounts, strict=True)):
        raise FrameError(index, CUT_SHORT)
