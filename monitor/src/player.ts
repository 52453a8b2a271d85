// Time: which frame is shown when. Frames are fetched ahead, and shown 25 times a second.

import * as api from "./api.js";

/** Pictures a second. */
const SHOWN_HZ = 25;
const TICK_MS = 1000 / SHOWN_HZ;
/** Frames that are fetched ahead: a second of pictures. */
const AHEAD = 25;
/** Frames kept behind, for a step back. */
const BEHIND = 4;
const RETRY_MS = 250;

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];

interface Fetching {
  cancel: AbortController;
  frame: api.Frame | null;
}

export interface Listener {
  show(frame: api.Frame): void;
  /** The frame of the player is not there yet; the progress of the run is known if the server has answered. */
  wait(progress: api.Progress | null): void;
  change(): void;
}

export class Player {
  playing: boolean;
  speed = 1;
  /** Pictures shown while playing, and how often one was not there in time. */
  readonly counts = { shown: 0, late: 0 };
  private position: number;
  private shown = -1;
  private due = 0;
  private readonly cache = new Map<number, Fetching>();

  constructor(
    private readonly session: api.Session,
    readonly first: number,
    readonly last: number,
    private readonly listener: Listener,
    startsPlaying: boolean,
  ) {
    this.playing = startsPlaying;
    this.position = first;
    requestAnimationFrame((now) => this.tick(now));
  }

  /** The frame that is shown, or waited for. */
  get frame(): number {
    return Math.min(this.last, Math.floor(this.position + 1e-9));
  }

  get isShown(): boolean {
    return this.shown === this.frame;
  }

  seek(frame: number): void {
    this.position = Math.max(this.first, Math.min(this.last, Math.round(frame)));
    this.due = 0;
    // What is on the page belongs to another time.
    if (!this.isShown && this.cache.get(this.frame)?.frame == null) {
      this.listener.wait(null);
    }
    this.listener.change();
  }

  step(frames: number): void {
    this.playing = false;
    this.seek(this.frame + frames);
  }

  toggle(): void {
    if (!this.playing && this.frame === this.last) {
      this.seek(this.first);
    }
    this.playing = !this.playing;
    this.due = 0;
    this.listener.change();
  }

  faster(steps: number): void {
    const index = SPEEDS.indexOf(this.speed) + steps;
    this.speed = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, index))] ?? 1;
    this.listener.change();
  }

  /** Frames from one picture to the next. */
  private get stride(): number {
    return (this.session.rate_hz * this.speed) / SHOWN_HZ;
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    this.fetchAhead();
    if (this.shown !== this.frame) {
      this.showIfThere(now);
      return;
    }
    // Frames due within the next half refresh interval of the screen are drawn now.
    if (!this.playing || now < this.due - 6) {
      return;
    }
    if (this.frame === this.last) {
      this.playing = false;
      this.listener.change();
      return;
    }
    this.position = Math.min(this.last, this.position + this.stride);
    // Slower than the pictures: the same frame is shown on.
    if (this.frame === this.shown) {
      this.due = Math.max(this.due + TICK_MS, now - TICK_MS);
      return;
    }
    if (this.cache.get(this.frame)?.frame == null) {
      this.counts.late += 1;
    }
    this.showIfThere(now);
  }

  private showIfThere(now: number): void {
    const found = this.cache.get(this.frame)?.frame;
    if (!found) {
      this.due = 0;
      return;
    }
    // In step with the clock; after a wait, from now on.
    this.due = this.due === 0 || now - this.due > 4 * TICK_MS ? now + TICK_MS : this.due + TICK_MS;
    this.shown = this.frame;
    if (this.playing) {
      this.counts.shown += 1;
    }
    this.listener.show(found);
  }

  private fetchAhead(): void {
    const stride = this.playing ? this.stride : 1;
    const wanted = new Set<number>([this.frame]);
    for (let i = 1; i <= AHEAD; i++) {
      const next = Math.floor(this.position + i * stride + 1e-9);
      if (next <= this.last) {
        wanted.add(next);
      }
    }
    for (const [number, { cancel }] of this.cache) {
      const near = number <= this.frame && number >= this.frame - BEHIND * Math.max(1, stride);
      if (!wanted.has(number) && !near) {
        cancel.abort();
        this.cache.delete(number);
      }
    }
    for (const number of wanted) {
      if (!this.cache.has(number)) {
        this.fetch(number);
      }
    }
  }

  private fetch(number: number): void {
    const fetching: Fetching = { cancel: new AbortController(), frame: null };
    this.cache.set(number, fetching);
    api.frame(number, fetching.cancel.signal).then(
      (frame) => (fetching.frame = frame),
      (error: unknown) => {
        if (number === this.frame && error instanceof api.NotYet) {
          this.listener.wait(error.progress);
        }
        // Retried after a pause if still needed; a lost server may come back.
        setTimeout(() => this.cache.get(number) === fetching && this.cache.delete(number), RETRY_MS);
      },
    );
  }
}
