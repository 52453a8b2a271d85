"""Makes the files of other tools in golden/flight_dynamics/, and tables of the states that those tools read.

    python3 -m venv .venv && .venv/bin/pip install -r golden/flight_dynamics/requirements.txt
    .venv/bin/python golden/flight_dynamics/make.py --reason "why the old ones are wrong"

Needs Java 11 or later (Orekit). Writers: Orekit 13.1 (Apache-2.0) for OEM, AEM, OPM and TDM in both notations;
`oem` 0.4 (MIT) for an OEM in UTC over a leap second; CSPICE of spiceypy 8.3 (MIT; NAIF's rules) for SPK of the
types 2, 3, 8, 9 and 13. The motions are Kepler orbits of this script. The two
element sets are those of published test cases (NORAD 25544 and 09880).

- `states.csv`: file, TAI, position (km) and velocity (km/s) along GCRF, interpolated by the tool that wrote the
  file (Orekit, `oem` with ERFA's frame bias, CSPICE), at times between the nodes.
- `tle.csv`: states of SGP4 by the PyPI package `sgp4` (its own C++), turned from TEME to GCRS by ERFA with
  the nutation of 1980 in full, the equation of the equinoxes, precession of 1976 and frame bias.
- `teme.csv`: a state in TEME and the same along GCRF by Orekit (no corrections of the pole's motion).
- `attitudes.csv`: file, TAI, and the components along the body of the GCRF axes x, y, z (nine numbers), by
  Orekit.
- `parameters.csv`: file, TAI and GCRF state (km, km/s) by Orekit of each OPM.
- `directions.csv`: TAI, right ascension and declination (degrees) given to the TDM.
"""

import csv
import io
import math
import pathlib
import sys

import erfa
import numpy as np
import spiceypy as spice

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest
import orekit_data

GM = 398600.4415  # km^3/s^2
CREATED = "2012-04-20T00:00:00"
J2000_JD = 2451545.0
TLE = """TEST
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
"""
# Molniya orbit: SGP4's deep-space part with its resonance. Elements of Vallado et al. (2006), satellite
# 09880.
TLE_DEEP = """1 09880U 77021A   06176.56157475  .00000421  00000-0  10000-3 0  9814
2 09880  64.5968 349.3786 7069051 270.0229  16.3320  2.00813614112380
"""


def kepler(seconds, semi_major_axis=7130.0, eccentricity=0.01):
    """Position (km) and velocity (km/s) on a Kepler orbit, `seconds` after its perigee."""
    mean_motion = math.sqrt(GM / semi_major_axis**3)
    mean = mean_motion * seconds
    anomaly = mean
    for _ in range(50):
        anomaly -= (anomaly - eccentricity * math.sin(anomaly) - mean) / (1 - eccentricity * math.cos(anomaly))
    cos, sin = math.cos(anomaly), math.sin(anomaly)
    eta = math.sqrt(1 - eccentricity**2)
    rate = mean_motion / (1 - eccentricity * cos)
    position = semi_major_axis * np.array([cos - eccentricity, eta * sin, 0.0])
    velocity = semi_major_axis * rate * np.array([-sin, eta * cos, 0.0])
    inclined = erfa.rz(-2.2, erfa.rx(-1.7, erfa.rz(-0.4, np.eye(3))))
    return inclined @ position, inclined @ velocity


def texts(values):
    return [repr(float(value)) for value in values]


def tai_text(jd1, jd2):
    year, month, day, (hour, minute, second, fraction) = erfa.d2dtf("TAI", 9, jd1, jd2)
    hour, minute, second, fraction = (int(value) for value in (hour, minute, second, fraction))
    return f"{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{fraction:09}"


def write(name, header, rows):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    (HERE / name).write_text(text.getvalue())


# --- Orekit -------------------------------------------------------------------------------------------------


