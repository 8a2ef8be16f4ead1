"""Takes the picture of docs/calibration.md anew, from grinds of a law that is made up.

source tools/setup.sh && "$python" tools/calibration_picture.py
"""

from pathlib import Path

import numpy as np

from beltgrinding import calibration, calibration_plot

OUT = Path(__file__).resolve().parents[1] / "docs" / "images" / "calibration.png"
COUNT = 48

random = np.random.default_rng(4)
force = random.choice([10.0, 20.0, 35.0, 60.0], COUNT)
speed = random.choice([12.0, 18.0, 25.0, 32.0], COUNT)
area = random.choice([80.0, 150.0, 300.0], COUNT)
time = random.choice([5.0, 10.0, 20.0], COUNT)
work = np.cumsum(force * speed * time)
rate = 1.5e-6 * 20e3 * (speed / 20) ** 1.2 * 0.1 * (force / area / 0.1) ** 1.4
removed = area * time * rate * np.exp(-work / 4e5) * np.exp(0.07 * random.normal(size=COUNT))
removed[[7, 30]] *= (1.9, 0.5)  # a burr left on, a slipped part
result = calibration.fit(
    {
        "force_N": force,
        "belt_speed_m_s": speed,
        "area_mm2": area,
        "time_s": time,
        "work_J": work,
        "removed_volume_mm3": removed,
    }
)
OUT.write_bytes(calibration_plot.render(result["report"], dpi=80))
