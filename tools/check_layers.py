#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hold every #include in include/, src/, apps/, plugins/ and python/ to the layers of docs/ARCHITECTURE.md.

    check_layers.py [ROOT]     exit 0: all allowed; 1: each forbidden include as file:line; 2: usage

A layer may include itself, the layers its row of MAY_INCLUDE names, and what those may include in turn.
"""
import pathlib
import re
import sys

# Folder -> layer. The longest folder that matches counts. `src/render/<method>` is a layer of its own each.
FOLDERS = {
    "src/base": "base",
    "src/aperture": "aperture",
    "src/optics/surface": "surface",
    "src/optics/glass": "glass",
    "src/optics/coating": "coating",
    "src/optics/lens": "lens",
    "src/optics/lens_files": "lens_files",
    "src/optics/trace": "trace",
    "src/ghosts": "ghosts",
    "src/diffraction": "diffraction",
    "src/image": "image",
    "src/drawing": "drawing",
    "src/render/planning": "render/planning",
    "src/render/radiometry": "render/radiometry",
    "src/render/area_lights": "render/area_lights",
    "src/render/polygons": "render/polygons",
    "src/render/stop_patterns": "render/stop_patterns",
    "src/render/starburst": "render/starburst",
    "src/render/session": "render/session",
    "src/render/adaptive/tiles": "render/adaptive/tiles",
    "src/render/adaptive/cells": "render/adaptive/cells",
    "src/render/adaptive/budget": "render/adaptive/budget",
    "src/render/adaptive/choose": "render/adaptive/choose",
    "src/render/adaptive/clip": "render/adaptive/clip",
    "src/render/adaptive/emit": "render/adaptive/emit",
    "src/render/ray_maps": "render/ray_maps",
    "src/render/pupils": "render/pupils",
    "src/settings": "settings",
    "src/plates": "plates",
    "src/plate_modules": "plate_modules",
    "src/compositing": "compositing",
    "src/machine": "machine",
    "src/sequence": "sequence",
    "src/measure": "measure",
    "src/polynomial": "polynomial",
    "src/requests": "requests",
    "src/c_interface": "c_interface",
    "src/vulkan": "vulkan",
    "src/render/device": "render/device",
    "apps": "apps",
    "plugins": "apps",
    "python": "apps",
}
RENDERERS = "src/render"

# Public header, from include/contrejour -> the layer that implements it.
PUBLIC = {
    "contrejour.h": "api",
    "../contrejour.h": "c_interface",
    "../contrejour_optics.h": "c_interface",
    "export.h": "base",
    "expert/check_lens.h": "lens",
    "expert/coating.h": "coating",
    "expert/colour.h": "image",
    "context.h": "base",
    "expert/direct_image.h": "render/radiometry",
    "expert/devices.h": "render/device",
    "expert/vulkan_target.h": "render/device",
    "expert/dirt.h": "aperture",
    "expert/film_design.h": "coating",
    "expert/film_material.h": "coating",
    "expert/first_order.h": "lens",
    "expert/fractional_fourier.h": "diffraction",
    "expert/fraunhofer.h": "diffraction",
    "frame.h": "render/radiometry",
    "frame_settings.h": "render/planning",
    "expert/fresnel.h": "diffraction",
    "expert/ghost.h": "ghosts",
    "ghost_figures.h": "render/planning",
    "expert/ghost_options.h": "render/planning",
    "expert/glass.h": "glass",
    "expert/glass_catalogue.h": "glass",
    "image.h": "image",
    "image_view.h": "image",
    "image_io.h": "image",
    "expert/iris.h": "aperture",
    "expert/iris_field.h": "aperture",
    "expert/key_values.h": "base",
    "lens.h": "lens",
    "expert/lens_starburst.h": "render/starburst",
    "light.h": "image",
    "expert/light_detection.h": "image",
    "expert/moving_light.h": "image",
    "expert/light_source.h": "base",
    "expert/capture.h": "measure",
    "expert/capture_list.h": "measure",
    "expert/merge_stations.h": "measure",
    "expert/merged_sweep.h": "measure",
    "expert/station_file.h": "measure",
    "expert/flare_prediction.h": "measure",
    "expert/flare_source.h": "measure",
    "expert/flare_layers.h": "render/planning",
    "expert/picture_layers.h": "compositing",
    "expert/ghost_outline.h": "measure",
    "expert/ghost_profile.h": "measure",
    "expert/animation.h": "sequence",
    "expert/frame_pattern.h": "sequence",
    "expert/frame_range.h": "sequence",
    "expert/frame_record.h": "sequence",
    "expert/run_frames.h": "sequence",
    "expert/light_tracks.h": "sequence",
    "expert/track_files.h": "sequence",
    "expert/machine_speed.h": "machine",
    "expert/measured_flare.h": "measure",
    "expert/panorama.h": "measure",
    "expert/sweep.h": "measure",
    "expert/fit_flare.h": "measure",
    "expert/fit_comparison.h": "measure",
    "expert/learn_lens.h": "measure",
    "expert/sweep_geometry.h": "measure",
    "method_options.h": "render/planning",
    "expert/methods.h": "render/planning",
    "expert/metrics.h": "image",
    "expert/output_file.h": "base",
    "expert/pupil_mask.h": "diffraction",
    "render.h": "render/planning",
    "renderer.h": "render/session",
    "expert/render_statistics.h": "render/planning",
    "result.h": "base",
    "expert/ringing_options.h": "render/planning",
    "expert/spectrum_file.h": "image",
    "expert/starburst.h": "diffraction",
    "expert/starburst_options.h": "render/planning",
    "expert/clear_aperture.h": "surface",
    "expert/coating_file.h": "coating",
    "expert/coated_glass.h": "coating",
    "expert/glass_text.h": "settings",
    "expert/ghost_id.h": "lens",
    "expert/seidel.h": "lens",
    "expert/svg.h": "drawing",
    "expert/lens_section.h": "drawing",
    "expert/surface_shape.h": "surface",
    "expert/trace.h": "trace",
    "expert/trace_rays.h": "trace",
    "expert/vec.h": "base",
    "expert/write_lens.h": "lens_files",
    "preset.h": "settings",
    "expert/nearest_name.h": "base",
    "expert/parameter.h": "settings",
    "expert/parameter_text.h": "settings",
    "expert/parameter_values.h": "settings",
    "expert/settings.h": "settings",
    "expert/session.h": "settings",
    "expert/preview_exposure.h": "settings",
    "expert/requests.h": "requests",
    "expert/picture_window.h": "requests",
    "expert/exposure.h": "requests",
    "expert/source_renderer.h": "requests",
    "apply.h": "compositing",
    "expert/apply_files.h": "compositing",
    "expert/detected_picture.h": "compositing",
    "expert/flare_plan.h": "compositing",
    "expert/flare_visibility.h": "compositing",
    "expert/measured_settings.h": "compositing",
    "expert/renderer_settings.h": "compositing",
    "expert/pixel_grid.h": "compositing",
    "expert/plate.h": "plates",
    "expert/colour_view.h": "plates",
    "expert/polynomial.h": "polynomial",
    "expert/direct_polynomials.h": "polynomial",
    "expert/polynomial_method.h": "render/planning",
    "expert/polynomial_range.h": "polynomial",
    "expert/published_fits.h": "polynomial",
    "expert/published_pictures.h": "polynomial",
    "expert/published_samples.h": "polynomial",
}

# "*renderers" stands for every src/render/<method>, "renderer" for one without a row of its own, "public" for
# include/contrejour.
MAY_INCLUDE = {
    "base": [],
    "aperture": ["base"],
    "surface": ["base"],
    "glass": ["base"],
    "coating": ["glass", "surface"],
    "lens": ["glass", "coating", "surface", "aperture"],
    "lens_files": ["lens"],
    "trace": ["lens", "surface"],
    "image": ["base"],
    "ghosts": ["trace"],
    "drawing": ["ghosts", "image"],
    "diffraction": ["lens", "image"],
    "render/pupils": ["ghosts"],
    "polynomial": ["render/pupils", "ghosts", "image"],
    "render/radiometry": ["render/pupils", "ghosts", "image"],
    "render/planning": ["render/radiometry", "lens", "ghosts", "image"],
    "renderer": ["render/device", "render/stop_patterns", "render/ray_maps", "render/pupils", "render/planning", "trace", "ghosts",
                 "diffraction", "image"],
    "renderer:adaptive": ["renderer", "render/ray_maps", "render/adaptive/choose", "render/adaptive/emit",
                          "render/adaptive/tiles"],
    "renderer:polynomial": ["renderer:adaptive", "polynomial"],
    "render/ray_maps": ["render/planning", "render/pupils"],
    "render/adaptive/tiles": ["render/polygons", "image"],
    "render/adaptive/cells": ["render/ray_maps", "render/polygons", "render/stop_patterns"],
    "render/adaptive/budget": ["render/adaptive/cells", "render/planning"],
    "render/adaptive/choose": ["render/adaptive/budget"],
    "render/adaptive/clip": ["render/adaptive/budget"],
    "render/adaptive/emit": ["render/adaptive/clip"],
    "render/area_lights": ["render/planning"],
    "render/polygons": ["image", "aperture"],
    "render/stop_patterns": ["render/planning", "render/polygons", "ghosts", "diffraction"],
    "render/starburst": ["render/planning", "ghosts", "diffraction", "render/area_lights"],
    "render/session": ["*renderers", "render/device", "render/area_lights", "render/starburst"],
    "settings": ["render/planning"],
    "plates": ["image"],
    "plate_modules": ["plates"],
    "compositing": ["settings", "render/session", "measure"],
    "sequence": ["settings", "image"],
    "machine": ["trace", "ghosts", "image", "render/planning"],
    "measure": ["render/session", "image"],
    "vulkan": ["render/device", "render/planning", "image"],
    "render/device": ["render/planning", "render/stop_patterns", "trace", "ghosts", "image"],
    "requests": ["compositing", "render/session"],
    "api": ["compositing", "render/session"],
    "c_interface": ["api", "requests", "drawing", "lens_files"],
    "apps": ["public"],
}

# Libraries that stay in one place: pattern of the include, folders that may name it, why.
FENCED = [
    (r"vulkan/v(k|ulkan)|(GLES?\d?|OpenGL)/|glad|shaderc", ("src/vulkan", "apps/studio"), "graphics stays in vulkan and the studio"),
    (r"GLFW/|imgui|ofx", ("apps", "plugins"), "windows and hosts belong to apps"),
    (r"(oneapi/)?tbb/", ("src/base",), "threads come from base/tasks.h, where their hand-overs are annotated"),
    (r"nlohmann/", ("src/base", "apps", "tests"), "one wrapper that keeps its exceptions in"),
    (r"pugixml", ("src/optics/lens_files",), "one reader of XML"),
    (r"yaml-cpp/", ("src/base",), "one wrapper that keeps its exceptions in"),
    (r"gemmi/|pocketfft", ("src/diffraction",), "one wrapper of the FFT"),
    (r"OpenImageIO/|OpenColorIO/", ("src/plate_modules",), "modules of their own, loaded when they are needed first"),
    (r"Eigen/", ("src/diffraction", "src/optics/coating", "src/render/pupils", "src/measure/fit",
                "src/measure/prescription", "src/polynomial"),
     "one wrapper of the eigen solver, five of least squares"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')
SUFFIXES = {".h", ".hpp", ".inl", ".c", ".cc", ".cpp", ".comp"}


def layer_of(path):
    """Layer of a path relative to the root, or None where the table does not know its folder."""
    parts = path.split("/")
    if parts[0] == "include":
        name = "/".join(parts[2:]) if len(parts) > 2 else "../" + parts[1]
        return PUBLIC.get(name)
    for size in range(len(parts) - 1, 0, -1):
        folder = "/".join(parts[:size])
        if folder in FOLDERS:
            return FOLDERS[folder]
        if size == 3 and folder.startswith(RENDERERS + "/"):
            return "renderer:" + parts[2]
    return None


def closure(layer, allowed=MAY_INCLUDE):
    """Every layer that `layer` may include, lower ones implied."""
    seen, todo = set(), [layer]
    while todo:
        name = todo.pop()
        for lower in allowed["renderer" if name not in allowed and name.startswith("renderer:") else name]:
            if lower == "*renderers":
                lower = "renderer"
            if lower not in seen and lower != "public":
                seen.add(lower)
                todo.append(lower)
    return seen


def without_comments(text):
    """The same lines with comments blanked, so that a commented-out include does not count."""

    def blank(match):  # strings stay: a // inside one opens no comment
        return re.sub(r"[^\n]", " ", match.group(0)) if match.group(0).startswith("/") else match.group(0)

    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def find_ours(root, source, name):
    """Path, relative to the root, of the file of ours that an include names; None for a library's."""
    if name.startswith("contrejour/"):
        return "include/" + name
    for base in (source.rpartition("/")[0], "src", "apps", "plugins", "include"):
        path = pathlib.PurePosixPath(base) / name
        parts = []
        for part in path.parts:
            if part == ".." and parts:
                parts.pop()
            else:
                parts.append(part)
        candidate = "/".join(parts)
        if (root / candidate).is_file():
            return candidate
        if base in ("src", "apps", "plugins") and layer_of(candidate) not in (None, "apps"):
            return candidate  # a file of a layer of ours that is generated, or missing
    return None


