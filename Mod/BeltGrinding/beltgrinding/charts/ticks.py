"""Round values for an axis, by matplotlib's locators; its import waits until one is asked for."""

import importlib
import math
from functools import lru_cache

from ..engine import InputError
from .model import LOGARITHMIC, Tick

STEPS = (1.0, 2.0, 5.0, 10.0)


@lru_cache(maxsize=None)
def library(name):
    """A module of matplotlib. Raises InputError where it is missing."""
    try:
        return importlib.import_module(f"matplotlib.{name}")
    except ImportError:
        raise InputError(
            "charts.no_matplotlib", "a chart needs matplotlib (Debian: python3-matplotlib)"
        ) from None


def ticker():
    """matplotlib's module of locators. Raises InputError where it is missing."""
    return library("ticker")


def ticks(axis, low=None, high=None, count=None):
    """The ``Tick`` of an axis from ``low`` to ``high``, at most ``count`` steps apart from another, by
    default what the axis says. Raises InputError without matplotlib.
    """
    low, high = axis.low if low is None else low, axis.high if high is None else high
    if axis.ticks is not None:
        return [tick for tick in axis.ticks if low <= tick.value <= high]
    if axis.scale == LOGARITHMIC:
        locator = ticker().LogLocator(subs=axis.decade, numticks=100)
        return [_tick(axis, value, f"{value:.4g}") for value in _inside(locator, low, high)]
    values = _inside(_locator(count or axis.count), low / axis.size, high / axis.size)
    step = min((b - a for a, b in zip(values, values[1:])), default=abs(high - low) or 1.0)
    decimals = max(0, -math.floor(math.log10(step) + 1e-6))
    return [_tick(axis, value * axis.size, axis.number(value, decimals)) for value in values]


def _tick(axis, value, text):
    return Tick(value, text if axis.labelled else "")


@lru_cache(maxsize=16)
def _locator(count):
    return ticker().MaxNLocator(count, steps=STEPS)


def _inside(locator, low, high):
    """A locator's values that lie between; it gives those beyond the ends, too."""
    beyond = 1e-9 * max(high - low, 1e-12)
    values = locator.tick_values(low, high)
    return [float(value) for value in values if low - beyond <= value <= high + beyond]
