"""Messages in the window have the labels of fields, no keys of the job file and no options of the command line."""

import re

import pytest

from beltgrinding.base import messages
from beltgrinding.engine import InputError
from beltgrinding.gui.common import field_words
from beltgrinding.gui.common.messages import error_text
from support.hands import start

pytestmark = pytest.mark.freecad(window=True)

# Of the command line, of C++ and Python callers, of folders of results, clusters: no window asks for them.
ELSEWHERE = {"cli", "call", "studies", "hdf5", "ply", "reporting", "simulation.not_of_a_run"}
ELSEWHERE |= {"planning.not_of_a_plan", "frames.quaternion_and_abc", "contact", "scan.no_module"}
ELSEWHERE |= {"job.no_left_by"}  # a document gives it
ELSEWHERE |= {"calibration.wear_without_job", "robot_program", "job.lay_direction"}
ELSEWHERE |= {
    "planning.belt_law",
    "gui.choose_surrogate",
    "job.surrogate_of_other_wheel",
    "planning.keep_what",
}
# Columns of tables, words of robots' and URDF's own files, choices of a property: what the user has to write.
WRITTEN = {
    "area_mm2",
    "force_N",
    "belt_speed_m_s",
    "time_s",
    "removed_volume_mm3",
    "depth_mm",
    "free_s",
}
WRITTEN |= {"length_mm", "contact_width_mm", "remaining_cut", "base_link", "tip_link", "ref_frame"}
WRITTEN |= {"set_tcp", "tool_dz_mm", "contact_wheel", "one_way", "part_in_hand", "vertex_index"}
KEY_LIKE = re.compile(
    r"(?<![\w{/])(?:[a-z]+(?:_[a-zA-Z0-9]+)+|--[a-z-]+|beltgrind [a-z-]+)(?!\w)|''"
)


def test_no_message_has_a_key_or_an_option():
    start()
    wrong = {}
    for code, form in messages._catalogue("de").items():
        room = code.split(".")[0]
        if not isinstance(form, str) or room in ELSEWHERE or code in ELSEWHERE:
            continue
        said = field_words.in_words(
            re.sub(r"\{[^}]*\}", "7", form.replace("{key}.", "belt_machine.force_device."))
        )
        found = [word for word in KEY_LIKE.findall(said) if word not in WRITTEN]
        if found:
            wrong[code] = found
    assert not wrong, "\n".join(f"{code}: {found}" for code, found in wrong.items())


def test_what_the_window_says_has_the_fields_label():
    start()
    error = InputError(
        "job.wrong", "{key} is {value}; set belt_machine.force_N.", key="law.wear.model", value=0
    )
    assert error_text(error) == ("“Belt-grinding job: Model” is 0; set “Belt machine: Force”.")
    assert str(error).startswith("law.wear.model")  # for macros, and all that is written
    words = field_words.in_words
    assert words("inspection.tolerance_mm[1]: 'x'") == "“Belt-grinding job: Upper limit”: 'x'"
    assert words("lower step_over_mm") == "lower “Raster path: Step-over”"
    assert words("'clearance_mm'") == "“Clearance”"  # of two objects, by one name
    assert words("give (--wear-unit)") == "give (“Work of one unit of wear”)"
    for kept in ("in_tolerance of my_part.src", "/tmp/force_N/a", "length_mm", "program_2.src"):
        assert words(kept) == kept
