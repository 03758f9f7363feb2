"""``python -m wrinklewave``."""

from wrinklewave.cli import main

main()
