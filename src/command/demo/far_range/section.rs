//! Section of the demo's page on the far range.

use far_range::scoring::names;
use far_range_views::report::findings;
use files::Failure;
use report::charts::chart::{
    BESIDE, Chart, MEASURED, REFERENCE, TRUTH, WRONG, axes, bars, rounded, stacked_bars,
};
use report::page::data_table::DataTable;
use report::verdict::Finding;
use report::{Link, Section, pictures_of_run};

use super::{FarRangeResults, MethodResult, direction_rms_arcsec};
use crate::command::demo::{percent_or_dash, value};

/// Frames that are shown: the first of each day after the warm-up, and the last.
const SHOWN_FRAMES: [u64; 3] = [66, 186, 425];

impl FarRangeResults {
    /// Returns the properties of the runs for the head of the page.
    pub(in crate::command::demo) fn facts(&self) -> Vec<(&'static str, String)> {
        let [nearest, farthest] = self.range_km;
        vec![
            ("Far range", format!("{} images", self.best.score.frames)),
            ("Distance", format!("{farthest:.0} to {nearest:.1} km")),
        ]
    }

    /// Returns the findings on the best method.
    pub(in crate::command::demo) fn findings(&self) -> Vec<Finding> {
        let of_part =
            |finding: Finding| Finding { subject: format!("far range, {}", finding.subject), ..finding };
        findings(&self.best.score).into_iter().map(of_part).collect()
    }

    /// Returns the section: outcomes and errors of both methods, frames, links.
    ///
    /// # Errors
    /// A [`Failure`] when a frame cannot be drawn.
    pub(in crate::command::demo) fn section(&self) -> Result<Section, Failure> {
        let methods = [&self.best, &self.paper];
        let pictures = pictures_of_run(&self.best.directory, &SHOWN_FRAMES)?;
        Ok(Section::new("stars", "Far range: a spacecraft among the stars")
            .text(format!(
                "A star camera looks ahead along the orbit of ARGON, the far-range rendezvous of PRISMA in \
                 April 2012. The other spacecraft is a point of light among stars, hot pixels and cosmic-ray \
                 hits. The first {} images, in which the method of 2012 learns the hot pixels, count for \
                 neither method.",
                self.best.score.warm_up_frames
            ))
            .chart(outcomes(methods))
            .chart(errors_by_day(methods))
            .text("Three of the images, with the truth and the measurement of the best method:")
            .pictures(pictures)
            .links(vec![
                Link::new("far-range/report.html", "Report of the best method"),
                Link::new("far-range-2012/report.html", "Report of the method of 2012"),
            ]))
    }
}

/// Returns the chart of correct, wrong and missed images by method.
fn outcomes(methods: [&MethodResult; 2]) -> Chart {
    let kinds = [
        ("correct", names::CORRECT_RATE, TRUTH),
        ("wrong", names::WRONG_RATE, WRONG),
        ("missed", names::MISS_RATE, REFERENCE),
    ];
    let names = methods.map(|method| method.name.to_owned());
    let mut table = DataTable::new(["method", "correct", "wrong", "missed"]);
    for method in methods {
        let cell = |(_, key, _)| percent_or_dash(value(&method.score.figures, key));
        table.push([vec![method.name.to_owned()], kinds.map(cell).to_vec()].concat());
    }
    let percents = |key| methods.map(|method| 100.0 * value(&method.score.figures, key).unwrap_or(0.0));
    let traces = kinds.map(|(name, key, colour)| {
        bars(name, &names, percents(key).map(|percent| rounded(percent, 2)).to_vec(), colour)
    });
    let caption = "The same images by two built-in methods: left the best one, which every scenario uses unless \
        it names another; right the method of the paper of 2012, built in to reproduce its published table. \
        Wrong: something else was taken for the spacecraft. Missed: no answer.";
    Chart::new(caption, 340, table, traces.to_vec(), stacked_bars("", "images, %"))
}

/// Returns the chart of the errors of the direction by day and method.
fn errors_by_day(methods: [&MethodResult; 2]) -> Chart {
    let days: Vec<String> =
        methods[0].score.groups.keys().filter(|name| *name != score::WARM_UP).cloned().collect();
    let mut table = DataTable::new([vec!["method".to_owned()], days.clone()].concat());
    let mut traces = Vec::new();
    for (method, colour) in methods.into_iter().zip([MEASURED, BESIDE]) {
        let of_day = |day: &String| direction_rms_arcsec(&method.score.groups.get(day)?.figures);
        let arcsec: Vec<f64> = days.iter().map(|day| rounded(of_day(day).unwrap_or(0.0), 2)).collect();
        let cells = arcsec.iter().map(|arcsec| format!("{arcsec:.1}″")).collect();
        table.push([vec![method.name.to_owned()], cells].concat());
        traces.push(bars(method.name, &days, arcsec, colour));
    }
    let caption = "RMS error of the direction to the spacecraft, of the correct measurements. From day 1 to day 5 \
        the distance shrinks and the over-exposed image of the spacecraft is cut by the camera's regions of \
        interest; the best method fits the cut image, the method of 2012 takes the centre of what is left.";
    Chart::new(caption, 340, table, traces, axes("", "error, arcsec"))
}