def orekit():
    import jpype

    orekit_data.begin()
    from java.lang import StringBuilder
    from java.util import ArrayList
    from org.hipparchus.geometry.euclidean.threed import Rotation, RotationConvention, Vector3D
    from org.orekit.data import DataContext
    from org.orekit.files.ccsds.definitions import BodyFacade, FrameFacade, OrbitRelativeFrame, SpacecraftBodyFrame, TimeSystem
    from org.orekit.files.ccsds.ndm import WriterBuilder
    from org.orekit.files.ccsds.ndm.adm import AdmHeader, AttitudeType
    from org.orekit.files.ccsds.ndm.adm.aem import Aem, AemData, AemMetadata, AemSegment
    from org.orekit.files.ccsds.ndm.odm import CartesianCovariance, OdmCommonMetadata, OdmHeader, SpacecraftParameters, StateVector
    from org.orekit.files.ccsds.ndm.odm.oem import InterpolationMethod, Oem, OemData, OemMetadata, OemSegment
    from org.orekit.files.ccsds.ndm.odm.opm import Maneuver, Opm, OpmData
    from org.orekit.files.ccsds.ndm.tdm import AngleType, Observation, ObservationsBlock, ObservationType, Tdm, TdmHeader, TdmMetadata, TrackingMode
    from org.orekit.files.ccsds.section import Segment
    from org.orekit.files.ccsds.utils.generation import KvnGenerator, XmlGenerator
    from org.orekit.frames import FramesFactory
    from org.orekit.time import AbsoluteDate, TimeScalesFactory
    from org.orekit.utils import CartesianDerivativesFilter, IERSConventions, PVCoordinates, TimeStampedAngularCoordinates, TimeStampedPVCoordinates, TimeStampedPVCoordinatesHermiteInterpolator

    tai, utc = TimeScalesFactory.getTAI(), TimeScalesFactory.getUTC()
    gcrf, eme, teme = FramesFactory.getGCRF(), FramesFactory.getEME2000(), FramesFactory.getTEME()
    context, conventions = DataContext.getDefault(), IERSConventions.IERS_2010
    builder = WriterBuilder()

    def vector(values):
        return Vector3D(*(float(value) * 1e3 for value in values))

    def generate(writer, message, notation):
        text = StringBuilder()
        if notation == "kvn":
            generator = KvnGenerator(text, 20, "dummy", math.nan, 60)
        else:
            generator = XmlGenerator(text, 2, "dummy", math.nan, True, XmlGenerator.NDM_XML_V3_SCHEMA_LOCATION)
        writer.writeMessage(generator, message)
        generator.close()
        return str(text)

    def header(kind, version):
        made = kind()
        made.setFormatVersion(version)
        made.setCreationDate(AbsoluteDate(2012, 4, 20, utc))
        made.setOriginator("OREKIT")
        return made

    def pv(date, values):
        position, velocity = values
        return TimeStampedPVCoordinates(date, vector(position), vector(velocity))

    states = []

    def expect(name, frame_pvs):
        for date, got in frame_pvs:
            numbers = [*got.getPosition().toArray(), *got.getVelocity().toArray()]
            states.append([name, str(date.toStringWithoutUtcOffset(tai, 9)), *texts(np.array(numbers) / 1e3)])

    def covariance_at(date, facade):
        covariance = CartesianCovariance(lambda: facade)
        covariance.setEpoch(date)
        matrix = np.diag([4e-4, 9e-4, 1e-4, 4e-10, 1e-10, 9e-10])
        matrix[1, 0] = matrix[0, 1] = 1e-4
        matrix[4, 2] = matrix[2, 4] = -3e-8
        for i in range(6):
            for j in range(i + 1):
                covariance.setCovarianceMatrixEntry(i, j, float(matrix[i, j]) * 1e6)
        return covariance

    def oem(name, notation, frame, system, scale, method, degree, covariances, segments):
        listed = ArrayList()
        for first, last in segments:
            metadata = OemMetadata(4)
            metadata.setObjectName("MANGO")
            metadata.setObjectID("2010-028B")
            metadata.setCenter(BodyFacade("EARTH", None))
            metadata.setReferenceFrame(FrameFacade.map(frame))
            metadata.setTimeSystem(system)
            metadata.setStartTime(START.shiftedBy(float(first)))
            metadata.setStopTime(START.shiftedBy(float(last)))
            metadata.setUseableStartTime(START.shiftedBy(first + 60.0))
            metadata.setUseableStopTime(START.shiftedBy(last - 60.0))
            metadata.setInterpolationMethod(method)
            metadata.setInterpolationDegree(degree)
            data = OemData()
            for seconds in range(first, last + 1, 60):
                data.addData(pv(START.shiftedBy(float(seconds)), kepler(seconds)), False)
            if covariances:
                data.addCovarianceMatrix(covariance_at(START.shiftedBy(first + 120.0), FrameFacade.map(frame)))
            listed.add(OemSegment(metadata, data, GM * 1e9))
        message = Oem(header(OdmHeader, 2.0), listed, conventions, context, GM * 1e9)
        (HERE / name).write_text(generate(builder.buildOemWriter(), message, notation))
        # Orekit's interpolation of the same nodes, turned to GCRF; its reader of a message about the Earth,
        # and so its propagator from a message, need a JPL ephemeris. Its Lagrange polynomial is of the
        # positions.
        is_hermite = method == InterpolationMethod.HERMITE
        points = (degree + 1) // 2 if is_hermite else degree + 1
        interpolator = TimeStampedPVCoordinatesHermiteInterpolator(points, CartesianDerivativesFilter.USE_PV if is_hermite else CartesianDerivativesFilter.USE_P)
        found = []
        for (first, last), segment in zip(segments, listed):
            for k in range(12):
                date = START.shiftedBy(round(first + 60.0 + (last - first - 120.0) * (k + 0.37) / 12, 3))
                interpolated = interpolator.interpolate(date, segment.getData().getCoordinates())
                found.append((date, frame.getTransformTo(gcrf, date).transformPVCoordinates(interpolated)))
        expect(name, found)

    global START
    START = AbsoluteDate(2012, 4, 23, 1, 2, 3.0, tai)
    hermite, lagrange = InterpolationMethod.HERMITE, InterpolationMethod.LAGRANGE
    oem("orekit-hermite.oem", "kvn", eme, TimeSystem.TT, tai, hermite, 7, True, [(0, 1800)])
    oem("orekit-lagrange.oem", "kvn", gcrf, TimeSystem.GPS, tai, lagrange, 7, False, [(0, 1800), (1680, 3600)])
    oem("orekit-hermite.oem.xml", "xml", eme, TimeSystem.UTC, tai, hermite, 5, True, [(0, 1800)])
    oem("orekit-teme.oem", "kvn", teme, TimeSystem.TAI, tai, hermite, 7, False, [(0, 1800)])

    # States in TEME along GCRF.
    rows = []
    for year in range(1992, 2048, 3):
        date = AbsoluteDate(year, 5, 6, 7, 8, 9.5, tai)
        position, velocity = kepler(1000.0 * (year - 1990))
        got = teme.getTransformTo(gcrf, date).transformPVCoordinates(PVCoordinates(vector(position), vector(velocity)))
        rows.append([str(date.toStringWithoutUtcOffset(tai, 9)), *texts([*position, *velocity]), *texts(np.array([*got.getPosition().toArray(), *got.getVelocity().toArray()]) / 1e3)])
    write("teme.csv", ["tai", "teme_x_km", "teme_y_km", "teme_z_km", "teme_vx_km_s", "teme_vy_km_s", "teme_vz_km_s", "x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s"], rows)

    # Parameters: a state with masses, areas and coefficients, a finite burn along R, T, N and an impulse
    # along the axes of the state.
    rtn = FrameFacade(None, None, OrbitRelativeFrame.RTN, None, "RTN")
    rows = []
    for name, notation, frame, system in [("orekit.opm", "kvn", eme, TimeSystem.TT), ("orekit.opm.xml", "xml", gcrf, TimeSystem.UTC)]:
        metadata = OdmCommonMetadata()
        metadata.setObjectName("MANGO")
        metadata.setObjectID("2010-028B")
        metadata.setCenter(BodyFacade("EARTH", None))
        metadata.setReferenceFrame(FrameFacade.map(frame))
        metadata.setTimeSystem(system)
        position, velocity = kepler(1234.5)
        state = StateVector()
        state.setEpoch(START)
        for axis in range(3):
            state.setP(axis, float(position[axis]) * 1e3)
            state.setV(axis, float(velocity[axis]) * 1e3)
        parameters = SpacecraftParameters()
        parameters.setMass(145.0)
        parameters.setSolarRadArea(1.3)
        parameters.setSolarRadCoeff(1.32)
        parameters.setDragArea(1.1)
        parameters.setDragCoeff(2.5)
        manoeuvres = ArrayList()
        for seconds, duration, mass, axes, dv in [(600.0, 12.5, -0.02, rtn, (0.01, -0.2, 0.03)), (1800.0, 0.0, -0.01, FrameFacade.map(frame), (0.1, 0.0, -0.05))]:
            manoeuvre = Maneuver()
            manoeuvre.setEpochIgnition(START.shiftedBy(seconds))
            manoeuvre.setDuration(duration)
            manoeuvre.setDeltaMass(mass)
            manoeuvre.setReferenceFrame(axes)
            for axis in range(3):
                manoeuvre.setDV(axis, dv[axis])
            manoeuvres.add(manoeuvre)
        data = OpmData(state, None, parameters, covariance_at(START, rtn), manoeuvres, None, 145.0)
        listed = ArrayList()
        listed.add(Segment(metadata, data))
        message = Opm(header(OdmHeader, 2.0), listed, conventions, context, GM * 1e9)
        (HERE / name).write_text(generate(builder.buildOpmWriter(), message, notation))
        got = frame.getTransformTo(gcrf, START).transformPVCoordinates(PVCoordinates(vector(position), vector(velocity)))
        numbers = [*got.getPosition().toArray(), *got.getVelocity().toArray()]
        rows.append([name, str(START.toStringWithoutUtcOffset(tai, 9)), *texts(np.array(numbers) / 1e3)])
    write("parameters.csv", ["file", "tai", "x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s"], rows)

    # Attitudes: a slow turn about an axis that is no axis of symmetry.
    attitudes = []
    for name, notation, version, frame_is_a in [("orekit.aem", "kvn", 1.0, True), ("orekit-v2.aem", "kvn", 2.0, True), ("orekit.aem.xml", "xml", 1.0, True), ("orekit-reverse.aem", "kvn", 1.0, False)]:
        metadata = AemMetadata(4)
        metadata.setObjectName("MANGO")
        metadata.setObjectID("2010-028B")
        metadata.setCenter(BodyFacade("EARTH", None))
        body = FrameFacade(None, None, None, SpacecraftBodyFrame(SpacecraftBodyFrame.BaseEquipment.SC_BODY, "1"), "SC_BODY_1")
        ends = metadata.getEndpoints()
        ends.setFrameA(FrameFacade.map(eme) if frame_is_a else body)
        ends.setFrameB(body if frame_is_a else FrameFacade.map(eme))
        ends.setA2b(True)
        metadata.setTimeSystem(TimeSystem.TAI)
        metadata.setAttitudeType(AttitudeType.QUATERNION)
        metadata.setIsFirst(version < 2.0 and notation == "kvn")
        metadata.setStartTime(START)
        metadata.setStopTime(START.shiftedBy(300.0))
        metadata.setInterpolationMethod("LINEAR")
        metadata.setInterpolationDegree(1)
        data = AemData()
        for k in range(31):
            date = START.shiftedBy(10.0 * k)
            rotation = Rotation(Vector3D(0.2, -0.7, 0.4), 0.3 + 0.01 * k, RotationConvention.FRAME_TRANSFORM)
            # Orekit's data are from the celestial frame to the body; its writer turns them round if A is the
            # body.
            data.addData(TimeStampedAngularCoordinates(date, rotation, Vector3D.ZERO, Vector3D.ZERO))
            if k % 7 == 0:
                # Along the body from GCRF: Orekit's rotation from GCRF to EME2000, then the attitude.
                to_eme = gcrf.getTransformTo(eme, date).getRotation()
                axes = [rotation.applyTo(to_eme.applyTo(axis)) for axis in (Vector3D.PLUS_I, Vector3D.PLUS_J, Vector3D.PLUS_K)]
                attitudes.append([name, str(date.toStringWithoutUtcOffset(tai, 9)), *texts([value for axis in axes for value in axis.toArray()])])
        listed = ArrayList()
        listed.add(AemSegment(metadata, data))
        message = Aem(header(AdmHeader, version), listed, conventions, context)
        (HERE / name).write_text(generate(builder.buildAemWriter(), message, notation))
    write("attitudes.csv", ["file", "tai", *(f"{axis}_{body}" for axis in "xyz" for body in ("x", "y", "z"))], attitudes)

    # Angles.
    directions = []
    for name, notation in [("orekit.tdm", "kvn"), ("orekit.tdm.xml", "xml")]:
        metadata = TdmMetadata()
        metadata.setTimeSystem(TimeSystem.UTC)
        metadata.addParticipant(1, "MANGO")
        metadata.addParticipant(2, "TANGO")
        metadata.setMode(TrackingMode.SEQUENTIAL)
        metadata.setPath(jpype.JArray(jpype.JInt)([2, 1]))
        metadata.setAngleType(AngleType.RADEC)
        metadata.setReferenceFrame(FrameFacade.map(eme))
        block = ObservationsBlock()
        for k in range(6):
            date = START.shiftedBy(30.0 * k)
            ascension, declination = 10.0 + 60.0 * k, 80.0 - 31.25 * k
            block.addObservation(Observation(ObservationType.ANGLE_1, date, math.radians(ascension)))
            block.addObservation(Observation(ObservationType.ANGLE_2, date, math.radians(declination)))
            directions.append([name, str(date.toStringWithoutUtcOffset(tai, 9)), *texts([ascension, declination])])
        listed = ArrayList()
        listed.add(Segment(metadata, block))
        message = Tdm(header(TdmHeader, 2.0), listed, conventions, context)
        (HERE / name).write_text(generate(builder.buildTdmWriter(), message, notation))
    write("directions.csv", ["file", "tai", "right_ascension_deg", "declination_deg"], directions)
    return states


