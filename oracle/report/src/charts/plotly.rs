//! Traces and layouts of charts, as JSON for plotly.js.
//!
//! The types hold only the attributes that the charts use, under plotly.js's names;
//! <https://plotly.com/javascript/reference/> defines the attributes. Numbers are as short as is useful:
//! integers without a decimal point, other numbers with at most nine significant digits.

use serde::Serialize;
use serde_json::{Map, Value};

/// Attributes of a plotly.js object.
#[derive(Debug, Clone, Default, Serialize)]
#[serde(transparent)]
struct Attributes(Map<String, Value>);

impl Attributes {
    /// Sets an attribute, replacing an earlier value.
    fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.0.insert(name.to_owned(), value.into());
        self
    }

    fn into_value(self) -> Value {
        Value::Object(self.0)
    }
}

/// Returns a number as JSON; a number that is not finite becomes null, which leaves a gap.
fn number(value: f64) -> Value {
    /// Limit (2⁵³) above which not every integer is representable as a float.
    const MAX_EXACT_INTEGER: f64 = 9_007_199_254_740_992.0;
    if value.fract() == 0.0 && value.abs() <= MAX_EXACT_INTEGER {
        return Value::from(value as i64);
    }
    // The formatted text always parses as a float, and a number that is not finite has no JSON.
    let short = format!("{value:.8e}").parse().unwrap_or(value);
    serde_json::Number::from_f64(short).map_or(Value::Null, Value::Number)
}

fn numbers(values: &[f64]) -> Value {
    values.iter().map(|&value| number(value)).collect()
}

/// Values along an axis, or one per point.
#[derive(Debug, Clone)]
pub struct Values(Value);

impl From<Vec<f64>> for Values {
    fn from(values: Vec<f64>) -> Self {
        Self(numbers(&values))
    }
}

impl From<Vec<u64>> for Values {
    fn from(values: Vec<u64>) -> Self {
        Self(Value::from(values))
    }
}

impl From<Vec<String>> for Values {
    fn from(values: Vec<String>) -> Self {
        Self(Value::from(values))
    }
}

/// Drawing mode of a scatter trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Lines.
    Lines,
    /// Markers.
    Markers,
    /// Lines with markers.
    LinesAndMarkers,
    /// Texts.
    Text,
}

impl Mode {
    fn code(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Markers => "markers",
            Self::LinesAndMarkers => "lines+markers",
            Self::Text => "text",
        }
    }
}

/// Shape of a marker other than a dot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symbol {
    /// A cross.
    Cross,
    /// A ring.
    Ring,
    /// A square.
    Square,
}

impl Symbol {
    fn code(self) -> &'static str {
        match self {
            Self::Cross => "x",
            Self::Ring => "circle-open",
            Self::Square => "square-open",
        }
    }
}

/// Position of a text relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextPosition {
    /// Above and to the right.
    TopRight,
    /// To the left.
    MiddleLeft,
}

impl TextPosition {
    fn code(self) -> &'static str {
        match self {
            Self::TopRight => "top right",
            Self::MiddleLeft => "middle left",
        }
    }
}

/// Colour scale of a heat map, from its smallest to its largest value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourScale {
    /// Colours from dark blue to yellow.
    Viridis,
    /// Colours from blue through grey to red.
    BlueToRed,
}

impl ColourScale {
    fn code(self) -> &'static str {
        match self {
            Self::Viridis => "Viridis",
            Self::BlueToRed => "RdBu",
        }
    }
}

/// Style of a line.
#[derive(Debug, Clone)]
pub struct Line(Attributes);

impl Line {
    /// Creates a solid line; `width` in px.
    pub fn new(width: f64) -> Self {
        Self(Attributes::default().with("width", number(width)))
    }

    /// Sets the colour.
    pub fn colour(self, colour: &str) -> Self {
        Self(self.0.with("color", colour))
    }

    /// Makes the line dashed.
    pub fn dashed(self) -> Self {
        Self(self.0.with("dash", "dash"))
    }
}

/// Style of the markers of points or of bars.
#[derive(Debug, Clone, Default)]
pub struct Marker(Attributes);

