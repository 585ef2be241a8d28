"""Checks a spectral EXR file of arsc with an independent reader.

    pip install colour-science OpenImageIO
    arsc image convert FILE.exr -o FILE.csv
    python tests/spectral_exr.py FILE.exr FILE.csv

Compares every band of every pixel (S0) as colour-science reads it with the text that arsc writes.
"""

import sys

import colour
import numpy


def main(exr, csv):
    components, _ = colour.read_spectral_image_Fichet2021(exr, additional_data=True)
    wavelengths, samples = components["S0"]
    header = open(csv).readline().strip().split(",")[2:]
    rows = numpy.loadtxt(csv, delimiter=",", skiprows=1)
    height, width = samples.shape[:2]
    assert [round(w, 4) for w in wavelengths] == [round(float(h), 4) for h in header], "wavelengths differ"
    assert rows.shape == (width * height, 2 + len(header)), "sizes differ"
    text = rows[:, 2:].reshape(height, width, -1)
    worst = numpy.abs(text - samples).max() / max(numpy.abs(text).max(), 1e-30)
    assert worst < 1e-6, f"radiances differ by {worst} of the greatest"
    print(f"{width} x {height} pixels, {len(header)} bands: the same")


main(*sys.argv[1:])
