"""Scenes of CSG as data, the same for every program: leaves of a kind with sizes and an affine map, Boolean trees of
them, a camera, a point light. Canonical placements are those of `arsc` (docs/reference/builtins.md): z is up and the
axis of everything round. `arsl.py` and `pov.py` write them down."""

import math
from dataclasses import dataclass, field

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))


@dataclass
class Leaf:
    """`kind` names a writer in both programs, `size` its numbers; `map` holds the images of the axes, then of the origin."""

    kind: str
    size: dict
    map: tuple = IDENTITY


@dataclass
class Node:
    """`operator` is union, intersection or difference; of a difference all operands after the first are taken away."""

    operator: str
    operands: list


@dataclass
class Scene:
    name: str
    solids: list
    eye: tuple
    target: tuple
    light: tuple
    fov_degrees: float = 36.0
    # Operands of the largest solid: what the bars go by.
    operands: int = 0
    # Solids of one union: a program may take them as independent things if that is faster for it.
    is_union: bool = False
    # Meshes by name: (vertices, triangles).
    meshes: dict = field(default_factory=dict)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def times(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return times(a, 1.0 / math.sqrt(dot(a, a)))


def apply(map, p):
    """The image of a point."""
    return add(map[3], linear(map, p))


def linear(map, v):
    return tuple(map[0][i] * v[0] + map[1][i] * v[1] + map[2][i] * v[2] for i in range(3))


def compose(outer, inner):
    return tuple(linear(outer, column) for column in inner[:3]) + (apply(outer, inner[3]),)


def translation(p):
    return IDENTITY[:3] + (tuple(p),)


def scaling(x, y, z):
    return ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z), (0.0, 0.0, 0.0))


def rotation(axis, angle):
    """About x (0), y (1) or z (2), radians."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    columns = [list(column) for column in IDENTITY[:3]]
    columns[i][i], columns[i][j] = c, s
    columns[j][i], columns[j][j] = -s, c
    return tuple(map(tuple, columns)) + (IDENTITY[3],)


def ball(center, radius):
    return Leaf("sphere", {"radius": radius, "center": tuple(center)})


def block(low, high):
    return Leaf("box", {"min": tuple(low), "max": tuple(high)})


def union(operands):
    return Node("union", list(operands))


def difference(first, rest):
    return Node("difference", [first, *rest])


def leaves(node):
    """All leaves below, from left to right, whatever the depth."""
    found, stack = [], [node]
    while stack:
        node = stack.pop()
        if isinstance(node, Leaf):
            found.append(node)
        else:
            stack.extend(reversed(node.operands))
    return found


def camera_frame(scene):
    """Unit vectors right, up and forward."""
    forward = unit(sub(scene.target, scene.eye))
    right = unit(cross(forward, (0.0, 0.0, 1.0)))
    return right, cross(right, forward), forward
