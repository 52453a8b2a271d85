//! Point-spread function from a file of the user.
//!
//! The file holds the flux in each cell of a grid finer than the pixels, before integration over pixels: the
//! output of an optical design program, or a measured image after deconvolution. Cell centres are
//! `1/oversampling` px apart.

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

use std::path::Path;

use config::regular_file;
use truth::SimError;

use super::cumulative_flux::CumulativeFlux;

/// Maximum size of a file that is read, bytes: 2048 × 2048 cells of sixteen characters.
const MAX_BYTES: u64 = 1 << 26;
/// Allowed number of cells along a side.
const CELLS: std::ops::RangeInclusive<usize> = 3..=2048;

/// Largest flux of a cell, in any unit. Sums and moments of larger numbers could overflow.
const MAX_CELL_FLUX: f64 = 1e100;

/// Reads a shape from a file, normalised to unit flux, with its centroid at the centre.
///
/// # Errors
/// [`SimError::PsfFile`] if the file cannot be read or does not hold a matrix of numbers that are 0 or more.
pub(super) fn sampled(path: &Path, oversampling: f64) -> Result<CumulativeFlux, SimError> {
    let fail = |problem: String| SimError::PsfFile { path: path.to_path_buf(), problem };
    let text = regular_file::read_text(path, MAX_BYTES).map_err(|error| fail(error.to_string()))?;
    let (mut light, columns) = matrix(&text).map_err(fail)?;
    let (mut flux, mut moment_x, mut moment_y) = (0.0, 0.0, 0.0);
    for (j, row) in light.chunks_exact(columns).enumerate() {
        for (i, &cell) in row.iter().enumerate() {
            flux += cell;
            moment_x += cell * i as f64;
            moment_y += cell * j as f64;
        }
    }
    if flux <= 0.0 {
        return Err(fail(format!("its sum is {flux}, expected more than 0")));
    }
    for cell in &mut light {
        *cell /= flux;
    }
    let step_px = 1.0 / oversampling;
    Ok(CumulativeFlux::cells(
        &light,
        columns,
        step_px,
        [moment_x, moment_y].map(|moment| -moment / flux * step_px),
    ))
}

/// Parses the numbers row by row, and returns them with the number of columns.
fn matrix(text: &str) -> Result<(Vec<f64>, usize), String> {
    let (mut light, mut columns, mut rows) = (Vec::new(), 0, 0);
    let lines = (1..).zip(text.strip_prefix('\u{feff}').unwrap_or(text).lines());
    for (line, content) in lines.filter(|(_, content)| !content.trim().is_empty()) {
        let before = light.len();
        for (column, cell) in (1..).zip(content.split(',').map(str::trim)) {
            match cell.parse::<f64>() {
                Ok(value) if (0.0..=MAX_CELL_FLUX).contains(&value) => light.push(value),
                _ => {
                    return Err(format!(
                        "line {line}, cell {column} is `{cell}`, expected a number of 0 to 1e100"
                    ));
                }
            }
        }
        let found = light.len() - before;
        if rows == 0 {
            columns = found;
        }
        if found != columns || !CELLS.contains(&found) {
            return Err(format!(
                "line {line} has {found} cells, expected as many as the first line, {} to {}",
                CELLS.start(),
                CELLS.end()
            ));
        }
        rows += 1;
        if rows > *CELLS.end() {
            break;
        }
    }
    if CELLS.contains(&rows) {
        Ok((light, columns))
    } else {
        let more = if rows > *CELLS.end() { " or more" } else { "" };
        Err(format!("it has {rows} rows{more}, expected {} to {}", CELLS.start(), CELLS.end()))
    }
}
