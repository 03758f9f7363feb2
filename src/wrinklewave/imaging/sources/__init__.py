"""Readers of recordings, one file format per module; ``wrinklewave.imaging.frames.open_recording`` chooses."""
