"""The pictures of the study."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

mpl.use("Agg")
import matplotlib.pyplot as plt

from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.fronts import arrival_times
from wrinklewave.analysis.wrinkles import wavelength_spectra
from wrinklewave.experiments.wrinkle_study import ONSET_GROWTH, Member, agreement, amplitudes

Array = NDArray[np.float64]
POSITIONS = (15e-3, 25e-3, 35e-3)
TIMES = (0.8e-3, 1.4e-3, 2.8e-3)
STYLES = {"resolved": "-", "rate-dependent": "--", "quasi-static": ":"}
COLOURS = ("#c1272d", "#0000a7", "#008176")
SHOWN = (
    "sinusoidal, 10 um",
    "sinusoidal, 30 um",
    "random, 30 um",
    "30 um at 2.5 m/s",
    "30 um at 20 m/s",
    "elastic, 2 m/s, 30 um",
)
OBSERVED_FRONT, OBSERVED_WRINKLES = 44.0, 32.0
"""Speeds of the wave without film and of the wrinkles that the paper reports [m/s]."""


def draw_all(out: Path, members: Mapping[str, Member]) -> None:
    """Every picture for which there are members."""
    shown = [members[name] for name in SHOWN if name in members]
    if len(shown) == len(SHOWN):
        draw_panels(shown, against_time, "time (ms)").savefig(out / "amplitude_against_time.png", dpi=130)
        draw_panels(shown, against_position, "undeformed position X (mm)").savefig(
            out / "amplitude_against_position.png", dpi=130
        )
        draw_panels(
            shown, onsets, "undeformed position X (mm)", "time at which the amplitude has doubled (ms)", True
        ).savefig(out / "onset_against_position.png", dpi=130)
    if {"sinusoidal, 10 um", "sinusoidal, 30 um"} <= set(members):
        draw_paper(members).savefig(out / "paper.png", dpi=160)
    if {"sinusoidal, 30 um", "random, 30 um", "random, 60 um"} <= set(members):
        draw_spectra(members).savefig(out / "spectra.png", dpi=130)
    draw_agreement(list(members.values())).savefig(out / "agreement.png", dpi=130)


def label(name: str) -> str:
    return name.replace("um", "µm")


def draw_panels(
    members: list[Member], draw: Any, x: str, y: str = "wrinkle amplitude (mm)", own_scale: bool = False
) -> plt.Figure:
    """One panel per member, drawn by ``draw(panel, member)``."""
    figure, axes = plt.subplots(2, 3, figsize=(11, 7), sharey=not own_scale, layout="constrained")
    for panel, member in zip(axes.flat, members, strict=True):
        draw(panel, member)
        panel.set_title(label(member.name), fontsize=10)
        panel.spines[["top", "right"]].set_visible(False)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    figure.supxlabel(x)
    figure.supylabel(y)
    return figure


def against_time(panel: plt.Axes, member: Member) -> None:
    """Amplitude against time at three material points."""
    for model, style in STYLES.items():
        time = member.surfaces[model]["time"].values
        for X, colour, curve in zip(
            POSITIONS, COLOURS, amplitudes(member, model, np.array(POSITIONS)).T, strict=True
        ):
            panel.plot(
                time * 1e3, curve * 1e3, style, color=colour, lw=1.2, label=f"X = {X * 1e3:g} mm, {model}"
            )


def against_position(panel: plt.Axes, member: Member) -> None:
    """Amplitude against material position at three times."""
    X = np.linspace(4e-3, 46e-3, 300)
    for model, style in STYLES.items():
        known, curves = member.surfaces[model]["time"].values, amplitudes(member, model, X)
        for time, colour in zip(TIMES, COLOURS, strict=True):
            curve = curves[int(np.argmin(np.abs(known - time)))]
            panel.plot(
                X * 1e3, curve * 1e3, style, color=colour, lw=1.2, label=f"t = {time * 1e3:g} ms, {model}"
            )


def onsets(panel: plt.Axes, member: Member) -> None:
    """When wrinkles have set in, and when Eq. 1 has them reach the same amplitude."""
    X = np.linspace(6e-3, 44e-3, 300)
    time = member.surfaces["resolved"]["time"].values
    wanted = ONSET_GROWTH * amplitudes(member, "resolved", X)[0]
    for (model, style), colour in zip(STYLES.items(), COLOURS, strict=True):
        arrivals = arrival_times(time, amplitudes(member, model, X), wanted)
        panel.plot(X * 1e3, arrivals * 1e3, style, color=colour, lw=1.4, label=model)
    panel.set_ylim(bottom=0)


def draw_paper(members: Mapping[str, Member]) -> plt.Figure:
    """Amplitude and onset: observed, resolved, rate-dependent and quasi-static, in the paper's impact."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
    pair = [members["sinusoidal, 10 um"], members["sinusoidal, 30 um"]]
    analyses = {
        (m.name, model): analyse(m.surfaces[model], m.case.analysis) for m in pair for model in STYLES
    }
    time = pair[0].surfaces["resolved"]["time"].values * 1e3
    highest = 0.0
    for member, colour in zip(pair, COLOURS, strict=False):
        for model, style in STYLES.items():
            result, seed = analyses[member.name, model], member.name.split(", ")[1].replace("um", "µm")
            quasi_static = model == "quasi-static"
            if quasi_static and member is not pair[0]:
                continue
            pen = {"color": "black" if quasi_static else colour, "ls": style, "lw": 1.4}
            name = "quasi-static (Eq. 1)" if quasi_static else f"{model}, imperfection {seed}"
            left.plot(time, result.wrinkles.amplitude * 1e3, label=name, **pen)
            highest = (
                max(highest, float(np.nanmax(result.wrinkles.amplitude)) * 1e3) if quasi_static else highest
            )
            front = result.wrinkles.front
            right.plot(front.positions * 1e3, front.times * 1e3, **pen)
    left.axhspan(0, 0.5 * highest, color="0.9", zorder=0, label="observed: over 50 % below Eq. 1")
    left.set(
        xlabel="time (ms)", ylabel="mean wrinkle amplitude, x = 16 to 49 mm (mm)", ylim=(0, None), xlim=(0, 5)
    )
    wave = analyses[pair[0].name, "resolved"].pulse.wavefront
    right.plot(wave.positions * 1e3, wave.times * 1e3, color="0.5", lw=1.4, label="wavefront, resolved")
    x, contact = np.array([0.0, 45.0]), float(analyses[pair[0].name, "resolved"].boundary.contact_time) * 1e3
    for speed, style, name in ((OBSERVED_FRONT, "-", "wave"), (OBSERVED_WRINKLES, "--", "wrinkles")):
        right.plot(
            x,
            contact + x / speed,
            style,
            color="#eecc16",
            lw=2.5,
            zorder=0,
            label=f"observed {name}, {speed:g} m/s",
        )
    right.set(xlabel="x (mm)", ylabel="time of arrival (ms)", xlim=(0, 45), ylim=(0, 3))
    for panel in (left, right):
        panel.spines[["top", "right"]].set_visible(False)
        panel.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2)
    return figure


