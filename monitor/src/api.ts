// Requests and responses of the server, by frame number.

export interface Camera {
  name: string;
  columns: number;
  rows: number;
  focal_x_px: number;
  focal_y_px: number;
}

export interface Session {
  world: "docking" | "far_range" | "middle_range";
  title: string;
  seed: number;
  mode: "live" | "replay";
  /** Frames a second at speed 1. */
  rate_hz: number;
  cameras: Camera[];
  /** Points: frame, range and range rate; corridor: range, least and greatest rate. */
  plan: { range_unit: string; points: [number, number, number][]; corridor: [number, number, number][] };
  /** First frames of the days of a schedule; empty in a world without. */
  begins: number[];
  /** The chaser's way, by frame, in the axes of the target's orbit, and the target's distance from the centre of the Earth at the beginning. */
  orbit_rtn_km?: [number, Vector][];
  orbit_radius_km?: number;
  /** Centre of the docking unit from the target's, m. */
  docking_unit_m?: [number, number];
  notes: string[];
}

export interface Progress {
  from: number;
  to: number;
  processed: number;
  failure: string | null;
}

export interface Shape {
  figure: "circle" | "cross" | "box";
  kind: string;
  x_px: number;
  y_px: number;
  size_px: number;
  slope?: number;
  label?: string;
}

export interface Parameter {
  section: string;
  name: string;
  label: string;
  unit: string;
  decimals: number;
  measured: number | null;
  sigma: number | null;
  truth: number | null;
}

export type Vector = [number, number, number];

export interface View {
  position: Vector;
  axes: [Vector, Vector, Vector];
}

export type Model =
  | { world: "docking"; camera: number; measured: View | null; truth: View; sun: Vector | null }
  | { world: "far_range"; measured: View | null; truth: View; sun: Vector; line_of_sight: Vector | null }
  | { world: "middle_range"; truth: View; radius_km: number; sun: Vector };

export interface Report {
  frame: number;
  time_utc: string;
  elapsed_s: number;
  group: string;
  image: { columns: number; rows: number; first_row: number; row_step: number; camera_rows: number };
  status: string;
  parameters: Parameter[];
  facts: { label: string; value: string }[];
  overlay: Shape[];
  truth_overlay: Shape[];
  phase: { measured: [number, number] | null; truth: [number, number] };
  ground: { spacecraft: [number, number]; sun: [number, number] } | null;
  model: Model;
}

export interface History {
  measured: [number, number, number][];
  truth: [number, number, number][];
}

export interface Facets {
  facets: { outer: Vector[]; holes?: Vector[][]; normal: Vector; reflectance: number }[];
}

export interface Frame {
  report: Report;
  picture: Uint8Array;
}

/** The frame is not processed yet, or the run has failed. */
export class NotYet extends Error {
  constructor(readonly progress: Progress) {
    super(progress.failure ?? `processed up to ${progress.processed}`);
  }
}

async function ask(path: string, signal?: AbortSignal): Promise<Response> {
  const response = await fetch(path, { signal: signal ?? null });
  if (response.status === 202 || response.status === 500) {
    throw new NotYet((await response.json()) as Progress);
  }
  if (!response.ok) {
    throw new Error(`${path}: ${response.status} ${await response.text()}`);
  }
  return response;
}

async function document<T>(path: string): Promise<T> {
  return (await (await ask(path)).json()) as T;
}

export const session = () => document<Session>("api/session.json");
export const scene = () => document<Facets>("api/scene.json");
export const progress = () => document<Progress>("api/progress.json");
export const history = () => document<History>("api/history.json");
export const groundTrack = (frame: number) => document<[number, number][]>(`api/ground/${frame}.json`);

/** All of a frame; the server answers when it is processed, or after some seconds that it is not. */
export async function frame(number: number, signal: AbortSignal): Promise<Frame> {
  const [report, picture] = await Promise.all([
    ask(`api/frames/${number}.json`, signal).then((response) => response.json() as Promise<Report>),
    ask(`api/frames/${number}.gray`, signal).then((response) => response.arrayBuffer()),
  ]);
  return { report, picture: new Uint8Array(picture) };
}
