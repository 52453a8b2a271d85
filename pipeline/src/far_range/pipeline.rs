//! Paper mode: sequence of its steps, and its state between frames.

use contract::{
    AttitudeSource, Body, CameraFrame, Cluster, Frame, Icrs, Label, ListedStar, Measurement, NoSolution,
    Outcome, PixelPoint, Rotation, Setup, Solution, Telemetry,
};
use hifitime::Epoch;

use super::aberration::aberration_correction;
use super::attitude::{MountingFilter, StarPair, solve_q_method};
use super::background::BackgroundEstimator;
use super::config::{AberrationConfig, FarRangeConfig};
use super::detect::{Blob, Detector, Weights, transmitted_pixels};
use super::hotspots::Hotspots;
use super::identify::{StarList, identify};
use super::line_of_sight::line_of_sight;
use super::motion::{ClusterMotion, select_target};
use super::overrides::{Identity, Overrides};
use super::track::{Track, expected_position, link};
use super::unusable_frame::unusable_reason;
use crate::{CameraModel, PipelineError};

/// Far-range method for one sequence of frames.
///
/// A frame whose image is empty or saturated leaves the state unchanged: the next frame is linked across it.
/// A frame counts as saturated when more than half of its transmitted pixels are at full scale.
#[derive(Debug)]
pub(super) struct PaperPipeline {
    config: FarRangeConfig,
    model: CameraModel,
    stars: StarList,
    mounting: MountingFilter,
    hotspots: Hotspots,
    previous: Option<PreviousFrame>,
    background: BackgroundEstimator,
    detector: Detector,
}

/// State kept from the previous frame.
#[derive(Debug)]
struct PreviousFrame {
    time: Epoch,
    body_from_icrs: Rotation<Body, Icrs>,
    /// Camera attitude, if it was given by an override.
    camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    tracks: Vec<Track>,
}

impl PaperPipeline {
    /// Creates a pipeline before its first frame.
    ///
    /// # Errors
    /// Those of [`FarRangeConfig::check`] and of the camera's check; [`contract::OutOfRange`] for parameters
    /// that conflict with a camera's zero suppression.
    pub(super) fn new(config: FarRangeConfig, setup: &Setup) -> Result<Self, PipelineError> {
        config.check()?;
        config.check_suppression(setup.zero_suppression_dn, setup.bit_depth)?;
        let model = CameraModel::new(&setup.camera)?;
        Ok(Self {
            stars: StarList::new(&setup.stars, config.identification.max_magnitude, &model),
            mounting: MountingFilter::new(setup.camera_from_body, config.attitude.filter_lambda),
            hotspots: Hotspots::new(config.hotspots.clone()),
            previous: None,
            background: BackgroundEstimator::default(),
            detector: Detector::default(),
            model,
            config,
        })
    }

    /// Returns the clusters of a frame (section 2.1), or the reason why there are none.
    fn detect(&mut self, frame: &Frame) -> Result<Vec<Blob>, NoSolution> {
        let above_background = self.config.weights == Weights::AboveBackground;
        let background = if above_background || self.config.thresholds.needs_background() {
            Some(self.background.estimate(frame).ok_or(NoSolution::EmptyFrame)?)
        } else {
            None
        };
        let thresholds = self.config.thresholds.for_frame(frame, background);
        if 2 * self.detector.find_bright(frame, thresholds) > transmitted_pixels(frame) {
            return Err(NoSolution::SaturatedFrame);
        }
        let base_dn = background.filter(|_| above_background).map_or(0.0, |b| b.median_dn);
        let blobs =
            self.detector.detect(frame, thresholds, base_dn, self.config.max_clusters as usize).to_vec();
        if blobs.is_empty() { Err(NoSolution::EmptyFrame) } else { Ok(blobs) }
    }

