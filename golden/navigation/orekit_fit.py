#!/usr/bin/env python3
"""Makes a second reference for relative navigation: the orbit of make.py's lines of sight by Orekit 13.1.

Orekit integrates the target by its DOP853 with the acceleration of J2 and the variational equations, and its
BatchLSEstimator (Gauss-Newton by QR decomposition) finds the target's Cartesian state and three constant rotations
of the camera. Orekit has no angles between two satellites, so this script adds the measurement: two angles in the
axes of the camera, as in make.py, and the expected rotations (zero with their standard deviation) as one more
measurement. The chaser at a measurement is integrated by Orekit from the nearest state of chaser.csv on the same
side of the manoeuvres.

    pip install -r golden/navigation/requirements.txt
    python3 golden/navigation/orekit_fit.py --reason "why"

Needs Java 11 or later. orekit.csv: position of the chaser along the target's R, T, N, m, and its standard
deviation, as in estimates.csv.
"""

import csv
import pathlib
import sys

import numpy as np
import orekit_jpype

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]
import make  # noqa: E402
import manifest  # noqa: E402

orekit_jpype.initVM()
import jpype  # noqa: E402
from java.util import ArrayList  # noqa: E402
from org.hipparchus.geometry.euclidean.threed import Vector3D  # noqa: E402
from org.hipparchus.linear import QRDecomposer  # noqa: E402
from org.hipparchus.optim.nonlinear.vector.leastsquares import GaussNewtonOptimizer  # noqa: E402
from org.orekit.estimation.leastsquares import BatchLSEstimator  # noqa: E402
from org.orekit.estimation.measurements import EstimatedMeasurement, ObservableSatellite  # noqa: E402
from org.orekit.forces.gravity import J2OnlyPerturbation  # noqa: E402
from org.orekit.frames import FramesFactory  # noqa: E402
from org.orekit.orbits import CartesianOrbit, PositionAngleType  # noqa: E402
from org.orekit.propagation.conversion import (  # noqa: E402
    DormandPrince853IntegratorBuilder, NumericalPropagatorBuilder)
from org.orekit.time import AbsoluteDate  # noqa: E402
from org.orekit.utils import PVCoordinates, ParameterDriver, TimeStampedPVCoordinates  # noqa: E402

FRAME, EPOCH, MU = FramesFactory.getGCRF(), AbsoluteDate.J2000_EPOCH, make.GM * 1e9
SATELLITE = ObservableSatellite(0)
ROTATIONS = [ParameterDriver(f"rotation-{axis}", 0.0, make.CONSTANT, -1.0, 1.0) for axis in "xyz"]
for driver in ROTATIONS:
    driver.setSelected(True)


def table(name):
    with open(HERE / name) as file:
        return np.array([[float(value) for value in row] for row in list(csv.reader(file))[1:]])


def builder(state_km, date):
    """Orekit's builder of a propagator with J2 from a state, km and km/s."""
    pv = PVCoordinates(*(Vector3D(*(float(x) * 1e3 for x in part)) for part in (state_km[:3], state_km[3:])))
    integrator = DormandPrince853IntegratorBuilder(1e-3, 60.0, 1e-6)
    made = NumericalPropagatorBuilder(CartesianOrbit(pv, FRAME, date, MU), integrator, PositionAngleType.TRUE, 10.0)
    made.addForceModel(J2OnlyPerturbation(MU, make.RADIUS * 1e3, make.J2, FRAME))
    return made


def state_km(pv):
    return np.array([*pv.getPosition().toArray(), *pv.getVelocity().toArray()]) * 1e-3


def propagated(start_km, start_s, seconds):
    """States at times in order, km and km/s."""
    propagator = builder(start_km, EPOCH.shiftedBy(float(start_s))).buildPropagator()
    return np.array([state_km(propagator.getPVCoordinates(EPOCH.shiftedBy(float(t)), FRAME)) for t in seconds])


