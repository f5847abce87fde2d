# SPDX-License-Identifier: Apache-2.0
"""Emission and transmittance of materials, read from their nodes where these are constant.

Colours by nodes that are followed: RGB, value, black body, light path, image textures (their mean). Any other node
counts as the socket's own default, or a factor as one half.
"""
from __future__ import annotations

from typing import Callable, Optional

import numpy as np

from .photometry import blackbody_rgb

WHITE, BLACK = np.ones(3), np.zeros(3)
_MAX_DEPTH = 32  # of nested shaders; deeper ones, and loops, count as black


def _rgb(value) -> np.ndarray:
    return np.full(3, float(value)) if isinstance(value, (int, float)) else np.array(value[:3], dtype=float)


def _source(socket):
    """The socket that feeds this one, past reroutes; None where nothing does."""
    for _ in range(_MAX_DEPTH):
        if socket is None or not socket.is_linked:
            return None
        origin = socket.links[0].from_socket
        if origin.node.type != "REROUTE":
            return origin
        socket = origin.node.inputs[0]
    return None


def constant(socket, unknown: Optional[float] = None) -> np.ndarray:
    """The value of a socket as RGB."""
    origin = _source(socket)
    if origin is None:
        return _rgb(socket.default_value)
    node = origin.node
    if node.type in ("RGB", "VALUE"):
        return _rgb(origin.default_value)
    if node.type == "BLACKBODY":
        return np.array(blackbody_rgb(float(constant(node.inputs[0])[0])))
    if node.type == "LIGHT_PATH":
        return WHITE if origin.name == "Is Camera Ray" else BLACK
    if node.type == "TEX_IMAGE" and node.image is not None and origin.name == "Color":
        return _mean_colour(node.image)
    return _rgb(socket.default_value if unknown is None else unknown)


def _mean_colour(image) -> np.ndarray:
    pixels = np.empty(len(image.pixels), np.float32)
    if len(pixels) == 0:
        return WHITE
    image.pixels.foreach_get(pixels)
    return pixels.reshape(-1, image.channels)[:, :3].mean(axis=0).astype(float)


def _input(node, *names):
    return next((node.inputs[name] for name in names if name in node.inputs), None)


def _mixed(socket, of_shader: Callable, depth: int = 0) -> np.ndarray:
    """The value of a shader that is mixed and added of others."""
    origin = _source(socket)
    if origin is None or depth > _MAX_DEPTH:
        return BLACK
    node = origin.node
    if node.type == "MIX_SHADER":
        factor = float(np.clip(constant(node.inputs[0], 0.5).mean(), 0.0, 1.0))
        first, second = (_mixed(node.inputs[k], of_shader, depth + 1) for k in (1, 2))
        return (1.0 - factor) * first + factor * second
    if node.type == "ADD_SHADER":
        return _mixed(node.inputs[0], of_shader, depth + 1) + _mixed(node.inputs[1], of_shader, depth + 1)
    return of_shader(node)


def _emission_of_shader(node) -> np.ndarray:
    if node.type == "EMISSION":
        return constant(node.inputs["Color"]) * constant(node.inputs["Strength"])
    if node.type == "BSDF_PRINCIPLED":
        return constant(_input(node, "Emission", "Emission Color")) * constant(node.inputs["Emission Strength"])
    return BLACK


def _transmittance_of_shader(node) -> np.ndarray:
    if node.type in ("BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION"):
        return np.clip(constant(node.inputs["Color"]), 0.0, 1.0)
    if node.type == "BSDF_PRINCIPLED":
        alpha = float(constant(node.inputs["Alpha"], 1.0)[0])
        through = constant(_input(node, "Transmission", "Transmission Weight"), 0.0)
        through = through * constant(node.inputs["Base Color"])
        return np.clip(1.0 - alpha + alpha * through, 0.0, 1.0)
    return BLACK


def surface_of(tree):
    """The surface socket of the output in force of a material, world or lamp."""
    outputs = [node for node in tree.nodes if node.type.startswith("OUTPUT_") and "Surface" in node.inputs]
    active = next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)
    return active.inputs["Surface"] if active is not None else None


def emission(material) -> np.ndarray:
    """Radiance, alike in all directions and on both sides."""
    if material is None or not material.use_nodes:
        return BLACK
    return np.maximum(0.0, _mixed(surface_of(material.node_tree), _emission_of_shader))


def transmittance(material) -> np.ndarray:
    """The part of light that goes straight through; glass counts as if it did not bend it."""
    if material is None or not material.use_nodes:
        return BLACK
    return _mixed(surface_of(material.node_tree), _transmittance_of_shader)


def lamp_factor(lamp) -> np.ndarray:
    """A lamp's own nodes multiply its colour by this."""
    if not lamp.use_nodes or lamp.node_tree is None:
        return WHITE
    surface = surface_of(lamp.node_tree)
    return np.maximum(0.0, _mixed(surface, _emission_of_shader)) if _source(surface) is not None else WHITE


def sky_of(world):
    """The sky texture that a world's background shows, and the background's strength; None where there is none."""
    if world is None or not world.use_nodes:
        return None
    background = _source(surface_of(world.node_tree))
    if background is None or background.node.type != "BACKGROUND":
        return None
    sky = _source(background.node.inputs["Color"])
    if sky is None or sky.node.type != "TEX_SKY":
        return None
    return sky.node, constant(background.node.inputs["Strength"])
