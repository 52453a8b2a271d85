"""The plain frame in other simulators, each in the way that its own documentation recommends.

A simulator is a function from the number of a frame to its digital numbers (rows, columns). All draw the
stars anew in each frame, as Boresight does; what does not change from frame to frame is made before, outside
of the time.
"""

import galsim
import getframes
import numpy as np
import pyxel
from getframes.noise import DetectorWorkspace
from getframes.scene.sources import Catalog
from pyxel.detectors import CCD, CCDGeometry, Characteristics, ChargeToVoltSettings, Environment
from pyxel.exposure import Exposure, Readout
from pyxel.models.charge_collection import simple_collection
from pyxel.models.charge_generation import simple_conversion
from pyxel.models.charge_measurement import output_node_noise, simple_measurement
from pyxel.models.photon_collection import shot_noise
from pyxel.models.readout_electronics import simple_adc
from pyxel.pipelines import DetectionPipeline, ModelFunction
from scipy.special import erf

FWHM_PER_SIGMA = 2.0 * np.sqrt(2.0 * np.log(2.0))


class Scene:
    """Numbers of the plain frame, as the example frame_speed prints them."""

    def __init__(self, told):
        self.shape = (told["rows"], told["columns"])
        self.sigma_px = told["sigma_px"]
        self.exposure_s = told["exposure_s"]
        self.sensor = told["sensor"]
        self.x, self.y, self.electrons = np.array(told["stars_x_px_y_px_electrons"]).T
        self.sky_e = self.sensor["background_e_per_s"] * self.exposure_s
        self.dark_e = self.sensor["dark_current_e_per_s"] * self.exposure_s
        self.gain = self.sensor["gain_e_per_dn"]
        self.bias = self.sensor["bias_dn"]
        self.read_e = self.sensor["read_noise_e"]
        self.well_e = self.sensor["full_well_e"]
        self.full_scale = 2 ** self.sensor["bit_depth"] - 1

    def star_map(self, reach_sigmas=6.0):
        """Expected electrons of the stars: Gaussians integrated over each pixel, all stars at once, in
        separable parts."""
        half = int(np.ceil(reach_sigmas * self.sigma_px)) + 1
        span = np.arange(-half, half + 1)
        ix, iy = np.rint(self.x).astype(int), np.rint(self.y).astype(int)

        def shares(centre, first):
            edges = np.arange(-half, half + 2)[None, :] - 0.5 + (first - centre)[:, None]
            return np.diff(0.5 * erf(edges / (self.sigma_px * np.sqrt(2.0))), axis=1)

        stamps = shares(self.y, iy)[:, :, None] * (self.electrons[:, None] * shares(self.x, ix))[:, None, :]
        padded = np.zeros((self.shape[0] + 2 * half, self.shape[1] + 2 * half))
        rows, columns = iy[:, None] + half + span, ix[:, None] + half + span
        np.add.at(padded, (rows[:, :, None], columns[:, None, :]), stamps)
        return padded[half:-half, half:-half]

    def digitise(self, electrons):
        """The converter: rounds and clips, in place."""
        electrons /= self.gain
        electrons += self.bias + 0.5
        np.clip(electrons, 0, self.full_scale, out=electrons)
        return electrons.astype(np.uint16)


def numpy_double(scene):
    generator = np.random.default_rng(1)

    def frame(_):
        mean = scene.star_map()
        mean += scene.sky_e + scene.dark_e
        electrons = generator.poisson(mean).astype(float)
        np.minimum(electrons, scene.well_e, out=electrons)
        electrons += generator.normal(0.0, scene.read_e, scene.shape)
        return scene.digitise(electrons)

    return frame


