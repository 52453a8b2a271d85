// A three-dimensional stage: light, a viewer that turns about a point, and drawing when something has
// changed.

import {
  AmbientLight,
  BufferGeometry,
  CanvasTexture,
  Color,
  DirectionalLight,
  Float32BufferAttribute,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  PerspectiveCamera,
  Scene,
  Sprite,
  SpriteMaterial,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Camera, Vector, View } from "./api.js";
import { context, element, fit } from "./canvas.js";

/** From the beginning of one drawing of the model to that of the next, in times that the first takes. */
const PAUSE = 4;
/** How often is asked whether a drawing is done. */
const POLL_MS = 3;

export class Stage {
  readonly scene = new Scene();
  readonly sun = new DirectionalLight(0xffffff, 2.6);
  readonly ambient = new AmbientLight(0x8899aa, 0.9);
  /** The point that is looked at, and how far from it the viewer is before zooming. */
  readonly centre = new Vector3();
  distance = 10;
  private readonly canvas = element<HTMLCanvasElement>("#model > canvas");
  private readonly renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
  private readonly eye: PerspectiveCamera;
  private zoom = 1;
  private isStale = true;
  /** When the next drawing may begin. */
  private next = 0;

  constructor(
    near: number,
    far: number,
    /** Direction of the viewer: angles about the upright axis and above the horizon, rad. */
    private azimuth: number,
    private elevation: number,
    private readonly onTurn: () => void,
  ) {
    this.eye = new PerspectiveCamera(40, 1, near, far);
    this.scene.background = new Color(0x05080c);
    this.scene.add(this.ambient, this.sun);
    this.follow();
  }

  invalidate(): void {
    this.isStale = true;
  }

  draw(): void {
    const resized = fit(this.canvas);
    if (!resized && (!this.isStale || performance.now() < this.next)) {
      return;
    }
    this.isStale = false;
    if (resized) {
      this.renderer.setViewport(0, 0, this.canvas.width, this.canvas.height);
      this.eye.aspect = this.canvas.width / this.canvas.height;
      this.eye.updateProjectionMatrix();
    }
    // A narrow view moves the viewpoint back, so that the horizontal extent stays the same.
    const away = this.distance * this.zoom * Math.max(1, 1.25 / this.eye.aspect);
    const [c, s] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    this.eye.position
      .set(c * Math.sin(this.azimuth), s, c * Math.cos(this.azimuth))
      .multiplyScalar(away)
      .add(this.centre);
    this.eye.lookAt(this.centre);
    this.renderer.render(this.scene, this.eye);
    this.pause();
  }

  /**
   * Lets the next drawing wait for some times as long as this one takes. Where software draws, the model so takes a share of the
   * time and no more: the picture comes first.
   */
  private pause(): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const drawing = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const began = performance.now();
    this.next = Infinity;
    const look = () => {
      // Without a fence, or when the context is lost, there is nothing to wait for.
      if (drawing && !gl.isContextLost() && gl.getSyncParameter(drawing, gl.SYNC_STATUS) !== gl.SIGNALED) {
        setTimeout(look, POLL_MS);
        return;
      }
      gl.deleteSync(drawing);
      this.next = began + PAUSE * (performance.now() - began);
    };
    setTimeout(look, POLL_MS);
  }

  private follow(): void {
    let held: { x: number; y: number } | null = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      held = { x: event.clientX, y: event.clientY };
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointerup", () => (held = null));
    this.canvas.addEventListener("pointermove", (event) => {
      if (!held) {
        return;
      }
      this.azimuth -= (event.clientX - held.x) * 0.008;
      this.elevation = Math.max(-1.5, Math.min(1.5, this.elevation + (event.clientY - held.y) * 0.008));
      held = { x: event.clientX, y: event.clientY };
      this.turned();
    });
    this.canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom = Math.max(0.15, Math.min(6, this.zoom * Math.exp(event.deltaY * 0.001)));
        this.turned();
      },
      { passive: false },
    );
  }

  private turned(): void {
    this.invalidate();
    this.onTurn();
  }
}

export function vector([x, y, z]: Vector): Vector3 {
  return new Vector3(x, y, z);
}

/** From a camera's frame to that in which its view is given. */
export function placed(view: View): Matrix4 {
  const [x, y, z] = view.axes.map(vector) as [Vector3, Vector3, Vector3];
  return new Matrix4().makeBasis(x, y, z).setPosition(vector(view.position));
}

/** Edges of a field of view, one unit deep along the optical axis. */
export function fieldOfView(camera: Camera, colour: number): LineSegments {
  const x = camera.columns / 2 / camera.focal_x_px;
  const y = camera.rows / 2 / camera.focal_y_px;
  const corners = [[-x, -y, 1], [x, -y, 1], [x, y, 1], [-x, y, 1]] as const;
  const places: number[] = [];
  corners.forEach((corner, i) => {
    places.push(0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]!);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(places, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.8 }));
}

/** A word at a place, always of the same size on the screen. */
export function label(text: string, style: string): Sprite {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [256, 64];
  const onto = context(canvas);
  onto.font = "30px system-ui, sans-serif";
  onto.fillStyle = style;
  onto.textBaseline = "middle";
  onto.fillText(text, 12, 32);
  const material = new SpriteMaterial({
    map: new CanvasTexture(canvas),
    sizeAttenuation: false,
    depthTest: false,
    transparent: true,
  });
  const sprite = new Sprite(material);
  // Seen from the right-hand side.
  sprite.center.set(0, 0.5);
  sprite.scale.set(0.24, 0.06, 1);
  return sprite;
}

export function line(points: Vector3[], colour: number, opacity = 1): Line {
  const material = new LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity });
  return new Line(new BufferGeometry().setFromPoints(points), material);
}
