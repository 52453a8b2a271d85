//! Header of a frame as FITS cards.

use std::path::Path;

use contract::Frame;
use fitsio_pure::header::Card;
use fitsio_pure::value::Value;
use hifitime::Unit;

use crate::error::FileLocation;
use crate::table::time::format_utc;
use crate::table::windows;
use crate::{FileError, FrameHeader, SipTerm, TanSip};

/// Cards under construction; each card is checked when it is added.
struct Cards<'a> {
    path: &'a Path,
    cards: Vec<Card>,
}

impl Cards<'_> {
    fn add(&mut self, keyword: &str, value: Value, comment: &str) -> Result<(), FileError> {
        if let Value::Float(number) = value
            && !number.is_finite()
        {
            return Err(FileError::value(
                self.path,
                FileLocation::Header,
                keyword,
                number,
                "a finite number",
            ));
        }
        let card = Card::new(keyword, value).map_err(|error| FileError::format(self.path, "FITS", error))?;
        self.cards.push(Card { comment: Some(comment.to_owned()).filter(|c| !c.is_empty()), ..card });
        Ok(())
    }

    fn text(&mut self, keyword: &str, text: &str, comment: &str) -> Result<(), FileError> {
        // FITS headers are printable ASCII; any other character would make the whole file unreadable for
        // other programs.
        if text.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
            self.add(keyword, Value::String(text.to_owned()), comment)
        } else {
            Err(FileError::value(self.path, FileLocation::Header, keyword, text, "printable ASCII"))
        }
    }

    fn number(&mut self, keyword: &str, number: f64, comment: &str) -> Result<(), FileError> {
        self.add(keyword, Value::Float(number), comment)
    }

    fn integer(&mut self, keyword: &str, number: u64, comment: &str) -> Result<(), FileError> {
        let value = i64::try_from(number).map_err(|_| {
            FileError::value(self.path, FileLocation::Header, keyword, number, "less than 2^63")
        })?;
        self.add(keyword, Value::Integer(value), comment)
    }

    fn comment(&mut self, text: &str) {
        let keyword = *b"COMMENT ";
        self.cards.push(Card { keyword, value: None, comment: Some(format!("  {text}")) });
    }
}

/// Returns all cards of a frame except the mandatory ones.
pub(crate) fn frame_cards(path: &Path, frame: &Frame, header: &FrameHeader) -> Result<Vec<Card>, FileError> {
    let mut cards = Cards { path, cards: Vec::new() };
    cards.number("BSCALE", 1.0, "DN = BZERO + BSCALE * stored")?;
    cards.number("BZERO", 32768.0, "unsigned 16 bit")?;
    cards.text("BUNIT", "adu", "")?;
    cards.integer("FRAMENO", frame.number(), "number of the frame")?;
    cards.integer("BITDEPTH", u64::from(frame.bit_depth()), "bits of the converter")?;
    cards.text("ROWORDER", "TOP-DOWN", "the first row is the top row")?;
    times(&mut cards, header)?;
    if let Some(gain) = header.gain_e_per_dn {
        cards.number("GAIN", gain, "[electron/adu]")?;
    }
    if let Some([x, y, z]) = header.observer_velocity_km_s.map(<[f64; 3]>::from) {
        cards.number("OBSVELX", x, "[km/s] observer, barycentric, ICRS axes")?;
        cards.number("OBSVELY", y, "[km/s]")?;
        cards.number("OBSVELZ", z, "[km/s]")?;
    }
    // The seed is written as text, because it has 64 bits and most readers treat FITS integers as signed.
    cards.text("SEED", &header.seed.to_string(), "seed of the scenario")?;
    cards.text("CREATOR", &format!("boresight {}", header.version), "")?;
    cards.text("CONFHASH", &header.configuration_hash, "")?;
    if let Some(regions) = frame.windows() {
        cards.integer("NROI", regions.len() as u64, "transmitted regions; all else is 0")?;
        for (number, window) in (1..).zip(regions) {
            cards.text(&format!("ROI{number}"), &windows::format_one(window), "x y columns rows, from 0")?;
        }
    }
    cards.text("RADESYS", "ICRS", "")?;
    if let Some(wcs) = &header.wcs {
        world_coordinates(&mut cards, wcs)?;
    }
    Ok(cards.cards)
}

fn times(cards: &mut Cards<'_>, header: &FrameHeader) -> Result<(), FileError> {
    cards.number("EXPTIME", header.exposure_s, "[s]")?;
    cards.text("TIMESYS", "UTC", "")?;
    let half = Unit::Second * (0.5 * header.exposure_s);
    for (keyword, time, comment) in [
        ("DATE-BEG", header.time - half, "start of the exposure"),
        ("DATE-AVG", header.time, "middle of the exposure"),
        ("DATE-END", header.time + half, "end of the exposure"),
    ] {
        let text = format_utc(time);
        // FITS takes the time scale from TIMESYS and does not allow `Z`.
        cards.text(keyword, text.trim_end_matches('Z'), comment)?;
    }
    Ok(())
}

fn world_coordinates(cards: &mut Cards<'_>, wcs: &TanSip) -> Result<(), FileError> {
    cards.integer("WCSAXES", 2, "")?;
    let suffix = if wcs.sip.is_some() { "-SIP" } else { "" };
    cards.text("CTYPE1", &format!("RA---TAN{suffix}"), "")?;
    cards.text("CTYPE2", &format!("DEC--TAN{suffix}"), "")?;
    cards.text("CUNIT1", "deg", "")?;
    cards.text("CUNIT2", "deg", "")?;
    cards.number("CRPIX1", wcs.crpix[0], "principal point, first pixel is 1")?;
    cards.number("CRPIX2", wcs.crpix[1], "")?;
    cards.number("CRVAL1", wcs.crval_deg[0], "[deg]")?;
    cards.number("CRVAL2", wcs.crval_deg[1], "[deg]")?;
    for (row, values) in wcs.cd_deg_per_px.iter().enumerate() {
        for (column, &value) in values.iter().enumerate() {
            cards.number(&format!("CD{}_{}", row + 1, column + 1), value, "[deg/pix]")?;
        }
    }
    // LONPOLE is written explicitly, because its default differs at the pole.
    cards.number("LONPOLE", 180.0, "[deg]")?;
    let astrometric = "World coordinates are astrometric, made from the truth: stellar";
    match &wcs.sip {
        Some(sip) => {
            for (name, terms) in [("A", &sip.a), ("B", &sip.b), ("AP", &sip.ap), ("BP", &sip.bp)] {
                polynomial(cards, name, sip.order, terms)?;
            }
            cards.comment(astrometric);
            cards.comment("aberration is folded into CRVAL, CD and the SIP polynomials,");
            cards.comment(&format!("which are fitted; largest residual {:.1e} pix.", sip.residual_px));
        }
        None => {
            cards.comment(astrometric);
            cards.comment("aberration is folded into CRVAL and CD. No SIP polynomial fits the");
            cards.comment("distortion at the corners: coordinates are accurate only near CRPIX.");
        }
    }
    Ok(())
}

fn polynomial(cards: &mut Cards<'_>, name: &str, order: usize, terms: &[SipTerm]) -> Result<(), FileError> {
    cards.integer(&format!("{name}_ORDER"), order as u64, "")?;
    for term in terms {
        cards.number(&format!("{name}_{}_{}", term.u_power, term.v_power), term.coefficient, "")?;
    }
    Ok(())
}
