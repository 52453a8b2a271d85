// The ground track with day and night.

import { geoCircle, geoEquirectangular, geoGraticule10, geoPath } from "d3-geo";
import { feature } from "topojson-client";
import land from "world-atlas/land-110m.json";
import type { Report } from "./api.js";
import { context, element, fit } from "./canvas.js";
import { colour } from "./theme.js";

const topology = land as unknown as Parameters<typeof feature>[0];
const coast = feature(topology, topology.objects["land"]!);
const graticule = geoGraticule10();
const hemisphere = geoCircle().radius(90).precision(2);

export class GroundPanel {
  private readonly canvas = element<HTMLCanvasElement>("#ground > canvas");
  private readonly context = context(this.canvas);
  private readonly note = element("#ground-note");
  private readonly base = document.createElement("canvas");
  private readonly projection = geoEquirectangular();
  private track: [number, number][] = [];
  private last: Report | null = null;

  /** The track about the frame that is shown. */
  setTrack(track: [number, number][]): void {
    this.track = track;
    this.draw();
  }

  show(report: Report): void {
    this.last = report;
    this.draw();
  }

  /** Forgets what was drawn with other colours. */
  restyle(): void {
    this.base.width = 0;
    this.draw();
  }

  draw(): void {
    const { canvas, context } = this;
    const density = Math.min(devicePixelRatio, 2);
    if (fit(canvas) || this.base.width !== canvas.width) {
      this.drawBase();
    }
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(this.base, 0, 0);
    const ground = this.last?.ground;
    if (!ground) {
      this.note.textContent = "no orbit defined";
      return;
    }
    const path = geoPath(this.projection, context);
    const [sun, craft] = [ground.sun, ground.spacecraft];
    context.beginPath();
    path(hemisphere.center([sun[0] + 180, -sun[1]])());
    context.fillStyle = colour("night");
    context.fill();
    context.lineWidth = 1.6 * density;
    const half = Math.floor(this.track.length / 2);
    for (const [part, alpha] of [[this.track.slice(0, half + 1), 0.9], [this.track.slice(half), 0.4]] as const) {
      context.beginPath();
      path({ type: "LineString", coordinates: part });
      context.globalAlpha = alpha;
      context.strokeStyle = colour("accent");
      context.stroke();
    }
    context.globalAlpha = 1;
    this.mark(sun, 5 * density, "#ffd34d", false);
    this.mark(craft, 4.5 * density, colour("fair"), true);
    const degrees = (value: number, positive: string, negative: string) =>
      `${Math.abs(value).toFixed(1)}° ${value < 0 ? negative : positive}`;
    this.note.textContent = `${degrees(craft[1], "N", "S")}  ${degrees(craft[0], "E", "W")}`;
  }

  private mark(place: [number, number], radius: number, style: string, cross: boolean): void {
    const at = this.projection(place);
    if (!at) {
      return;
    }
    const { context } = this;
    context.beginPath();
    context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
    context.fillStyle = style;
    context.fill();
    if (cross) {
      context.beginPath();
      context.arc(at[0], at[1], 2.2 * radius, 0, 2 * Math.PI);
      context.strokeStyle = style;
      context.lineWidth = radius / 3;
      context.stroke();
    }
  }

  private drawBase(): void {
    const { canvas, base } = this;
    base.width = canvas.width;
    base.height = canvas.height;
    const size: [number, number] = [canvas.width, canvas.height];
    this.projection.fitExtent([[0, 0], size], { type: "Sphere" });
    const onto = context(base);
    const path = geoPath(this.projection, onto);
    onto.clearRect(0, 0, ...size);
    const fill = (shape: Parameters<typeof path>[0], style: string) => {
      onto.beginPath();
      path(shape);
      onto.fillStyle = style;
      onto.fill();
    };
    fill({ type: "Sphere" }, colour("sea"));
    fill(coast, colour("land"));
    onto.beginPath();
    path(graticule);
    onto.strokeStyle = colour("grid");
    onto.lineWidth = 0.6;
    onto.stroke();
  }
}
