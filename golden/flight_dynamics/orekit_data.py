"""Data that Orekit needs: leap seconds, and the Earth as the centre of a message."""

import pathlib
import tempfile

import erfa


def leap_seconds(folder):
    """Writes ERFA's table of leap seconds in the form of the US Naval Observatory, which Orekit reads."""
    months = "JAN FEB MAR APR MAY JUN JUL AUG SEP OCT NOV DEC".split()
    lines = []
    for year, month, offset in erfa.leap_seconds.get():
        if year >= 1972:
            jd1, jd2 = erfa.cal2jd(year, month, 1)
            lines.append(f" {year} {months[month - 1]}  1 =JD {jd1 + jd2:.1f}  TAI-UTC={offset:12.7f} S + (MJD - 41317.) X 0.0      S")
    (pathlib.Path(folder) / "tai-utc.dat").write_text("\n".join(lines) + "\n")


class Earth:
    """The Earth as a body of Orekit, which otherwise needs a planetary ephemeris to read a message about it."""

    def getName(self):
        return "EARTH"

    def getGM(self):
        return 398600.4415e9

    def getInertiallyOrientedFrame(self):
        from org.orekit.frames import FramesFactory

        return FramesFactory.getGCRF()

    getBodyOrientedFrame = getInertiallyOrientedFrame


class EarthLoader:
    """Loader of the only body."""

    def loadCelestialBody(self, name):
        import jpype
        from org.orekit.bodies import CelestialBody

        return jpype.JProxy(CelestialBody, inst=Earth())


def begin():
    """Starts Java with leap seconds and the Earth."""
    import jpype
    import orekit_jpype

    orekit_jpype.initVM()
    from java.io import File
    from org.orekit.bodies import CelestialBodyLoader
    from org.orekit.data import DataContext, DirectoryCrawler

    folder = tempfile.mkdtemp()
    leap_seconds(folder)
    context = DataContext.getDefault()
    context.getDataProvidersManager().addProvider(DirectoryCrawler(File(folder)))
    # The axes of ICRF, which angles refer to, are those of the barycentre.
    for name in ("Earth", "solar system barycenter"):
        context.getCelestialBodies().addCelestialBodyLoader(name, jpype.JProxy(CelestialBodyLoader, inst=EarthLoader()))
