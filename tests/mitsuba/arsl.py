"""Scenes as scripts of `arsc`."""

from model import RANGE_NM

IMPORTS = """import std.material { lambert, conductor, rough_conductor, dielectric, rough_dielectric, thin_dielectric, polariser, retarder }
import std.medium { medium, isotropic, henyey_greenstein, rayleigh }
"""


def vector(v):
    return "(" + ", ".join(repr(float(x)) for x in v) + ")"


def spectrum(kind, value):
    if not isinstance(value, (int, float)):
        pairs = ", ".join(f"({float(nm)!r}nm, {float(x)!r})" for nm, x in value)
        return f"{kind}([{pairs}])"
    return f"constant_{kind}({float(value)!r})" if kind == "emission" else repr(float(value))


def material(m):
    rough = ""
    if m.get("roughness") is not None:
        rough = f", roughness: {m['roughness']!r}, distribution: {m['distribution']}"
    prefix = "rough_" if rough else ""
    match m["type"]:
        case "lambert":
            return f"lambert({spectrum('reflectance', m['reflectance'])})"
        case "metal":
            eta, k = spectrum("refractive_index", m["eta"]), spectrum("extinction", m["k"])
            return f"{prefix}conductor({eta}, {k}{rough})"
        case "glass":
            return f"{prefix}dielectric({spectrum('refractive_index', m['ior'])}{rough})"
        case "pane":
            return f"thin_dielectric({spectrum('refractive_index', m['ior'])})"
        case "polariser":
            return f"polariser(angle: {m['angle']!r}deg)"
        case "retarder":
            return f"retarder(retardance: {m['retardance']!r}deg, angle: {m['angle']!r}deg)"


def phase(p):
    return f"henyey_greenstein({p['g']!r})" if p["type"] == "hg" else f"{p['type']}()"


def medium(m):
    coefficient = lambda key: spectrum("coefficient", m[key])
    return f"medium(absorption: {coefficient('absorption')}, scattering: {coefficient('scattering')}, phase: {phase(m['phase'])})"


def shape(s):
    size = s.size
    match s.kind:
        case "quad":
            text = f"quad({', '.join(map(vector, size['corners']))})"
        case "rectangle":
            text = f"rectangle(width: {size['width']!r}, depth: {size['height']!r})"
            text += f" |> rotate_x({size['tilt']!r}deg) |> translate({vector(size['center'])})"
        case "sphere":
            text = f"sphere(radius: {size['radius']!r}, center: {vector(size['center'])})"
        case "box":
            text = f"box(min: {vector(size['min'])}, max: {vector(size['max'])})"
        case "mesh":
            text = f"mesh(\"{size['path']}\")"
    if s.material is not None:
        text += f" |> with(m_{s.material})"
    if s.medium is not None:
        text += f" |> with(v_{s.medium})"
    if s.emission is not None:
        text += f" |> with(emitter({spectrum('emission', s.emission)}))"
    return text


def script(scene, samples, picture):
    """The script; `picture` is the name of the spectral EXR file that it writes."""
    lines = [IMPORTS]
    lines += [f"let m_{name} = {material(m)}" for name, m in scene.materials.items()]
    lines += [f"let v_{name} = {medium(m)}" for name, m in scene.media.items()]
    lines += ["", "scene {"]
    lines += [f"    {shape(s)}" for s in scene.shapes]
    if scene.environment is not None:
        lines.append(f"    environment({spectrum('emission', scene.environment)})")
    camera, side = scene.camera, scene.resolution
    polarised = "true" if scene.polarised else "false"
    lines += [
        "}",
        "",
        f"camera perspective(eye: {vector(camera.eye)}, target: {vector(camera.target)}, up: {vector(camera.up)}, "
        f"fov: {camera.fov!r}deg, resolution: ({side}, {side}), filter: box_filter())",
        "",
        "actions {",
        f"    path_trace(samples: {samples}, max_depth: {scene.depth - 1}, polarised: {polarised}, "
        f"wavelengths: ({RANGE_NM[0]!r}nm, {RANGE_NM[1]!r}nm))",
        f'    write_exr("{picture}")',
        "}",
    ]
    return "\n".join(lines) + "\n"
