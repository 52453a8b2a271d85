//! Hot pixels belong to the detector: their positions are the same in every frame.

use boresight_sim::truth::ObjectKind;

use crate::small_scene::{simulator, still};

#[test]
fn hot_pixels_keep_their_positions_in_frames_seconds_and_minutes_apart() {
    let simulator = simulator(&still());
    let mut camera = simulator.camera().unwrap();
    let mut positions = |frame| {
        let objects = camera.expose(frame).unwrap().objects;
        let hot = objects.into_iter().filter(|object| object.kind == ObjectKind::HotPixel);
        hot.map(|object| (object.id, object.position)).collect::<Vec<_>>()
    };
    // Frames are a quarter of a second apart.
    let first = positions(0);
    assert_eq!(first.len(), 12);
    for frame in [1, 30, 61, 999] {
        assert_eq!(positions(frame), first, "frame {frame}");
    }
    // The numbers count pixels row by row.
    let is_its_position = |(id, at): &(u32, contract::PixelPoint)| f64::from(*id) == 160.0 * at.y + at.x;
    assert!(first.iter().all(is_its_position), "{first:?}");
}