def chaser_at(seconds, states):
    """The chaser's states at times, from the nearest reported state on the same side of the manoeuvres."""
    bounds = [time for time, _ in make.MANOEUVRES]
    out = []
    for t in seconds:
        same = np.searchsorted(bounds, states[:, 0], "right") == np.searchsorted(bounds, t, "right")
        near = states[same][np.argmin(abs(states[same][:, 0] - t))]
        out.append(propagated(near[1:], near[0], [t])[0])
    return np.array(out)


@jpype.JImplements("org.orekit.estimation.measurements.ObservedMeasurement")
class Measurement:
    """Values with standard deviations, predicted by a function of the target's position, m, and the rotations,
    which returns the prediction and its derivatives by both."""

    def __init__(self, seconds, observed, sigma, predict):
        self.date, self.predict = EPOCH.shiftedBy(float(seconds)), predict
        self.observed = jpype.JArray(jpype.JDouble)(np.asarray(observed, float))
        self.sigma = jpype.JArray(jpype.JDouble)(np.asarray(sigma, float))
        self.enabled = True
        self.satellites, self.drivers = ArrayList(), ArrayList()
        self.satellites.add(SATELLITE)
        for driver in ROTATIONS:
            self.drivers.add(driver)

    def evaluate(self, iteration, count, states, with_derivatives):
        pv = TimeStampedPVCoordinates(states[0].getDate(), states[0].getPVCoordinates(FRAME))
        position = np.array(pv.getPosition().toArray())
        rotation = np.array([driver.getValue() for driver in ROTATIONS])
        value, by_position, by_rotation = self.predict(position, rotation)
        estimated = EstimatedMeasurement(self, iteration, count, states, [pv])
        estimated.setEstimatedValue(*map(float, value))
        if with_derivatives:
            by_state = np.hstack([by_position, np.zeros((len(value), 3))])
            estimated.setStateDerivatives(0, jpype.JArray(jpype.JDouble, 2)(by_state.tolist()))
            for k, driver in enumerate(ROTATIONS):
                column = jpype.JArray(jpype.JDouble)(by_rotation[:, k].tolist())
                estimated.setParameterDerivatives(driver, self.date, column)
        return estimated

    @jpype.JOverride
    def estimate(self, iteration, count, states):
        return self.evaluate(iteration, count, states, True)

    @jpype.JOverride
    def estimateWithoutDerivatives(self, *arguments):
        iteration, count, states = arguments if len(arguments) == 3 else (0, 0, arguments[0])
        return self.evaluate(iteration, count, states, False)

    @jpype.JOverride
    def getDate(self):
        return self.date

    @jpype.JOverride
    def compareTo(self, other):
        # Orekit keeps measurements in a sorted set: equal dates must not make two equal.
        order = self.date.compareTo(other.getDate())
        return order if order or self.equals(other) else (1 if self.getDimension() > other.getDimension() else -1)

    @jpype.JOverride
    def equals(self, other):
        return bool(self.hashCode() == other.hashCode())

    @jpype.JOverride
    def hashCode(self):
        return id(self) & 0x7FFFFFFF

    @jpype.JOverride
    def getObservedValue(self):
        return self.observed

    @jpype.JOverride
    def setObservedValue(self, values):
        self.observed = values

    @jpype.JOverride
    def setEnabled(self, enabled):
        self.enabled = enabled

    @jpype.JOverride
    def isEnabled(self):
        return self.enabled

    @jpype.JOverride
    def getDimension(self):
        return len(self.observed)

    @jpype.JOverride
    def getTheoreticalStandardDeviation(self):
        return self.sigma

    @jpype.JOverride
    def getBaseWeight(self):
        return jpype.JArray(jpype.JDouble)([1.0] * len(self.observed))

    @jpype.JOverride
    def addModifier(self, modifier):
        raise NotImplementedError

    @jpype.JOverride
    def getModifiers(self):
        return ArrayList()

    @jpype.JOverride
    def getSatellites(self):
        return self.satellites

    @jpype.JOverride
    def getParametersDrivers(self):
        return self.drivers

    @jpype.JOverride
    def getMeasurementType(self):
        return "Angles"


