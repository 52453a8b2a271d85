//! Attitude of the camera, and the effect of aberration on it.

use ::report::charts::axis_limits::{limits, note_outside, outside};
use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, TRUTH, cloud, line, points, rounded, stacked,
};
use ::report::charts::thinning::{bins, thinned, thinning_caption};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use contract::{Body, CameraFrame, Direction, Rotation};
use files::Failure;
use sim::truth::Observer;

use super::run::{FarRangeRun, broken, by_bins, shown_time_ms, time_axis};

/// Number of rows of the table behind the chart of aberration corrections.
const TABLE_BINS: usize = 60;
/// Speed of light, km/s.
const LIGHT_KM_S: f64 = 299_792.458;

/// Returns the section on the camera's attitude with respect to the chaser.
pub(super) fn mounting(run: &FarRangeRun) -> Section {
    let count = run.truths.len();
    let degrees = |rotation: Rotation<CameraFrame, Body>| {
        let (phi, theta, psi) = rotation.euler_123();
        [phi.degrees(), theta.degrees(), psi.degrees()]
    };
    let measured: Vec<[f64; 3]> = (0..count)
        .map(|row| {
            let camera = run.outcomes[row].as_ref().and_then(|outcome| outcome.camera_from_icrs);
            camera.map_or([f64::NAN; 3], |camera| {
                degrees(camera * run.telemetry[row].telemetry.body_from_icrs.inverse())
            })
        })
        .collect();
    let section =
        Section::new("mounting", "Attitude of the camera with respect to the chaser").in_paper("Fig. 8");
    let stated: Vec<usize> = (0..count).filter(|&row| measured[row][0].is_finite()).collect();
    if stated.is_empty() {
        return section.absent("The pipeline reports no attitude of the camera.");
    }
    let truth =
        |row: usize| degrees(run.truths[row].camera_from_icrs * run.truths[row].body_from_icrs.inverse());
    let every = thinned(count, &[]);
    let mut beyond = 0;
    let panels = ["φ, °", "θ, °", "ψ, °"].into_iter().enumerate().map(|(index, title)| {
        let value = |row: usize| measured[row][index];
        let mut traces = cloud("measured", &stated, Some(&value), MEASURED, |rows| {
            let y = rows.iter().map(|&row| rounded(value(row), 5)).collect();
            points("", run.times(rows), y, MEASURED)
        });
        let (true_x, true_y) = broken(run, every.iter().map(|&row| (row, rounded(truth(row)[index], 5))));
        traces.push(line("true", true_x, true_y, TRUTH));
        let range =
            limits(stated.iter().map(|&row| value(row)).chain(every.iter().map(|&row| truth(row)[index])));
        beyond += outside(range, stated.iter().map(|&row| value(row)));
        Panel { range: Some(range), ..Panel::new(title, traces) }
    });
    let panels: Vec<Panel> = panels.collect();
    let (traces, layout) = stacked(time_axis(run), panels);
    let data = by_bins(
        run,
        &[
            ("φ, °", &|row| measured[row][0], 4),
            ("θ, °", &|row| measured[row][1], 4),
            ("ψ, °", &|row| measured[row][2], 4),
        ],
    );
    section.chart(Chart::new(
        format!(
            "Euler angles 123 of the rotation from the chaser's body to the camera: the camera's attitude by \
             the pipeline against the body's attitude by telemetry. It contains the noise of both. {} {}",
            note_outside(beyond, 3 * stated.len(), "angles"),
            thinning_caption(&[(stated.len(), "attitudes")], true)
        ),
        600,
        data,
        traces,
        layout,
    ))
}

/// Returns the section on the correction angles of the aberration.
pub(super) fn aberration(run: &FarRangeRun) -> Result<Section, Failure> {
    let count = run.truths.len();
    // The angles are smooth functions of time: a sparse sample suffices.
    let rows = thinned(count, &[]);
    let mut angles = Vec::with_capacity(rows.len());
    for &row in &rows {
        let truth = &run.truths[row];
        let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s)?;
        let bore = truth.camera_from_icrs.inverse() * Direction::z();
        let correction = observer.barycentric_velocity_km_s().cross(bore.vector()) / LIGHT_KM_S;
        let in_camera = truth.camera_from_icrs.rotate(&correction);
        angles.push([in_camera.x.to_degrees(), in_camera.y.to_degrees(), correction.norm().to_degrees()]);
    }
    let component = |name: &str, index: usize, colour| {
        let values = rows.iter().zip(&angles).map(|(&row, angle)| (row, rounded(angle[index], 6)));
        let (x, y) = broken(run, values);
        line(name, x, y, colour)
    };
    let traces = vec![
        component("about x", 0, MEASURED),
        component("about y", 1, BESIDE),
        component("total", 2, REFERENCE),
    ];
    let (traces, layout) = stacked(time_axis(run), vec![Panel::new("angle, °", traces)]);
    let mut data = DataTable::new(["time (UTC)", "about x, °", "about y, °", "total, °"]);
    for bin in bins(rows.len(), TABLE_BINS) {
        let angle = angles[bin.start];
        data.push([
            shown_time_ms(&run.truths[rows[bin.start]]),
            format!("{:.6}", angle[0]),
            format!("{:.6}", angle[1]),
            format!("{:.6}", angle[2]),
        ]);
    }
    Ok(Section::new("aberration", "Angles of the aberration correction").in_paper("Fig. 9").chart(Chart::new(
        "Rotation of the camera's attitude about its axes that corrects for aberration, for the true velocity about the Sun. It \
         oscillates along the orbit, because the chaser's orbital velocity adds to the Earth's.",
        340,
        data,
        traces,
        layout,
    )))
}