    /// Updates the mounting with the stars of a frame (section 2.4) if there are enough stars.
    fn calibrate(
        &mut self,
        seen: &[(Blob, ListedStar)],
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> AttitudeSource {
        if seen.is_empty() {
            return AttitudeSource::NoStars;
        }
        let pairs: Vec<StarPair> = seen
            .iter()
            .filter_map(|(blob, star)| {
                Some(StarPair {
                    camera: self.model.back_project(blob.centre)?,
                    icrs: overrides.apparent.map_or(star.direction, |apparent| apparent(star)),
                    weight: 1.0,
                })
            })
            .collect();
        let enough = pairs.len() >= self.config.attitude.min_stars as usize;
        let Some(apparent) = enough.then(|| solve_q_method(&pairs)).flatten() else {
            return AttitudeSource::TooFewStars;
        };
        let solved = match self.config.aberration {
            AberrationConfig::Correct if overrides.apparent.is_none() => {
                // An impossible velocity counts as unknown: only the annual part is corrected.
                aberration_correction(telemetry.time, telemetry.velocity_km_s, &apparent)
                    .or_else(|| aberration_correction(telemetry.time, None, &apparent))
                    .map_or(apparent, |correction| correction * apparent)
            }
            AberrationConfig::Correct | AberrationConfig::Ignore => apparent,
        };
        self.mounting.update(solved, telemetry.body_from_icrs);
        AttitudeSource::Stars
    }

    /// Identifies each cluster before its motion is examined (section 2.1).
    fn identify(
        &self,
        blobs: &[Blob],
        camera_from_icrs: &Rotation<CameraFrame, Icrs>,
        overrides: &Overrides<'_>,
    ) -> Vec<PriorIdentity> {
        if let Some(identity) = overrides.identity {
            let identities = |blob: &Blob| match identity(blob.centre) {
                Identity::Star(id) => PriorIdentity::Star { id, listed: self.stars.by_id(id) },
                Identity::Hotspot => PriorIdentity::Hotspot,
                Identity::Neither => PriorIdentity::NoStarNorHotspot,
            };
            return blobs.iter().map(identities).collect();
        }
        // A marked hotspot near a star would be matched to the star and spoil the attitude.
        let is_marked: Vec<bool> = blobs.iter().map(|blob| self.hotspots.is_marked(blob)).collect();
        let predicted = self.stars.predict(camera_from_icrs, &self.model);
        identify(blobs, &is_marked, &predicted, self.config.identification.radius_px)
            .into_iter()
            .zip(is_marked)
            .map(|(star, is_marked)| match star.map(|i| predicted[i].star) {
                Some(star) => PriorIdentity::Star { id: star.id, listed: Some(star) },
                None if is_marked => PriorIdentity::Hotspot,
                None => PriorIdentity::Nothing,
            })
            .collect()
    }

    /// Links clusters to the previous frame (section 2.2). Returns `None` if there is no frame to link to: at
    /// the first frame, after a gap, and when time does not advance. Consumes the stored previous frame; the
    /// current frame replaces it.
    fn link(
        &mut self,
        blobs: &[Blob],
        telemetry: &Telemetry,
        camera_from_icrs_now: &Rotation<CameraFrame, Icrs>,
    ) -> Option<ClusterLinks> {
        let mut previous = self.previous.take()?;
        let dt_s = (telemetry.time - previous.time).to_seconds();
        if !(dt_s > 0.0 && dt_s <= self.config.max_gap_s) {
            return None;
        }
        let icrs_from_camera_before = previous
            .camera_from_icrs
            .unwrap_or_else(|| self.mounting.camera_from_body() * previous.body_from_icrs)
            .inverse();
        let expected: Vec<_> = previous
            .tracks
            .iter()
            .map(|track| {
                expected_position(track, &icrs_from_camera_before, camera_from_icrs_now, &self.model)
            })
            .collect();
        let links = link(blobs, &previous.tracks, &expected, &self.config.tracking);
        // Each previous track continues in at most one cluster.
        let before =
            links.into_iter().map(|link| link.map(|i| std::mem::take(&mut previous.tracks[i]))).collect();
        Some(ClusterLinks { dt_s, before })
    }
}

/// Previous track of each cluster, `dt_s` seconds ago.
struct ClusterLinks {
    dt_s: f64,
    before: Vec<Option<Track>>,
}

impl ClusterLinks {
    /// Links of `clusters` clusters that are all new.
    fn none(clusters: usize) -> Self {
        Self { dt_s: 0.0, before: vec![None; clusters] }
    }
}

/// Identity of a cluster before its motion is examined.
#[derive(Debug, Clone, Copy)]
enum PriorIdentity {
    /// Star; `listed` is `None` if the star list does not hold it.
    Star { id: u32, listed: Option<ListedStar> },
    /// Hotspot.
    Hotspot,
    /// Neither star nor hotspot, as stated by an override.
    NoStarNorHotspot,
    /// Unidentified: its motion may show that it is a hotspot.
    Nothing,
}

/// A cluster of a frame after the examination of its motion.
struct ExaminedCluster {
    blob: Blob,
    /// Centre in the previous frame; `None` if the cluster is not linked.
    previous: Option<PixelPoint>,
    track: Track,
    label: Label,
}

impl ExaminedCluster {
    fn motion(&self) -> ClusterMotion {
        ClusterMotion {
            centre: self.blob.centre,
            previous: self.previous,
            is_candidate: self.label == Label::Candidate,
        }
    }

