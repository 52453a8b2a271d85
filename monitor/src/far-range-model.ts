// The far-range model: the chaser's orbit about the target, both above the Earth, and the camera's field of
// view.

import {
  BufferGeometry,
  ConeGeometry,
  Float32BufferAttribute,
  Group,
  type Line,
  type LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import type { Model, Session } from "./api.js";
import { pieces } from "./pieces.js";
import { fieldOfView, label, line, placed, Stage, vector } from "./stage.js";

const EARTH_RADIUS_KM = 6371;
const MEASURED = 0xffb84d;
const TRUTH = 0xd9a7ff;

export class FarRangeModel {
  readonly stage: Stage;
  truth = false;
  /** From radial, along-track and normal axes to the stage's: along-track to the right, radial up. */
  private readonly world = new Group();
  private readonly field: LineSegments;
  private readonly ghost: LineSegments;
  private readonly sight: Line;
  private readonly chaser: Mesh;
  private readonly target: Mesh;
  private readonly targetLabel = label("target", "#ff8f8f");
  private readonly chaserLabel = label("chaser", "#ffffff");

  constructor(session: Session, onTurn: () => void) {
    this.stage = new Stage(0.02, 30000, 0.55, 0.3, onTurn);
    const { world } = this;
    world.matrixAutoUpdate = false;
    world.matrix.makeBasis(new Vector3(0, 1, 0), new Vector3(1, 0, 0), new Vector3(0, 0, -1));
    this.stage.scene.add(world);

    const earth = new Mesh(
      new SphereGeometry(EARTH_RADIUS_KM, 128, 64),
      new MeshLambertMaterial({ color: 0x1d4a7a }),
    );
    earth.position.set(-(session.orbit_radius_km ?? 2 * EARTH_RADIUS_KM), 0, 0);
    world.add(earth);
    for (const piece of pieces(session.orbit_rtn_km ?? [], ([frame]) => frame, session.begins)) {
      world.add(line(piece.map(([, place]) => vector(place)), 0x57c7ff, 0.55));
    }
    for (const radius of [1, 5, 10, 20, 30]) {
      const mark = label(`${radius} km`, "#8496a8");
      mark.position.set(radius, 0, 0);
      world.add(ring(radius), mark);
    }
    this.target = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ color: 0xff6b6b }));
    this.chaser = new Mesh(new ConeGeometry(0.6, 1.8, 16).rotateX(Math.PI / 2), new MeshBasicMaterial({ color: 0xffffff }));
    const camera = session.cameras[0]!;
    this.field = fieldOfView(camera, MEASURED);
    this.ghost = fieldOfView(camera, TRUTH);
    this.sight = line([new Vector3(), new Vector3(0, 1, 0)], MEASURED);
    for (const body of [this.chaser, this.field, this.ghost]) {
      body.matrixAutoUpdate = false;
    }
    world.add(this.target, this.chaser, this.field, this.ghost, this.sight, this.targetLabel, this.chaserLabel);
  }

  show(model: Model): void {
    if (model.world !== "far_range") {
      return;
    }
    const position = vector(model.truth.position);
    const range = position.length();
    const size = 0.018 * range;
    this.target.scale.setScalar(0.7 * size);
    this.chaser.matrix.copy(placed(model.truth)).scale(new Vector3(size, size, size));
    this.field.visible = model.measured !== null;
    if (model.measured) {
      this.field.matrix.copy(placed(model.measured)).scale(new Vector3(range, range, range));
    }
    this.ghost.visible = this.truth;
    this.ghost.matrix.copy(placed(model.truth)).scale(new Vector3(range, range, range));
    this.chaserLabel.position.copy(position);
    this.sight.visible = model.line_of_sight !== null;
    if (model.line_of_sight) {
      const end = vector(model.line_of_sight).multiplyScalar(range).add(position);
      const places = new Float32BufferAttribute([...position.toArray(), ...end.toArray()], 3);
      (this.sight.geometry as BufferGeometry).setAttribute("position", places);
    }
    const { stage } = this;
    stage.centre.copy(position).multiplyScalar(0.5).applyMatrix4(this.world.matrix);
    stage.distance = 1.75 * range;
    stage.sun.position.copy(vector(model.sun)).applyMatrix4(this.world.matrix).multiplyScalar(1e5);
    stage.invalidate();
  }
}

/** A circle of so many kilometres about the target, in the plane of its orbit. */
function ring(radius: number): Line {
  const points = Array.from({ length: 129 }, (_, i) => {
    const angle = (i / 128) * 2 * Math.PI;
    return new Vector3(radius * Math.sin(angle), radius * Math.cos(angle), 0);
  });
  return line(points, 0x8496a8, 0.35);
}
