//! `boresight sky`: one picture of the sky by a camera.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use contract::PixelPoint;
use far_range::{CameraSource, SkyPicture, SkyView, star_name};
use files::{AtomicFile, Failure, FileError, ImageFormat, ReplaceableFile, format_utc};
use hifitime::Epoch;
use serde_json::{Value, json};
use show::{
    Class, Colour, Mark, Panel, Pixels, PlateScale, Reduction, Shape, ShowError, Stretch, Symbol, encode,
    image, is_boresight_picture,
};
use sim::truth::{ObjectKind, ObjectTruth};

use crate::command::Answer;
use crate::command::options::{exposure, number, output_path, time};
use crate::command::output::Output;

/// Number of the brightest stars that are listed and, with `--label`, marked.
const LISTED_STARS: usize = 12;
/// Number of the listed stars in the text for a terminal.
const PRINTED_STARS: usize = 5;
/// Signal-to-noise ratio from which a star counts as visible.
const VISIBLE_SNR: f64 = 5.0;
/// Files that a picture may replace.
const PICTURES: ReplaceableFile<'static> = ReplaceableFile {
    description: "an earlier picture of Boresight (--out FILE.png)",
    matches: &is_boresight_picture,
};
/// Mark of a labelled star.
const STAR: Class =
    Class { code: "star", words: "star", colour: Colour::Blue, symbol: Symbol::Circle, rank: 0 };

#[derive(Debug, Args)]
pub(in crate::command) struct SkyArguments {
    /// Right ascension of the centre of the image, ICRS, degrees, 0 to 360
    #[arg(long, value_name = "DEG", value_parser = right_ascension)]
    ra: f64,
    /// Declination, degrees, -90 to 90
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = declination)]
    dec: f64,
    /// Clockwise rotation of the camera about its boresight, degrees, -360 to 360. At 0 north is up and east
    /// to the left
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true, value_parser = roll)]
    roll: f64,
    /// A built-in camera (`boresight scenario camera` lists them), or a TOML file with the tables [camera],
    /// [sensor], [psf] and [radiometry]
    #[arg(long, value_name = "NAME|FILE")]
    camera: String,
    /// File to write. FILE.png: an 8-bit picture, which replaces an earlier picture of Boresight, but no
    /// other file; with --raw the digital numbers, 16 bits, in a new file. FILE.fits: the digital numbers
    /// with world coordinates, in a new file
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: PathBuf,
    /// Exposure time, s, 1e-6 to 1000
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = exposure)]
    exposure: f64,
    /// Middle of the exposure, UTC, 1990 to 2050: sets proper motion, aberration, planets, Moon and zodiacal
    /// light
    #[arg(long, value_name = "UTC", default_value = "2026-01-01T00:00:00Z", value_parser = time)]
    time: Epoch,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(0..=i64::MAX as u64))]
    seed: u64,
    /// Map from digital numbers to grey: asinh, linear (darkest to brightest pixel) or full (0 to full
    /// scale); default: asinh
    #[arg(long, value_name = "STRETCH", conflicts_with = "raw")]
    stretch: Option<Stretch>,
    /// PNG: write the digital numbers of the camera, 16 bits, without stretch
    #[arg(long)]
    raw: bool,
    /// Mark the brightest stars with their names, or their numbers in the Hipparcos catalogue
    #[arg(long, conflicts_with = "raw")]
    label: bool,
}

/// Parses a right ascension, degrees.
fn right_ascension(text: &str) -> Result<f64, String> {
    number(text, 0.0, 360.0)
}

/// Parses a declination, degrees.
fn declination(text: &str) -> Result<f64, String> {
    number(text, -90.0, 90.0)
}

/// Parses a rotation about the boresight, degrees.
fn roll(text: &str) -> Result<f64, String> {
    number(text, -360.0, 360.0)
}

/// Kind of the file to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// An 8-bit picture.
    Picture,
    /// The digital numbers.
    Raw(ImageFormat),
}

