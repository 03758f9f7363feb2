"""Settings for every test."""

from hypothesis import settings

# kernels are compiled at their first call, which takes longer than any deadline
settings.register_profile("wrinklewave", deadline=None)
settings.load_profile("wrinklewave")