impl Marker {
    /// Creates the style of dots of the default size, or of bars.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the diameter, px.
    pub fn size(self, px: u32) -> Self {
        Self(self.0.with("size", px))
    }

    /// Sets the colour.
    pub fn colour(self, colour: &str) -> Self {
        Self(self.0.with("color", colour))
    }

    /// Sets the colour of every bar.
    pub fn colours(self, colours: &[&str]) -> Self {
        Self(self.0.with("color", colours.to_vec()))
    }

    /// Sets the opacity, 0 to 1.
    pub fn opacity(self, opacity: f64) -> Self {
        Self(self.0.with("opacity", number(opacity)))
    }

    /// Sets the symbol.
    pub fn symbol(self, symbol: Symbol) -> Self {
        Self(self.0.with("symbol", symbol.code()))
    }
}

/// Error bars from a point to the limits of its interval.
#[derive(Debug, Clone)]
pub struct ErrorBars(Attributes);

impl ErrorBars {
    /// Creates error bars of these lengths, one per point: `up` extends upwards or to the right, `down`
    /// downwards or to the left.
    pub fn new(up: &[f64], down: &[f64]) -> Self {
        let bars = Attributes::default().with("type", "data").with("symmetric", false).with("thickness", 1.2);
        Self(bars.with("array", numbers(up)).with("arrayminus", numbers(down)))
    }
}

/// A series of a chart: points, a line, bars or a heat map.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub struct Trace(Attributes);

impl Trace {
    /// All trace types that a report draws; the embedded plotly.js bundle must support them.
    #[cfg(test)]
    pub const TRACE_TYPES: [&str; 3] = ["scatter", "bar", "heatmap"];

    fn new(kind: &str, x: impl Into<Values>, y: impl Into<Values>) -> Self {
        Self(Attributes::default().with("type", kind).with("x", x.into().0).with("y", y.into().0))
    }

    /// Creates points, a line through them, or texts beside them.
    pub fn scatter(mode: Mode, x: impl Into<Values>, y: impl Into<Values>) -> Self {
        Self::new("scatter", x, y).mode(mode)
    }

    /// Creates vertical bars.
    pub fn bars(x: impl Into<Values>, y: impl Into<Values>) -> Self {
        Self::new("bar", x, y)
    }

    /// Creates horizontal bars; `y` has the names.
    pub fn bars_across(x: impl Into<Values>, y: impl Into<Values>) -> Self {
        Self::new("bar", x, y).with("orientation", "h")
    }

    /// Creates coloured cells; `z` has a row of numbers for each `y`, and each row a number for each `x`.
    pub fn heat_map(x: impl Into<Values>, y: impl Into<Values>, z: &[Vec<f64>]) -> Self {
        let rows: Value = z.iter().map(|row| numbers(row)).collect();
        Self::new("heatmap", x, y).with("z", rows)
    }

    fn with(self, name: &str, value: impl Into<Value>) -> Self {
        Self(self.0.with(name, value))
    }

    /// Sets the name in the legend and on hover. Plotly.js interprets tags in it.
    pub fn name(self, name: String) -> Self {
        self.with("name", name)
    }

    /// Sets the mode.
    pub fn mode(self, mode: Mode) -> Self {
        self.with("mode", mode.code())
    }

    /// Sets the line.
    pub fn line(self, line: Line) -> Self {
        self.with("line", line.0.into_value())
    }

    /// Sets the markers.
    pub fn marker(self, marker: Marker) -> Self {
        self.with("marker", marker.0.into_value())
    }

    /// Sets the opacity, 0 to 1.
    pub fn opacity(self, opacity: f64) -> Self {
        self.with("opacity", number(opacity))
    }

    /// Leaves the trace out of the legend.
    pub fn not_in_legend(self) -> Self {
        self.with("showlegend", false)
    }

    /// Fills the area between this line and the line of the preceding trace.
    pub fn fill_to_previous(self, colour: &str) -> Self {
        self.with("fill", "tonexty").with("fillcolor", colour)
    }

    /// Sets the error bars along x.
    pub fn error_x(self, bars: ErrorBars) -> Self {
        self.with("error_x", bars.0.into_value())
    }

