//! Digital numbers of a frame, and what the camera keeps of them on board.

use contract::Window;
use sensor::onboard::RoiExtractor;
use sensor::{FrameCharge, PixelSampler, RawImage, SparseImage};
use truth::SimError;

use crate::Simulator;

/// Selection of the drawn pixels in a frame of which a camera keeps only regions, or only values above a
/// floor. The kept pixels are bit-identical in both cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PixelSelection {
    /// Pixels that the camera examines: all above the threshold of its regions or its floor, and all in its
    /// regions.
    #[default]
    Needed,
    /// All pixels.
    All,
}

/// Readout of frames with the on-board functions, and the buffers that frames reuse.
#[derive(Debug)]
pub(crate) struct FrameReadout {
    sampler: PixelSampler,
    raw: SparseImage,
    pub(crate) pixel_selection: PixelSelection,
    regions: Option<RoiExtractor>,
}

impl FrameReadout {
    pub(crate) fn new(simulator: &Simulator) -> Result<Self, SimError> {
        let (columns, rows) = simulator.projection.detector();
        Ok(Self {
            sampler: simulator.sensor.new_sampler(),
            raw: simulator.sensor.new_sparse(),
            pixel_selection: PixelSelection::Needed,
            regions: simulator.roi.as_ref().map(|roi| RoiExtractor::new(roi, columns, rows)).transpose()?,
        })
    }

    /// Returns the digital numbers of the last frame.
    pub(crate) fn raw(&self) -> &RawImage {
        self.raw.raw()
    }

    /// Reads out a frame. Returns the regions that the camera keeps; `None`: the whole image.
    pub(crate) fn read_out(
        &mut self,
        simulator: &Simulator,
        charge: &FrameCharge<'_>,
    ) -> Result<Option<Vec<Window>>, SimError> {
        if let Some(regions) = &self.regions {
            let threshold_dn = regions.threshold_dn();
            self.read_out_above(simulator, threshold_dn, charge)?;
            return self.extract_regions(simulator, charge);
        }
        match simulator.zero_suppression_dn {
            Some(floor_dn) => {
                self.read_out_above(simulator, floor_dn, charge)?;
                self.raw.suppress(floor_dn);
            }
            None => {
                simulator.sensor.read_out(charge, &mut self.sampler, self.raw.full_image())?;
            }
        }
        Ok(None)
    }

    /// Reads out the pixels of a frame above a floor, or all pixels.
    fn read_out_above(
        &mut self,
        simulator: &Simulator,
        floor_dn: u16,
        charge: &FrameCharge<'_>,
    ) -> Result<(), SimError> {
        let sensor = &simulator.sensor;
        sensor.read_out_above(floor_dn, charge, &mut self.sampler, &mut self.raw)?;
        if self.pixel_selection == PixelSelection::All {
            let (columns, rows) = self.raw.raw().size();
            let whole = [Window { x: 0, y: 0, columns, rows }];
            sensor.read_out_windows(&whole, charge, &mut self.sampler, &mut self.raw)?;
        }
        Ok(())
    }

    /// Finds the regions that the camera keeps, and reads out all their pixels.
    fn extract_regions(
        &mut self,
        simulator: &Simulator,
        charge: &FrameCharge<'_>,
    ) -> Result<Option<Vec<Window>>, SimError> {
        let Some(regions) = &mut self.regions else { return Ok(None) };
        let windows = regions.extract_from(self.raw.raw(), self.raw.runs());
        simulator.sensor.read_out_windows(&windows, charge, &mut self.sampler, &mut self.raw)?;
        Ok(Some(windows))
    }
}
