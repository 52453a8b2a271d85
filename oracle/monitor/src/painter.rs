//! Draws a picture again that is not kept any more, or never was: frame N alone is the frame N of the run.
use axum::body::Bytes;
use files::Failure;
use run::World as _;

use super::feed::{Feed, Surroundings};
use super::session::{Order, Session};

/// Draws what is ordered, until the monitor is closed.
///
/// # Errors
/// A [`Failure`] when a frame cannot be made.
pub(super) fn paint(feed: &Feed, surroundings: &Surroundings, session: &Session) -> Result<(), Failure> {
    match feed {
        Feed::FarRange(prepared, _) => {
            let mut camera = prepared.simulator().camera()?;
            serve(session, |order| Ok(surroundings.stretch.picture(&camera.expose(order.frame)?.frame)))
        }
        Feed::Docking(prepared, _) => {
            let simulator = prepared.simulator();
            let mut workspace = simulator.workspace()?;
            serve(session, |order| {
                let exposure =
                    prepared.renderer().expose(simulator, prepared.setup(), &mut workspace, order.frame)?;
                Ok(surroundings.stretch.picture(exposure.video.digitise(&order.digitiser).image()))
            })
        }
    }
}

fn serve(session: &Session, mut draw: impl FnMut(&Order) -> Result<Bytes, Failure>) -> Result<(), Failure> {
    while let Some(order) = session.next_order() {
        let picture = draw(&order)?;
        session.deliver(order, picture);
    }
    Ok(())
}