def numpy_fast(scene):
    """Numpy's fastest generator, normal numbers in single precision, Poisson numbers of one mean away from
    stars."""
    generator = np.random.Generator(np.random.SFC64(1))

    def frame(_):
        stars = scene.star_map()
        electrons = generator.poisson(scene.sky_e + scene.dark_e, scene.shape).astype(np.float32)
        lit = stars > 0.0
        electrons[lit] += generator.poisson(stars[lit])
        np.minimum(electrons, scene.well_e, out=electrons)
        noise = generator.standard_normal(scene.shape, dtype=np.float32)
        noise *= np.float32(scene.read_e)
        electrons += noise
        return scene.digitise(electrons)

    return frame


def getframes_parts(scene, precision):
    config = getframes.CameraConfig(
        name="plain",
        sensor_type=getframes.SensorType.CCD,
        resolution=scene.shape,
        pixel_size_um=8.6,
        quantum_efficiency=1.0,
        full_well_e=scene.well_e,
        bit_depth=scene.sensor["bit_depth"],
        gain_e_per_adu=scene.gain,
        bias_offset_adu=scene.bias,
        read_noise_e=scene.read_e,
        dark_current_e_per_s=scene.dark_e / scene.exposure_s,
    )
    camera = getframes.Camera(config, default_temperature_c=config.dark_current_ref_temp_c, precision=precision)
    table = {"x": scene.x, "y": scene.y, "rate": scene.electrons / scene.exposure_s}
    stars = Catalog.from_table(table, photon_rate="rate", x="x", y="y")
    flat = getframes.UniformIllumination(photon_rate=scene.sky_e / scene.exposure_s)
    return camera, [stars], flat


def getframes_default(scene):
    camera, stars, flat = getframes_parts(scene, "double")
    sky = getframes.Scene(
        shape=scene.shape,
        optics=getframes.Telescope.unit(),
        psf=getframes.GaussianPSF(fwhm_arcsec=FWHM_PER_SIGMA * scene.sigma_px),
        sources=[*stars, flat],
    )
    return lambda number: camera.observe(sky, exposure=scene.exposure_s, seed=number).data


def getframes_fast(scene):
    """Single precision, no truth, one workspace and one image for all frames."""
    camera, stars, flat = getframes_parts(scene, "single")
    sky = getframes.Scene(
        shape=scene.shape,
        optics=getframes.Telescope.unit(),
        psf=getframes.GaussianPSF(fwhm_arcsec=FWHM_PER_SIGMA * scene.sigma_px),
        sources=stars,
    )
    workspace, image = DetectorWorkspace(), np.empty(scene.shape, dtype=np.uint32)

    def frame(number):
        rate = sky.photon_rate_map(precision="single")
        return camera.expose(
            rate,
            scene.exposure_s,
            background=flat.photon_rate,
            seed=number,
            include_truth=False,
            workspace=workspace,
            out=image,
        ).data

    return frame


def galsim_frame(scene, method):
    """Stamps of 13 pixels for the stars, then CCDNoise; `method` is drawImage's."""
    stars = [
        (galsim.Gaussian(sigma=scene.sigma_px, flux=electrons), galsim.PositionD(x + 1.0, y + 1.0))
        for x, y, electrons in zip(scene.x, scene.y, scene.electrons)
    ]
    bounds = galsim.BoundsI(1, scene.shape[1], 1, scene.shape[0])
    half = 6

    def frame(number):
        generator = galsim.BaseDeviate(number + 1)
        image = galsim.ImageF(bounds, init_value=0.0)
        for star, centre in stars:
            ix, iy = round(centre.x), round(centre.y)
            stamp = image[galsim.BoundsI(ix - half, ix + half, iy - half, iy + half) & bounds]
            star.drawImage(image=stamp, method=method, center=centre, scale=1.0, add_to_image=True)
        image += scene.sky_e + scene.dark_e
        image.addNoise(galsim.CCDNoise(generator, gain=1.0, read_noise=scene.read_e))
        return scene.digitise(image.array)

    return frame


def galsim_integrated(scene):
    return galsim_frame(scene, "auto")


def galsim_sampled(scene):
    return galsim_frame(scene, "no_pixel")


