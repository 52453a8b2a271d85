//! Charts of the report, and their common traces and layouts: lines, point clouds, intervals, bars, stacked
//! panels.

use serde::Serialize;

use super::plotly::{Axis, ErrorBars, Layout, Line, Marker, Mode, Symbol, Trace, Values};
use super::thinning::{extremes, sampled};
use crate::page::data_table::DataTable;
use crate::page::script_safe::script_safe;

/// Colour of true values.
pub const TRUTH: &str = "#2f9e69";
/// Colour of correct measurements.
pub const MEASURED: &str = "#3686c9";
/// Colour of wrong measurements.
pub const WRONG: &str = "#c9415a";
/// Colour of a second quantity beside the measurement: a mean, a limit.
pub const BESIDE: &str = "#e0752d";
/// Colour of reference values.
pub const REFERENCE: &str = "#7c8792";

/// Number of points below which each point is drawn larger and more opaque.
const FEW_POINTS: usize = 300;

/// A chart, its caption and its data table.
#[derive(Clone)]
pub struct Chart {
    /// Caption below the chart.
    pub caption: String,
    /// Height on the page, px.
    pub height_px: u32,
    /// Numbers in the chart, or a summary of them.
    pub data: DataTable,
    traces: Vec<Trace>,
    layout: Layout,
}

impl std::fmt::Debug for Chart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Chart").field("caption", &self.caption).finish_non_exhaustive()
    }
}

impl Chart {
    /// Creates a chart of these traces.
    pub fn new(
        caption: impl Into<String>,
        height_px: u32,
        data: DataTable,
        traces: Vec<Trace>,
        layout: Layout,
    ) -> Self {
        Self { caption: caption.into(), height_px, data, traces, layout }
    }

    /// Returns the figure as JSON for plotly.js, escaped for use inside a script tag.
    pub fn json(&self) -> String {
        #[derive(Serialize)]
        struct Figure<'a> {
            data: &'a [Trace],
            layout: &'a Layout,
        }
        // The figure consists of JSON values only, so serialisation cannot fail.
        let json = serde_json::to_string(&Figure { data: &self.traces, layout: &self.layout });
        script_safe(&json.unwrap_or_default())
    }
}

/// Rounds a number to `decimals` decimals; more would only lengthen the page.
pub fn rounded(value: f64, decimals: i32) -> f64 {
    let unit = (0..decimals).fold(1.0, |unit, _| unit * 10.0);
    (value * unit).round() / unit
}

