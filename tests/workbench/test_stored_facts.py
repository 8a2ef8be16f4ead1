"""What a document keeps of a program's problems: sentences, and what says them in another language."""

import os

import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.objects import stored_facts


@pytest.mark.freecad
def test_problems_are_told_in_the_windows_language_after_loading():
    doc = FreeCAD.newDocument()
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    job = beltgrinding.make_job(part, ["Face6"], Spacing=1.0)
    beltgrinding.make_belt_machine(job)
    with open("pass.src", "w") as file:
        file.write(
            "DEF pass()\n"
            "$VEL.CP = 0.1\n"
            "LIN {X 0, Y 0, Z 30, A 0, B 0, C 180}\n"
            "LIN NOWHERE\n"
            "LIN {X 50, Y 0, Z 30, A 0, B 0, C 180}\n"
            "END\n"
        )
    robot = beltgrinding.import_program(job, "pass.src")
    english = list(robot.Problems)
    assert len(english) == 1 and "NOWHERE" in english[0], english
    assert stored_facts.sentences(robot, "Problems", "en") == english
    doc.saveAs(os.path.abspath("kept.FCStd"))
    FreeCAD.closeDocument(doc.Name)

    doc = FreeCAD.openDocument(os.path.abspath("kept.FCStd"))
    robot = doc.RobotPath
    assert list(robot.Problems) == english
    german = stored_facts.sentences(robot, "Problems", "de")
    assert "NOWHERE" in german[0] and "pass.src:4: " in german[0] and german != english, german

    robot.Problems = ["mine", *english]  # of a macro: as it stands
    assert stored_facts.sentences(robot, "Problems", "de") == ["mine", *english]
    robot.removeProperty("ProblemsData")  # of a version before 0.2
    assert stored_facts.sentences(robot, "Problems", "de", 1) == ["mine"]
