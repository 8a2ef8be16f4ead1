"""The comparison of the manual's pictures sees a changed character, and no rounding of colours."""

import numpy as np
import pytest
from PIL import Image, ImageDraw

from support import pictures

KEPT = "workbench-simulation"
PLACE = (150, 572)  # where the panel is empty


@pytest.fixture
def labelled(tmp_path, monkeypatch):
    """Writes the kept picture with a text in its panel; compared with the one that says "30 N"."""
    monkeypatch.setattr(pictures, "IMAGES", tmp_path / "kept")
    monkeypatch.setattr(pictures, "MADE", tmp_path / "made")
    kept = Image.open(pictures.ROOT / "docs" / "images" / f"{KEPT}.png").convert("RGB")
    for folder in ("kept", "made"):
        (tmp_path / folder).mkdir()

    def write(text, change=None, folder="made"):
        image = kept.copy()
        ImageDraw.Draw(image).text(PLACE, text, (0, 0, 0))
        if change is not None:
            image = Image.fromarray(change(np.asarray(image)))
        image.save(tmp_path / folder / f"{KEPT}.png")

    write("30 N", folder="kept")
    return write


@pytest.mark.parametrize("text", ["31 N", "36 N", "38 N", "80 N", "30 M", "30 N.", "20 N"])
def test_a_changed_label_fails(labelled, text):
    labelled(text)
    (sentence,) = pictures.stale([KEPT])
    assert "shows something else" in sentence
    with pytest.raises(AssertionError, match="look at build/pictures"):
        pictures.check(pictures.RELEASE, [KEPT])
    pictures.check([1, 0], [KEPT])  # others draw their own frames


def test_the_same_picture_passes(labelled):
    labelled("30 N")
    assert pictures.stale([KEPT]) == []

    def rounded(pixels):
        noise = np.random.default_rng(1).integers(-2, 3, pixels.shape)
        return np.clip(pixels + noise, 0, 255).astype(np.uint8)

    labelled("30 N", rounded)
    assert pictures.stale([KEPT]) == []


@pytest.mark.parametrize("colour, same", [((220, 0, 140), True), ((90, 90, 90), False)])
def test_the_steps_of_a_coloured_line_may_lie_elsewhere(labelled, colour, same):
    def line(steps):
        def draw(pixels):
            image = Image.fromarray(pixels)
            ends = [700, *(x + steps for x in range(720, 800, 20)), 800]
            for k, (x, end) in enumerate(zip(ends, ends[1:])):
                ImageDraw.Draw(image).line((x, 300 - k, end, 300 - k), colour)
            return np.asarray(image)

        return draw

    labelled("30 N", line(0), "kept")
    labelled("30 N", line(4))
    assert (pictures.stale([KEPT]) == []) == same


@pytest.mark.parametrize(
    "other", [np.flipud, lambda pixels: pixels[:-1], lambda pixels: 255 - pixels]
)
def test_another_picture_fails(labelled, other):
    labelled("30 N", other)
    assert len(pictures.stale([KEPT])) == 1


def test_a_picture_that_is_not_kept_fails(labelled):
    labelled("30 N")
    assert pictures.stale(["nothing"]) == ["nothing is not in docs/images"]