    /// Sets the error bars along y.
    pub fn error_y(self, bars: ErrorBars) -> Self {
        self.with("error_y", bars.0.into_value())
    }

    /// Sets a value per point that is not drawn; the hover template refers to it as `%{customdata}`.
    pub fn custom_data(self, values: Vec<u64>) -> Self {
        self.with("customdata", Values::from(values).0)
    }

    /// Sets the hover text of a point, in the template language of plotly.js.
    pub fn hover_template(self, template: &str) -> Self {
        self.with("hovertemplate", template)
    }

    /// Disables the hover text of the trace.
    pub fn no_hover(self) -> Self {
        self.with("hoverinfo", "skip")
    }

    /// Sets a text per point.
    pub fn texts(self, texts: Vec<String>) -> Self {
        self.with("text", texts)
    }

    /// Sets the position of the texts.
    pub fn text_position(self, position: TextPosition) -> Self {
        self.with("textposition", position.code())
    }

    /// Sets the colour of the texts, and their size in px.
    pub fn text_font(self, colour: &str, px: u32) -> Self {
        self.with("textfont", Attributes::default().with("color", colour).with("size", px).into_value())
    }

    /// Sets the name of the vertical axis: `y`, `y2`, and so on.
    pub fn y_axis(self, name: &str) -> Self {
        self.with("yaxis", name)
    }

    /// Sets a text per cell of a heat map.
    pub fn cell_texts(self, texts: Vec<Vec<String>>) -> Self {
        self.with("text", texts)
    }

    /// Sets the colour scale.
    pub fn colour_scale(self, scale: ColourScale) -> Self {
        self.with("colorscale", scale.code())
    }

    /// Sets the title of the colour bar beside a heat map.
    pub fn colour_bar_title(self, title: &str) -> Self {
        self.with("colorbar", Attributes::default().with("title", titled(title)).into_value())
    }

    /// Sets the values at the ends of the colour scale; the default is the smallest and the largest value of
    /// the map.
    pub fn colour_range(self, [low, high]: [f64; 2]) -> Self {
        self.with("zmin", number(low)).with("zmax", number(high))
    }

    /// Disables the hover text of empty cells.
    pub fn no_hover_on_gaps(self) -> Self {
        self.with("hoverongaps", false)
    }
}

fn titled(text: &str) -> Value {
    Attributes::default().with("text", text).into_value()
}

/// An axis of a chart.
#[derive(Debug, Clone, Default)]
pub struct Axis(Attributes);

impl Axis {
    /// Creates an axis without a title; its type follows from the values.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates an axis with a title, which is left out when empty. Plotly.js interprets tags in the title.
    pub fn titled(title: &str) -> Self {
        if title.is_empty() { Self::new() } else { Self::new().with("title", titled(title)) }
    }

    fn with(self, name: &str, value: impl Into<Value>) -> Self {
        Self(self.0.with(name, value))
    }

    /// Makes the axis logarithmic. Its range is then given as logarithms to base ten.
    pub fn logarithmic(self) -> Self {
        self.with("type", "log")
    }

    /// Makes the axis an axis of time; values are milliseconds of UTC since 1970-01-01.
    pub fn with_time_axis(self) -> Self {
        self.with("type", "date")
    }

    /// Sets the values at the ends of the axis, the left or bottom end first.
    pub fn range(self, ends: [f64; 2]) -> Self {
        self.with("range", numbers(&ends))
    }

    /// Sets the part of the chart's height or width that the axis covers, from 0 to 1.
    pub fn domain(self, ends: [f64; 2]) -> Self {
        self.with("domain", numbers(&ends))
    }

    /// Sets the name of the axis that this axis is attached to.
    pub fn anchor(self, name: &str) -> Self {
        self.with("anchor", name)
    }

    /// Gives this axis the same length per unit as the named axis.
    pub fn same_scale_as(self, name: &str) -> Self {
        self.with("scaleanchor", name)
    }

    /// Shortens the axis instead of its range if its scale is bound to another axis.
    pub fn constrain_domain(self) -> Self {
        self.with("constrain", "domain")
    }

