//! Documents that the page receives once: the scenario, its cameras, the plan, and the facets of the scene.
use axum::body::Bytes;
use contract::Camera;
use files::Failure;
use serde_json::{Value, json};

use crate::feed::{Feed, MonitorContext};

/// The constant documents.
#[derive(Debug, Clone)]
pub(crate) struct Overview {
    pub(crate) session: Bytes,
    pub(crate) scene: Bytes,
}

impl Overview {
    pub(crate) fn from_feed(feed: &Feed, context: &MonitorContext) -> Result<Self, Failure> {
        let [session, scene] = feed.world.overview(&feed.measurements, context)?;
        Ok(Self { session: bytes(&session)?, scene: bytes(&scene)? })
    }
}

/// Returns the geometry of a camera as the page reads it.
pub fn camera(name: &str, camera: &Camera) -> Value {
    let (focal_x_px, focal_y_px) = camera.focal_length_px();
    json!({
        "name": name,
        "columns": camera.columns,
        "rows": camera.rows,
        "focal_x_px": focal_x_px,
        "focal_y_px": focal_y_px,
        "principal_x_px": camera.principal_x_px,
        "principal_y_px": camera.principal_y_px,
    })
}

fn bytes(document: &Value) -> Result<Bytes, Failure> {
    serde_json::to_vec(document)
        .map(Bytes::from)
        .map_err(|error| Failure::Usage(format!("the session cannot be written as JSON: {error}")))
}
