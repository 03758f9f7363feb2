"""
1. An impact in a few lines
===========================

From a case file to a surface motion and its numbers: the paper's block, coarse and for a millisecond.
"""

# %%
# The case
# --------
# A case file describes block, material, film and striker. Anything in it can be replaced.

import matplotlib.pyplot as plt

import wrinklewave as ww

run = ww.simulate("../../examples/quick.toml", overrides=["drive.rise_time=0.2 ms"])

# %%
# The surface motion
# ------------------
# An ``xarray.Dataset`` with the height of the surface on a grid fixed in the laboratory, as a camera sees it.

run.surface

# %%
# Its analysis
# ------------
# Scalars have their unit in their name.

speed = run.summary["wavefront_speed_m_per_s"]
print(f"wavefront: {speed:.1f} m/s, wrinkles: {run.summary['wrinkle_speed_m_per_s']:.1f} m/s")

# %%
# A picture
# ---------
# Displacement against position and time, and the line that the speed is the slope of.

front = run.analysis.pulse.wavefront
figure, axes = plt.subplots(figsize=(6, 4))
(1e3 * run.surface["u_y"]).plot(ax=axes, cbar_kwargs={"label": "displacement [mm]"})
axes.plot(front.positions, front.intercept + front.positions / front.speed, "w--")
axes.set(xlabel="position [m]", ylabel="time [s]")

# %%
# How far can it be trusted? The energy balance and the share of hourglass control say so.

imbalance = run.summary["energy_imbalance_max"]
print(
    f"energy balance off by {imbalance:.1e}, hourglass share {run.summary['hourglass_energy_share_max']:.1e}"
)
