//! Stacks of frames, and their checks.

/// Smallest number of frames of a stack: temporal noise is a difference of frames.
pub const MIN_FRAMES: usize = 2;

/// Smallest number of pixels: with fewer, the distribution of pixels does not show which are defects.
pub const MIN_PIXELS: usize = 1024;

/// Smallest number of different digital numbers that shows by how many bits files are shifted.
const MIN_CODES_OF_SHIFT: usize = 16;

/// Frames of one exposure time and one level of light.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameStack {
    /// Name in messages.
    pub name: String,
    /// Exposure time, s, 0 or more.
    pub time_s: f64,
    /// Relative light on the sensor; 0 without light. Photoelectrons are proportional to `light` · `time_s`.
    pub light: f64,
    /// Names of the frames in messages.
    pub names: Vec<String>,
    /// Digital numbers of each frame, row by row.
    pub frames: Vec<Vec<u16>>,
}

impl FrameStack {
    /// Light collected in the exposure, in units of the relative light times seconds.
    pub(crate) fn exposure(&self) -> f64 {
        self.light * self.time_s
    }
}

/// All frames of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorFrames {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Bits of the integers in the files, 8 to 16.
    pub stored_bits: u8,
    /// Frames of the shortest exposure without light.
    pub bias: Option<FrameStack>,
    /// Frames without light, a stack per exposure time.
    pub darks: Vec<FrameStack>,
    /// Frames with uniform light, a stack per level.
    pub flats: Vec<FrameStack>,
}

/// Reason why frames give no figures at all.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SensorFitError {
    /// No frames.
    #[error("no frames, expected bias, dark or flat frames")]
    NoFrames,
    /// A stack with too few frames.
    #[error(
        "{0}: {1} frame, expected {MIN_FRAMES} or more: noise is the difference between frames of one kind"
    )]
    TooFewFrames(String, usize),
    /// A frame of another size than the sensor's.
    #[error("{0}: {1} pixels, expected {2} as in the first frame: a sensor has one size")]
    OtherSize(String, usize, usize),
    /// A sensor with too few pixels.
    #[error("the frames have {0} pixels, expected {MIN_PIXELS} or more")]
    TooSmall(usize),
    /// Two frames with the same numbers.
    #[error(
        "{0} and {1} are the same in every pixel, expected two exposures: copies of a frame have no noise"
    )]
    Copies(String, String),
    /// A stack that should be brighter than another one.
    #[error(
        "{brighter} has a mean of {brighter_dn:.2} DN, which is not above {darker} with {darker_dn:.2} DN; \
             expected {expected}: are folders exchanged?"
    )]
    Order {
        /// Stack that should be the brighter one.
        brighter: String,
        /// Its mean, DN.
        brighter_dn: f64,
        /// Stack that should be the darker one.
        darker: String,
        /// Its mean, DN.
        darker_dn: f64,
        /// Rule that the two break.
        expected: &'static str,
    },
}

impl SensorFrames {
    /// Returns all stacks: bias, darks, flats.
    pub(crate) fn stacks(&self) -> impl Iterator<Item = &FrameStack> {
        self.bias.iter().chain(&self.darks).chain(&self.flats)
    }

    /// Checks the numbers of frames and pixels, and that no flat or dark frame is a copy.
    ///
    /// # Errors
    /// [`SensorFitError`] for the first fault.
    pub(crate) fn check(&self) -> Result<(), SensorFitError> {
        let pixels = self.columns * self.rows;
        if self.stacks().next().is_none() {
            return Err(SensorFitError::NoFrames);
        }
        if pixels < MIN_PIXELS {
            return Err(SensorFitError::TooSmall(pixels));
        }
        for stack in self.stacks() {
            if stack.frames.len() < MIN_FRAMES {
                return Err(SensorFitError::TooFewFrames(stack.name.clone(), stack.frames.len()));
            }
            let name_of = |index: usize| stack.names.get(index).unwrap_or(&stack.name).clone();
            if let Some(index) = stack.frames.iter().position(|frame| frame.len() != pixels) {
                return Err(SensorFitError::OtherSize(name_of(index), stack.frames[index].len(), pixels));
            }
            if let Some((a, b)) = copies(&stack.frames) {
                return Err(SensorFitError::Copies(name_of(a), name_of(b)));
            }
        }
        Ok(())
    }

