"""Derives the short-period variations of `navigation/src/short_period.rs` with SymPy and prints them.

Gauss's equations of variation in a, u = omega + M, k = e cos omega, h = e sin omega, i, Omega with the
acceleration of J2 are expanded to first order in e. Their mean over u is the secular drift; the integral of
the remainder, with zero mean over u, is the variation. Unit: kappa = J2 (R/a)^2; s = sin i, c = cos i.

    pip install -r golden/navigation/requirements.txt
    python3 golden/navigation/short_period.py
"""

import sympy as sp
from sympy.simplify.fu import TR8

u, k, h, c, s, eps = sp.symbols("u k h c s eps")
K, H = eps * k, eps * h
HALF3 = sp.Rational(3, 2)

# True minus mean argument of latitude, a/r and r/a to first order in e.
LEAD = 2 * K * sp.sin(u) - 2 * H * sp.cos(u)
INVERSE = K * sp.cos(u) + H * sp.sin(u)


def sin_of(m):
    return sp.sin(m * u) + m * LEAD * sp.cos(m * u)


def cos_of(m):
    return sp.cos(m * u) - m * LEAD * sp.sin(m * u)


def reduced(x):
    """First order in e, products of sines and cosines as sums."""
    return sp.expand(TR8(sp.expand(sp.series(sp.expand(x), eps, 0, 2).removeO())))


def mean(x):
    return sp.integrate(x, (u, 0, 2 * sp.pi)) / (2 * sp.pi)


def variation(rate):
    """Mean of a rate by u, and the periodic integral of the remainder."""
    rate = reduced(rate)
    secular = sp.expand(mean(rate))
    periodic = reduced(sp.integrate(sp.expand(rate - secular), u))
    return secular, sp.expand(periodic - mean(periodic))


def main():
    # Acceleration along R, T, N in units of n^2 a kappa.
    strength = 1 + 4 * INVERSE
    f_r = -HALF3 * strength * (1 - HALF3 * s**2 + HALF3 * s**2 * cos_of(2))
    f_t = -HALF3 * strength * s**2 * sin_of(2)
    f_n = -3 * strength * s * c * sin_of(1)
    r = 1 - INVERSE
    sin1, cos1 = sin_of(1), cos_of(1)
    by_a = 2 * (f_t * (1 + K * cos1 + H * sin1) + f_r * (K * sin1 - H * cos1))
    by_k = sin1 * f_r + ((1 + r) * cos1 + r * K) * f_t + r * H * (c / s) * sin1 * f_n
    by_h = -cos1 * f_r + ((1 + r) * sin1 + r * H) * f_t - r * K * (c / s) * sin1 * f_n
    by_node = r * sin1 * f_n / s
    of_a = variation(by_a)
    # The mean motion follows the osculating a.
    by_u = -2 * r * f_r + (K * by_h - H * by_k) / 2 - c * by_node - HALF3 * of_a[1]
    results = {
        "a": of_a,
        "u": variation(by_u),
        "ex": variation(by_k),
        "ey": variation(by_h),
        "i": variation(r * cos1 * f_n),
        "Omega": variation(by_node),
    }
    for name, (secular, periodic) in results.items():
        print(name, "secular rate by u:", sp.simplify(secular.subs(eps, 1)))
        for term in [f(m * u) for m in range(1, 6) for f in (sp.sin, sp.cos)]:
            factor = periodic.coeff(term).subs(eps, 1)
            if factor != 0:
                print("   ", term, ":", sp.factor(factor))


if __name__ == "__main__":
    main()
