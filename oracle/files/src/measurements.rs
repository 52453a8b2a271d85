//! `measurements.csv`: a pipeline's answers, ours or anybody's.

use std::path::Path;

use contract::{
    AttitudeSource, CameraFrame, Icrs, Measurement, NoSolution, Outcome, PixelPoint, Rotation, Solution,
};

use super::csv_table::Presence::{Optional, Required};
use super::csv_table::{CsvReader, CsvRow, CsvWriter, Layout, cells};
use super::{FileError, unit};

const POSITION: [&str; 2] = ["x_px", "y_px"];
const LINE_OF_SIGHT: [&str; 3] = ["los_j2000_x", "los_j2000_y", "los_j2000_z"];
const QUATERNION: [&str; 4] = ["q_cam_j2000_w", "q_cam_j2000_x", "q_cam_j2000_y", "q_cam_j2000_z"];

const LAYOUT: Layout = &[
    ("frame", Required),
    ("status", Required),
    (POSITION[0], Required),
    (POSITION[1], Required),
    (LINE_OF_SIGHT[0], Optional),
    (LINE_OF_SIGHT[1], Optional),
    (LINE_OF_SIGHT[2], Optional),
    (QUATERNION[0], Optional),
    (QUATERNION[1], Optional),
    (QUATERNION[2], Optional),
    (QUATERNION[3], Optional),
    ("attitude", Optional),
    ("n_stars", Optional),
];

/// The status of a row that has a target; any other text is the reason why there is none.
const DETECTED: &str = "detected";

/// Writes the table row by row.
pub struct MeasurementWriter(CsvWriter);

impl MeasurementWriter {
    /// Creates the table.
    ///
    /// # Errors
    /// [`FileError::Io`] when the file exists or cannot be created.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        CsvWriter::create(path, LAYOUT).map(Self)
    }

    /// Writes the answer to one frame. Its clusters have a table of their own ([`super::FrameCluster`]).
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn write(&mut self, frame: u64, outcome: &Outcome) -> Result<(), FileError> {
        let status = match &outcome.solution {
            Solution::Detected(_) => DETECTED.to_owned(),
            Solution::NoSolution(reason) => reason.to_string(),
        };
        let measurement = outcome.measurement();
        let position = cells(measurement.map(|m| [m.position.x, m.position.y]));
        let line_of_sight =
            cells(measurement.and_then(|m| m.line_of_sight).map(|direction| (*direction.vector()).into()));
        let quaternion = cells(outcome.camera_from_icrs.map(|rotation| rotation.wxyz()));
        let attitude = outcome.attitude_source.map_or("", AttitudeSource::code).to_owned();
        let start = [frame.to_string(), status];
        let end = [attitude, outcome.n_stars.map_or_else(String::new, |n| n.to_string())];
        self.0.write(start.into_iter().chain(position).chain(line_of_sight).chain(quaternion).chain(end))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn finish(self) -> Result<(), FileError> {
        self.0.finish()
    }
}

/// Reads the table: the answer to each frame, frames ascending, gaps allowed, clusters empty.
///
/// # Errors
/// A [`FileError`] that names line and column of the first cell that is not as it should be.
pub fn read_measurements(path: &Path) -> Result<Vec<(u64, Outcome)>, FileError> {
    let mut table = CsvReader::open(path, LAYOUT)?;
    let mut outcomes: Vec<(u64, Outcome)> = Vec::new();
    while let Some(row) = table.next_row()? {
        let frame = row.frame_after(outcomes.last().map(|(frame, _)| *frame))?;
        outcomes.push((frame, parse(&row)?));
    }
    Ok(outcomes)
}

fn parse(row: &CsvRow<'_>) -> Result<Outcome, FileError> {
    let attitude_source = match row.text("attitude").trim() {
        "" => None,
        code => Some(
            AttitudeSource::parse(code)
                .ok_or_else(|| row.error("attitude", "`stars`, `too_few_stars`, `no_stars` or nothing"))?,
        ),
    };
    let n_stars = if row.text("n_stars").trim().is_empty() { None } else { Some(row.count("n_stars")?) };
    Ok(Outcome {
        solution: solution(row)?,
        camera_from_icrs: attitude(row)?,
        attitude_source,
        n_stars,
        clusters: Vec::new(),
    })
}

fn solution(row: &CsvRow<'_>) -> Result<Solution, FileError> {
    // Not trimmed for the reason of none: it is kept to the letter.
    let status = row.text("status");
    if status.trim().is_empty() {
        return Err(row.error("status", "`detected`, or the reason why there is no target"));
    }
    if status.trim() != DETECTED {
        // A position here is a detection under a misspelt word: counted as a miss, it would be lost in silence.
        for column in POSITION.into_iter().chain(LINE_OF_SIGHT) {
            if !row.text(column).trim().is_empty() {
                return Err(row.error(column, format!("nothing, as the status is `{status}`")));
            }
        }
        return Ok(Solution::NoSolution(NoSolution::parse(status)));
    }
    let [x, y] = row.numbers(POSITION)?;
    let line_of_sight = row
        .optional_numbers(LINE_OF_SIGHT)?
        .map(|xyz| unit::direction(xyz).ok_or_else(|| row.error(LINE_OF_SIGHT[0], unit::EXPECTED)))
        .transpose()?;
    Ok(Solution::Detected(Measurement { position: PixelPoint::new(x, y), line_of_sight }))
}

