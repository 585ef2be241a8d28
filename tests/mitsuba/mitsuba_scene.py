"""Scenes as dictionaries of Mitsuba 3, and pictures of them as arrays. A variant must have been chosen before the import
of anything here is used."""

import drjit
import mitsuba as mi
import numpy

# What Mitsuba's film takes for a luminance of 1, in cd m^-2: 683 lm/W times the integral of the observer's y, nm, as
# Mitsuba has it (MI_CIE_Y_NORMALIZATION). Radiance is in W m^-2 sr^-1 nm^-1 in both programs.
LUMINANCE = 683.0 * 106.7502593994140625


def spectrum(value):
    if isinstance(value, (int, float)):
        return {"type": "uniform", "value": float(value)}
    nm, values = zip(*value)
    return {"type": "irregular", "wavelengths": ",".join(map(repr, map(float, nm))), "values": ",".join(map(repr, map(float, values)))}


def material(m):
    rough = {}
    if m.get("roughness") is not None:
        rough = {"alpha": m["roughness"], "distribution": m["distribution"]}
    prefix = "rough" if rough else ""
    match m["type"]:
        case "lambert":
            return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": spectrum(m["reflectance"])}}
        case "metal":
            metal = {"type": f"{prefix}conductor", "eta": spectrum(m["eta"]), "k": spectrum(m["k"]), **rough}
            return {"type": "twosided", "bsdf": metal}
        case "glass":
            return {"type": f"{prefix}dielectric", "int_ior": m["ior"], "ext_ior": 1.0, **rough}
        case "pane":
            return {"type": "thindielectric", "int_ior": m["ior"], "ext_ior": 1.0}
        case "polariser":
            # Its polariser turns the other way than its wave plate.
            return {"type": "polarizer", "theta": -m["angle"]}
        case "retarder":
            return {"type": "retarder", "theta": m["angle"], "delta": m["retardance"]}


def medium(m):
    nm = numpy.linspace(360.0, 830.0, 95)
    absorption, scattering = (numpy.interp(nm, *zip(*pairs(m[key]))) for key in ("absorption", "scattering"))
    total = absorption + scattering
    volume = lambda values: {"type": "constvolume", "value": spectrum(list(zip(nm.tolist(), values.tolist())))}
    return {
        "type": "homogeneous",
        "sigma_t": volume(total),
        "albedo": volume(scattering / total),
        "phase": dict(m["phase"]),
    }


def pairs(value):
    return [(360.0, value), (830.0, value)] if isinstance(value, (int, float)) else value


def shape(s, materials, media, folder):
    size, transform = s.size, mi.ScalarTransform4f
    match s.kind:
        case "quad":
            made = {"type": "rectangle", "to_world": parallelogram(size["corners"])}
        case "rectangle":
            place = transform().translate(size["center"]).rotate([1, 0, 0], size["tilt"])
            made = {"type": "rectangle", "to_world": place.scale([size["width"] / 2, size["height"] / 2, 1])}
        case "sphere":
            made = {"type": "sphere", "radius": size["radius"], "center": list(size["center"])}
        case "box":
            low, high = numpy.array(size["min"], float), numpy.array(size["max"], float)
            made = {"type": "cube", "to_world": transform().translate((low + high) / 2).scale((high - low) / 2)}
        case "mesh":
            made = {"type": "ply", "filename": str(folder / size["path"]), "face_normals": True}
    if s.material is not None:
        made["bsdf"] = materials[s.material]
    if s.medium is not None:
        made["interior"] = media[s.medium]
        if s.material is None:
            made["bsdf"] = {"type": "null"}
    if s.emission is not None:
        made["emitter"] = {"type": "area", "radiance": spectrum(s.emission)}
    return made


def parallelogram(corners):
    """The map of Mitsuba's rectangle from -1 to 1 onto four corners."""
    a, b, _, d = (numpy.array(c, float) for c in corners)
    c = numpy.array(corners[2], float)
    if not numpy.allclose(a + c, b + d):
        raise ValueError("not a parallelogram")
    x, y = (b - a) / 2, (d - a) / 2
    z = numpy.cross(x, y)
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, y, z / numpy.linalg.norm(z), (a + c) / 2
    return mi.ScalarTransform4f(matrix)


def is_plain_quad(s):
    return s.kind == "quad" and s.emission is None


def merged(scene, folder):
    """Quads of one material as one mesh, which Mitsuba traces faster than as many rectangles."""
    from model import mesh, write_ply

    rest, quads = [], {}
    for s in scene.shapes:
        if is_plain_quad(s):
            quads.setdefault(s.material, []).append(s.size["corners"])
        else:
            rest.append(s)
    for name, all_corners in quads.items():
        path = folder / f"{scene.name}.{name}.ply"
        count = len(all_corners)
        first = 4 * numpy.arange(count)[:, None]
        triangles = numpy.concatenate([first + [0, 1, 2], first + [0, 2, 3]])
        write_ply(path, numpy.array(all_corners, float).reshape(-1, 3), triangles)
        rest.append(mesh(name, path.name))
    return rest


def load(scene, folder):
    materials = {name: material(m) for name, m in scene.materials.items()}
    media = {name: medium(m) for name, m in scene.media.items()}
    kind = "volpathmis" if media else "path"
    integrator = {"type": kind, "max_depth": scene.depth}
    if scene.polarised:
        integrator = {"type": "stokes", "integrator": integrator}
    camera = scene.camera
    description = {
        "type": "scene",
        "integrator": integrator,
        "camera": {
            "type": "perspective",
            "to_world": mi.ScalarTransform4f().look_at(origin=camera.eye, target=camera.target, up=camera.up),
            "fov": camera.fov,
            "fov_axis": "smaller",
            "near_clip": 1e-3,
            "far_clip": 1e4,
            "film": {
                "type": "hdrfilm",
                "width": scene.resolution,
                "height": scene.resolution,
                "pixel_format": "xyz",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
            "sampler": {"type": "independent"},
        },
    }
    for i, s in enumerate(merged(scene, folder)):
        description[f"shape_{i}"] = shape(s, materials, media, folder)
    if scene.environment is not None:
        description["environment"] = {"type": "constant", "radiance": spectrum(scene.environment)}
    return mi.load_dict(description)


def render(loaded, samples, seed):
    """Pixels (rows, columns, channels): X, Y, Z with Y in cd m^-2; of polarised scenes then the Stokes parameters, each as
    linear sRGB with the same white."""
    image = mi.render(loaded, spp=samples, seed=seed)
    drjit.eval(image)
    drjit.sync_thread()
    return numpy.array(image) * LUMINANCE
