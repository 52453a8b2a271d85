//! Charts: traces and layouts of the charting library, as the pages use them.

use plotly::common::{DashType, ErrorData, ErrorType, Fill, Line, Marker, MarkerSymbol, Mode};
use plotly::layout::{Axis, AxisType, BarMode};
use plotly::{Bar, Layout, Scatter, Trace, Traces};
use serde::Serialize;

use super::page::{DataTable, script_safe};
use super::thin::{extremes, sampled};

/// What is true.
pub(super) const TRUTH: &str = "#2f9e69";
/// What was measured, and is right.
pub(super) const MEASURED: &str = "#3686c9";
/// What was measured, and is wrong.
pub(super) const WRONG: &str = "#c9415a";
/// A second thing beside the measured one: a mean, a limit.
pub(super) const BESIDE: &str = "#e0752d";
/// What is only there to be compared with.
pub(super) const REFERENCE: &str = "#7c8792";

/// Points that are few.
const FEW: usize = 300;

/// A chart, the words below it and the table behind it.
#[derive(Clone)]
pub struct Chart {
    /// What it shows.
    pub caption: String,
    /// Height on the page, px.
    pub height_px: u32,
    /// The numbers in it, or a summary of them.
    pub data: DataTable,
    traces: Traces,
    layout: Layout,
}

impl std::fmt::Debug for Chart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Chart").field("caption", &self.caption).finish_non_exhaustive()
    }
}

impl Chart {
    /// A chart of these traces.
    pub(super) fn new(
        caption: impl Into<String>,
        height_px: u32,
        data: DataTable,
        traces: Vec<Box<dyn Trace>>,
        layout: Layout,
    ) -> Self {
        let mut all = Traces::new();
        traces.into_iter().for_each(|trace| all.push(trace));
        Self { caption: caption.into(), height_px, data, traces: all, layout }
    }

    /// The figure as the charting library takes it, safe inside a script tag.
    pub fn json(&self) -> String {
        #[derive(Serialize)]
        struct Figure<'a> {
            data: &'a Traces,
            layout: &'a Layout,
        }
        // Numbers, words and lists alone: there is nothing that JSON lacks. What is not finite becomes null, a gap.
        let json = serde_json::to_string(&Figure { data: &self.traces, layout: &self.layout });
        script_safe(&json.unwrap_or_default())
    }
}

/// Points or a line of numbers over x, in the box in which the charting library makes them.
pub(super) type Curve<X> = Box<Scatter<X, f64>>;

/// A number with so many decimals: more would only make the page longer.
pub(super) fn rounded(value: f64, decimals: i32) -> f64 {
    let unit = (0..decimals).fold(1.0, |unit, _| unit * 10.0);
    (value * unit).round() / unit
}

/// Words of somebody else's for a chart, which would take tags in them for markup.
pub(super) fn plain(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A line.
pub(super) fn line<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    y: Vec<f64>,
    colour: &'static str,
) -> Curve<X> {
    Scatter::new(x, y).name(plain(name)).mode(Mode::Lines).line(Line::new().width(1.6).color(colour))
}

/// Points.
pub(super) fn points<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    y: Vec<f64>,
    colour: &'static str,
) -> Curve<X> {
    let marker = Marker::new().size(4).color(colour).opacity(0.85);
    Scatter::new(x, y).name(plain(name)).mode(Mode::Markers).marker(marker)
}

/// A cloud of the points of some rows, and, where they are too many to be drawn, a sample of them with their extremes as rings. `make` draws
/// rows; `value` is what the extremes are of, and where there is none no extremes are drawn.
pub(super) fn cloud<X: Serialize + Clone + 'static>(
    name: &str,
    rows: &[usize],
    value: Option<&dyn Fn(usize) -> f64>,
    colour: &'static str,
    make: impl Fn(&[usize]) -> Curve<X>,
) -> Vec<Curve<X>> {
    let of = |places: Vec<usize>| -> Curve<X> {
        let rows: Vec<usize> = places.into_iter().map(|place| rows[place]).collect();
        make(&rows).mode(Mode::Markers)
    };
    // Few points are looked at one by one, of many their density.
    let (size, opacity) = if rows.len() < FEW { (5, 0.85) } else { (4, 0.6) };
    let marker = Marker::new().size(size).color(colour).opacity(opacity);
    let mut traces = vec![of(sampled(rows.len())).name(plain(name)).marker(marker)];
    let rings = value.map_or_else(Vec::new, |value| extremes(rows.len(), &|place| value(rows[place])));
    if !rings.is_empty() {
        let marker = Marker::new().size(6).color(REFERENCE).symbol(MarkerSymbol::CircleOpen);
        traces.push(of(rings).name("smallest and largest of each fiftieth").marker(marker));
    }
    traces
}

/// Points that stand out.
pub(super) fn crosses<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    y: Vec<f64>,
    colour: &'static str,
) -> Curve<X> {
    let marker = Marker::new().size(6).color(colour).symbol(MarkerSymbol::X);
    Scatter::new(x, y).name(plain(name)).mode(Mode::Markers).marker(marker)
}

/// Values with the limits of their intervals, as points with bars; the limits are absolute.
pub(super) fn intervals<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    y: Vec<f64>,
    low: &[f64],
    high: &[f64],
    colour: &'static str,
) -> Curve<X> {
    let up = high.iter().zip(&y).map(|(high, y)| (high - y).max(0.0)).collect();
    let down = low.iter().zip(&y).map(|(low, y)| (y - low).max(0.0)).collect();
    let bars = ErrorData::new(ErrorType::Data).symmetric(false).array(up).array_minus(down).thickness(1.2);
    Scatter::new(x, y)
        .name(plain(name))
        .mode(Mode::Markers)
        .marker(Marker::new().size(7).color(colour))
        .error_y(bars)
}

