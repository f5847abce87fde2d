# SPDX-License-Identifier: Apache-2.0
"""Properties: the lens of a camera with all parameters of the table, a scene's output, an object as a light."""
import functools

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import library
from .parameter_rows import Row, rows, setting, value_of_setting

DEFAULT_LENS = "planar-50"


@functools.lru_cache(maxsize=None)
def table() -> tuple[Row, ...]:
    return tuple(rows(library.load().parameters()))


def _limits(row: Row) -> dict:
    kind = int if row.kind == "integer" else float
    return {
        "min": kind(row.minimum),
        "max": kind(row.maximum),
        "soft_min": kind(row.soft_minimum),
        "soft_max": kind(row.soft_maximum),
    }


def _property_of(row: Row):
    common = {"name": row.label, "description": row.description, "default": row.default}
    if row.kind == "real":
        return FloatProperty(precision=3, **_limits(row), **common)
    if row.kind == "integer":
        return IntProperty(**_limits(row), **common)
    if row.kind == "switch":
        return BoolProperty(**common)
    if row.kind == "choice":
        return EnumProperty(items=[(name, name, "", number) for name, number in row.choices], **common)
    return StringProperty(subtype="FILE_PATH" if row.kind == "file" else "NONE", **common)


def _lens_names(_self, _context, text):
    return [name for name in library.load().bundled_lenses() if text.lower() in name]


def _look_names(_self, _context, text):
    return [name for name in library.load().bundled_presets() if text.lower() in name]


class CameraOptions:
    """Every camera has these besides the table's parameters."""

    lens: StringProperty(
        name="Lens", search=_lens_names, description=f"a bundled lens; empty: the look's, or {DEFAULT_LENS}"
    )
    lens_file: StringProperty(
        name="Lens File", subtype="FILE_PATH", description="a lens file of any format, in place of the bundled lens"
    )
    look: StringProperty(
        name="Look",
        search=_look_names,
        description="settings to start from; a parameter that is animated or not at its default overrides the look",
    )
    look_file: StringProperty(
        name="Look File", subtype="FILE_PATH", description="a look of your own, in place of the bundled one"
    )
    match_focal: BoolProperty(
        name="Zoom by Camera", default=True, description="a zoom lens takes the camera's focal length, within its range"
    )
    use_camera_focus: BoolProperty(
        name="Focus and f-Stop by Camera",
        default=True,
        description="the camera's depth of field, where it is on, sets the lens's focus and f-number",
    )


def camera_properties() -> type:
    """The class of a camera's properties, made of the table."""
    annotations = {**CameraOptions.__annotations__, **{row.attribute: _property_of(row) for row in table()}}
    return type("ContrejourCamera", (bpy.types.PropertyGroup,), {"__annotations__": annotations})


class ContrejourFoundLight(bpy.types.PropertyGroup):
    """A light as Find Lights lists it; `name` is Blender's own."""

    u: FloatProperty(name="U")
    v: FloatProperty(name="V")
    value: FloatProperty(name="Value", description="luminance that its image sums to over the picture's pixels")
    visible: FloatProperty(name="Visible", subtype="FACTOR")


class ContrejourScene(bpy.types.PropertyGroup):
    output: StringProperty(
        name="Output",
        subtype="FILE_PATH",
        default="//flare/flare_####.exr",
        description="OpenEXR files of the flare; #### is the frame's number",
    )
    half: BoolProperty(name="Half Float", description="16 bits a channel in place of 32")
    samples: IntProperty(
        name="Samples",
        default=128,
        min=1,
        max=4096,
        description="points on each light, each with a ray that finds what hides it",
    )
    max_lights: IntProperty(
        name="Lights, at Most", default=32, min=1, max=1000, description="the brightest lights are used"
    )
    with_render: EnumProperty(
        name="With Each Rendered Frame",
        items=[
            ("OFF", "Off", "flares are rendered by the buttons alone"),
            ("BEFORE", "Before", "the flare is there when the frame is composited"),
            ("AFTER", "After", "the flare is rendered when the frame is done"),
        ],
        description="renders the flare of each frame that Blender renders",
    )
    message: StringProperty(name="Message", description="what there is to know of the last flare")
    found: CollectionProperty(type=ContrejourFoundLight)
    found_index: IntProperty()


