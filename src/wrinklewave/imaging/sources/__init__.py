"""Readers of recordings, one file format per module; ``imaging.frames.open_recording`` chooses."""
