//! The simulated twin of a camera, from frames of the night sky.
//!
//! 1. [`FrameSet`]: frames with the camera that was fitted to them.
//! 2. [`TwinCamera`]: detector, optics and brightness scale with which the simulator makes such frames, and
//!    the
//!    file of the camera.
//! 3. [`scenario_text`] and [`pointings`]: a scenario that flies the pointings of the frames.
//! 4. [`twin_frames`]: the frames of a scenario.
//! 5. [`likeness`]: the differences of two sets of frames, with intervals.

mod camera_file;
mod frame_set;
pub mod likeness;
mod scenario;
mod twin_camera;
mod twin_frames;

pub use camera_file::{Origin, camera_toml};
pub use frame_set::FrameSet;
pub use scenario::{pointings, scenario_text};
pub use twin_camera::{MeasuredSensor, TwinCamera};
pub use twin_frames::twin_frames;
