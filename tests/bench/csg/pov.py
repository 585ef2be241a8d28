"""Scenes as scripts of POV-Ray 3.7.

The same double-precision numbers and maps; POV-Ray's torus lies about y and is turned. The finish makes every pixel one
of three greys, black for nothing, middle for dark, white for lit (brilliance 0 takes the cosine away), and is as cheap as
any: no reflection, no highlight, no texture but one colour. A union at the top is written as its members, because POV-Ray
puts those into its bounding hierarchy and walks through the members of a union one by one."""

import math

from model import IDENTITY, Leaf, Node, camera_frame, compose, times

HEADER = """#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 1 }
#default { texture { pigment { rgb 1 } finish { ambient 0.5 diffuse 0.5 brilliance 0 } } }
"""

# Exchanges y and z: the torus is symmetric, so that a mirrored one is as good.
SWAP = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0))


def vector(v):
    return "<" + ",".join(map(repr, v)) + ">"


def sphere(s):
    return f"sphere{{{vector(s['center'])},{s['radius']!r}", IDENTITY


def cylinder(s):
    return f"cylinder{{<0,0,0>,<0,0,{s['height']!r}>,{s['radius']!r}", IDENTITY


def cone(s):
    return f"cone{{<0,0,0>,{s['base']!r},<0,0,{s['height']!r}>,{s['top']!r}", IDENTITY


SOLIDS = {
    "sphere": sphere,
    "box": lambda s: (f"box{{{vector(s['min'])},{vector(s['max'])}", IDENTITY),
    "cylinder": cylinder,
    "cone": cone,
    "torus": lambda s: (f"torus{{{s['major']!r},{s['minor']!r}", SWAP),
}


def leaf(leaf):
    text, inner = SOLIDS[leaf.kind](leaf.size)
    map = compose(leaf.map, inner)
    if map[:3] == IDENTITY[:3] and map[3] != IDENTITY[3]:
        text += f" translate {vector(map[3])}"
    elif map != IDENTITY:
        text += " matrix <" + ",".join(repr(x) for column in map for x in column) + ">"
    return text + "}"


def flattened(node):
    """Operands without the unions among them that the operator makes superfluous: that is faster in POV-Ray."""
    dissolves = lambda i, operand: isinstance(operand, Node) and operand.operator == "union" and (
        node.operator == "union" or (node.operator == "difference" and i > 0)
    )
    lists = [operand.operands if dissolves(i, operand) else [operand] for i, operand in enumerate(node.operands)]
    return [operand for list in lists for operand in list]


def write(node, out):
    """Writes a tree without recursion: chains are thousands deep."""
    stack = [node]
    while stack:
        at = stack.pop()
        if isinstance(at, str):
            out.append(at)
        elif isinstance(at, Leaf):
            out.append(leaf(at))
        else:
            out.append(at.operator + "{")
            stack.append("}")
            stack.extend(reversed(flattened(at)))


def script(scene, _resolution):
    right, up, forward = camera_frame(scene)
    span = 2.0 * math.tan(0.5 * math.radians(scene.fov_degrees))
    out = [HEADER]
    out.append(
        f"camera {{ perspective location {vector(scene.eye)} right {vector(times(right, span))}"
        f" up {vector(times(up, span))} direction {vector(forward)} }}"
    )
    out.append(f"light_source {{ {vector(scene.light)} rgb 1 }}")
    for solid in scene.solids:
        if scene.is_union:
            for member in solid.operands:
                write(member, out)
        else:
            write(solid, out)
    return "\n".join(out) + "\n"
