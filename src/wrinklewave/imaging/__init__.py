"""Imaging: from high-speed video to surface motion, and back with a synthetic camera."""