    /// Sets the format of tick labels, as a d3 format.
    pub fn tick_format(self, format: &str) -> Self {
        self.with("tickformat", format)
    }

    /// Sets the maximum number of ticks.
    pub fn max_ticks(self, count: u32) -> Self {
        self.with("nticks", count)
    }

    /// Sets the values with a tick.
    pub fn ticks(self, values: &[f64]) -> Self {
        self.with("tickvals", numbers(values))
    }

    /// Hides the line, the ticks and the labels of the axis.
    pub fn hidden(self) -> Self {
        self.with("visible", false)
    }
}

/// Axes and legend of a chart.
#[derive(Debug, Clone, Default, Serialize)]
#[serde(transparent)]
pub struct Layout(Attributes);

impl Layout {
    /// Creates a layout with these axes.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self::default().x_axis(x).y_axis("y", y)
    }

    fn with(self, name: &str, value: impl Into<Value>) -> Self {
        Self(self.0.with(name, value))
    }

    /// Replaces the x axis.
    pub fn x_axis(self, axis: Axis) -> Self {
        self.with("xaxis", axis.0.into_value())
    }

    /// Sets the vertical axis that traces refer to as `y`, `y2`, and so on.
    pub fn y_axis(self, name: &str, axis: Axis) -> Self {
        self.with(&name.replacen('y', "yaxis", 1), axis.0.into_value())
    }

    /// Shows or hides the legend; by default a chart with a single trace has none.
    pub fn legend(self, is_shown: bool) -> Self {
        self.with("showlegend", is_shown)
    }

    /// Stacks bars with the same x value, with a gap of this fraction of the bar spacing.
    pub fn stacked_bars(self, gap: f64) -> Self {
        self.with("barmode", "stack").with("bargap", number(gap))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: impl Serialize, json: &str) {
        assert_eq!(serde_json::to_string(&value).unwrap(), json);
    }

    #[test]
    fn numbers_are_short_and_gaps_are_null() {
        check(number(5.0), "5");
        check(number(-0.0), "0");
        check(number(1_335_139_200_123.0), "1335139200123");
        check(number(0.1 + 0.2), "0.3");
        check(number(1.0 / 3.0), "0.333333333");
        check(number(-12_345.678_901_234), "-12345.6789");
        check(number(2.5e-12), "2.5e-12");
        check(number(1e300), "1e+300");
        check(numbers(&[f64::NAN, f64::INFINITY, 1.5]), "[null,null,1.5]");
    }

    #[test]
    fn a_trace_has_only_the_attributes_that_were_set() {
        let trace = Trace::scatter(Mode::Lines, vec![1.0, 2.0], vec![0.5, f64::NAN]);
        let trace = trace.line(Line::new(1.2).colour("#123456").dashed()).not_in_legend().y_axis("y2");
        let json = serde_json::json!({
            "type": "scatter", "mode": "lines", "x": [1, 2], "y": [0.5, null], "showlegend": false, "yaxis": "y2",
            "line": { "width": 1.2, "color": "#123456", "dash": "dash" },
        });
        assert_eq!(serde_json::to_value(trace).unwrap(), json);
        let map = Trace::heat_map(vec!["a".to_owned()], vec![3_u64], &[vec![f64::NAN]]);
        let json = serde_json::json!({ "type": "heatmap", "x": ["a"], "y": [3], "z": [[null]] });
        assert_eq!(serde_json::to_value(map).unwrap(), json);
    }

    #[test]
    fn a_later_value_of_an_attribute_holds() {
        let trace = Trace::scatter(Mode::Lines, vec![1.0], vec![1.0]).mode(Mode::Markers);
        assert_eq!(serde_json::to_value(trace).unwrap()["mode"], "markers");
    }

    #[test]
    fn every_vertical_axis_has_the_name_that_traces_give_it() {
        let layout =
            Layout::new(Axis::titled(""), Axis::titled("m")).y_axis("y2", Axis::new().domain([0.0, 0.5]));
        let json = serde_json::json!({
            "xaxis": {}, "yaxis": { "title": { "text": "m" } }, "yaxis2": { "domain": [0, 0.5] },
        });
        assert_eq!(serde_json::to_value(layout).unwrap(), json);
    }
}
