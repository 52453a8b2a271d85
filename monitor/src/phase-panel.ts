// The phase chart: range against range rate, with the corridor about the plan.

import uPlot from "uplot";
import type { History, Report, Session } from "./api.js";
import { element } from "./canvas.js";
import { pieces } from "./pieces.js";
import { colour } from "./theme.js";

type Point = readonly [number, number];
/** Ticks of a logarithmic axis: without the ends of the scale, which are no round numbers and stand on the edge of the chart. */
const decades = (_chart: uPlot, _axis: number, least: number, greatest: number): number[] => {
  const ticks: number[] = [];
  for (let power = Math.floor(Math.log10(least)); power <= Math.log10(greatest); power++) {
    // Parsed from text, so that the value is 0.3 and not 3 × 0.1.
    ticks.push(...[1, 2, 3, 4, 5, 6, 7, 8, 9].map((digit) => Number(`${digit}e${power}`)));
  }
  return ticks.filter((tick) => tick >= least && tick <= greatest);
};

/** Frame, range and range rate. */
type Moment = readonly [number, number, number];

export class PhasePanel {
  private readonly place = element("#phase > .chart");
  private chart: uPlot | null = null;
  private history: History = { measured: [], truth: [] };
  private last: Report | null = null;
  truth = false;

  constructor(private readonly session: Session) {
    new ResizeObserver(() => this.build()).observe(this.place);
  }

  setHistory(history: History): void {
    this.history = history;
    this.draw();
  }

  show(report: Report): void {
    this.last = report;
    this.draw();
  }

  draw(): void {
    this.chart?.redraw(false);
  }

  build(): void {
    this.chart?.destroy();
    this.chart = null;
    const { corridor, range_unit } = this.session.plan;
    const [width, height] = [this.place.clientWidth, this.place.clientHeight];
    if (corridor.length === 0 || width < 50 || height < 50) {
      return;
    }
    const ranges = corridor.map(([range]) => range);
    const [least, greatest] = [ranges[0]!, ranges[ranges.length - 1]!];
    const isWide = greatest / least > 5;
    const axis = (label: string, size: number): uPlot.Axis => ({
      label,
      size,
      labelSize: 16,
      gap: 3,
      labelGap: 0,
      font: "11px system-ui, sans-serif",
      labelFont: "11px system-ui, sans-serif",
      stroke: colour("dim"),
      grid: { stroke: colour("grid"), width: 1 },
      ticks: { stroke: colour("grid"), width: 1, size: 4 },
    });
    const edge: uPlot.Series = { stroke: colour("edge"), width: 1, points: { show: false } };
    const options: uPlot.Options = {
      width,
      height,
      padding: [6, 16, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        // The approach goes to the right.
        x: { time: false, dir: -1, ...(isWide ? { distr: 3 as const } : {}), range: [least * 0.95, greatest * 1.05] },
      },
      axes: [{ ...axis(`range, ${range_unit}`, 22), ...(isWide ? { splits: decades } : {}) }, axis("rate, m/s", 44)],
      series: [{}, edge, edge],
      bands: [{ series: [2, 1], fill: colour("corridor") }],
      hooks: { draw: [(chart) => this.drawFlight(chart)] },
    };
    const data: uPlot.AlignedData = [ranges, corridor.map(([, low]) => low), corridor.map(([, , high]) => high)];
    this.chart = new uPlot(options, data, this.place);
  }

  private drawFlight(chart: uPlot): void {
    const { ctx } = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(chart.bbox.left, chart.bbox.top, chart.bbox.width, chart.bbox.height);
    ctx.clip();
    const now = this.last?.frame ?? -1;
    const upTo = (points: Moment[]): Moment[] => points.filter(([frame]) => frame <= now);
    this.line(chart, this.session.plan.points, colour("dim"), 1, [3, 3]);
    const measured = upTo(this.history.measured);
    // A camera in the far range measures directions: the range there is the orbit's. In the middle range the
    // chart has no measured rates.
    const isOrbit = this.session.world !== "docking";
    if (isOrbit || this.truth) {
      this.line(chart, upTo(this.history.truth), isOrbit ? colour("accent") : colour("truth"), 1.5, []);
    }
    ctx.fillStyle = colour("accent");
    for (const [, range, rate] of measured) {
      this.dot(chart, [range, rate], 1.6);
    }
    const current = this.last?.phase;
    if (current?.measured) {
      ctx.fillStyle = colour("fair");
      this.dot(chart, current.measured, 5);
    }
    if (current && (isOrbit || this.truth)) {
      ctx.fillStyle = isOrbit ? colour("fair") : colour("truth");
      this.dot(chart, current.truth, 4);
    }
    ctx.restore();
  }

  private line(chart: uPlot, points: readonly Moment[], style: string, width: number, dash: number[]): void {
    const { ctx } = chart;
    ctx.beginPath();
    for (const piece of pieces(points, ([frame]) => frame, this.session.begins)) {
      piece.forEach(([, range, rate], i) => {
        const [x, y] = [chart.valToPos(range, "x", true), chart.valToPos(rate, "y", true)];
        i === 0 ? ctx.moveTo(x, y) : ctx.lineTo(x, y);
      });
    }
    ctx.strokeStyle = style;
    ctx.lineWidth = width * devicePixelRatio;
    ctx.setLineDash(dash);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  private dot(chart: uPlot, [range, rate]: Point, radius: number): void {
    const { ctx } = chart;
    ctx.beginPath();
    const [x, y] = [chart.valToPos(range, "x", true), chart.valToPos(rate, "y", true)];
    ctx.arc(x, y, radius * devicePixelRatio, 0, 2 * Math.PI);
    ctx.fill();
  }
}
