"""A document's result is one: its files are known by their sums, and half a result is none."""

import json

import pytest

from support.freecad import in_document  # noqa: F401
