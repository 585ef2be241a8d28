"""Scenes as scripts of `arsc`."""

from model import IDENTITY, Leaf


def vector(v):
    return "(" + ", ".join(map(repr, v)) + ")"


SOLIDS = {
    "sphere": lambda s: f"sphere(radius: {s['radius']!r}, center: {vector(s['center'])})",
    "box": lambda s: f"box(min: {vector(s['min'])}, max: {vector(s['max'])})",
    "cylinder": lambda s: f"cylinder(radius: {s['radius']!r}, height: {s['height']!r})",
    "cone": lambda s: f"cone(radius: {s['base']!r}, top_radius: {s['top']!r}, height: {s['height']!r})",
    "torus": lambda s: f"torus(major: {s['major']!r}, minor: {s['minor']!r})",
}


def leaf(leaf):
    text = SOLIDS[leaf.kind](leaf.size)
    if leaf.map != IDENTITY:
        x, y, z, origin = map(vector, leaf.map)
        text += f" |> transform(matrix(x: {x}, y: {y}, z: {z}, origin: {origin}))"
    return text


def expression(node, names):
    """The expression of a tree. Deep ones go into names of their own, so that nothing nests deeply."""
    order, stack = [], [node]
    while stack:
        at = stack.pop()
        if not isinstance(at, Leaf):
            order.append(at)
            stack.extend(at.operands)
    for at in reversed(order):
        texts = [leaf(operand) if isinstance(operand, Leaf) else f"n{names[id(operand)]}" for operand in at.operands]
        name = names[id(at)] = len(names)
        yield f"let n{name} = {at.operator}({', '.join(texts)})"


def script(scene, resolution):
    names, definitions, solids = {}, [], []
    for solid in scene.solids:
        definitions.extend(expression(solid, names))
        solids.append(leaf(solid) if isinstance(solid, Leaf) else f"n{names[id(solid)]}")
    inside = "\n".join(f"    {solid} |> with(lambert(0.5))" for solid in solids)
    return f"""import std.material {{ lambert }}
import std.spectra {{ d65 }}

{chr(10).join(definitions)}

scene {{
{inside}
    point_light(intensity: d65) |> translate({vector(scene.light)})
}}

camera perspective(eye: {vector(scene.eye)}, target: {vector(scene.target)}, fov: {scene.fov_degrees!r}deg, resolution: ({resolution}, {resolution}))
"""
