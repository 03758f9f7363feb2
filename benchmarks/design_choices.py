"""Tables behind ``docs/decisions.md``: what the choices that the paper leaves open do to its numbers.

    python benchmarks/design_choices.py [FOLDER]

writes ``bulk_modulus.md`` and ``hourglass_control.md`` into FOLDER, by default ``docs/tables``. Takes a few minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

import wrinklewave as ww
from wrinklewave.experiments.paper_statements import BULK_CHOICES

ROOT = Path(__file__).parents[1]
PAPER = ROOT / "examples" / "paper_impact.toml"
SMOOTHINGS_MS = (0.03, 0.1, 0.2, 0.3)
CONTROLS = (0.0, 0.1, 1.0)
RISE_TIMES_MS = (0.05, 0.5)
END_MOTION = """[drive]
kind = "end-motion"
velocity = "10 m/s"
stop_distance = "6.3 mm"
overshoot = "9 mm"
overshoot_time = "1 ms"
smoothing = "{smoothing} ms"

"""


def main() -> None:
    """Write both tables."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "tables"
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in (("bulk_modulus", bulk_modulus()), ("hourglass_control", hourglass_control())):
        (folder / f"{name}.md").write_text("\n".join(rows) + "\n", encoding="utf-8")


def bulk_modulus() -> Iterator[str]:
    """Speeds and strain rates under each bulk response, for ends that move off the more or the less gently."""
    yield from _head("`bulk_response`", *(f"smoothing {s} ms" for s in SMOOTHINGS_MS))
    for bulk in BULK_CHOICES:
        cells = []
        for smoothing in SMOOTHINGS_MS:
            found = ww.simulate(_moved_end(smoothing), overrides=[f"substrate.bulk_response={bulk}"]).summary
            names = ("wavefront_speed", "wavefront_speed_origin_line")
            speeds = ", ".join(f"{found[f'{name}_m_per_s']:.0f}" for name in names)
            cells.append(f"{speeds} m/s; {found['strain_rate_max_per_s']:.0f} /s")
        yield _row(f"`{bulk}`", *cells)


def hourglass_control() -> Iterator[str]:
    """Hourglass amplitude and energy, and what becomes of the displacement, against the fully integrated element."""
    titles = ("largest hourglass amplitude", "energy share", "$u_y$ at 25 mm differs by")
    yield from _head("rise time", "element", "control", *titles)
    for rise in RISE_TIMES_MS:
        settings = [f"drive.rise_time={rise} ms"]
        reference = ww.simulate(PAPER, overrides=[*settings, "mesh.element=mean-dilatation"])
        yield _hourglass_row(f"{rise} ms", "mean-dilatation", "", reference, reference)
        for factor in CONTROLS:
            run = ww.simulate(PAPER, overrides=[*settings, f"mesh.hourglass.stiffness={factor}"])
            yield _hourglass_row(f"{rise} ms", "one-point", f"{factor:g}", run, reference)


def _moved_end(smoothing: float) -> ww.Case:
    """The paper's case with the parametric motion of the end in place of the striker."""
    text = PAPER.read_text(encoding="utf-8")
    before, _, after = text.partition("[drive]")
    rest = after[after.index("\n[") :]
    return ww.case_from_text(before + END_MOTION.format(smoothing=smoothing) + rest, source=PAPER)


def _hourglass_row(rise: str, element: str, control: str, run: ww.Run, reference: ww.Run) -> str:
    heights = [r.surface["y_smooth"].sel(x=25e-3, method="nearest").values for r in (run, reference)]  # type: ignore[index]
    differs = np.abs(heights[0] - heights[1]).max() / np.ptp(heights[1])
    amplitude, share = (
        run.summary[name] for name in ("hourglass_amplitude_max", "hourglass_energy_share_max")
    )
    return _row(
        rise, element, control, f"{amplitude:.2f}", f"{share:.2%}" if control else "", f"{differs:.2%}"
    )


def _head(*titles: str) -> Sequence[str]:
    return _row(*titles), _row(*("---" for _ in titles))


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
