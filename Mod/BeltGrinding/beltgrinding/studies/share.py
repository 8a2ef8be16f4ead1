"""The tolerance yield: the share of runs that pass, and how sure it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import Any

CONFIDENCE = 0.95


def wilson(
    passed: int, count: int, confidence: float = CONFIDENCE
) -> tuple[float, float] | tuple[None, None]:
    """(low, high): the score interval of a share of ``passed`` among ``count`` independent runs (Wilson 1927,
    J. Am. Stat. Assoc. 22:209). Both None without runs."""
    if not count:
        return None, None
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    share, spread = passed / count, z * z / count
    middle = (share + 0.5 * spread) / (1.0 + spread)
    half = z * math.sqrt(share * (1.0 - share) / count + 0.25 * spread / count) / (1.0 + spread)
    low = 0.0 if passed == 0 else max(middle - half, 0.0)
    high = 1.0 if passed == count else min(middle + half, 1.0)
    return low, high


def of(verdicts: Sequence[str], random: bool, confidence: float = CONFIDENCE) -> dict[str, Any]:
    """The yield of ``verdicts`` ("pass", "fail" or "unknown" each): dict(passed, failed, unknown, count, share, low,
    high). What is not known has not passed. ``random``: the runs are a sample; else there is no interval.
    """
    counts = {word: sum(one == word for one in verdicts) for word in ("pass", "fail", "unknown")}
    count = sum(counts.values())
    low, high = wilson(counts["pass"], count, confidence) if random else (None, None)
    return {
        "passed": counts["pass"],
        "failed": counts["fail"],
        "unknown": counts["unknown"],
        "count": count,
        "share": counts["pass"] / count if count else None,
        "low": low,
        "high": high,
    }