impl SkyArguments {
    /// Returns the kind of the file, from its extension and `--raw`.
    ///
    /// # Errors
    /// [`Failure::Usage`] for another extension, and for options that the kind does not have.
    fn kind(&self) -> Result<Kind, Failure> {
        let extension = self.out.extension().map(|extension| extension.to_ascii_lowercase());
        let shown = self.out.display();
        match extension.as_deref().and_then(|extension| extension.to_str()) {
            Some("png") if self.raw => Ok(Kind::Raw(ImageFormat::Png)),
            Some("png") => Ok(Kind::Picture),
            Some("fits") if self.stretch.is_some() || self.label => Err(Failure::Usage(format!(
                "--out is {shown}, expected a file name that ends in .png for --stretch and --label: FITS has \
                 the digital numbers"
            ))),
            Some("fits") => Ok(Kind::Raw(ImageFormat::Fits)),
            _ => Err(Failure::Usage(format!(
                "--out is {shown}, expected a file name that ends in .png or .fits"
            ))),
        }
    }
}

pub(in crate::command) fn sky(arguments: &SkyArguments, output: &Output) -> Result<Answer, Failure> {
    // Rejected before the work begins.
    let kind = arguments.kind()?;
    match kind {
        Kind::Picture => PICTURES.check(&arguments.out)?,
        Kind::Raw(_) if arguments.out.symlink_metadata().is_ok() => {
            return Err(Failure::Usage(format!(
                "--out is {}, which exists, expected an unused name: nothing is overwritten",
                arguments.out.display()
            )));
        }
        Kind::Raw(_) => {}
    }
    let camera = CameraSource::read(&arguments.camera).map_err(|failure| match failure {
        Failure::Usage(message) => Failure::Usage(format!("--camera: {message}")),
        failure => failure,
    })?;
    let view = SkyView {
        camera,
        ra_deg: arguments.ra,
        dec_deg: arguments.dec,
        roll_deg: arguments.roll,
        exposure_s: arguments.exposure,
        time: arguments.time,
        seed: arguments.seed,
    };
    let picture = view.expose()?;
    let stars = brightest_stars(&picture);
    match kind {
        Kind::Raw(format) => picture.write(&arguments.out, format)?,
        Kind::Picture => {
            let shown = if arguments.label { stars.as_slice() } else { &[] };
            write_picture(&arguments.out, &picture, arguments.stretch.unwrap_or(Stretch::Asinh), shown)?;
        }
    }
    output.answer(&document(arguments, &picture, &stars), text(arguments, &picture, &stars))?;
    Ok(Answer::Yes)
}

/// Returns the brightest stars whose centre is in the picture, brightest first.
fn brightest_stars(picture: &SkyPicture) -> Vec<&ObjectTruth> {
    let mut stars: Vec<&ObjectTruth> = visible_stars(picture).collect();
    stars.sort_by(|a, b| b.electrons.total_cmp(&a.electrons));
    stars.truncate(LISTED_STARS);
    stars
}

/// Returns the stars with a sufficient signal-to-noise ratio whose centre is in the picture.
fn visible_stars(picture: &SkyPicture) -> impl Iterator<Item = &ObjectTruth> {
    let (columns, rows) = (picture.frame().columns() as f64, picture.frame().rows() as f64);
    let is_inside =
        move |at: PixelPoint| (-0.5..columns - 0.5).contains(&at.x) && (-0.5..rows - 0.5).contains(&at.y);
    let is_star = |object: &&ObjectTruth| object.kind == ObjectKind::Star && object.snr >= VISIBLE_SNR;
    picture.objects().iter().filter(is_star).filter(move |star| is_inside(star.position))
}

/// Returns the name of a star, or its number in the Hipparcos catalogue.
fn label(star: &ObjectTruth) -> String {
    star_name(star.id).map_or_else(|| format!("HIP {}", star.id), str::to_owned)
}

/// Writes the 8-bit picture, with labels of some stars.
fn write_picture(
    path: &Path,
    picture: &SkyPicture,
    stretch: Stretch,
    labelled: &[&ObjectTruth],
) -> Result<(), Failure> {
    let undrawn = |error: ShowError| Failure::Usage(error.to_string());
    let drawn = image(&panel(picture, stretch, labelled)).map_err(undrawn)?;
    let bytes = encode(&drawn, "boresight sky").map_err(undrawn)?;
    let file = AtomicFile::create(path)?;
    file.file().write_all(&bytes).map_err(|source| FileError::io(path, "write", source))?;
    Ok(file.replace(PICTURES)?)
}