VOLT_PER_E = 1e-6


def pyxel_detector(scene):
    # The converter truncates: half a digital number is in the lower end of its range.
    low = -(scene.bias + 0.5) * scene.gain * VOLT_PER_E
    detector = CCD(
        geometry=CCDGeometry(row=scene.shape[0], col=scene.shape[1]),
        environment=Environment(temperature=293.0),
        characteristics=Characteristics(
            quantum_efficiency=1.0,
            charge_to_volt=ChargeToVoltSettings(value=VOLT_PER_E),
            pre_amplification=1.0,
            full_well_capacity=scene.well_e,
            adc_bit_resolution=scene.sensor["bit_depth"],
            adc_voltage_range=(low, low + scene.full_scale * scene.gain * VOLT_PER_E),
        ),
    )
    return detector


def light(detector, scene):
    """A model for Pyxel's pipeline: the expected photons of the plain frame."""
    detector.photon.array = scene.star_map() + scene.sky_e


def pyxel_models(scene):
    """Pyxel's models called in sequence without its pipeline, with the dark current in the mean signal: one
    Poisson number a pixel instead of two, with equal distribution."""
    detector = pyxel_detector(scene)
    readout = Readout(times=[scene.exposure_s])
    detector.set_readout(times=readout.times, start_time=0.0, non_destructive=False)

    def frame(number):
        np.random.seed(number)
        detector.empty()
        detector.time, detector.time_step = scene.exposure_s, scene.exposure_s
        detector.photon.array = scene.star_map() + (scene.sky_e + scene.dark_e)
        shot_noise(detector)
        simple_conversion(detector, binomial_sampling=False)
        simple_collection(detector)
        simple_measurement(detector)
        output_node_noise(detector, std_deviation=scene.read_e * VOLT_PER_E)
        simple_adc(detector)
        return detector.image.array

    return frame


def pyxel_pipeline(scene):
    """Pyxel as its users run it: a detector, a pipeline of models, one exposure."""
    detector = pyxel_detector(scene)
    models = "pyxel.models."

    def model(path, **arguments):
        return ModelFunction(func=models + path, name=path.rsplit(".", 1)[1], arguments=arguments)

    pipeline = DetectionPipeline(
        photon_collection=[
            ModelFunction(func=f"{__name__}.light", name="light", arguments={"scene": scene}),
            model("photon_collection.shot_noise"),
        ],
        charge_generation=[
            model("charge_generation.simple_conversion", binomial_sampling=False),
            model("charge_generation.simple_dark_current", dark_rate=scene.dark_e / scene.exposure_s),
        ],
        charge_collection=[model("charge_collection.simple_collection")],
        charge_measurement=[
            model("charge_measurement.simple_measurement"),
            model("charge_measurement.output_node_noise", std_deviation=scene.read_e * VOLT_PER_E),
        ],
        readout_electronics=[model("readout_electronics.simple_adc")],
    )
    exposure = Exposure(readout=Readout(times=[scene.exposure_s]))

    def frame(number):
        np.random.seed(number)
        pyxel.run_mode(mode=exposure, detector=detector, pipeline=pipeline)
        return detector.image.array

    return frame


# Name in the table, function that makes frames, True if the expected image is ours.
SIMULATORS = [
    ("numpy: `default_rng`, double precision", numpy_double, True),
    ("numpy: SFC64, single precision, one mean for the background", numpy_fast, True),
    ("getframes 2.6: `Camera.observe`", getframes_default, True),
    ("getframes 2.6: single precision, workspace, no truth", getframes_fast, True),
    ("GalSim 2.8: stars integrated over pixels (FFT)", galsim_integrated, True),
    ("GalSim 2.8: stars sampled at centres (`no_pixel`)", galsim_sampled, False),
    ("Pyxel 3: its models alone, dark current in the light", pyxel_models, True),
    ("Pyxel 3: `pyxel.run_mode`", pyxel_pipeline, True),
]