    fn cluster(&self, is_target: bool) -> Cluster {
        Cluster {
            position: self.blob.centre,
            size: self.blob.size,
            pixels: self.blob.pixels,
            label: if is_target { Label::Target } else { self.label },
        }
    }
}

impl PaperPipeline {
    /// Processes a frame like [`contract::Pipeline::process`], with results of single steps supplied from
    /// outside; for an error budget.
    pub(super) fn process_with(
        &mut self,
        frame: &Frame,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        if let Some(reason) = unusable_reason(frame, telemetry, &self.model) {
            return Outcome::without_solution(NoSolution::Failed(reason));
        }
        let predicted_attitude = self.attitude(telemetry, overrides);

        // Clusters of bright pixels (section 2.1).
        let mut blobs = match self.detect(frame) {
            Ok(blobs) => blobs,
            Err(reason) => {
                return Outcome {
                    camera_from_icrs: Some(predicted_attitude),
                    attitude_source: Some(AttitudeSource::NoStars),
                    ..Outcome::without_solution(reason)
                };
            }
        };
        replace_centres(&mut blobs, overrides);

        // Stars and marked hotspots, at the predicted attitude; then the attitude from the stars (2.4).
        let identities = self.identify(&blobs, &predicted_attitude, overrides);
        let seen = listed_stars(&blobs, &identities);
        let attitude_source = self.calibrate(&seen, telemetry, overrides);
        let camera_from_icrs = self.attitude(telemetry, overrides);

        // Motion from the previous frame (2.2); a cluster that does not move is a hotspot.
        let linked = self.link(&blobs, telemetry, &camera_from_icrs);
        let has_previous = linked.is_some();
        let links = linked.unwrap_or_else(|| ClusterLinks::none(blobs.len()));
        let examined = self.examine(&blobs, &identities, links);

        // The target moves unlike all others (2.3).
        let motions: Vec<ClusterMotion> = examined.iter().map(ExaminedCluster::motion).collect();
        let target = select_target(&motions);
        let solution = match target.map(|index| blobs[index].centre) {
            Some(centre) => Solution::Detected(Measurement::new(
                centre,
                line_of_sight(centre, &camera_from_icrs, &self.model),
            )),
            None if has_previous => Solution::NoSolution(NoSolution::NoTarget),
            None => Solution::NoSolution(NoSolution::NoPreviousFrame),
        };

        let mut clusters = Vec::with_capacity(examined.len());
        let mut tracks = Vec::with_capacity(examined.len());
        for (index, cluster) in examined.into_iter().enumerate() {
            clusters.push(cluster.cluster(target == Some(index)));
            tracks.push(cluster.track);
        }
        self.previous = Some(PreviousFrame {
            time: telemetry.time,
            body_from_icrs: telemetry.body_from_icrs,
            camera_from_icrs: overrides.camera_from_icrs,
            tracks,
        });
        Outcome {
            solution,
            camera_from_icrs: Some(camera_from_icrs),
            attitude_source: Some(attitude_source),
            n_stars: Some(seen.len() as u32),
            clusters,
        }
    }

    /// Returns the attitude of the camera: the measured attitude of the body with the present estimate of the
    /// mounting, or that of an override.
    fn attitude(&self, telemetry: &Telemetry, overrides: &Overrides<'_>) -> Rotation<CameraFrame, Icrs> {
        match overrides.camera_from_icrs {
            Some(given) => given,
            None => self.mounting.camera_from_body() * telemetry.body_from_icrs,
        }
    }

    /// Extends the track of each cluster by this frame, and labels the cluster by its identity and track.
    fn examine(
        &mut self,
        blobs: &[Blob],
        identities: &[PriorIdentity],
        links: ClusterLinks,
    ) -> Vec<ExaminedCluster> {
        let n_max = self.config.hotspots.n_max();
        let mut examined = Vec::with_capacity(blobs.len());
        for (index, before) in links.before.into_iter().enumerate() {
            let (blob, identity) = (&blobs[index], identities[index]);
            let is_star = matches!(identity, PriorIdentity::Star { .. });
            let previous = before.as_ref().map(|track| track.centre);
            let track = match before {
                Some(track) => track.extended(blob, is_star, links.dt_s, n_max),
                None => Track::new(blob, is_star),
            };
            let label = match identity {
                PriorIdentity::Star { id, .. } => Label::Star(id),
                PriorIdentity::Hotspot => Label::Hotspot,
                PriorIdentity::Nothing if self.hotspots.is_hotspot(&track) => Label::Hotspot,
                _ if previous.is_some() => Label::Candidate,
                _ => Label::Unlinked,
            };
            examined.push(ExaminedCluster { blob: *blob, previous, track, label });
        }
        examined
    }
}

/// Replaces the centres that an override gives.
fn replace_centres(blobs: &mut [Blob], overrides: &Overrides<'_>) {
    let Some(given) = overrides.centroid else { return };
    for blob in blobs {
        if let Some(centre) = given(blob.centre) {
            blob.centre = centre;
        }
    }
}

/// Returns the clusters that are stars of the star list, each with its star.
fn listed_stars(blobs: &[Blob], identities: &[PriorIdentity]) -> Vec<(Blob, ListedStar)> {
    let mut seen = Vec::new();
    for (index, identity) in identities.iter().enumerate() {
        if let PriorIdentity::Star { listed: Some(star), .. } = *identity {
            seen.push((blobs[index], star));
        }
    }
    seen
}
