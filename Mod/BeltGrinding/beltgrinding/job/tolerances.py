"""The tolerances of a job: their check, their colours, the narrowest of them."""

from ..engine import InputError


def narrowest_band(inspection):
    """(lower, upper) of the narrowest tolerance of a job's ``inspection``, mm."""
    bands = [inspection["tolerance_mm"]]
    bands += [
        zone["tolerance_mm"] for zone in inspection.get("zones", []) if zone.get("tolerance_mm")
    ]
    return min(bands, key=lambda band: band[1] - band[0])


def check_zones(zones, faces):
    """Raises InputError for tolerance zones that cannot be; ``faces``: those that are ground, numbered
    from 1, none for all.
    """
    ground, names = set(faces), set()
    for i, zone in enumerate(zones):
        where = f"inspection.zones[{i}]"
        if zone["name"] in names:
            raise InputError(
                "job.zone_name_taken",
                "{key} '{name}': another zone has this name already; give it another",
                key=where,
                name=zone["name"],
            )
        names.add(zone["name"])
        for key in ("tolerance_mm", "thickness_mm"):
            lower, upper = zone.get(key, (0.0, 0.0))
            if lower > upper:
                raise InputError(
                    "job.zone_limits_swapped",
                    "{key} '{name}'.{limits}: the lower limit lies above the upper one",
                    key=where,
                    name=zone["name"],
                    limits=key,
                )
        if "tolerance_mm" not in zone and "thickness_mm" not in zone:
            raise InputError(
                "job.zone_without_limits",
                "{key} '{name}': give it the key 'tolerance_mm', 'thickness_mm' or both",
                key=where,
                name=zone["name"],
            )
        for face in zone.get("faces", []):
            if ground and face not in ground:
                raise InputError(
                    "job.zone_face_not_ground",
                    "{key} '{name}'.faces: face {face} is not ground; see design.faces",
                    key=where,
                    name=zone["name"],
                    face=face,
                )


def colour_scale(job):
    """(lower, upper, limit) of the job's colours, mm; the limit lies outside of the band."""
    lower, upper = job["inspection"]["tolerance_mm"]
    limit = max(job["inspection"]["colour_limit_mm"], 1.01 * max(abs(lower), abs(upper)))
    return lower, upper, limit
