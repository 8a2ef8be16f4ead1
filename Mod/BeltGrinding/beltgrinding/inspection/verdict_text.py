"""The verdict in words."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..base.kinds import Json
from . import finish, finish_zones, heat, section_figures


def text(verdict: Json) -> str:
    """A few lines that say it all."""
    failed = [one for one in verdict["zones"] if one["verdict"] != "pass"]
    bad = [one["face"] for one in verdict["faces"] if one["verdict"] == "fail"]
    coarse = " (coarse resolution: for searching, no verdict)"
    lines = [f"verdict: {verdict['overall'].upper()}"]
    lines[0] += coarse if verdict.get("resolution") == "coarse" else ""
    if bad:
        lines[0] += f", {len(bad)} of {len(verdict['faces'])} faces are not in tolerance"
    for zone in failed:
        name = "elsewhere" if zone["name"] is None else f"zone '{zone['name']}'"
        if zone.get("finish") and finish_zones.without(zone) == "pass":
            known = "not as called for" if zone["verdict"] == "fail" else "not all known"
            lines.append(f"  {name}: in tolerance, but its finish is {known}")
            continue
        if zone["worst"] is None:
            lines.append(f"  {name}: nothing could be inspected")
            continue
        if zone["verdict"] == "unknown":
            lines.append(f"  {name}: in tolerance, but not everything could be inspected")
            continue
        worst = zone["worst"]
        lines.append(
            f"  {name}: {100 * zone['above_share']:.2f} % of the area above and "
            f"{100 * zone['below_share']:.2f} % below tolerance, at worst {worst['value_mm']:+.3f} mm, "
            f"{max(worst['beyond_mm'], 0.0):.3f} mm beyond, on face {worst['face']}"
        )
        thick = zone["thickness"]
        if thick and thick["verdict"] == "fail":
            lines.append(
                f"    thickness out of tolerance on {100 * thick['out_share']:.2f} % of the area, at "
                f"worst {thick['worst']['value_mm']:+.3f} mm"
            )
    lines += [_finish(zone) for zone in verdict["zones"] if zone.get("finish")]
    lines += [_edge(zone) for zone in verdict["zones"] if zone.get("edge")]
    for section in verdict.get("sections", ()):
        lines += _section(section)
    for cluster in verdict["clusters"][:3]:
        lines.append(f"  {cluster['number']}. {_told(cluster, verdict['programs'])}")
    if verdict.get("heat"):
        lines.append(heat.text(verdict["heat"], verdict["programs"]))
    if verdict.get("finish"):
        lines.append(finish.text(verdict["finish"], verdict["programs"]))
    doubts = [
        ("rays that met no stock", verdict["missed_rays"]),
        ("samples with defective stock", verdict["defective_samples"]),
        ("events outside of the law's range", verdict["extrapolated_law_events"]),
        ("contacts not converged", verdict["not_converged_events"]),
        ("places of the programs not resolved", verdict["unresolved_motions"]),
    ]
    told = [f"{count} {what}" for what, count in doubts if count]
    if verdict["unresolved_motions"] is None:
        told.append("the programs could not be read again")
    if told:
        lines.append(f"  in doubt: {', '.join(told)}")
    return "\n".join(lines + [f"  note: {note}" for note in verdict["notes"]])


def _finish(zone: Json) -> str:
    found, told = zone["finish"], []
    if found.get("Ra"):
        ra = found["Ra"]
        most = "not known" if ra["max_um"] is None else f"at most {ra['max_um']:.2f} µm"
        told.append(
            f"Ra {most} (limit {ra['limit_um']:g} µm, {found['acceptance']}): {100 * ra['above_share']:.2f} % above, "
            f"{100 * ra['unknown_share']:.2f} % not known: {ra['verdict']}"
        )
    if found.get("lay"):
        lay = found["lay"]
        told.append(
            f"lay {lay['symbol']}: {100 * lay['off_share']:.2f} % otherwise, "
            f"{100 * lay['unknown_share']:.2f} % not known: {lay['verdict']}"
        )
    return f"  zone '{zone['name']}': finish: {'; '.join(told)}"


def _edge(zone: Json) -> str:
    edge = zone["edge"]
    radius, loss = edge["radius_mm"], edge["chord_loss_mm"]
    told = f"  zone '{zone['name']}': edges in {edge['sections']} sections: radius "
    told += f"{radius['min']:.3f} to {radius['max']:.3f} mm" if radius else "not known"
    told += f" (design {edge['design_radius_mm']['mean']:.3f} mm), chord loss "
    if not loss:
        return told + "not known"
    return told + f"{loss['mean']:.3f} mm on the mean, {loss['max']:.3f} mm at most"


def _section(section: Json) -> list[str]:
    """A section's figures of the design, before and after grinding, a line each."""
    lines = [f"  section '{section['name']}', mm: designed, before, after"]
    rows = list(section_figures.rows(section))
    if not rows:
        return [f"  section '{section['name']}': not known"]
    for key, edge, distance, cells in rows:
        what = {"chord_mm": "chord", "thickness_mm": "greatest thickness", "radius_mm": "radius"}
        name = what.get(key, f"thickness at {distance:g}" if distance is not None else "")
        name = name if edge is None else f"{edge} edge, {name}"
        told = ", ".join(f"{c:.3f}" if isinstance(c, float) else c.replace("_", " ") for c in cells)
        lines.append(f"    {name}: {told}")
    return lines


def _told(cluster: Json, programs: Sequence[Json]) -> str:
    x, y, z = cluster["worst"]["point_mm"]
    told = (
        f"{cluster['area_mm2']:.1f} mm2 {'too much left' if cluster['side'] == 'above' else 'cut too deep'}, "
        f"at worst {cluster['worst']['value_mm']:+.3f} mm at ({x:.1f}, {y:.1f}, {z:.1f})"
    )
    if (cluster["untouched_share"] or 0.0) > 0.5:
        told += f"; {100 * cluster['untouched_share']:.0f} % of it was never touched"
    elif cluster["motions"]:
        most = cluster["motions"][0]
        if cluster["motion_count"] > 1:
            told += f"; {cluster['motion_count']} motions"
        told += f"; {100 * most['share']:.0f} % of it by {_place(most, programs)}"
    return told


def _place(motion: Json, programs: Sequence[Json]) -> str:
    if motion["program"] is None:
        return f"motion {motion['motion']}"
    place = f"line {motion['line']}" if motion["line"] else f"pose {motion['pose'] + 1}"
    return f"{Path(programs[motion['program']]['name']).name}, {place}"
