"""Takes the picture of docs/contact.md anew: a footprint, and CalculiX's beside it; some minutes.

source tools/setup.sh && "$python" tools/contact_picture.py
"""

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from beltgrinding.contact import single_contact as contact, finite_elements as reference

OUT = Path(__file__).resolve().parents[1] / "docs" / "images" / "contact-reference.png"
COLOURS = np.array(
    [(255, 255, 255), (254, 217, 118), (253, 141, 60), (227, 26, 28), (128, 0, 38)], dtype=float
)
SCALE = 10  # pixels a mm
HALF = 17  # mm of the circumference shown on either side
BAR = 200  # pixels

given = contact.validate(
    {
        "wheel": {"outer_radius_mm": 100, "width_mm": 30, "rim_thickness_mm": 15},
        "workpiece": {"shape": "cylinder", "radius_mm": 50, "axis_angle_deg": 30},
        "force_N": 80,
        "spacing_mm": 0.5,
    }
)
ours = contact.run(given)
truth = reference.solve(ours, contact.rim(given))
figures = reference.compare(ours, truth)
highest = ours["peak_pressure"]


def panel(pressure):
    shown = pressure[::-1, np.abs(ours["x"]) < HALF]
    at = np.clip(shown / highest, 0, 1) * (len(COLOURS) - 1)
    rgb = np.stack(
        [np.interp(at, np.arange(len(COLOURS)), COLOURS[:, k]) for k in range(3)], axis=-1
    )
    image = Image.fromarray(rgb.astype(np.uint8))
    height, width = shown.shape
    return image.resize((width * SCALE // 2, height * SCALE // 2), Image.NEAREST)


left, right = panel(ours["pressure"]), panel(truth["pressure"])
gap, top, bottom = 30, 40, 70
canvas = Image.new("RGB", (left.width * 2 + 3 * gap, left.height + top + bottom), "white")
font = ImageFont.truetype("DejaVuSans.ttf", 15)
draw = ImageDraw.Draw(canvas)
for image, at, title in (
    (left, gap, f"wheel_rim, {1000 * ours['time']:.0f} ms"),
    (right, left.width + 2 * gap, f"CalculiX, neo-Hookean, {truth['time']:.0f} s"),
):
    canvas.paste(image, (at, top))
    draw.rectangle((at, top, at + image.width - 1, top + image.height - 1), outline="grey")
    draw.text((at, 12), title, fill="black", font=font)
for i in range(BAR):
    colour = tuple(
        int(np.interp(i / (BAR - 1) * (len(COLOURS) - 1), range(len(COLOURS)), COLOURS[:, k]))
        for k in range(3)
    )
    draw.line((gap + i, canvas.height - 50, gap + i, canvas.height - 36), fill=colour)
draw.text((gap, canvas.height - 30), f"0 to {highest:.2f} MPa", fill="black", font=font)
text = (
    f"force {100 * figures['force_difference']:+.1f} %, "
    f"pressure {100 * figures['pressure_difference_L1']:.1f} % (L1)"
)
draw.text((left.width + 2 * gap, canvas.height - 50), text, fill="black", font=font)
canvas.save(OUT)
print(text)
