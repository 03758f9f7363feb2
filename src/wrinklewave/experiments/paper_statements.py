"""What "Wrinkles Riding Waves in Soft Layered Materials" says about its simulation, as checks on a summary.

Each statement names the key of ``summary.json`` that answers it, the rule that decides, and why a simulation
may fail to reproduce it. Theory's closed forms bring the numbers of the paper along themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

Summary = Mapping[str, float | None]

LONG_TERM, INSTANTANEOUS, RELAXING = "elastic-long-term", "elastic-instantaneous", "relaxing"
BULK_CHOICES = (LONG_TERM, INSTANTANEOUS, RELAXING)


@dataclass(frozen=True)
class Rule:
    """When a number reproduces a statement.

    Attributes:
        target: the paper's number, SI.
        tolerance: relative deviation that is allowed.
        side: "near" (within the tolerance on both sides), "at least" or "at most".
    """

    target: float
    tolerance: float = 0.0
    side: str = "near"

    def holds(self, value: float) -> bool:
        """Whether ``value`` (SI) reproduces the statement."""
        slack = self.tolerance * abs(self.target)
        above, below = value >= self.target - slack, value <= self.target + slack
        return {"near": above and below, "at least": above, "at most": below}[self.side]


@dataclass(frozen=True)
class Statement:
    """One thing that the paper says.

    Attributes:
        quantity: what it is about.
        paper: what the paper says, with its unit.
        about: "simulation", or "experiment" where the paper gives no number for its simulation.
        value: our number [SI] from a summary; None if there is none.
        rule: decides.
        unit, scale: for printing; shown = scale * SI value.
        reasons: why a bulk choice does not reproduce it; under "" for every other choice.
    """

    quantity: str
    paper: str
    about: str
    value: Callable[[Summary], float | None]
    rule: Rule
    unit: str = ""
    scale: float = 1.0
    reasons: Mapping[str, str] = field(default_factory=dict)

    def reason(self, bulk: str) -> str:
        """Likely reason why a run with this bulk response does not reproduce the statement."""
        return self.reasons.get(bulk, self.reasons.get("", ""))


def _key(name: str) -> Callable[[Summary], float | None]:
    return lambda summary: summary.get(name)


def _quotient(above: str, below: str) -> Callable[[Summary], float | None]:
    def value(summary: Summary) -> float | None:
        numerator, denominator = summary.get(above), summary.get(below)
        return None if numerator is None or not denominator else numerator / denominator

    return value


FASTER = "a bulk modulus that is K_i at short times makes the surface rise sooner and the free line steeper"
GENTLER = "comes out only for an end whose motion is smoothed by about 0.2 ms"

STATEMENTS = (
    Statement(
        "wavefront speed c_S, free line",
        "57 m/s",
        "simulation",
        _key("wavefront_speed_m_per_s"),
        Rule(57.0, 0.15),
        "m/s",
        reasons={
            "": "depends on the fit window and on the motion of the struck end, which is not published",
            INSTANTANEOUS: FASTER,
            RELAXING: FASTER,
        },
    ),
    Statement(
        "wavefront speed c_S, line through the origin",
        "57 m/s",
        "simulation",
        _key("wavefront_speed_origin_line_m_per_s"),
        Rule(57.0, 0.15),
        "m/s",
        reasons={
            "": "the line through the origin counts the time in which the end gathers speed as travel",
            INSTANTANEOUS: GENTLER,
            RELAXING: GENTLER,
        },
    ),
    Statement(
        "wrinkle speed, free line",
        "57 m/s = c_S",
        "simulation",
        _key("wrinkle_speed_m_per_s"),
        Rule(57.0, 0.15),
        "m/s",
        reasons={
            "": "as for c_S; wrinkles form where the strain passes eps_c, ahead of the rise of the surface",
            INSTANTANEOUS: "as for c_S",
            RELAXING: "as for c_S",
        },
    ),
    Statement(
        "wrinkle speed over wavefront speed",
        "1 (simulated)",
        "simulation",
        _key("wrinkle_to_wavefront_speed_ratio"),
        Rule(1.0, 0.15),
        reasons={
            "": "the strain of Eq. 1 passes eps_c at another speed than the surface passes its threshold"
        },
    ),
    Statement(
        "wrinkle speed over wavefront speed",
        "0.73 = 32/44 (measured)",
        "experiment",
        _key("wrinkle_to_wavefront_speed_ratio"),
        Rule(32.0 / 44.0, 0.10),
        reasons={"": "Eq. 1 is quasi-static: it knows no delay; a rate-dependent or resolved film has one"},
    ),
    Statement(
        "largest depth-averaged strain rate",
        "> 500 /s in small regions near the striker",
        "simulation",
        _key("strain_rate_max_per_s"),
        Rule(500.0, side="at least"),
        "1/s",
        reasons={"": "the end gathers speed too slowly, or the bulk response spreads the strain"},
    ),
    Statement(
        "reach of strain rates above 500 /s from the struck end",
        "small regions",
        "simulation",
        _key("strain_rate_above_500_per_s_reach_m"),
        Rule(10e-3, side="at most"),
        "mm",
        1e3,
        reasons={"": "the front stays steep far into the block"},
    ),
    Statement(
        "share of the map with strain rates above 300 /s",
        "little (its map is cut there)",
        "simulation",
        _key("strain_rate_above_300_per_s_share"),
        Rule(0.05, side="at most"),
        "%",
        1e2,
        reasons={"": "the front stays steep far into the block"},
    ),
    Statement(
        "speed of the fast fronts of little strain",
        "424 m/s = c_L",
        "simulation",
        _key("fast_front_speed_m_per_s"),
        Rule(424.0, 0.15),
        "m/s",
        reasons={
            "": "seen at the first strain rate of 3 /s, which comes late far from an end that starts gently: "
            "421 m/s where it starts within 0.1 ms",
            LONG_TERM: "with K_0 the fastest wave is sqrt((K_0 + 4 mu_i/3)/rho) = 83 m/s",
        },
    ),
    Statement(
        "largest strain over critical strain",
        "far below 18 (moderate strains)",
        "simulation",
        _key("strain_max_over_critical_strain"),
        Rule(18.0, side="at most"),
        reasons={"": "the struck end is strained beyond what the paper shows"},
    ),
    Statement(
        "motion of the struck end: frequency beyond which its spectrum stays below a tenth",
        "< 400 Hz",
        "simulation",
        _key("boundary_bandwidth_hz"),
        Rule(400.0, 0.1, side="at most"),
        "Hz",
        reasons={
            "": "the motion of the end is not published; the recoil from the striker has sharper corners here"
        },
    ),
    Statement(
        "strain when the striker is at rest, along the arc",
        "about 0.12",
        "experiment",
        _key("strain_at_rest"),
        Rule(0.12, 0.15),
        reasons={"": "while the wave is on its way the surface is longer than its chord"},
    ),
    Statement(
        "A_0, Eq. 1 at that strain",
        "0.171 mm at 0.12",
        "experiment",
        _key("amplitude_at_rest_m"),
        Rule(1.7141e-4, 0.15),
        "mm",
        1e3,
        reasons={"": "follows from the strain above"},
    ),
    Statement(
        "wavelength over that of Eq. 1 with the arc's strain",
        "about 1",
        "simulation",
        _key("wavelength_over_expected"),
        Rule(1.0, 0.05),
        reasons={"": "Eq. 2 puts lambda_c on undeformed material: lambda_c (1 - eps), 4 to 5 % below Eq. 1"},
    ),
    Statement(
        "wrinkle amplitude over that of Eq. 1 with the arc's strain",
        "< 0.5 of the simulated one",
        "experiment",
        _key("wrinkle_amplitude_over_expected"),
        Rule(0.5, side="at most"),
        reasons={"": "Eq. 1 is quasi-static; a rate-dependent or resolved film stays behind it"},
    ),
    Statement(
        "first wrinkles, distance from the struck end",
        "nearer than the measured 12 mm",
        "simulation",
        _key("wrinkle_onset_distance_m"),
        Rule(12e-3, side="at most"),
        "mm",
        1e3,
        reasons={"": "the struck end is confined longer than in the paper's simulation"},
    ),
    Statement(
        "first wrinkles, time",
        "about 0.40 ms (measured)",
        "experiment",
        _key("wrinkle_onset_time_s"),
        Rule(0.4e-3, 0.25),
        "ms",
        1e3,
        reasons={"": "Eq. 1 wrinkles as soon as the strain passes eps_c; and time counts from contact"},
    ),
    Statement(
        "margin without wrinkles at the struck end, after 3 ms",
        "some millimetres",
        "simulation",
        _key("wrinkle_free_margin_at_end_m"),
        Rule(0.5e-3, side="at least"),
        "mm",
        1e3,
        reasons={"": "depends on how the end is held sideways and on the depth that is averaged over"},
    ),
    Statement(
        "surface 10 mm ahead of the wavefront, over the largest displacement",
        "flat",
        "experiment",
        _quotient("displacement_10_mm_ahead_of_wavefront_m", "displacement_max_m"),
        Rule(0.03, side="at most"),
        reasons={"": "a bulk modulus that is K_i at short times lifts the whole surface at once"},
    ),
    Statement(
        "rise time at 45 mm over that at 15 mm",
        "> 1: the pulse broadens",
        "simulation",
        _quotient("rise_time_at_45_mm_s", "rise_time_at_15_mm_s"),
        Rule(1.0, side="at least"),
        reasons={"": "at 45 mm the held end limits the rise"},
    ),
)
