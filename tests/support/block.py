"""A block of 60 x 40 x 20 mm whose top, Face6, is ground in one pass along x; imported inside FreeCAD."""

from pathlib import Path

import Part

import beltgrinding

ROWS = [f"{x},20,20.2,0,1,0,0,30" for x in range(10, 51, 5)]
HEADER = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"
REMOVED = 1.25e-4 * 20000.0 * 30.0 * 40.0 / 30.0  # K V_b F t, mm3


def write_pass():
    """Writes the pass to pass.csv."""
    Path("pass.csv").write_text("\n".join([HEADER, *ROWS]) + "\n")


def block(doc):
    """The part, in a document."""
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    return part


def make(part, **stock):
    """A job that grinds the part by pass.csv."""
    job = beltgrinding.make_job(part, ["Face6"], Spacing="0.6 mm")
    beltgrinding.make_stock(job, **(stock or {"Allowance": "0.2 mm"}))
    beltgrinding.make_belt_machine(job, WheelRadius=60, WheelWidth="15 mm", Force="30 N")
    beltgrinding.import_program(job, "pass.csv")
    return job


def near(a, b, rel=0.01):
    """Whether a is b but for a share."""
    return abs(a - b) <= rel * abs(b)
