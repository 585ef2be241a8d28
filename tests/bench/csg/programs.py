"""Running the two programs and reading what they say."""

import json
import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import arsl
import pov


def run(command, folder, patience):
    """Standard output and error together, and processor seconds of the whole process. `None` when it takes too long."""
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, cwd=folder)
        deadline = time.monotonic() + patience
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > deadline:
                process.kill()
                os.wait4(process.pid, 0)
                process.returncode = -9
                return None
            time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read().decode(errors="replace")
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))} ended with {process.returncode}:\n{text[-3000:]}")
    return text, usage.ru_utime + usage.ru_stime


def grey_map(path):
    """Width, height and one byte per pixel of a binary PGM, or of the red of a PPM."""
    data = Path(path).read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = at
        while data[end : end + 1] not in (b" ", b"\n", b"\t"):
            end += 1
        word, at = data[at:end], end + 1
        if word.startswith(b"#"):
            at = data.index(b"\n", end) + 1 if data[end : end + 1] != b"\n" else end + 1
        elif word:
            fields.append(word)
    step = 3 if fields[0] == b"P6" else 1
    return int(fields[1]), int(fields[2]), data[at:][::step]


def classes(path):
    """0 nothing, 1 dark, 2 lit."""
    return bytes(0 if value < 16 else 1 if value < 250 else 2 for value in grey_map(path)[2])


class Arsc:
    def __init__(self, path, strategy):
        self.path, self.strategy = path, strategy
        self.name = f"arsc {strategy}"

    def write(self, scene, resolution, folder):
        (folder / f"{scene.name}.arsl").write_text(arsl.script(scene, resolution))

    def trace(self, scene, resolution, folder, patience, repeat):
        sights = folder / f"{scene.name}.{self.strategy}.pgm"
        command = [
            self.path, "bench", "--rays", "--format", "json", "--repeat", str(repeat), "--threads", "1",
            "--csg", self.strategy, "--resolution", f"{resolution}x{resolution}", "--sights", str(sights),
            f"{scene.name}.arsl",
        ]
        ended = run(command, folder, patience)
        if ended is None:
            return None
        text, whole = ended
        line = json.loads(text[text.index("[") :])[0]
        return {
            "seconds": min(line["trace_seconds"]),
            "whole_seconds": whole,
            "rays": line["primary_rays"] + line["shadow_rays"],
            "shadow_rays": line["shadow_rays"],
            "classes": classes(sights),
            **{key: line[key] for key in ["build_seconds", "primitives", "cells", "bytes", "tests_per_ray"]},
        }


class Pov:
    name, strategy = "povray", "povray"

    def write(self, scene, resolution, folder):
        (folder / f"{scene.name}.pov").write_text(pov.script(scene, resolution))

    def trace(self, scene, resolution, folder, patience, repeat):
        del repeat
        picture = folder / f"{scene.name}.ppm"
        command = [
            "povray", f"+I{scene.name}.pov", f"+O{picture.name}", "+FP", f"+W{resolution}", f"+H{resolution}",
            "+WT1", "-A", "-D", "-V", "-J", "+Q9",
        ]
        ended = run(command, folder, patience)
        if ended is None:
            return None
        text, whole = ended
        text = text.replace("\r", "\n")
        seconds = re.search(r"Trace Time:.*\n.*using 1 thread\(s\) with ([0-9.]+) CPU-seconds", text)
        rays = re.search(r"Rays:\s+([0-9]+)", text)
        shadows = re.search(r"Shadow Ray Tests:\s+([0-9]+)", text)
        return {
            "seconds": float(seconds[1]),
            "whole_seconds": whole,
            "primary_rays": int(rays[1]),
            "shadow_tests": int(shadows[1]) if shadows else 0,
            "classes": classes(picture),
        }