# --- oem, SPICE, SGP4 ---------------------------------------------------------------------------------------


def oem_states():
    """An OEM by the package `oem` over the leap second of June 2012, in both notations."""
    from astropy.time import Time, TimeDelta
    from oem import OrbitEphemerisMessage
    from oem.components import EphemerisSegment, HeaderSection, MetaDataSection

    start = Time("2012-06-30T23:50:00", scale="utc")

    def at(seconds):
        return (start.tai + TimeDelta(seconds, format="sec")).utc

    epochs = [at(60.0 * k) for k in range(25)]
    positions, velocities = zip(*(kepler(60.0 * k) for k in range(25)))
    header = HeaderSection({"CCSDS_OEM_VERS": "2.0", "CREATION_DATE": CREATED, "ORIGINATOR": "OEM"})
    rows = []
    for method, suffix in [("HERMITE", "oem"), ("LAGRANGE", "oem.xml")]:
        name = f"oem-{method.lower()}.{suffix}"
        metadata = MetaDataSection(
            {
                "OBJECT_NAME": "TANGO", "OBJECT_ID": "2010-028F", "CENTER_NAME": "EARTH", "REF_FRAME": "EME2000", "TIME_SYSTEM": "UTC",
                "START_TIME": epochs[0].isot, "STOP_TIME": epochs[-1].isot, "INTERPOLATION": method, "INTERPOLATION_DEGREE": "7",
            }
        )
        message = OrbitEphemerisMessage(header, [EphemerisSegment(metadata, (epochs, *zip(*positions), *zip(*velocities)))])
        message.save_as(HERE / name, file_format="xml" if suffix.endswith("xml") else "kvn")
        read = OrbitEphemerisMessage.open(HERE / name)
        bias, _, _ = erfa.bp00(J2000_JD, 0.0)
        for k in range(12):
            # Exact in milliseconds.
            epoch = at(round(1440.0 * (k + 0.37) / 12, 3))
            state = read(epoch)
            rows.append([name, tai_text(epoch.tai.jd1, epoch.tai.jd2), *texts([*(bias.T @ state.position), *(bias.T @ state.velocity)])])
    return rows


