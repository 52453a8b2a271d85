"""Makes egm96.bin: the fully normalised coefficients of EGM96 to degree and order 36.

Source: EGM96 (Lemoine et al. 1998, NASA/TP-1998-206861), a work of NASA and NIMA, agencies of the United States,
free of copyright. The input is the file of the International Centre for Global Earth Models as contained in the
PyPI package satkit-data 0.9.0 (`satkit_data/data/EGM96.gfc`), whose SHA-256 this script checks. Tide-free
system, GM = 398600.4415 km3/s2, radius 6378.1363 km.

    python3 make_gravity.py EGM96.gfc egm96.bin

Layout: little-endian f64, no header. For each degree n from 0 to 36, for each order m from 0 to n: C, S.
"""

import hashlib
import math
import struct
import sys

DEGREE = 36
SHA256 = "5247a9e9c316dd2c8f8fd491d53be0e163cb5cb3676b021754240cc9e44cb43b"
# J2, J3, J4 of EGM96 as printed by Vallado (Fundamentals of Astrodynamics and Applications, 4th edition,
# Table D-1).
KNOWN = {2: 1.0826266835e-3, 3: -2.5326564853e-6, 4: -1.6196215914e-6}


def main():
    text = open(sys.argv[1], "rb").read()
    if hashlib.sha256(text).hexdigest() != SHA256:
        sys.exit(f"{sys.argv[1]} is another file: its SHA-256 differs from {SHA256}")
    table = {}
    for line in text.decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["gfc"] and int(words[1]) <= DEGREE:
            table[int(words[1]), int(words[2])] = float(words[3]), float(words[4])
    for n, expected in KNOWN.items():
        got = -math.sqrt(2 * n + 1) * table[n, 0][0]
        print(f"J{n} = {got:.10e}, expected {expected:.10e}")
        if abs(got / expected - 1.0) > 1e-9:
            sys.exit(f"J{n} is not that of EGM96")
    with open(sys.argv[2], "wb") as out:
        for n in range(DEGREE + 1):
            for m in range(n + 1):
                out.write(struct.pack("<2d", *table.get((n, m), (0.0, 0.0))))
                if n > 1 and (n, m) not in table:
                    sys.exit(f"no coefficient of degree {n} and order {m}")


main()
