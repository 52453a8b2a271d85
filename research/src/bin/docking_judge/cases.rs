//! Random poses and Sun directions for a range and a lens.

use contract::Camera;
use contract::docking::Pose;
use draws::Effect;
use sim::SimError;
use sim::docking::DockingSimulator;
use sim::mitsuba::Crop;
use sim::truth::approach::target_from_camera;

use boresight_research::docking_random::still::{NOISE_DN, Row};
use boresight_research::docking_random::{camera, random_sun};

/// Maximum lateral offset, as a fraction of d3, and maximum angles, degrees.
const OFFSET: f64 = 0.02;
const ANGLE_DEG: f64 = 2.0;
/// Half the side of the square about the disk's centre that Mitsuba renders, m: the disk's radius is 0.3 m,
/// and the cross, which stands off by 0.3 m, is seen in front of the disk.
const HALF_SIDE_M: f64 = 0.36;

/// Rows of the table.
pub(crate) const ROWS: [Row; 5] = [
    Row::narrow("narrow-20m", 20.0),
    Row::narrow("narrow-10m", 10.0),
    Row::narrow("narrow-5m", 5.0),
    Row::wide("wide-5m", 5.0),
    Row::wide("wide-2m", 2.0),
];

/// One frame: a pose, a Sun direction, and independent noise.
pub(crate) struct Case {
    pub(crate) camera: Camera,
    pub(crate) pose: Pose,
    pub(crate) simulator: DockingSimulator,
    focal_px: f64,
}

impl Case {
    /// Draws the pose with this number: lateral offsets and angles are uniform within their limits, the Sun
    /// is uniform over the cap about the face's normal.
    pub(crate) fn random(row: &Row, seed: u64, number: u64) -> Result<Self, SimError> {
        let mut stream = row.seed(seed).stream(number, Effect::AttitudeControl, 0);
        let pose = row.random_pose(OFFSET, ANGLE_DEG, &mut stream);
        let sun = random_sun(&mut stream);
        let camera = camera(row.focal_px);
        let simulator = row.simulator(&camera, &pose, sun, NOISE_DN, (seed, number))?;
        Ok(Self { camera, pose, simulator, focal_px: row.focal_px })
    }

    /// Square about the disk, clipped to the image.
    pub(crate) fn target_window(&self) -> Crop {
        let centre = target_from_camera(&self.pose).transpose() * -self.pose.position_m;
        let half_px = self.focal_px * HALF_SIDE_M / centre.z;
        let span = |principal: f64, offset: f64, side: usize| {
            let middle = principal + 0.5 + self.focal_px * offset / centre.z;
            let low = (middle - half_px).round().max(0.0) as usize;
            let high = ((middle + half_px).round().max(0.0) as usize).min(side);
            (low, high.saturating_sub(low))
        };
        let (x, columns) = span(self.camera.principal_x_px, centre.x, self.camera.columns);
        let (y, rows) = span(self.camera.principal_y_px, centre.y, self.camera.rows);
        Crop { x, y, columns, rows }
    }
}