def spk():
    """Kernels of five types for the body -200, with the Earth as their centre."""
    states = []
    # 2012-04-23 00:00 TDB.
    start = (2456040.5 - J2000_JD) * 86400.0

    def state(seconds):
        return np.concatenate(kepler(seconds))

    def kernel(name, kind):
        path = HERE / name
        path.unlink(missing_ok=True)
        handle = spice.spkopn(str(path), "golden/flight_dynamics/make.py", 0)
        last = 3600.0
        if kind in (2, 3):
            step, degree = 300.0, 11
            nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
            records = []
            for index in range(int(last / step)):
                values = np.array([state(step * (index + 0.5 + 0.5 * node)) for node in nodes])
                fit = np.polynomial.chebyshev.chebfit(nodes, values, degree).T
                records.append(fit[: 3 if kind == 2 else 6].ravel())
            writer = spice.spkw02 if kind == 2 else spice.spkw03
            writer(handle, -200, 399, "J2000", start, start + last, "TEST", step, len(records), degree, np.concatenate(records), start)
        elif kind == 8:
            step, count = 30.0, 121
            spice.spkw08(handle, -200, 399, "J2000", start, start + last, "TEST", 7, count, np.array([state(step * k) for k in range(count)]), start, step)
        else:
            times = np.array([30.0 * k + 4.0 * math.sin(k) * (0 < k < 120) for k in range(121)])
            writer = spice.spkw09 if kind == 9 else spice.spkw13
            writer(handle, -200, 399, "J2000", start, start + last, "TEST", 7, len(times), np.array([state(time) for time in times]), start + times)
        spice.spkcls(handle)
        spice.furnsh(str(path))
        for k in range(12):
            # Sixteenths of a second, which a number of 64 bits resolves exactly.
            et = start + round(16 * last * (k + 0.37) / 12) / 16
            found, _ = spice.spkgeo(-200, et, "J2000", 399)
            # TDB to TT by the terms of Circular 179, those of Boresight: 10 us are 75 mm on this orbit, and
            # the subject here is the interpolation.
            t = et / (36525 * 86400)
            tt = et - (0.001657 * math.sin(628.3076 * t + 6.2401) + 0.000022 * math.sin(575.3385 * t + 4.2970) + 0.000014 * math.sin(1256.6152 * t + 6.1969)
                       + 0.000005 * math.sin(606.9777 * t + 4.0212) + 0.000005 * math.sin(52.9691 * t + 0.4444) + 0.000002 * math.sin(21.3299 * t + 5.5431)
                       + 0.000010 * t * math.sin(628.3076 * t + 4.2490))
            tai = tt - 32.184
            days = math.floor(tai / 86400)
            states.append([name, tai_text(J2000_JD + days, (tai - 86400 * days) / 86400), *texts(found)])
        spice.unload(str(path))

    for kind in (2, 3, 8, 9, 13):
        kernel(f"spice-type{kind}.bsp", kind)
    return states