def sight(seconds, observed, camera, chaser_m):
    """A line of sight: atan2(X, Z) and atan2(Y, Z) in the axes of the camera."""

    def predict(position, rotation):
        d = camera @ (position - chaser_m)
        x, y, z = turned = d + np.cross(rotation, d)
        by_turned = np.array([[z / (x * x + z * z), 0, -x / (x * x + z * z)],
                              [0, z / (y * y + z * z), -y / (y * y + z * z)]])
        by_d = by_turned @ (np.eye(3) + np.array([[0, -rotation[2], rotation[1]], [rotation[2], 0, -rotation[0]],
                                                  [-rotation[1], rotation[0], 0]]))
        by_rotation = by_turned @ -np.array([[0, -d[2], d[1]], [d[2], 0, -d[0]], [-d[1], d[0], 0]])
        return make.angles(turned[None])[0], by_d @ camera, by_rotation

    return Measurement(seconds, observed, [make.WHITE] * 2, predict)


def expected_rotations(seconds):
    def predict(_, rotation):
        return rotation, np.zeros((3, 3)), np.eye(3)

    return Measurement(seconds, np.zeros(3), [make.CONSTANT] * 3, predict)


def main():
    arguments = manifest.begin()
    sights, states = table("sights.csv"), table("chaser.csv")
    cameras = sights[:, 4:].reshape(-1, 3, 3)
    observed = make.angles(np.einsum("kij,kj->ki", cameras, sights[:, 1:4]))
    chaser = chaser_at(sights[:, 0], states)
    # The chaser 15 km back on its orbit: an orbit that is wrong by some hundred metres.
    start = propagated(states[0, 1:], 0.0, [15.0 / 7.48])[0]
    propagator = builder(start, EPOCH)
    estimator = BatchLSEstimator(GaussNewtonOptimizer(QRDecomposer(1e-14), False), propagator)
    for row, camera, angle, position in zip(sights, cameras, observed, chaser[:, :3] * 1e3):
        estimator.addMeasurement(sight(row[0], angle, camera, position))
    estimator.addMeasurement(expected_rotations(sights[0, 0] - 60.0))
    estimator.setParametersConvergenceThreshold(1e-6)
    estimator.setMaxIterations(40)
    estimator.setMaxEvaluations(40)
    orbit = estimator.estimate()[0].getInitialState()
    estimated = state_km(orbit.getPVCoordinates(FRAME))
    print("iterations", estimator.getIterationsCount(), "rms", estimator.getOptimum().getRMS())
    covariance = np.array([list(row) for row in estimator.getPhysicalCovariances(1e-30).getData()])[:6, :6]
    covariance *= 1e-6  # m to km
    epochs = make.EPOCHS
    own = chaser_at(epochs, states)

    def at(y):
        return np.array([make.relative(c, t) for c, t in zip(own, propagated(y, 0.0, epochs))])

    centre, step = at(estimated), np.array([1e-3] * 3 + [1e-6] * 3)
    slopes = np.array([(at(estimated + d) - at(estimated - d)) / (2 * h) for d, h in zip(np.diag(step), step)])
    sigma = np.sqrt(np.einsum("iek,ij,jek->ek", slopes, covariance, slopes))
    scipy = table("estimates.csv")
    print("minus SciPy / sigma", (centre - scipy[:, 1:4]) / sigma, "sigma", sigma, "ratio", sigma / scipy[:, 4:7],
          "error / sigma", (centre - scipy[:, 7:10]) / sigma, sep="\n")
    path = HERE / "orekit.csv"
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow("seconds,r_m,t_m,n_m,sigma_r_m,sigma_t_m,sigma_n_m".split(","))
        writer.writerows([[f"{x:.17g}" for x in row] for row in np.column_stack([epochs, centre, sigma])])
    manifest.record(path, arguments.reason)


if __name__ == "__main__":
    main()
