#!/usr/bin/env python3
"""Makes hosek_wilkie.bin from the data set that the package mitsuba (3.9.1, PyPI) carries.

    pip download --no-deps mitsuba==3.9.1 && python3 generate_sky.py mitsuba-3.9.1-*.whl

Layout of the result, little-endian f64, index order as written:
sky parameters [turbidity 1..10][albedo 0, 1][control point 0..5][wavelength 320..720 by 40 nm][A B C D E F G I H],
sky radiance [turbidity][albedo][control point][wavelength], W m^-2 sr^-1 nm^-1,
solar radiance [turbidity][piece 0..44][wavelength][power 0..3],
limb darkening [wavelength][power 0..5].
"""
import struct
import sys
import zipfile

FIELDS = ["sky_params_spec", "sky_rad_spec", "sun_rad_spec", "sun_ld_spec"]


def main(wheel):
    data = zipfile.ZipFile(wheel).read("mitsuba/data/sunsky/sunsky_datasets.bin")
    assert data[:12] == b"tensor_file\0"
    (count,) = struct.unpack_from("<I", data, 14)
    at, found = 18, {}
    for _ in range(count):
        (length,) = struct.unpack_from("<H", data, at)
        name = data[at + 2 : at + 2 + length].decode()
        at += 2 + length
        dims, kind, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{dims}Q", data, at + 11)
        at += 11 + 8 * dims
        size = 8
        for n in shape:
            size *= n
        assert kind == 11, "double precision"
        found[name] = data[offset : offset + size]
    with open("hosek_wilkie.bin", "wb") as out:
        for field in FIELDS:
            out.write(found[field])


main(sys.argv[1])