def tle():
    from sgp4.api import Satrec, WGS72

    rows = []
    for name, text in [("test.tle", TLE), ("deep.tle", TLE_DEEP)]:
        (HERE / name).write_text(text)
        satellite = Satrec.twoline2rv(*text.splitlines()[-2:], WGS72)
        for k in range(-4, 9):
            minutes = 777.0 * k
            error, position, velocity = satellite.sgp4_tsince(minutes)
            assert error == 0
            jd1, jd2 = satellite.jdsatepoch, satellite.jdsatepochF + minutes / 1440
            tai1, tai2 = erfa.utctai(jd1, jd2)
            tt1, tt2 = erfa.taitt(tai1, tai2)
            psi, epsilon = erfa.nut80(tt1, tt2)
            obliquity = erfa.obl80(tt1, tt2)
            tod_from_teme = erfa.rz(-psi * math.cos(obliquity), np.eye(3))
            mod_from_tod = erfa.numat(obliquity, psi, epsilon).T
            mean_from_mod = erfa.pmat76(tt1, tt2).T
            bias, _, _ = erfa.bp00(tt1, tt2)
            matrix = bias.T @ mean_from_mod @ mod_from_tod @ tod_from_teme
            rows.append([name, tai_text(tai1, tai2), *texts([*(matrix @ position), *(matrix @ velocity)])])
    write("tle.csv", ["file", "tai", "x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s"], rows)


def main():
    arguments = manifest.begin()
    states = orekit() + oem_states() + spk()
    write("states.csv", ["file", "tai", "x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s"], states)
    tle()
    for path in sorted(HERE.iterdir()):
        if path.is_file():
            manifest.record(path, arguments.reason)


if __name__ == "__main__":
    main()
