//! Draws pictures that are no longer stored, or never were: frame N can be drawn independently of the other
//! frames of the run.
use files::Failure;

use super::Session;
use crate::feed::{Feed, MonitorContext};

/// Draws ordered pictures until the monitor is closed.
///
/// # Errors
/// A [`Failure`] when a frame cannot be made.
pub(crate) fn paint(feed: &Feed, context: &MonitorContext, session: &Session) -> Result<(), Failure> {
    feed.world.paint(context, &|draw| {
        while let Some(order) = session.next_order() {
            let picture = draw(&order)?;
            session.deliver(order, picture);
        }
        Ok(())
    })
}
