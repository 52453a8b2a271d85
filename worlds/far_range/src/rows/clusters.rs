//! `clusters.parquet`: a pipeline's classification of each cluster, in addition to `measurements.csv`.

use contract::{Cluster, Label, PixelPoint};
use files::{Column, Columns, FileError, Row, table, without_dictionary};

/// A cluster with its frame number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameCluster {
    /// Number of the frame.
    pub frame: u64,
    /// The cluster.
    pub cluster: Cluster,
}

table! {
    /// A row of `clusters.parquet`.
    pub struct ClusterRow: parquet(frame) {
        /// number of the frame; ascending
        frame: u64,
        /// centre of the cluster
        position: PixelPoint = without_dictionary(["x_px", "y_px"]),
        /// sum of intensities, each 0 to 1
        size: f64 = without_dictionary(["size"]),
        /// number of pixels
        pixels: u32,
        /// classification: `star`, `hotspot`, `unlinked`, `candidate`, `target`
        label: String,
        /// number of the star in the catalogue; null unless the cluster is a star
        star_id: Option<u32>,
    }
}

impl From<&FrameCluster> for ClusterRow {
    fn from(FrameCluster { frame, cluster }: &FrameCluster) -> Self {
        let Cluster { position, size, pixels, label } = *cluster;
        let star_id = match label {
            Label::Star(id) => Some(id),
            _ => None,
        };
        Self { frame: *frame, position, size, pixels, label: label.code().to_owned(), star_id }
    }
}

impl Row for FrameCluster {
    fn columns(rows: &[Self]) -> Vec<Column> {
        ClusterRow::columns(&rows.iter().map(ClusterRow::from).collect::<Vec<_>>())
    }

    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let cluster = |(i, row): (usize, ClusterRow)| {
            let ClusterRow { frame, position, size, pixels, .. } = row;
            let label = label(&row.label, row.star_id).ok_or_else(|| {
                columns.error(i, "label", &row.label, "one of the values that this column allows")
            })?;
            Ok(Self { frame, cluster: Cluster { position, size, pixels, label } })
        };
        ClusterRow::rows(columns)?.into_iter().enumerate().map(cluster).collect()
    }

    fn frame(&self) -> u64 {
        self.frame
    }
}

/// Returns the label of a name; a star needs its number.
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

    use super::*;
    use files::{TableReader, TableWriter};

    #[test]
    fn every_label_round_trips() {
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
