// The camera image with the recognised features drawn over it.

import type { Frame, Session, Shape } from "./api.js";
import { context, element, fit } from "./canvas.js";

/** Over a picture that is always dark the colours are the same in either theme. */
const COLOURS: Record<string, string> = {
  cross: "#ffb84d",
  circle: "#57c7ff",
  station: "#9be564",
  docking_unit: "#f28cf0",
  "mark used": "#57c7ff",
  "mark rejected": "#ff6b6b",
  "mark missing": "#ff6b6b88",
  "mark out_of_field": "#ff6b6b44",
  target: "#ffb84d",
  star: "#57c7ff",
  hotspot: "#ff6b6b",
  unlinked: "#93a1ad",
  candidate: "#9be564",
};
const TRUTH = "#d9a7ff";
/** Side of what is enlarged about a distant target, px of the camera. */
const MAGNIFIED_PX = 32;

const LEGENDS: Record<Session["world"], [string, string, boolean][]> = {
  docking: [
    ["cross", "cross", false],
    ["circle", "marks", true],
    ["mark rejected", "rejected", false],
    ["docking_unit", "docking unit", true],
    ["station", "outline", true],
    ["truth", "truth", true],
  ],
  far_range: [
    ["target", "target", false],
    ["star", "star", false],
    ["hotspot", "hotspot", false],
    ["candidate", "candidate", false],
    ["unlinked", "unlinked", false],
    ["truth", "truth", true],
  ],
  middle_range: [
    ["target", "disk", true],
    ["truth", "truth", true],
  ],
};

/** Figures that are drawn thicker. */
const BOLD = new Set(["target", "cross", "truth target"]);

const colourOf = (shape: Shape, all: string | null): string => all ?? COLOURS[shape.kind] ?? "#ffffff";

export class CameraPanel {
  private readonly canvas = element<HTMLCanvasElement>("#camera > canvas");
  private readonly context = context(this.canvas);
  private readonly picture = document.createElement("canvas");
  private image: ImageData | null = null;
  private last: Frame | null = null;
  overlay = true;
  truth = false;

  constructor(private readonly session: Session) {
    const legend = element("#legend");
    for (const [kind, text, round] of LEGENDS[session.world]) {
      const item = document.createElement("span");
      const mark = document.createElement("i");
      mark.style.color = COLOURS[kind] ?? TRUTH;
      mark.className = round ? "round" : "";
      // Like the column of the truth, it is there when the truth is shown.
      item.className = kind === "truth" ? "truth" : "";
      item.append(mark, text);
      legend.append(item);
    }
  }

  show(frame: Frame): void {
    const { columns, rows } = frame.report.image;
    if (frame.picture.length !== columns * rows) {
      throw new Error(`a picture of ${frame.picture.length} bytes, expected ${columns} × ${rows}`);
    }
    if (this.image?.width !== columns || this.image.height !== rows) {
      this.picture.width = columns;
      this.picture.height = rows;
      this.image = new ImageData(columns, rows);
    }
    const pixels = new Uint32Array(this.image.data.buffer);
    const grey = frame.picture;
    for (let i = 0; i < grey.length; i++) {
      // Little-endian RGBA, as every machine with a browser has it.
      pixels[i] = 0xff000000 | (grey[i]! * 0x010101);
    }
    context(this.picture).putImageData(this.image, 0, 0);
    this.last = frame;
    this.draw();
  }

  draw(): void {
    fit(this.canvas);
    if (!this.last) {
      return;
    }
    const { report } = this.last;
    const { columns, rows, first_row, row_step, camera_rows } = report.image;
    const { context, canvas } = this;
    const scale = Math.min(canvas.width / columns, canvas.height / camera_rows);
    // From camera pixels, whose first one's centre is (0, 0), to the canvas.
    const left = (canvas.width - columns * scale) / 2 + scale / 2;
    const top = (canvas.height - camera_rows * scale) / 2 + scale / 2;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.setTransform(scale, 0, 0, scale, left, top);
    context.save();
    context.beginPath();
    context.rect(-0.5, -0.5, columns, camera_rows);
    context.clip();
    context.imageSmoothingQuality = "low";
    // Each row of a field stands about its own row of the camera.
    context.drawImage(this.picture, -0.5, first_row - row_step / 2, columns, rows * row_step);
    const [found, places] = [this.overlay ? report.overlay : [], this.truth ? report.truth_overlay : []];
    this.shapes(found, scale, null);
    this.shapes(places, scale, TRUTH);
    const labelled = [...places.map((shape) => [shape, TRUTH] as const), ...found.map((shape) => [shape, null] as const)];
    this.labels(labelled, scale, columns);
    context.restore();
    if (this.session.world !== "docking") {
      this.magnify(scale);
    }
    // Published for tests and scripts: camera pixel (x, y) is at left + scale x, top + scale y.
    Object.assign(canvas.dataset, { frame: report.frame, scale, left, top });
  }