def judge(source, layer, target):
    """Why `source` of `layer` may not include `target`, or None."""
    public_target = target.startswith("include/")
    if source.startswith("include/") and not public_target:
        return "a public header may include public headers only: users do not have this one"
    if layer == "apps":
        allowed = public_target or target.split("/")[:2] == source.split("/")[:2]  # a program's own folder is its own
        return None if allowed else "apps may include include/contrejour and their own folder only"
    other = layer_of(target)
    if other is None:
        return f"{target} belongs to no layer: add it to the table in tools/check_layers.py"
    lower = closure(layer)
    if other == layer or other in lower:
        return None
    if other.startswith("renderer:"):
        if "renderer" in lower:
            return None
        if layer.startswith("renderer:"):
            return "no renderer includes another"
    return f"{layer} may not include {other}"


def check_file(root, source):
    """Complaints about one file, as (line, text)."""
    layer = layer_of(source)
    if layer is None:
        where = "PUBLIC" if source.startswith("include/") else "FOLDERS"
        return [(1, f"belongs to no layer: add it to {where} in tools/check_layers.py")]
    complaints = []
    text = (root / source).read_text(encoding="utf-8", errors="replace")
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match.group(1) or match.group(2)
        for pattern, folders, why in FENCED:
            if re.match(pattern, name) and not source.startswith(tuple(folder + "/" for folder in folders)):
                complaints.append((number, f'includes "{name}": {why}'))
        target = find_ours(root, source, name)
        reason = judge(source, layer, target) if target else None
        if reason:
            complaints.append((number, f'includes "{name}": {reason}'))
    return complaints


def check_tree(root):
    """Complaints about all files under root, as file:line: text, and how many files were read."""
    complaints, count = [], 0
    for top in ("include", "src", "apps", "plugins", "python"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in SUFFIXES or not path.is_file():
                continue
            count += 1
            source = path.relative_to(root).as_posix()
            complaints += [f"{source}:{line}: {text}" for line, text in check_file(root, source)]
    return complaints, count


def main(arguments):
    if len(arguments) > 1 or (arguments and arguments[0].startswith("-")):
        print(__doc__.strip())
        return 0 if arguments[0] in ("-h", "--help") else 2
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    complaints, count = check_tree(root)
    if count == 0:
        print(f"{root}: no sources found", file=sys.stderr)
        return 2
    for complaint in complaints:
        print(complaint)
    print(f"layers: {count} files, {len(complaints)} forbidden includes")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
