"""A synthetic camera: films any surface motion, with the truth of every frame.

``film(surface, camera)`` gives a frame source like any recording, rendered frame by frame; its ``truth()``
holds the edge, the struck end, the striker and the wires in pixels. The measuring side is tested against it.
"""

from wrinklewave.imaging.camera.camera import Camera, Levels
from wrinklewave.imaging.camera.film import Film, film
from wrinklewave.imaging.camera.scene import Striker, Wires

__all__ = ["Camera", "Film", "Levels", "Striker", "Wires", "film"]