/// The same along x, for names down the side.
pub(super) fn intervals_across(
    name: &str,
    x: Vec<f64>,
    low: &[f64],
    high: &[f64],
    y: Vec<String>,
    colour: &'static str,
) -> Box<Scatter<f64, String>> {
    let up = high.iter().zip(&x).map(|(high, x)| (high - x).max(0.0)).collect();
    let down = low.iter().zip(&x).map(|(low, x)| (x - low).max(0.0)).collect();
    let bars = ErrorData::new(ErrorType::Data).symmetric(false).array(up).array_minus(down).thickness(1.2);
    Scatter::new(x, y.iter().map(|name| plain(name)).collect())
        .name(plain(name))
        .mode(Mode::Markers)
        .marker(Marker::new().size(7).color(colour))
        .error_x(bars)
}

/// The room between two lines, as two traces: its lower edge, and its upper one with the fill.
pub(super) fn band<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    low: Vec<f64>,
    high: Vec<f64>,
    fill: &'static str,
) -> [Curve<X>; 2] {
    let edge = |x, y| Scatter::new(x, y).mode(Mode::Lines).line(Line::new().width(0.0)).name(plain(name));
    let below = edge(x.clone(), low).show_legend(false);
    [below, edge(x, high).fill(Fill::ToNextY).fill_color(fill)]
}

/// A line that is there to be compared with.
pub(super) fn dashed<X: Serialize + Clone + 'static>(
    name: &str,
    x: Vec<X>,
    y: Vec<f64>,
    colour: &'static str,
) -> Curve<X> {
    let style = Line::new().width(1.2).color(colour).dash(DashType::Dash);
    Scatter::new(x, y).name(plain(name)).mode(Mode::Lines).line(style)
}

/// Bars, one a name.
pub(super) fn bars(name: &str, x: Vec<String>, y: Vec<f64>, colour: &'static str) -> Box<Bar<String, f64>> {
    Bar::new(x.iter().map(|x| plain(x)).collect(), y).name(plain(name)).marker(Marker::new().color(colour))
}

/// The layout of stacked bars.
pub(super) fn stacked_bars(x_title: &str, y_title: &str) -> Layout {
    // One kind of bar alone would have no name otherwise.
    axes(x_title, y_title).bar_mode(BarMode::Stack).bar_gap(0.4).show_legend(true)
}

/// The layout of one pair of axes.
pub(super) fn axes(x_title: &str, y_title: &str) -> Layout {
    Layout::new().x_axis(Axis::new().title(x_title)).y_axis(Axis::new().title(y_title))
}

/// An axis in powers of ten, with whole numbers at its ticks: a lone 2 may be 20. Few of them, as those before a power are close.
pub(super) fn log_axis(title: &str) -> Axis {
    Axis::new().title(title).type_(AxisType::Log).tick_format("~g").n_ticks(4)
}

/// Ticks of a low panel with an axis in powers of ten: powers, or 1 and 3, or 1, 2 and 5 of each, the fewest that are two, so that no label
/// covers another.
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

/// Some traces with an axis of their own, in a stack of them over one common axis.
pub(super) struct Panel<X: Serialize + Clone + 'static> {
    /// Title of its axis.
    pub(super) title: String,
    /// What is drawn in it.
    pub(super) traces: Vec<Curve<X>>,
    /// Limits of its axis; `None`: those of what is drawn.
    pub(super) range: Option<[f64; 2]>,
    /// Limits of an axis in powers of ten; `None` for a common one.
    pub(super) log: Option<[f64; 2]>,
}

impl<X: Serialize + Clone + 'static> Panel<X> {
    pub(super) fn new(title: impl Into<String>, traces: Vec<Curve<X>>) -> Self {
        Self { title: title.into(), traces, range: None, log: None }
    }
}

/// Panels above each other, at most eight, over one common axis. The legend is that of the first.
pub(super) fn stacked<X: Serialize + Clone + 'static>(
    x: Axis,
    panels: Vec<Panel<X>>,
) -> (Vec<Box<dyn Trace>>, Layout) {
    let count = panels.len().max(1);
    let (height, gap) = (1.0 / count as f64, 0.035);
    let anchor = if count == 1 { "y".to_owned() } else { format!("y{count}") };
    let mut layout = Layout::new().x_axis(x.anchor(&anchor));
    let mut traces: Vec<Box<dyn Trace>> = Vec::new();
    for (index, panel) in panels.into_iter().enumerate() {
        let top = 1.0 - index as f64 * height;
        let bottom = if index + 1 == count { 0.0 } else { top - height + gap };
        let axis = match panel.log {
            Some([low, high]) => log_axis(&panel.title)
                .tick_values(log_ticks(low, high))
                .range(vec![libm::log10(low) - 0.1, libm::log10(high) + 0.1]),
            None => Axis::new().title(panel.title.as_str()),
        };
        let mut axis = axis.domain(&[bottom, top]);
        if let Some([low, high]) = panel.range {
            axis = axis.range(vec![low, high]);
        }
        layout = match index {
            0 => layout.y_axis(axis),
            1 => layout.y_axis2(axis),
            2 => layout.y_axis3(axis),
            3 => layout.y_axis4(axis),
            4 => layout.y_axis5(axis),
            5 => layout.y_axis6(axis),
            6 => layout.y_axis7(axis),
            _ => layout.y_axis8(axis),
        };
        let name = if index == 0 { "y".to_owned() } else { format!("y{}", index + 1) };
        for trace in panel.traces {
            let trace = trace.y_axis(&name);
            traces.push(if index == 0 { trace } else { trace.show_legend(false) });
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
