"""The scenes that are compared: each one thing that both programs can do, under light that needs no luck to be found."""

from model import (
    Camera, Scene, ball, glass, lambert, lamp, mesh, metal, pane, polariser, quad, ramp, retarder, wavy_ball, window,
)

SKY = ramp(0.01, 0.02)
COPPER = (
    [(360, 1.3), (500, 1.15), (560, 1.0), (620, 0.4), (830, 0.25)],
    [(360, 1.9), (500, 2.5), (560, 2.6), (620, 3.3), (830, 5.3)],
)
PAINTS = {
    "black": lambert(0.0),
    "white": lambert([(360, 0.6), (430, 0.72), (830, 0.76)]),
    "red": lambert([(360, 0.05), (580, 0.06), (620, 0.6), (830, 0.65)]),
    "green": lambert([(360, 0.09), (470, 0.12), (530, 0.45), (600, 0.12), (830, 0.15)]),
}
VIEW = Camera((0.0, -5.0, 2.2), (0.0, 0.0, 0.6), 36.0)


def floor(material="white", half=3.0):
    return quad(material, (-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0))


def overhead(radiance=ramp(0.1, 0.2)):
    return lamp(radiance, 1.4, 1.4, (0.5, -0.5, 3.5), 180.0)


def studio(name, materials, shapes, lights=True, **more):
    """Things on a white floor under a lamp and a sky."""
    ends = [overhead()] if lights else []
    return Scene(name, VIEW, {**PAINTS, **materials}, [floor(), *shapes, *ends], environment=SKY, **more)