/// Returns the picture in the form that is drawn.
fn panel(picture: &SkyPicture, stretch: Stretch, labelled: &[&ObjectTruth]) -> Panel {
    let frame = picture.frame();
    let pixels = Pixels {
        columns: frame.columns(),
        rows: frame.rows(),
        dn: frame.dn().to_vec(),
        full_scale_dn: frame.full_scale_dn(),
    };
    let mark = |star: &&ObjectTruth| Mark {
        at: star.position,
        shape: Shape::Around { radius_px: star.radius_px, least: 6.0 },
        class: STAR,
        label: Some(label(star)),
    };
    Panel {
        view: pixels.full_window(),
        pixels,
        regions: None,
        close_up: None,
        stretch,
        reduction: Reduction::Brightest,
        scale: PlateScale { focal_length_px: picture.camera().focal_length_px().0, range_m: None },
        marks: labelled.iter().map(mark).collect(),
        title: String::new(),
        short_title: String::new(),
        verdict: None,
        tables: Vec::new(),
        caption: Vec::new(),
    }
}

/// Describes the direction of north in the picture: the camera turns clockwise, so the sky turns the other
/// way.
fn north(roll_deg: f64) -> String {
    // An angle from −180 to 180 degrees.
    let turn_deg = (roll_deg + 180.0).rem_euclid(360.0) - 180.0;
    match turn_deg {
        0.0 => "north up, east left".to_owned(),
        turn if turn > 0.0 => format!("north {turn}° counterclockwise from up"),
        turn => format!("north {}° clockwise from up", -turn),
    }
}

/// Returns the answer as JSON.
fn document(arguments: &SkyArguments, picture: &SkyPicture, stars: &[&ObjectTruth]) -> Value {
    let listed = |star: &&ObjectTruth| {
        json!({
            "hip": star.id,
            "name": star_name(star.id),
            "magnitude": star.magnitude,
            "x_px": star.position.x,
            "y_px": star.position.y,
            "electrons": star.electrons,
        })
    };
    json!({
        "file": arguments.out,
        "columns": picture.frame().columns(),
        "rows": picture.frame().rows(),
        "field_deg": picture.field_deg(),
        "time_utc": format_utc(arguments.time),
        "exposure_s": arguments.exposure,
        "north": north(arguments.roll),
        "visible_stars": visible_stars(picture).count(),
        "brightest": stars.iter().map(listed).collect::<Vec<Value>>(),
    })
}

/// Returns the answer for a terminal.
fn text(arguments: &SkyArguments, picture: &SkyPicture, stars: &[&ObjectTruth]) -> String {
    let field = picture
        .field_deg()
        .map_or_else(String::new, |[width, height]| format!(", {width:.1}° × {height:.1}°"));
    let mut text = format!(
        "{}: {} × {} px{field}, {}\n{} stars with a signal-to-noise ratio of at least {VISIBLE_SNR:.0}",
        arguments.out.display(),
        picture.frame().columns(),
        picture.frame().rows(),
        north(arguments.roll),
        visible_stars(picture).count(),
    );
    let words = |star: &&ObjectTruth| {
        let magnitude = star.magnitude.map_or_else(String::new, |magnitude| format!(" (V {magnitude:.1})"));
        format!("{}{magnitude} at {:.0}, {:.0}", label(star), star.position.x, star.position.y)
    };
    let brightest: Vec<String> = stars.iter().take(PRINTED_STARS).map(words).collect();
    if !brightest.is_empty() {
        text += &format!("; brightest, with column and row: {}", brightest.join("; "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_turns_against_the_camera() {
        assert_eq!(north(0.0), "north up, east left");
        assert_eq!(north(360.0), "north up, east left");
        assert_eq!(north(90.0), "north 90° counterclockwise from up");
        assert_eq!(north(-30.0), "north 30° clockwise from up");
        assert_eq!(north(350.0), "north 10° clockwise from up");
    }
}
