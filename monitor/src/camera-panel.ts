// The camera's picture with what was recognised drawn over it.

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

const LEGENDS: Record<Session["world"], [string, string, boolean][]> = {
  docking: [
    ["cross", "cross", false],
    ["circle", "marks", true],
    ["docking_unit", "docking unit", true],
    ["station", "outline", true],
  ],
  far_range: [
    ["target", "target", false],
    ["star", "star", false],
    ["hotspot", "hotspot", false],
    ["candidate", "candidate", false],
    ["unlinked", "unlinked", false],
  ],
};

export class CameraPanel {
  private readonly canvas = element<HTMLCanvasElement>("#camera > canvas");
  private readonly context = context(this.canvas);
  private readonly picture = document.createElement("canvas");
  private image: ImageData | null = null;
  private last: Frame | null = null;
  overlay = true;
  truth = false;

  constructor(session: Session) {
    const legend = element("#legend");
    for (const [kind, text, round] of LEGENDS[session.world]) {
      const item = document.createElement("span");
      const mark = document.createElement("i");
      mark.style.color = COLOURS[kind] ?? TRUTH;
      mark.className = round ? "round" : "";
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
    context.imageSmoothingQuality = "medium";
    // Each row of a field stands about its own row of the camera.
    context.drawImage(this.picture, -0.5, first_row - row_step / 2, columns, rows * row_step);
    if (this.overlay) {
      this.shapes(report.overlay, scale, null);
    }
    if (this.truth) {
      this.shapes(report.truth_overlay, scale, TRUTH);
    }
    context.restore();
    // For whoever reads the picture from the page: camera pixel (x, y) is at left + scale x, top + scale y.
    Object.assign(canvas.dataset, { frame: report.frame, scale, left, top });
  }

  private shapes(shapes: Shape[], scale: number, all: string | null): void {
    const density = Math.min(devicePixelRatio, 2);
    const { context } = this;
    for (const shape of shapes) {
      const { x_px: x, y_px: y, size_px: size } = shape;
      context.strokeStyle = all ?? COLOURS[shape.kind] ?? "#ffffff";
      context.fillStyle = context.strokeStyle;
      context.lineWidth = ((shape.kind === "target" || shape.kind === "cross" ? 2 : 1.2) * density) / scale;
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
      if (shape.label) {
        context.font = `${(9 * density) / scale}px system-ui, sans-serif`;
        context.fillText(shape.label, x + size + 2, y + size / 2);
      }
    }
    context.setLineDash([]);
  }
}