fn attitude(row: &CsvRow<'_>) -> Result<Option<Rotation<CameraFrame, Icrs>>, FileError> {
    row.optional_numbers(QUATERNION)?
        .map(|wxyz| {
            Rotation::from_wxyz(wxyz)
                .map_err(|error| row.error(QUATERNION[0], format!("a unit quaternion: {error}")))
        })
        .transpose()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use contract::Direction;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;

    fn read(text: &str) -> Result<Vec<(u64, Outcome)>, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("measurements.csv");
        fs::write(&path, text).unwrap();
        read_measurements(&path)
    }

    fn check_refused(text: &str, line: &str, column: &str) {
        let message = read(text).unwrap_err().to_string();
        assert!(message.contains(line) && message.contains(&format!("`{column}`")), "{message}");
    }

    #[test]
    fn four_columns_are_enough() {
        let outcomes = read("frame,status,x_px,y_px\n3,detected,1.5,2\n9,no_target,,\n").unwrap();
        assert_eq!(outcomes[0].1.measurement().unwrap().position, PixelPoint::new(1.5, 2.0));
        assert_eq!(outcomes[1], (9, Outcome::none(NoSolution::NoTarget)));
    }

    #[test]
    fn each_bad_cell_is_named_by_line_and_column() {
        let header = "frame,status,x_px,y_px,los_j2000_x,los_j2000_y,los_j2000_z,attitude,n_stars";
        let check = |row: &str, column| check_refused(&format!("{header}\n{row}\n"), "line 2", column);
        check("1,detected,,2,,,,,", "x_px");
        check("1,detected,1,NaN,,,,,", "y_px");
        check("1,detected,1,2,1,1,0,,", "los_j2000_x");
        check("1,detected,1,2,1,,0,,", "los_j2000_y");
        check("1,detected,1,2,,,,sun,", "attitude");
        check("1,detected,1,2,,,,,-3", "n_stars");
        check("1,,1,2,,,,,", "status");
        check("-1,detected,1,2,,,,,", "frame");
        check_refused("frame,status,x_px,y_px\n1,no_target,,\n1,no_target,,\n", "line 3", "frame");
    }

    #[test]
    fn a_misspelt_detection_is_refused_and_not_counted_as_a_miss() {
        check_refused("frame,status,x_px,y_px\n1,Detected,1,2\n", "line 2", "x_px");
    }

    #[test]
    fn a_misspelt_column_is_refused() {
        let message = read("frame,status,x_px,y_px,los_j2000_X\n").unwrap_err().to_string();
        assert!(message.contains("did you mean `los_j2000_x`"), "{message}");
    }

    fn any_outcome() -> impl Strategy<Value = Outcome> {
        let reason = prop_oneof![
            Just(NoSolution::EmptyFrame),
            Just(NoSolution::SaturatedFrame),
            Just(NoSolution::NoPreviousFrame),
            Just(NoSolution::NoTarget),
            "\\PC{0,20}".prop_map(NoSolution::Failed),
        ];
        let vector = || prop::array::uniform3(0.1..3.0_f64).prop_map(Vector3::from);
        let detected =
            (-10.0..800.0_f64, any::<f64>(), prop::option::of(vector())).prop_map(|(x, y, los)| {
                Solution::Detected(Measurement {
                    position: PixelPoint::new(x, if y.is_finite() { y } else { -0.0 }),
                    line_of_sight: los.map(|v| Direction::from_vector(v).unwrap()),
                })
            });
        let solution = prop_oneof![detected, reason.prop_map(Solution::NoSolution)];
        let source = prop::option::of(prop_oneof![
            Just(AttitudeSource::Stars),
            Just(AttitudeSource::TooFewStars),
            Just(AttitudeSource::NoStars),
        ]);
        (solution, prop::option::of(vector()), source, prop::option::of(any::<u32>())).prop_map(
            |(solution, axis, attitude_source, n_stars)| Outcome {
                solution,
                camera_from_icrs: axis.map(Rotation::from_rotation_vector),
                attitude_source,
                n_stars,
                clusters: Vec::new(),
            },
        )
    }

    proptest! {
        #[test]
        fn every_bit_comes_back(outcomes in prop::collection::vec(any_outcome(), 0..6)) {
            let directory = tempdir().unwrap();
            let path = directory.path().join("measurements.csv");
            let mut writer = MeasurementWriter::create(&path).unwrap();
            let rows: Vec<_> = (0..).map(|n: u64| n * 7).zip(outcomes).collect();
            rows.iter().for_each(|(frame, outcome)| writer.write(*frame, outcome).unwrap());
            writer.finish().unwrap();
            prop_assert_eq!(read_measurements(&path).unwrap(), rows);
        }
    }
}
