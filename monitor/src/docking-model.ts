// The docking model: the station as the simulator has it, and the spacecraft with its camera's cone.

import {
  BoxGeometry,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  type LineSegments,
  Mesh,
  MeshLambertMaterial,
  ShapeUtils,
  SphereGeometry,
  Vector2,
  Vector3,
} from "three";
import type { Facets, Model, Session, Vector } from "./api.js";
import { fieldOfView, placed, Stage, vector } from "./stage.js";

const MEASURED = 0xffb84d;
const TRUTH = 0xd9a7ff;
// The middle of station's end and spacecraft lies behind that of target and camera, m.
const BEHIND = new Vector3(0, -0.5, 1.5);

export class DockingModel {
  readonly stage: Stage;
  truth = false;
  private readonly craft = new Group();
  private readonly ghost = new Group();
  private readonly cones: LineSegments[];
  private readonly ghostCones: LineSegments[];

  constructor(session: Session, facets: Facets, onTurn: () => void) {
    this.stage = new Stage(0.1, 4000, 0.9, 0.35, onTurn);
    this.stage.scene.add(station(facets));
    const unit = session.docking_unit_m ?? [0, 0];
    this.cones = session.cameras.map((camera) => fieldOfView(camera, MEASURED));
    this.ghostCones = session.cameras.map((camera) => fieldOfView(camera, TRUTH));
    this.craft.add(spacecraft(unit, false), ...this.cones);
    this.ghost.add(spacecraft(unit, true), ...this.ghostCones);
    for (const group of [this.craft, this.ghost]) {
      group.matrixAutoUpdate = false;
      this.stage.scene.add(group);
    }
  }

  show(model: Model): void {
    if (model.world !== "docking") {
      return;
    }
    const { stage } = this;
    const view = model.measured;
    // Without a pose the last one stays, drawn faintly.
    this.craft.visible = view !== null;
    if (view) {
      this.craft.matrix.copy(placed(view));
    }
    this.ghost.visible = this.truth;
    this.ghost.matrix.copy(placed(model.truth));
    const where = vector((view ?? model.truth).position);
    const range = where.length();
    for (const cones of [this.cones, this.ghostCones]) {
      cones.forEach((cone, i) => {
        cone.visible = i === model.camera;
        cone.scale.setScalar(range);
      });
    }
    stage.centre.copy(where).multiplyScalar(0.5).add(BEHIND);
    stage.distance = 1.1 * range + 15;
    if (model.sun) {
      stage.sun.position.copy(vector(model.sun)).multiplyScalar(100);
    }
    stage.sun.intensity = model.sun ? 2.6 : 0.15;
    stage.invalidate();
  }
}

/** The facets of the scene, triangulated in their planes; brighter ones reflect more. */
function station({ facets }: Facets): Mesh {
  const [places, normals, colours]: number[][] = [[], [], []];
  for (const { outer, holes, normal, reflectance } of facets) {
    const up = vector(normal);
    const u = new Vector3(Math.abs(up.x) < 0.5 ? 1 : 0, Math.abs(up.x) < 0.5 ? 0 : 1, 0).cross(up).normalize();
    const v = new Vector3().crossVectors(up, u);
    const flat = (corner: Vector) => new Vector2(vector(corner).dot(u), vector(corner).dot(v));
    const corners = [...outer, ...(holes ?? []).flat()];
    const shade = new Color().setScalar(0.75 * reflectance ** 0.8 + 0.01);
    for (const face of ShapeUtils.triangulateShape(outer.map(flat), (holes ?? []).map((hole) => hole.map(flat)))) {
      for (const index of face) {
        places!.push(...corners[index]!);
        normals!.push(...normal);
        colours!.push(shade.r, shade.g, shade.b);
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(places!, 3));
  geometry.setAttribute("normal", new Float32BufferAttribute(normals!, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colours!, 3));
  return new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
}

/** A cargo ship in the camera's frame (x right, y down, z ahead): its docking axis goes through the docking unit in ideal docking. */
function spacecraft([across, up]: [number, number], isGhost: boolean): Group {
  const ship = new Group();
  const material = (colour: number) =>
    isGhost
      ? new MeshLambertMaterial({ color: TRUTH, wireframe: true, transparent: true, opacity: 0.35 })
      : new MeshLambertMaterial({ color: colour, side: DoubleSide });
  const add = (geometry: BufferGeometry, colour: number, x: number, z: number) => {
    const mesh = new Mesh(geometry, material(colour));
    mesh.position.set(x, 0, z);
    ship.add(mesh);
  };
  const along = (front: number, back: number, length: number) =>
    new CylinderGeometry(front, back, length, isGhost ? 12 : 28).rotateX(Math.PI / 2);
  add(along(0.35, 0.6, 0.5), 0x9aa3ab, 0, -0.45);
  add(new SphereGeometry(1.1, isGhost ? 12 : 28, isGhost ? 8 : 18), 0xb9c0c6, 0, -1.6);
  add(along(1.1, 1.1, 2.2), 0xa8b0b7, 0, -3.4);
  add(along(1.1, 1.35, 2.1), 0x8c959d, 0, -5.5);
  for (const side of [-1, 1]) {
    add(new BoxGeometry(3.8, 0.05, 1.3), 0x2f5fa8, side * 3.1, -5.2);
  }
  ship.position.set(across, -up, 0);
  return ship;
}