/// Escapes external text for a chart, because plotly.js interprets tags as markup.
pub fn plain(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns a line trace.
pub fn line(name: &str, x: impl Into<Values>, y: Vec<f64>, colour: &str) -> Trace {
    Trace::scatter(Mode::Lines, x, y).name(plain(name)).line(Line::new(1.6).colour(colour))
}

/// Returns a trace of points.
pub fn points(name: &str, x: impl Into<Values>, y: Vec<f64>, colour: &str) -> Trace {
    let marker = Marker::new().size(4).colour(colour).opacity(0.85);
    Trace::scatter(Mode::Markers, x, y).name(plain(name)).marker(marker)
}

/// Returns a cloud of points for the given rows. If there are too many to draw, the cloud is a sample of them
/// with the extremes of `value` as rings. `make` returns the trace of given rows; without `value` no extremes
/// are drawn.
pub fn cloud(
    name: &str,
    rows: &[usize],
    value: Option<&dyn Fn(usize) -> f64>,
    colour: &str,
    make: impl Fn(&[usize]) -> Trace,
) -> Vec<Trace> {
    let of = |places: Vec<usize>| {
        let rows: Vec<usize> = places.into_iter().map(|place| rows[place]).collect();
        make(&rows).mode(Mode::Markers)
    };
    // Few points are seen one by one, many points as a density.
    let (size, opacity) = if rows.len() < FEW_POINTS { (5, 0.85) } else { (4, 0.6) };
    let marker = Marker::new().size(size).colour(colour).opacity(opacity);
    let mut traces = vec![of(sampled(rows.len())).name(plain(name)).marker(marker)];
    let rings = value.map_or_else(Vec::new, |value| extremes(rows.len(), &|place| value(rows[place])));
    if !rings.is_empty() {
        let marker = Marker::new().size(6).colour(REFERENCE).symbol(Symbol::Ring);
        traces.push(of(rings).name("smallest and largest of each fiftieth part".to_owned()).marker(marker));
    }
    traces
}

/// Returns a trace of points that stand out.
pub fn crosses(name: &str, x: impl Into<Values>, y: Vec<f64>, colour: &str) -> Trace {
    let marker = Marker::new().size(6).colour(colour).symbol(Symbol::Cross);
    Trace::scatter(Mode::Markers, x, y).name(plain(name)).marker(marker)
}

/// Returns values with the limits of their intervals, as points with error bars; the limits are absolute.
pub fn intervals(
    name: &str,
    x: impl Into<Values>,
    y: Vec<f64>,
    low: &[f64],
    high: &[f64],
    colour: &str,
) -> Trace {
    let bars = bars_to(&y, low, high);
    let marker = Marker::new().size(7).colour(colour);
    Trace::scatter(Mode::Markers, x, y).name(plain(name)).marker(marker).error_y(bars)
}

/// Returns values with the limits of their intervals along x, for names on the vertical axis.
pub fn intervals_across(
    name: &str,
    x: Vec<f64>,
    low: &[f64],
    high: &[f64],
    y: Vec<String>,
    colour: &str,
) -> Trace {
    let bars = bars_to(&x, low, high);
    let marker = Marker::new().size(7).colour(colour);
    let names: Vec<String> = y.iter().map(|name| plain(name)).collect();
    Trace::scatter(Mode::Markers, x, names).name(plain(name)).marker(marker).error_x(bars)
}

/// Returns error bars from values to the limits of their intervals.
fn bars_to(values: &[f64], low: &[f64], high: &[f64]) -> ErrorBars {
    let up: Vec<f64> = high.iter().zip(values).map(|(high, value)| (high - value).max(0.0)).collect();
    let down: Vec<f64> = low.iter().zip(values).map(|(low, value)| (value - low).max(0.0)).collect();
    ErrorBars::new(&up, &down)
}

/// Returns the band between two lines, as two traces: the lower edge, and the upper edge with the fill.
pub fn band(name: &str, x: Vec<f64>, low: Vec<f64>, high: Vec<f64>, fill: &str) -> [Trace; 2] {
    let edge = |x, y| Trace::scatter(Mode::Lines, x, y).line(Line::new(0.0)).name(plain(name));
    let below = edge(x.clone(), low).not_in_legend();
    [below, edge(x, high).fill_to_previous(fill)]
}

/// Returns a dashed line for a reference.
pub fn dashed(name: &str, x: impl Into<Values>, y: Vec<f64>, colour: &str) -> Trace {
    let style = Line::new(1.2).colour(colour).dashed();
    Trace::scatter(Mode::Lines, x, y).name(plain(name)).line(style)
}

/// Returns a bar chart with one bar per name.
pub fn bars(name: &str, x: &[String], y: Vec<f64>, colour: &str) -> Trace {
    let names: Vec<String> = x.iter().map(|x| plain(x)).collect();
    Trace::bars(names, y).name(plain(name)).marker(Marker::new().colour(colour))
}

/// Returns horizontal bars, one per name, each with its colour; the last is on top.
pub fn bars_across(names: &[String], values: Vec<f64>, colours: Vec<&str>) -> Trace {
    let names: Vec<String> = names.iter().map(|name| plain(name)).collect();
    let marker = Marker::new().colours(&colours);
    Trace::bars_across(values, names)
        .marker(marker)
        .hover_template("%{y}: %{x}<extra></extra>")
        .not_in_legend()
}

/// Returns the layout of stacked bars.
pub fn stacked_bars(x_title: &str, y_title: &str) -> Layout {
    // The legend is forced: with a single kind of bar it would be hidden, and the kind unnamed.
    axes(x_title, y_title).stacked_bars(0.4).legend(true)
}

/// Returns the layout of one pair of axes.
pub fn axes(x_title: &str, y_title: &str) -> Layout {
    Layout::new(Axis::titled(x_title), Axis::titled(y_title))
}

/// Returns a logarithmic axis whose tick labels are complete numbers, since the default label 2 may mean 20.
/// It has few ticks, because those below a power of ten are close together.
pub fn log_axis(title: &str) -> Axis {
    Axis::titled(title).logarithmic().tick_format("~g").max_ticks(4)
}

/// Returns the ticks of a low panel with a logarithmic axis: powers of ten, or 1 and 3, or 1, 2 and 5 times
/// each power. The coarsest set with at least two ticks is chosen, so that labels do not overlap.
fn log_ticks(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (libm::floor(libm::log10(low)) as i32, libm::ceil(libm::log10(high)) as i32);
    let every = ((last - first) / 4).max(1) as usize;
    let ticks = |digits: &[f64]| -> Vec<f64> {
        let powers = (first..=last).step_by(every).map(|power| libm::pow(10.0, f64::from(power)));
        let all = powers.flat_map(|power| digits.iter().map(move |digit| digit * power));
        all.filter(|tick| (low..=high).contains(tick)).collect()
    };
    let sets: [&[f64]; 3] = [&[1.0], &[1.0, 3.0], &[1.0, 2.0, 5.0]];
    sets.into_iter().map(ticks).find(|ticks| ticks.len() > 1).unwrap_or_else(|| vec![low, high])
}

/// Traces with a separate vertical axis, in a stack of panels over one common horizontal axis.
pub struct Panel {
    /// Title of the vertical axis.
    pub title: String,
    /// Traces drawn in the panel.
    pub traces: Vec<Trace>,
    /// Limits of the vertical axis; `None`: those of the traces.
    pub range: Option<[f64; 2]>,
    /// Limits of a logarithmic vertical axis; `None` for a linear axis.
    pub log: Option<[f64; 2]>,
}

impl Panel {
    /// Creates a panel with a title and its traces.
    pub fn new(title: impl Into<String>, traces: Vec<Trace>) -> Self {
        Self { title: title.into(), traces, range: None, log: None }
    }
}

/// Stacks panels above each other over one common axis. Only the traces of the first panel are in the legend.
pub fn stacked(x: Axis, panels: Vec<Panel>) -> (Vec<Trace>, Layout) {
    let count = panels.len().max(1);
    let (height, gap) = (1.0 / count as f64, 0.035);
    let name = |index: usize| if index == 0 { "y".to_owned() } else { format!("y{}", index + 1) };
    let mut layout = Layout::default().x_axis(x.anchor(&name(count - 1)));
    let mut traces: Vec<Trace> = Vec::new();
    for (index, panel) in panels.into_iter().enumerate() {
        let top = 1.0 - index as f64 * height;
        let bottom = if index + 1 == count { 0.0 } else { top - height + gap };
        let axis = match panel.log {
            Some([low, high]) => log_axis(&panel.title)
                .ticks(&log_ticks(low, high))
                .range([libm::log10(low) - 0.1, libm::log10(high) + 0.1]),
            None => Axis::titled(&panel.title),
        };
        let mut axis = axis.domain([bottom, top]);
        if let Some(ends) = panel.range {
            axis = axis.range(ends);
        }
        layout = layout.y_axis(&name(index), axis);
        for trace in panel.traces {
            let trace = trace.y_axis(&name(index));
            traces.push(if index == 0 { trace } else { trace.not_in_legend() });
        }
    }
    (traces, layout)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_in_powers_of_ten_has_two_ticks_and_few_more() {
        for (low, high) in
            [(0.004, 0.05), (0.004, 0.06), (0.011, 0.019), (2e-5, 0.3), (1e-6, 0.5), (1e-9, 10.0)]
        {
            let ticks = log_ticks(low, high);
            assert!((2..=6).contains(&ticks.len()), "{low} to {high}: {ticks:?}");
        }
    }
}