  /** The target's surroundings, enlarged, in the lower left corner: a region of interest is a few pixels of the page. */
  private magnify(scale: number): void {
    const target = this.last?.report.overlay.find((shape) => shape.kind === "target");
    if (!target) {
      return;
    }
    const { context, canvas } = this;
    const density = Math.min(devicePixelRatio, 2);
    const side = Math.min(130 * density, canvas.height / 3);
    const enlarged = side / MAGNIFIED_PX;
    const [x, y] = [Math.round(target.x_px) - MAGNIFIED_PX / 2, Math.round(target.y_px) - MAGNIFIED_PX / 2];
    context.save();
    context.setTransform(1, 0, 0, 1, 8 * density, canvas.height - side - 8 * density);
    context.fillStyle = "#000";
    context.fillRect(0, 0, side, side);
    context.imageSmoothingEnabled = false;
    // From the first pixel's corner: the pixel (x, y) covers x to x + 1 of the picture.
    context.drawImage(this.picture, x, y, MAGNIFIED_PX, MAGNIFIED_PX, 0, 0, side, side);
    context.strokeStyle = COLOURS["target"]!;
    context.lineWidth = density;
    context.strokeRect(0, 0, side, side);
    if (this.overlay) {
      const [u, v] = [(target.x_px + 0.5 - x) * enlarged, (target.y_px + 0.5 - y) * enlarged];
      const [near, far] = [side / 8, side / 4];
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
        context.moveTo(u + near * dx, v + near * dy);
        context.lineTo(u + far * dx, v + far * dy);
      }
      context.stroke();
    }
    context.font = `${10 * density}px system-ui, sans-serif`;
    context.fillStyle = COLOURS["target"]!;
    context.fillText(`target ${(enlarged / scale).toFixed(0)}×`, 5 * density, 13 * density);
    context.restore();
  }

  private shapes(shapes: Shape[], scale: number, all: string | null): void {
    const density = Math.min(devicePixelRatio, 2);
    const { context } = this;
    for (const shape of shapes) {
      const { x_px: x, y_px: y, size_px: size } = shape;
      context.strokeStyle = colourOf(shape, all);
      context.lineWidth = ((BOLD.has(shape.kind) ? 2 : 1.2) * density) / scale;
      context.setLineDash(all ? [(4 * density) / scale, (3 * density) / scale] : []);
      context.beginPath();
      if (shape.figure === "circle") {
        context.arc(x, y, size, 0, 2 * Math.PI);
      } else if (shape.figure === "box") {
        context.rect(x - size, y - size, 2 * size, 2 * size);
      } else {
        const slope = shape.slope ?? 0;
        const [c, s] = [1 / Math.hypot(1, slope), slope / Math.hypot(1, slope)];
        // A cross of the far range leaves its middle free: there is the target.
        const gap = shape.kind === "target" ? 0.5 * size : 0;
        for (const [u, v] of [[c, s], [-c, -s], [-s, c], [s, -c]] as const) {
          context.moveTo(x + gap * u, y + gap * v);
          context.lineTo(x + size * u, y + size * v);
        }
      }
      context.stroke();
    }
    context.setLineDash([]);
  }

  /** Words beside figures, the first ones first: one that would lie on another is left out. */
  private labels(shapes: (readonly [Shape, string | null])[], scale: number, columns: number): void {
    const { context } = this;
    const height = (9 * Math.min(devicePixelRatio, 2)) / scale;
    context.font = `${height}px system-ui, sans-serif`;
    const drawn: { x: number; y: number; width: number }[] = [];
    for (const [shape, all] of shapes) {
      if (!shape.label) {
        continue;
      }
      const { width } = context.measureText(shape.label);
      const beside = shape.size_px + 2;
      // To the left where the picture ends.
      const x = shape.x_px + beside + width < columns ? shape.x_px + beside : shape.x_px - beside - width;
      const place = { x, y: shape.y_px + shape.size_px / 2, width };
      const liesOn = (other: typeof place) =>
        place.x < other.x + other.width && other.x < place.x + place.width && Math.abs(place.y - other.y) < height;
      if (drawn.some(liesOn)) {
        continue;
      }
      context.fillStyle = colourOf(shape, all);
      context.fillText(shape.label, place.x, place.y);
      drawn.push(place);
    }
  }
}
