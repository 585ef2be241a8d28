"""Scenes as data, for two programs: `arsl.py` writes them as scripts of `arsc`, `mitsuba_scene.py` as dictionaries of Mitsuba.

Right-handed, z up, metres. A spectrum is a number or a list of pairs (nm, value), linear between them. Angles in degrees."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy

# What both programs render.
RANGE_NM = (360.0, 830.0)


@dataclass
class Camera:
    eye: tuple
    target: tuple
    fov: float
    up: tuple = (0.0, 0.0, 1.0)


@dataclass
class Shape:
    """`kind`: quad (corners), rectangle (width, height, centre, tilt about x), sphere (radius, centre), ball of a closed
    solid likewise, box (min, max), mesh (path of a PLY file)."""

    kind: str
    size: dict
    material: str | None = None
    # Radiance, Lambertian, from the side of the normal.
    emission: object = None
    # Name of what fills the solid.
    medium: str | None = None


@dataclass
class Scene:
    name: str
    camera: Camera
    materials: dict
    shapes: list
    environment: object = None
    media: dict = field(default_factory=dict)
    depth: int = 20
    resolution: int = 256
    polarised: bool = False


def lambert(reflectance):
    return {"type": "lambert", "reflectance": reflectance}


def metal(eta, k, roughness=None, distribution="ggx"):
    return {"type": "metal", "eta": eta, "k": k, "roughness": roughness, "distribution": distribution}


def glass(ior, roughness=None, distribution="ggx"):
    return {"type": "glass", "ior": ior, "roughness": roughness, "distribution": distribution}


def pane(ior):
    return {"type": "pane", "ior": ior}


def polariser(angle):
    return {"type": "polariser", "angle": angle}


def retarder(retardance, angle):
    return {"type": "retarder", "retardance": retardance, "angle": angle}


def ramp(low, high):
    """A spectrum that goes straight from one end of the range to the other."""
    return [(RANGE_NM[0], low), (RANGE_NM[1], high)]


def quad(material, *corners, emission=None):
    return Shape("quad", {"corners": corners}, material, emission)


def lamp(radiance, width, height, center, tilt):
    """A black rectangle that emits along its normal: +z, turned about the x axis by `tilt` degrees."""
    return Shape("rectangle", {"width": width, "height": height, "center": center, "tilt": tilt}, "black", radiance)


def window(material, width, height, center, tilt):
    return Shape("rectangle", {"width": width, "height": height, "center": center, "tilt": tilt}, material)


def ball(material, radius, center, medium=None):
    return Shape("sphere", {"radius": radius, "center": center}, material, medium=medium)


def mesh(material, path, emission=None):
    return Shape("mesh", {"path": path}, material, emission)


def write_ply(path, positions, triangles):
    """Binary PLY: float positions (n, 3), indices (m, 3)."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = numpy.empty(len(triangles), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    data = header.encode() + numpy.ascontiguousarray(positions, "<f4").tobytes() + faces.tobytes()
    Path(path).write_bytes(data)


def wavy_ball(path, rows, columns, waves=0.06):
    """A closed ball of radius about 1 with bumps: 2 columns (rows - 1) triangles."""
    theta = numpy.pi * numpy.arange(rows + 1) / rows
    phi = 2 * numpy.pi * numpy.arange(columns) / columns
    t, p = numpy.meshgrid(theta[1:-1], phi, indexing="ij")
    radius = 1 + waves * numpy.sin(9 * t) * numpy.cos(11 * p) * numpy.sin(t) + 0.2 * waves * numpy.sin(57 * t + 3 * p)
    grid = numpy.stack([radius * numpy.sin(t) * numpy.cos(p), radius * numpy.sin(t) * numpy.sin(p), radius * numpy.cos(t)], -1)
    positions = numpy.concatenate([grid.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    top, bottom = len(positions) - 2, len(positions) - 1
    here = numpy.arange((rows - 1) * columns).reshape(rows - 1, columns)
    right = numpy.roll(here, -1, axis=1)
    lower = numpy.stack([here[:-1], here[1:], right[1:]], -1).reshape(-1, 3)
    upper = numpy.stack([here[:-1], right[1:], right[:-1]], -1).reshape(-1, 3)
    first = numpy.stack([numpy.full(columns, top), here[0], right[0]], -1)
    last = numpy.stack([numpy.full(columns, bottom), right[-1], here[-1]], -1)
    write_ply(path, positions, numpy.concatenate([first, lower, upper, last]))
