"""
2. What the bulk modulus does
=============================

The paper gives the shear modulus in time, but not the bulk modulus. Its three readings differ ahead of the front: with
K at its long-term value the surface stays flat there, as the images of the experiment show; with K at its instantaneous
value at short times the whole surface lifts at once.
"""

# %%
# Three runs
# ----------

import matplotlib.pyplot as plt

import wrinklewave as ww

choices = ("elastic-long-term", "elastic-instantaneous", "relaxing")
runs = {
    choice: ww.simulate("../../examples/quick.toml", overrides=[f"substrate.bulk_response={choice}"])
    for choice in choices
}

# %%
# The surface after half a millisecond
# ------------------------------------

figure, axes = plt.subplots(figsize=(6, 3.5))
for choice, run in runs.items():
    profile = run.surface["u_y_smooth"].sel(time=0.5e-3, method="nearest")
    axes.plot(1e3 * profile["x"], 1e3 * profile, label=choice)
axes.set(xlabel="position [mm]", ylabel="displacement [mm]")
axes.legend()

# %%
# In numbers
# ----------
# The displacement 10 mm ahead of the wavefront, over the largest one.

ahead = {
    choice: run.summary["displacement_10_mm_ahead_of_wavefront_m"] / run.summary["displacement_max_m"]
    for choice, run in runs.items()
}
for choice, share in ahead.items():
    print(f"{choice:25s} {share:6.1%}")
