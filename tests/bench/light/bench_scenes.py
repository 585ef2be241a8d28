"""The scenes of the benchmark."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "mitsuba"))
from model import Camera, Scene, Shape, ball, lambert, mesh, metal, quad, ramp, wavy_ball  # noqa: E402

BLACK = lambert(0.0)
COPPER = ([(360, 1.3), (500, 1.15), (560, 1.0), (620, 0.4), (830, 0.25)], [(360, 1.9), (500, 2.5), (560, 2.6), (620, 3.3), (830, 5.3)])


def block(material, base, top):
    """An upright block on a parallelogram, counter-clockwise from above: its sides and its top."""
    sides = [
        quad(material, (*p, 0.0), (*q, 0.0), (*q, top), (*p, top))
        for p, q in zip(base, base[1:] + base[:1])
    ]
    return [*sides, quad(material, *((*p, top) for p in base))]


def cornell(folder):
    """The box of the gallery: quads, a lamp just below the ceiling."""
    del folder
    w, d, h = 5.528, 5.592, 5.488
    shapes = [
        quad("white", (0, 0, 0), (w, 0, 0), (w, d, 0), (0, d, 0)),
        quad("white", (0, 0, h), (0, d, h), (w, d, h), (w, 0, h)),
        quad("white", (0, d, 0), (w, d, 0), (w, d, h), (0, d, h)),
        quad("red", (0, 0, 0), (0, d, 0), (0, d, h), (0, 0, h)),
        quad("green", (w, 0, 0), (w, 0, h), (w, d, h), (w, d, 0)),
        *block("white", [(2.96, 1.14), (4.53, 0.65), (5.03, 2.23), (3.46, 2.72)], 1.65),
        *block("white", [(0.88, 2.96), (2.46, 2.47), (2.95, 4.05), (1.37, 4.54)], 3.30),
        Shape("rectangle", {"width": 1.3, "height": 1.05, "center": (w / 2, 2.795, h - 0.01), "tilt": 180.0}, "black", ramp(0.1, 0.2)),
    ]
    materials = {
        "black": BLACK,
        "white": lambert([(360, 0.6), (430, 0.72), (830, 0.76)]),
        "red": lambert([(360, 0.05), (580, 0.06), (620, 0.6), (830, 0.65)]),
        "green": lambert([(360, 0.09), (470, 0.12), (530, 0.45), (600, 0.12), (830, 0.15)]),
    }
    return Scene("cornell", Camera((w / 2, -8.0, 2.73), (w / 2, 0.0, 2.73), 39.3), materials, shapes)


def metals(folder):
    """Rough copper balls, smoother ones to the right, under the same light from everywhere."""
    del folder
    roughness = [0.5, 0.35, 0.25, 0.15, 0.1, 0.05]
    materials = {f"copper_{i}": metal(*COPPER, roughness=r) for i, r in enumerate(roughness)}
    shapes = [
        ball(f"copper_{i}", 0.48, (i - 2.5, j - 2.5, 0.0)) for i in range(len(roughness)) for j in range(6)
    ]
    return Scene("metals", Camera((0.0, -2.0, 9.0), (0.0, 0.0, 0.0), 36.0), materials, shapes, environment=ramp(0.01, 0.02))


def large_mesh(folder, rows=808):
    """A diffuse ball with bumps, of 1.3 million triangles."""
    path = folder / f"wavy-{rows}.ply"
    if not path.exists():
        wavy_ball(path, rows, rows)
    materials = {"clay": lambert([(360, 0.3), (600, 0.7), (830, 0.8)])}
    shapes = [mesh("clay", path.name)]
    return Scene("mesh", Camera((0.0, -3.4, 1.0), (0.0, 0.0, 0.0), 36.0), materials, shapes, environment=ramp(0.01, 0.02))


def make(name, folder, resolution=256):
    """The scene; a small picture comes with a small mesh."""
    scene = large_mesh(folder, 40) if name == "mesh" and resolution < 100 else ALL[name](folder)
    scene.resolution = resolution
    return scene


ALL = {"cornell": cornell, "metals": metals, "mesh": large_mesh}
