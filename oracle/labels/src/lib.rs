//! Labels of images in the formats of machine learning: COCO, SPEED, BOP and YOLO.
//!
//! A world states, for all frames, the classes of its objects and its cameras ([`LabelSet`]), and for each
//! frame the objects in it: masks, keypoints, pose ([`FrameLabels`]). [`LabelWriter`] turns these into files.
//! No file is read here. The conventions of each format are in `docs/labels.md`.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod bop;
mod coco;
mod format;
mod frame;
mod json_file;
mod label_set;
mod speed;
mod writer;
mod yolo;

pub use format::{LabelFormat, LabelFormats};
pub use frame::{FrameLabels, KeypointLabel, ObjectLabel, ObjectPose, Visibility};
pub use label_set::{ImageCamera, LabelClass, LabelSet, LabelView, ModelExtent, RowSampling};
pub use writer::{LabelCounts, LabelImages, LabelWriter};