class ContrejourObject(bpy.types.PropertyGroup):
    use: BoolProperty(name="Causes Flare", default=True, description="this light, or this emitting mesh, causes flare")
    gain: FloatProperty(
        name="Gain", default=1.0, min=0.0, soft_max=10.0, description="multiplies its brightness; 1: as it is rendered"
    )
    spectrum: StringProperty(
        name="Spectrum",
        description="within each channel: D65, 3200K, sodium, led, fluorescent, or a file; empty: D65",
    )
    use_occlusion: BoolProperty(
        name="Can Be Hidden", default=True, description="objects in front of this light hide it"
    )
    hides_lights: BoolProperty(name="Hides Lights", default=True, description="this object hides lights behind it")


_static_classes = (ContrejourFoundLight, ContrejourScene, ContrejourObject)
_owners = {bpy.types.Scene: ContrejourScene, bpy.types.Object: ContrejourObject}
_camera_class = None


def register() -> None:
    global _camera_class
    for cls in _static_classes:
        bpy.utils.register_class(cls)
    _camera_class = camera_properties()
    bpy.utils.register_class(_camera_class)
    bpy.types.Camera.contrejour = PointerProperty(type=_camera_class)
    for owner, cls in _owners.items():
        owner.contrejour = PointerProperty(type=cls)


def unregister() -> None:
    global _camera_class
    for owner in (*_owners, bpy.types.Camera):
        del owner.contrejour
    bpy.utils.unregister_class(_camera_class)
    _camera_class = None
    for cls in reversed(_static_classes):
        bpy.utils.unregister_class(cls)


def lens_and_look(options) -> tuple[str | None, str | None]:
    """Names or files of a camera's lens and look; None for one that there is not."""
    look = bpy.path.abspath(options.look_file) if options.look_file else options.look.strip() or None
    lens = bpy.path.abspath(options.lens_file) if options.lens_file else options.lens.strip() or None
    if lens is None and (look is None or not library.load().find_preset(look).lens):
        lens = DEFAULT_LENS
    return lens, look


def _animated_paths(data) -> set[str]:
    animation = data.animation_data
    if animation is None:
        return set()
    curves = list(animation.drivers) + (list(animation.action.fcurves) if animation.action else [])
    return {curve.data_path for curve in curves}


def settings_of(options, camera, look: str | None) -> tuple[dict, float]:
    """The keyword arguments that a camera's properties stand for, and the gain, which is not the library's. camera: the
    original data, which has the animation; the options may be those of its evaluated copy."""
    animated = _animated_paths(camera)
    settings = {}
    for row in table():
        value = setting(row, getattr(options, row.attribute), f"contrejour.{row.attribute}" in animated)
        if row.kind == "file" and value is not None:
            value = bpy.path.abspath(value)
        if value is not None:
            settings[row.attribute] = value
    of_look = library.load().find_preset(look).settings if look else {}
    gain = float(settings.pop("gain", of_look.get("gain", 1.0)))
    stops = float(settings.pop("stops", of_look.get("stops", 0.0)))
    return settings, gain * 2.0**stops


def load_look(options, look: str) -> None:
    """Sets every parameter as the look does, and the lens; the look is then none."""
    preset = library.load().find_preset(look)
    for row in table():
        options.property_unset(row.attribute)
        if row.attribute in preset.settings:
            setattr(options, row.attribute, value_of_setting(row, preset.settings[row.attribute]))
    if preset.lens and not options.lens_file:
        options.lens = preset.lens
    options.look, options.look_file = "", ""
