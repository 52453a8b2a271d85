// The middle-range model: the body in sunlight, and the camera's field of view, in the axes of the camera.

import { type LineSegments, Mesh, MeshLambertMaterial, SphereGeometry, Vector3 } from "three";
import type { Model, Session } from "./api.js";
import { fieldOfView, placed, Stage, vector } from "./stage.js";

const MEASURED = 0xffb84d;

export class MiddleRangeModel {
  readonly stage: Stage;
  truth = false;
  private readonly field: LineSegments;
  private readonly body = new Mesh(new SphereGeometry(1, 64, 32), new MeshLambertMaterial({ color: 0xb8b0a6 }));

  constructor(session: Session, onTurn: () => void) {
    this.stage = new Stage(0.0005, 3000, 0.55, 0.3, onTurn);
    this.field = fieldOfView(session.cameras[0]!, MEASURED);
    this.field.matrixAutoUpdate = false;
    this.stage.scene.add(this.body, this.field);
  }

  show(model: Model): void {
    if (model.world !== "middle_range") {
      return;
    }
    const position = vector(model.truth.position);
    const range = position.length();
    this.body.scale.setScalar(model.radius_km);
    this.field.matrix.copy(placed(model.truth)).scale(new Vector3(range, range, range));
    const { stage } = this;
    stage.centre.copy(position).multiplyScalar(0.5);
    stage.distance = 1.75 * range;
    stage.sun.position.copy(vector(model.sun)).multiplyScalar(1e4);
    stage.invalidate();
  }
}