    /// Number of low bits that are zero in every pixel of every frame: files of converters with fewer bits
    /// than the file are often shifted up. 0 with too few different numbers to tell.
    pub(crate) fn shifted_bits(&self) -> u32 {
        let mut is_used = vec![false; usize::from(u16::MAX) + 1];
        let mut all_bits = 0;
        for dn in self.stacks().flat_map(|stack| &stack.frames).flatten() {
            is_used[usize::from(*dn)] = true;
            all_bits |= dn;
        }
        let codes = is_used.iter().filter(|used| **used).count();
        if codes < MIN_CODES_OF_SHIFT { 0 } else { all_bits.trailing_zeros() }
    }
}

/// Returns two frames that are equal in every pixel although their pixels differ; frames of one number are
/// left to the steps that follow, since a sensor without visible noise or a saturated one has them.
fn copies(frames: &[Vec<u16>]) -> Option<(usize, usize)> {
    for (a, frame) in frames.iter().enumerate() {
        if codes_of(frame) < MIN_CODES_OF_COPY {
            continue;
        }
        if let Some(b) = frames.iter().skip(a + 1).position(|other| other == frame) {
            return Some((a, a + 1 + b));
        }
    }
    None
}

/// Smallest number of different digital numbers in a frame of which an equal one is a copy.
const MIN_CODES_OF_COPY: usize = 4;

/// Number of different digital numbers in a frame, counted to [`MIN_CODES_OF_COPY`].
fn codes_of(frame: &[u16]) -> usize {
    let mut codes: Vec<u16> = Vec::new();
    for dn in frame {
        if !codes.contains(dn) {
            codes.push(*dn);
            if codes.len() >= MIN_CODES_OF_COPY {
                break;
            }
        }
    }
    codes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stack(name: &str, frames: Vec<Vec<u16>>) -> FrameStack {
        let names = (0..frames.len()).map(|index| format!("{name}/{index}.png")).collect();
        FrameStack { name: name.to_owned(), time_s: 0.0, light: 0.0, names, frames }
    }

    fn sensor(bias: FrameStack) -> SensorFrames {
        SensorFrames {
            columns: 32,
            rows: 32,
            stored_bits: 16,
            bias: Some(bias),
            darks: vec![],
            flats: vec![],
        }
    }

    fn ramp(step: u16, first: u16) -> Vec<u16> {
        (0..1024).map(|index| (first + index % 37) * step).collect()
    }

    #[test]
    fn faults_of_a_stack_name_the_frame_and_the_remedy() {
        let check = |frames, parts: [&str; 2]| {
            let message = sensor(stack("bias", frames)).check().unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        };
        check(vec![ramp(1, 0)], ["bias: 1 frame", "2 or more"]);
        check(vec![ramp(1, 0), vec![0; 1000]], ["bias/1.png: 1000 pixels", "expected 1024"]);
        check(vec![ramp(1, 0), ramp(1, 5), ramp(1, 0)], ["bias/0.png and bias/2.png", "copies"]);
        assert_eq!(sensor(stack("bias", vec![ramp(1, 0), ramp(1, 1)])).check(), Ok(()));
        assert_eq!(sensor(stack("bias", vec![vec![9; 1024], vec![9; 1024]])).check(), Ok(()));
    }

    #[test]
    fn shifted_files_are_recognised_by_their_low_bits() {
        assert_eq!(sensor(stack("bias", vec![ramp(16, 0), ramp(16, 1)])).shifted_bits(), 4);
        assert_eq!(sensor(stack("bias", vec![ramp(1, 0), ramp(1, 1)])).shifted_bits(), 0);
        assert_eq!(sensor(stack("bias", vec![vec![8; 1024]; 2])).shifted_bits(), 0);
    }
}