def draw_spectra(members: Mapping[str, Member]) -> plt.Figure:
    """Spectra of the wrinkles at 2.8 ms, as a camera sees them."""
    names = ("sinusoidal, 30 um", "random, 30 um", "random, 60 um")
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    for panel, name in zip(axes, names, strict=True):
        member = members[name]
        for (model, style), colour in zip(list(STYLES.items())[:2], COLOURS, strict=False):
            data, settings = member.surfaces[model], member.case.analysis
            row = int(np.argmin(np.abs(data["time"].values - TIMES[-1])))
            height = analyse(data, settings).wrinkles.height[[row]]
            window = settings.amplitude_window
            spectra = wavelength_spectra(
                height, data["x"].values, window=window, longest=settings.filter_wavelength
            )
            panel.plot(spectra.wavelength * 1e3, spectra.magnitude[0] * 1e3, style, color=colour, label=model)
        panel.set(title=label(name), xlabel="wavelength in the laboratory (mm)", xlim=(0.8, 4))
        panel.spines[["top", "right"]].set_visible(False)
    axes[0].set_ylabel("amplitude of a sinusoid (mm)")
    axes[0].legend(fontsize=8, frameon=False)
    return figure


def draw_agreement(members: list[Member]) -> plt.Figure:
    """The rate-dependent model over the resolved film: amplitudes and onset of every member."""
    figure, axes = plt.subplots(
        1, 2, figsize=(10, 0.36 * len(members) + 1.6), sharey=True, layout="constrained"
    )
    for row, member in enumerate(members):
        fit = agreement(member, "rate-dependent")
        axes[0].plot([fit.low, fit.high], [row, row], color="0.6", lw=4, solid_capstyle="butt")
        axes[0].plot(fit.median, row, "o", color="#c1272d")
        axes[0].plot(fit.mean, row, "|", color="black", ms=10)
        axes[1].plot(fit.onset, row, "o", color="#0000a7")
    axes[0].set(
        xlabel="amplitude over resolved\nmedian, 5 to 95 % of points and times, | of the mean",
        xlim=(0.58, 1.45),
    )
    axes[1].set(xlabel="onset time over resolved\nmedian of the points", xlim=(0.87, 1.13))
    axes[0].set_yticks(range(len(members)), [label(member.name) for member in members])
    axes[0].invert_yaxis()
    for panel in axes:
        panel.axvspan(0.9, 1.1, color="0.93", zorder=0)
        panel.axvline(1.0, color="black", lw=0.6)
        panel.spines[["top", "right"]].set_visible(False)
    return figure