def cornell(folder):
    del folder
    w = 2.0
    corner = lambda x, y, z: (x * w / 2, y * w / 2, z * w)
    shapes = [
        quad("white", corner(-1, -1, 0), corner(1, -1, 0), corner(1, 1, 0), corner(-1, 1, 0)),
        quad("white", corner(-1, -1, 1), corner(-1, 1, 1), corner(1, 1, 1), corner(1, -1, 1)),
        quad("white", corner(-1, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(-1, 1, 1)),
        quad("red", corner(-1, -1, 0), corner(-1, 1, 0), corner(-1, 1, 1), corner(-1, -1, 1)),
        quad("green", corner(1, -1, 0), corner(1, -1, 1), corner(1, 1, 1), corner(1, 1, 0)),
        ball("white", 0.4, (-0.4, 0.2, 0.4)),
        lamp(ramp(0.1, 0.2), 0.6, 0.6, (0.0, 0.0, 1.99), 180.0),
    ]
    return Scene("cornell", Camera((0.0, -4.2, 1.0), (0.0, 0.0, 1.0), 36.0), PAINTS, shapes)


def diffuse_mesh(folder):
    path = folder / "wavy-120.ply"
    wavy_ball(path, 120, 120)
    camera = Camera((0.0, -3.4, 1.0), (0.0, 0.0, 0.0), 36.0)
    return Scene("diffuse_mesh", camera, PAINTS, [mesh("white", path.name)], environment=SKY)


def mesh_lamp(folder):
    path = folder / "wavy-24.ply"
    wavy_ball(path, 24, 24, waves=0.2)
    shapes = [floor(), quad("red", (-3, 2, 0), (3, 2, 0), (3, 2, 4), (-3, 2, 4)), mesh("black", path.name, emission=ramp(0.1, 0.2))]
    return Scene("mesh_lamp", Camera((0.0, -7.0, 3.5), (0.0, 0.0, 0.3), 40.0), PAINTS, shapes)


def rough_metal(name, roughness, distribution):
    def make(folder):
        del folder
        copper = metal(*COPPER, roughness=roughness, distribution=distribution)
        return studio(name, {"copper": copper}, [ball("copper", 0.9, (0.0, 0.0, 0.9))])

    return make


def smooth_metal(folder):
    del folder
    shapes = [ball("copper", 0.7, (-0.75, 0.0, 0.7)), ball("copper", 0.7, (0.75, 0.0, 0.7))]
    return studio("smooth_metal", {"copper": metal(*COPPER)}, shapes, lights=False)


def smooth_glass(folder):
    del folder
    return studio("smooth_glass", {"glass": glass(1.5)}, [ball("glass", 0.9, (0.0, 0.0, 0.95))], lights=False)


def rough_glass(folder):
    del folder
    frosted = glass(1.5, roughness=0.1)
    return studio("rough_glass", {"glass": frosted}, [ball("glass", 0.9, (0.0, 0.0, 0.95))], lights=False)


def thin_glass(folder):
    del folder
    shapes = [ball("red", 0.8, (-0.4, 1.0, 0.8)), window("pane", 2.6, 1.8, (0.3, -0.6, 0.95), 90.0)]
    return studio("thin_glass", {"pane": pane(1.5)}, shapes, lights=False)


def fog(name, phase):
    def make(folder):
        del folder
        media = {"fog": {"absorption": ramp(0.1, 0.4), "scattering": ramp(2.0, 1.0), "phase": phase}}
        # So deep that it does not matter what counts as an event.
        fog = [ball(None, 0.9, (0.0, 0.0, 0.95), medium="fog")]
        return studio(name, {}, fog, lights=False, media=media, depth=200)

    return make


def polarising(name, materials, shapes, camera=VIEW):
    """As `studio`, without any colour: luminances of Stokes parameters are made of Mitsuba's RGB, and of the 10 nm bands of
    `arsc`."""
    grey = {"grey": lambert(0.7), **materials}
    return Scene(name, camera, grey, [floor("grey"), *shapes], environment=0.015, polarised=True)


STEEL = metal(2.0, 3.0)


def two_balls(material):
    return [ball(material, 0.7, (-0.75, 0.0, 0.75)), ball(material, 0.7, (0.75, 0.0, 0.75))]


def polarised_glass(folder):
    """Reflections in and through glass, of a sky and a floor that do not polarise."""
    del folder
    return polarising("polarised_glass", {"glass": glass(1.5)}, two_balls("glass"))


def polarised_metal(folder):
    del folder
    return polarising("polarised_metal", {"steel": STEEL}, two_balls("steel"))


def polarised_rough_metal(folder):
    del folder
    return polarising("polarised_rough_metal", {"steel": metal(2.0, 3.0, roughness=0.1)}, two_balls("steel"))


def polarised_sheets(folder):
    """Metal balls through a polariser, half of it behind a wave plate; from afar, since Mitsuba's sheets are exact for
    light that falls straight on them only."""
    del folder
    materials = {"steel": STEEL, "polariser": polariser(30.0), "plate": retarder(90.0, 70.0)}
    sheets = [window("polariser", 2.0, 2.0, (0.0, -200.0, 0.75), 90.0), window("plate", 1.0, 2.0, (0.5, -201.0, 0.75), 90.0)]
    camera = Camera((0.0, -600.0, 0.75), (0.0, 0.0, 0.75), 0.3)
    return polarising("polarised_sheets", materials, [*two_balls("steel"), *sheets], camera)


ALL = {
    "cornell": cornell,
    "diffuse_mesh": diffuse_mesh,
    "mesh_lamp": mesh_lamp,
    "ggx_metal": rough_metal("ggx_metal", 0.1, "ggx"),
    "beckmann_metal": rough_metal("beckmann_metal", 0.1, "beckmann"),
    "smooth_metal": smooth_metal,
    "smooth_glass": smooth_glass,
    "rough_glass": rough_glass,
    "thin_glass": thin_glass,
    "polarised_glass": polarised_glass,
    "polarised_metal": polarised_metal,
    "polarised_rough_metal": polarised_rough_metal,
}

# Known to differ: see docs/mitsuba.md.
DIFFERENT = {
    "ggx_very_rough": rough_metal("ggx_very_rough", 0.5, "ggx"),
    "polarised_sheets": polarised_sheets,
    "fog_isotropic": fog("fog_isotropic", {"type": "isotropic"}),
    "fog_forward": fog("fog_forward", {"type": "hg", "g": 0.6}),
}
