"""Renders one scene in one variant of Mitsuba on one thread: `worker.py VARIANT SCENE.pickle PICTURE.npy`.

Reads lines of JSON {"seed": …, "samples": …}, writes the picture, and answers each with processor seconds and memory."""

import json
import pickle
import resource
import sys
from pathlib import Path

import mitsuba as mi
import numpy


def cpu():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def main():
    variant, place, picture = sys.argv[1:]
    mi.set_variant(variant)
    import drjit
    import mitsuba_scene
    import programs

    drjit.set_thread_count(1)
    start = cpu()
    scene = pickle.loads(Path(place).read_bytes())
    loaded = mitsuba_scene.load(scene, Path(place).parent)
    prepare = cpu() - start
    # Compiles what is compiled.
    mitsuba_scene.render(loaded, 1, 1)
    for line in sys.stdin:
        order = json.loads(line)
        start = cpu()
        image = mitsuba_scene.render(loaded, order["samples"], order["seed"])
        seconds = cpu() - start
        numpy.save(picture, image)
        print(json.dumps({"cpu": seconds, "prepare": prepare, "memory": programs.peak_of("self")}), flush=True)


sys.path.insert(0, str(Path(__file__).parent))
main()
