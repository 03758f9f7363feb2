"""Resolved film, rate-dependent model and Eq. 1, slowly and in the paper's impact. One command makes everything:

    python examples/wrinkle_study/study.py --out runs/wrinkle_study

Eighteen resolved runs of 3 to 7 s on a free core and two slow compressions of 9 and 16 s; finished runs in the
folder are used again. Beside the figures it writes study.csv (all numbers) and table.md.
"""

from __future__ import annotations

import argparse
import csv
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import figures
import slow

from wrinklewave.config import Case, load_case
from wrinklewave.experiments.wrinkle_study import Member, member_rows, run_member, surface_of_run

HERE = Path(__file__).parent
BASE = HERE.parent / "paper_resolved.toml"
ALONE = ("wrinkles.model=none", "mesh.elements=[202, 74]", "mesh.grading=[1, 1]")
TIMES = 'analysis.times=["0.4 ms", "1.2 ms", "2 ms"]'
RANDOM = "film.imperfection={{kind='random', amplitude='{imperfection}', wavelengths=['1 mm', '4 mm'], seed={seed}}}"
COLUMNS = (  # of the documentation's table: whose, heading, key, factor and format
    ("resolved", "wrinkle over wave speed, free line", "wrinkle_to_wavefront_speed_ratio", 1, ".2f"),
    ("resolved", "through the origin", "origin_line_speed_ratio", 1, ".2f"),
    ("resolved", "largest mean amplitude over quasi-static", "amplitude_over_quasi_static", 1, ".2f"),
    ("resolved", "strain at onset", "strain_at_onset", 1, ".3f"),
    ("resolved", "delay (ms)", "onset_delay_s", 1e3, ".2f"),
    ("resolved", "crests' shift (µm)", "crest_shift_rms_m", 1e6, ".0f"),
    ("resolved", "wavelength (mm)", "wavelength_m", 1e3, ".2f"),
    ("rate-dependent", "model over resolved: amplitude", "over_resolved_median", 1, ".3f"),
    ("rate-dependent", "5 %", "over_resolved_5_percent", 1, ".2f"),
    ("rate-dependent", "95 %", "over_resolved_95_percent", 1, ".2f"),
    ("rate-dependent", "mean amplitude", "mean_over_resolved", 1, ".3f"),
    ("rate-dependent", "onset time", "onset_over_resolved", 1, ".3f"),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("runs/wrinkle_study"))
    parser.add_argument(
        "--set", dest="overrides", action="append", default=[], help="key=value for every run"
    )
    parser.add_argument("--only", default="", help="part of the names of the members wanted")
    arguments = parser.parse_args()
    out: Path = arguments.out
    out.mkdir(parents=True, exist_ok=True)
    if not arguments.only:
        slow.study(out)
    members = []
    for member in impacts(out, arguments.overrides, arguments.only):
        rows = member_rows(member)
        members.append((member, rows))
        print(f"{member.name}: " + summary_line(rows), flush=True)
    write_csv(out / "study.csv", [row for _, rows in members for row in rows])
    (out / "table.md").write_text(table(members), encoding="utf-8")
    figures.draw_all(out, {member.name: member for member, _ in members})


def impacts(out: Path, overrides: list[str], only: str) -> Iterator[Member]:
    """Every member, from new or finished runs."""
    for group in tomllib.loads((HERE / "members.toml").read_text(encoding="utf-8"))["group"]:
        wanted = [member for member in group["members"] if only in member["name"]]
        if not wanted:
            continue
        shared = [TIMES, *group.get("set", []), *overrides]
        substrate = surface_of_run(
            load_case(BASE, [*shared, *ALONE]), out / folder(f"substrate {group['name']}")
        )
        for member in wanted:
            case = case_of(member, shared)
            yield run_member(member["name"], case, substrate, out=out / folder(member["name"]))


def case_of(member: Mapping[str, Any], shared: list[str]) -> Case:
    """The resolved case of a member."""
    amplitude = f"film.imperfection.amplitude={member['imperfection']}"
    imperfection = RANDOM.format(**member) if "seed" in member else amplitude
    return load_case(
        BASE, [imperfection, *shared, *member.get("set", []), f"solver.end_time={member['end']}"]
    )


def folder(name: str) -> str:
    """Name of a folder for a run."""
    return re.sub(r"[^a-z0-9.]+", "_", name.lower()).strip("_")


def summary_line(rows: list[dict[str, str | float]]) -> str:
    """The rate-dependent model against the resolved film, on one line."""
    row = next(row for row in rows if row["model"] == "rate-dependent")
    return (
        f"amplitude {row['over_resolved_median']:.3f} ({row['over_resolved_5_percent']:.2f} to "
        f"{row['over_resolved_95_percent']:.2f}) of the resolved one, onset {row['onset_over_resolved']:.3f}"
    )


def write_csv(path: Path, rows: list[dict[str, str | float]]) -> None:
    """All numbers; what a model does not have stays empty."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, names, restval="")
        writer.writeheader()
        writer.writerows(rows)


def table(members: list[tuple[Member, list[dict[str, str | float]]]]) -> str:
    """The numbers of the documentation's table, as Markdown."""
    lines = ["| member | " + " | ".join(heading for _, heading, *_ in COLUMNS) + " |"]
    lines.append("| --- |" + " --- |" * len(COLUMNS))
    for member, rows in members:
        of = {str(row["model"]): row for row in rows}
        cells = [cell(of[model], key, factor, how) for model, _, key, factor, how in COLUMNS]
        lines.append(f"| {figures.label(member.name)} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def cell(row: Mapping[str, str | float], key: str, factor: float, how: str) -> str:
    """A number with its standard uncertainty where there is one, or a dash for a number that there is not."""
    value, sigma = (row.get(name, math.nan) for name in (key, f"{key}_sigma"))
    known = [format(factor * v, how) for v in (value, sigma) if isinstance(v, float) and math.isfinite(v)]
    return " ± ".join(known) or "-"


if __name__ == "__main__":
    main()
