"""An animation of the playback, for the README; imported inside FreeCAD."""

from pathlib import Path

import FreeCADGui as Gui
from PIL import Image

from support import hands, pictures

SIZE = (640, 400)  # pixels
FRAMES = 48
STEP = 90  # ms a frame
STILL = 1200  # ms of the last one
COLOURS = 160


def play(dock, name):
    """Takes a GIF of a recorded run, from its begin to its end, to the pictures; returns its bytes."""
    shots = []
    duration = dock.scene.duration
    for k in range(FRAMES):
        dock.go(duration * k / (FRAMES - 1))
        hands.settle()
        Gui.ActiveDocument.ActiveView.saveImage("frame.png", 2 * SIZE[0], 2 * SIZE[1], "White")
        shots.append(Image.open("frame.png").convert("RGB").resize(SIZE, Image.LANCZOS))
    # One palette for all, of the begin, the middle and the end: colours do not flicker.
    sheet = Image.new("RGB", (SIZE[0], 3 * SIZE[1]))
    for k, shot in enumerate((shots[0], shots[len(shots) // 2], shots[-1])):
        sheet.paste(shot, (0, k * SIZE[1]))
    palette = sheet.quantize(COLOURS, dither=Image.NONE)
    frames = [shot.quantize(palette=palette, dither=Image.NONE) for shot in shots]
    pictures.MADE.mkdir(parents=True, exist_ok=True)
    path = Path(pictures.MADE, f"{name}.gif")
    times = [STEP] * (FRAMES - 1) + [STILL]
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=times, loop=0, optimize=True
    )
    return path.read_bytes()
