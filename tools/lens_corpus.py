#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Read every lens file below a folder and say what came of it: what is read, what is refused and why, and which figures
are not those that the files state.

    lens_corpus.py PROGRAM FOLDER [--json]

PROGRAM is contrejour. Focal lengths of tables that are plain enough to be added up here are computed again by first-order
optics that shares no code with it ("second opinion"), so that a difference from the stated figure is the file's own.
"""
import argparse
import json
import pathlib
import re
import subprocess
import xml.etree.ElementTree as xml

ENDINGS = {".lens", ".zmx", ".seq", ".roa", ".json", ".dat", ".xml", ".spd", ".toml"}
TEXT_FOLDERS = ("opticalbench",)  # whose lenses are .txt
NO_LENSES = re.compile(r"licen[sc]e|/preset/|benchmark-project|optiland_samples", re.I)
FAR_OFF, NEAR = 0.03, 0.01  # of the focal length

# What a refusal is about, by its words: the first that fits.
REASONS = [
    ("mirrors", r"mirror|'reflect'"),
    ("parts of lenses: no stop and no image", r"no surface is the stop"),
    ("no image of distant objects", r"forms no image"),
    ("diffractive, thin, ideal or Fresnel elements",
     r"DOE|DIF:|DGRATING|PARAXIAL|Fresnel|ThinLens|phase_element"),
    ("axes that tilt or shift for good", r"reversed decentre|image surface stands"),
    ("no lens, or none with an f-number", r"no lens: no surface refracts|f_number is"),
    ("other programs' formats", r"not a lens file that is known"),
]


def files_below(folder):
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        ending = path.suffix.lower()
        wanted = ending in ENDINGS or (ending == ".txt" and name.startswith(TEXT_FOLDERS))
        if not path.is_file() or not wanted or NO_LENSES.search("/" + name):
            continue
        if name == "lentil/lenses.json":
            yield from (f"{name}#{key}" for key in json.loads(path.read_text(encoding="utf-8")))
        else:
            yield name


def check(program, folder, names):
    verdicts = []
    for start in range(0, len(names), 200):
        done = subprocess.run([program, "lens", "check", "--json", "--", *names[start:start + 200]], cwd=folder,
                              capture_output=True, timeout=300)
        if done.returncode not in (0, 1):
            raise SystemExit(f"lens check ended with {done.returncode}: {done.stderr.decode()[:500]}")
        verdicts += json.loads(done.stdout)["lenses"]
    return verdicts


def reason_of(error):
    return next((name for name, words in REASONS if re.search(words, error)), "other: " + error)


def paraxial_focal_length(rows):
    """Of rows (curvature, gap, index behind): a ray along the axis, surface by surface."""
    height, slope, index = 1.0, 0.0, 1.0
    for curvature, gap, behind in rows:
        slope = (index * slope - height * curvature * (behind - index)) / behind
        index = behind
        height += slope * gap
    return -1.0 / slope if slope else float("inf")


def curvature_of(radius):
    return 1.0 / radius if radius else 0.0


def flaresim_rows(text):
    """None for cylinders."""
    rows, index, inside = [], 1.0, False
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if line.strip().startswith("surfaces:"):
            inside = True
        elif inside and words:
            if len(words) > 6 and words[6] not in ("sph", "spherical"):
                return None
            stop = words[0].lower() == "stop"
            radius = 0.0 if stop or words[0] == "inf" else float(words[0])
            index = index if stop else max(1.0, float(words[2])) if float(words[2]) > 1.0001 else 1.0
            rows.append((curvature_of(radius), float(words[1]), index))
    return rows


def xml_rows(path):
    rows = []
    for element in xml.parse(path).getroot().find("elements"):
        number = {child.tag: child.text for child in element}
        if number["type"] == "lensSpherical":
            rows.append((curvature_of(float(number["radius"])), float(number["thickness"]),
                         float(number["refractiveIndex"])))
        elif rows and number["type"] == "apertureStop":
            rows.append((0.0, float(number["thickness"]), rows[-1][2]))
    return rows


def realflare_rows(text):
    return [(curvature_of(e["radius"]), e["distance"], e["refractive_index"]) for e in json.loads(text)["lens_elements"]]


def lentil_rows(text, key):
    rows, index = [], 1.0
    for element in json.loads(text)[key]["optical-elements-patent"]:
        if element["lens-geometry"].startswith("cyl") or isinstance(element["thickness"], list):
            return None
        index = index if element["material"] == "iris" else element.get("ior") or (1.0 if element["material"] == "air" else None)
        if index is None:
            return None
        rows.append((0.0 if abs(element["radius"]) >= 99999 else 1.0 / element["radius"], element["thickness"], index))
    return rows


def second_opinion(folder, name):
    """The focal length as computed here, or None."""
    file, _, key = name.partition("#")
    path = folder / file
    rows = None
    if file.endswith(".lens"):
        rows = flaresim_rows(path.read_text(encoding="utf-8", errors="replace"))
    elif file.endswith(".xml"):
        rows = xml_rows(path)
    elif file.startswith("realflare"):
        rows = realflare_rows(path.read_text(encoding="utf-8"))
    elif key:
        rows = lentil_rows(path.read_text(encoding="utf-8"), key)
    return paraxial_focal_length(rows) if rows else None


def survey(program, folder):
    summary = {"files": 0, "read": 0, "refused": {}, "stated": 0, "within_1_percent": 0, "within_3_percent": 0, "off": {},
               "stops_placed": [], "second_opinions": 0, "second_opinions_differ": {}}
    for verdict in check(program, folder, list(files_below(folder))):
        name = verdict["file"]
        summary["files"] += 1
        if not verdict["accepted"]:
            summary["refused"].setdefault(reason_of(verdict["error"]), []).append(name)
            continue
        summary["read"] += 1
        if any("no surface is the stop" in warning for warning in verdict["warnings"]):
            summary["stops_placed"].append(name)
        computed, stated = verdict["focal_length_mm"], verdict["stated_focal_length_mm"]
        opinion = second_opinion(folder, name)
        if opinion is not None:
            summary["second_opinions"] += 1
            if abs(opinion / computed - 1.0) > 1e-4:
                summary["second_opinions_differ"][name] = [computed, opinion]
        if stated is None:
            continue
        summary["stated"] += 1
        off = abs(computed / stated - 1.0)
        summary["within_1_percent"] += off <= NEAR
        summary["within_3_percent"] += off <= FAR_OFF
        if off > FAR_OFF:
            summary["off"][name] = [stated, computed]
    return summary


def text_of(summary):
    lines = [f"{summary['files']} files: {summary['read']} read, {summary['files'] - summary['read']} refused"]
    for reason, names in sorted(summary["refused"].items(), key=lambda item: -len(item[1])):
        lines.append(f"  {len(names):4}  {reason}")
    lines.append(f"{len(summary['stops_placed'])} have their stop where CODE V's, ray-optics' or DeepLens's rule or the rims put it")
    lines.append(f"{summary['stated']} state a focal length: {summary['within_1_percent']} have it within 1 per cent, "
                 f"{summary['within_3_percent']} within 3; the others:")
    for name, (stated, computed) in summary["off"].items():
        lines.append(f"  {name}: {stated:g} stated, {computed:.4g} computed")
    lines.append(f"{summary['second_opinions']} focal lengths computed a second time, "
                 f"{len(summary['second_opinions_differ'])} with another result")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--json", action="store_true", help="names and all")
    options = parser.parse_args()
    summary = survey(pathlib.Path(options.program).resolve(), options.folder)
    print(json.dumps(summary, indent=1) if options.json else text_of(summary))


if __name__ == "__main__":
    main()
