//! `clusters.parquet`: what a pipeline took each cluster for, beside `measurements.csv`.

use contract::{Cluster, Label, PixelPoint};

use super::FileError;
use super::parquet_table::{Columns, Row};
use super::table_column::Column;

/// A cluster and the frame it was found in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameCluster {
    /// Number of the frame.
    pub frame: u64,
    /// The cluster.
    pub cluster: Cluster,
}

impl FrameCluster {
    fn star(&self) -> Option<u32> {
        match self.cluster.label {
            Label::Star(id) => Some(id),
            _ => None,
        }
    }
}

impl Row for FrameCluster {
    fn columns(rows: &[Self]) -> Vec<Column> {
        let numbers =
            |name, value: fn(&Cluster) -> f64| Column::new(name, rows.iter().map(|row| value(&row.cluster)));
        vec![
            Column::new("frame", rows.iter().map(|row| row.frame)),
            numbers("x_px", |cluster| cluster.position.x).seldom_repeating(),
            numbers("y_px", |cluster| cluster.position.y).seldom_repeating(),
            numbers("size", |cluster| cluster.size).seldom_repeating(),
            Column::new("pixels", rows.iter().map(|row| row.cluster.pixels)),
            Column::texts("label", rows.iter().map(|row| row.cluster.label.code())),
            Column::nullable("star_id", rows.iter().map(Self::star)),
        ]
    }

    #[expect(
        clippy::indexing_slicing,
        reason = "`row` is below the number of rows of the batch, which all its columns have"
    )]
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let (frame, pixels) = (columns.u64("frame")?, columns.u32("pixels")?);
        let (x, y, size) = (columns.f64("x_px")?, columns.f64("y_px")?, columns.f64("size")?);
        let star = columns.optional_u32("star_id")?;
        (0..columns.len())
            .map(|row| {
                let label = columns.word("label", row, |word| label(word, star.get(row)))?;
                let position = PixelPoint::new(x[row], y[row]);
                let cluster = Cluster { position, size: size[row], pixels: pixels[row], label };
                Ok(Self { frame: frame[row], cluster })
            })
            .collect()
    }

    fn frame(&self) -> u64 {
        self.frame
    }
}

/// The label of a word; a star needs its number.
fn label(word: &str, star: Option<u32>) -> Option<Label> {
    let others = [Label::Hotspot, Label::Unlinked, Label::Candidate, Label::Target];
    match star {
        Some(id) => Some(Label::Star(id)).filter(|label| label.code() == word),
        None => others.into_iter().find(|label| label.code() == word),
    }
}

#[cfg(test)]
mod tests {
    use tempfile::tempdir;

    use super::super::{TableReader, TableWriter};
    use super::*;

    #[test]
    fn every_label_comes_back() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("clusters.parquet");
        let labels = [Label::Star(7), Label::Hotspot, Label::Unlinked, Label::Candidate, Label::Target];
        let row = |(i, label): (u64, Label)| {
            let position = PixelPoint::new(0.1 * i as f64, -0.5);
            FrameCluster { frame: i / 2, cluster: Cluster { position, size: 0.3, pixels: 4, label } }
        };
        let rows: Vec<_> = (0..).zip(labels).map(row).collect();
        let mut writer = TableWriter::create(&path).unwrap();
        writer.write(rows.clone()).unwrap();
        writer.finish().unwrap();
        let reader = TableReader::<FrameCluster>::open(&path).unwrap();
        let back: Vec<_> = reader.flat_map(|frame| frame.unwrap().1).collect();
        assert_eq!(back, rows);
    }

    #[test]
    fn a_star_without_a_number_is_not_a_star() {
        assert_eq!(label("star", None), None);
        assert_eq!(label("target", Some(3)), None);
    }
}
