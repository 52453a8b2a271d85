//! Names of the formats on the command line.

use std::fmt;
use std::str::FromStr;

/// Format of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LabelFormat {
    /// COCO: `annotations.json` with boxes, masks and keypoints.
    Coco,
    /// SPEED and SPEED+: pose of one object per image.
    Speed,
    /// BOP: poses, boxes and masks of all objects.
    Bop,
    /// YOLO: text files with boxes, and with boxes and keypoints.
    Yolo,
}

impl LabelFormat {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Coco, Self::Speed, Self::Bop, Self::Yolo];

    /// Returns the name on the command line and of the format's folder.
    pub fn code(self) -> &'static str {
        match self {
            Self::Coco => "coco",
            Self::Speed => "speed",
            Self::Bop => "bop",
            Self::Yolo => "yolo",
        }
    }
}

/// Formats to write: at least one, each once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelFormats {
    formats: Vec<LabelFormat>,
}

impl LabelFormats {
    /// Returns true if a format is to be written.
    pub fn contains(&self, format: LabelFormat) -> bool {
        self.formats.contains(&format)
    }
}

impl FromStr for LabelFormats {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "expected one or more of coco, speed, bop, yolo, separated by commas";
        let mut formats = Vec::new();
        for word in text.split(',') {
            let format = LabelFormat::ALL.into_iter().find(|format| format.code() == word.trim());
            let format = format.ok_or_else(|| format!("`{word}` is no format of labels, {expected}"))?;
            if formats.contains(&format) {
                return Err(format!("`{}` is named twice, {expected}", format.code()));
            }
            formats.push(format);
        }
        Ok(Self { formats })
    }
}

impl fmt::Display for LabelFormats {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let codes: Vec<&str> = self.formats.iter().map(|format| format.code()).collect();
        formatter.write_str(&codes.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_read_in_any_order() {
        let formats: LabelFormats = "yolo, coco".parse().unwrap();
        assert!(formats.contains(LabelFormat::Coco) && !formats.contains(LabelFormat::Bop));
        assert_eq!(formats.to_string(), "yolo,coco");
    }

    #[test]
    fn unknown_empty_and_repeated_names_are_refused() {
        for (text, message) in [
            ("kitti", "`kitti` is no format of labels, expected one or more of coco, speed, bop, yolo"),
            ("coco,", "`` is no format"),
            ("", "`` is no format"),
            ("COCO", "`COCO` is no format"),
            ("coco,bop,coco", "`coco` is named twice"),
        ] {
            let refused = text.parse::<LabelFormats>().unwrap_err();
            assert!(refused.contains(message), "{refused}");
        }
    }
}
