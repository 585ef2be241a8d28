"""Mitsuba in a virtual environment of its own, and runs of `arsc`."""

import json
import os
import pickle
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import arsl

MITSUBA = "mitsuba==3.9.1"


def enter_environment():
    """Goes on only where Mitsuba can be imported: else installs it into a virtual environment and starts anew in there."""
    try:
        import mitsuba  # noqa: F401
        import numpy  # noqa: F401

        return
    except ImportError:
        pass
    place = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "arsc-mitsuba"
    python = place / "bin" / "python"
    if Path(sys.prefix).resolve() == place.resolve():
        sys.exit(f"{MITSUBA} is in {place} and does not work there")
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", place], check=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", MITSUBA, "numpy"], check=True)
    os.execv(python, [python, *sys.argv])


def has_llvm():
    """Whether Mitsuba's compiled variants find LLVM: Debian's libllvm19."""
    probe = "import mitsuba; mitsuba.set_variant('llvm_ad_spectral'); import drjit; drjit.eval(mitsuba.Float(1) + 1)"
    return subprocess.run([sys.executable, "-c", probe], capture_output=True, check=False).returncode == 0


def run_arsc(program, scene, samples, seed, folder, threads=1):
    """Renders. Gives the path of the picture, processor seconds, seconds, and the peak of memory in bytes."""
    script, picture = folder / f"{scene.name}.arsl", folder / f"{scene.name}.exr"
    script.write_text(arsl.script(scene, samples, picture.name))
    command = [program, "render", "--quiet", "-j", str(threads), "--seed", str(seed), "-o", str(folder), str(script)]
    with tempfile.TemporaryFile() as out:
        start, memory = time.monotonic(), 0
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, cwd=folder)
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            memory = max(memory, peak_of(process.pid))
            time.sleep(0.004)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read().decode(errors="replace")
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}:\n{text[-3000:]}")
    seconds = time.monotonic() - start
    return {
        "picture": picture,
        "cpu": usage.ru_utime + usage.ru_stime,
        "seconds": seconds,
        "memory": memory,
    }


def peak_of(pid):
    """Bytes that a process has held at most. (What `wait4` gives counts that of its parent before the fork.)"""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().split("\n")
    except OSError:
        return 0
    return max((int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM:")), default=0)


def read_exr(path):
    """Channels by name, each (rows, columns)."""
    import mitsuba as mi
    import numpy

    if mi.variant() is None:
        mi.set_variant("scalar_spectral")
    bitmap = mi.Bitmap(str(path))
    pixels = numpy.array(bitmap)
    names = [field.name for field in bitmap.struct_()]
    return {name: pixels[:, :, i].astype(float) for i, name in enumerate(names)}


class Mitsuba:
    """A scene in a variant of Mitsuba, in a process of its own."""

    def __init__(self, variant, scene, folder):
        place, self.picture = folder / f"{scene.name}.pickle", folder / f"{scene.name}.{variant}.npy"
        place.write_bytes(pickle.dumps(scene))
        command = [sys.executable, Path(__file__).parent / "worker.py", variant, place, self.picture]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def render(self, samples, seed):
        """Figures of the run, and pixels as `mitsuba_scene.render` gives them."""
        import numpy

        self.process.stdin.write(json.dumps({"samples": samples, "seed": seed}) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"Mitsuba ended with {self.process.wait()}")
        return json.loads(line), numpy.load(self.picture)

    def stop(self):
        self.process.stdin.close()
        self.process.wait()
