// The monitor's page: panels, controls and keys.

import * as api from "./api.js";
import { CameraPanel } from "./camera-panel.js";
import { element, onResize } from "./canvas.js";
import { DockingModel } from "./docking-model.js";
import { FarRangeModel } from "./far-range-model.js";
import { MiddleRangeModel } from "./middle-range-model.js";
import { GroundPanel } from "./ground-panel.js";
import { ParameterPanel } from "./parameter-panel.js";
import { PhasePanel } from "./phase-panel.js";
import { Player, SPEEDS } from "./player.js";
import { onThemeChange } from "./theme.js";

/** The picture and the numbers change with every frame; these panels, which change slowly, less often. */
const SLOW_MS = 200;
const MODEL_MS = 40;
const PROGRESS_MS = 500;

async function start(): Promise<void> {
  const [session, progress] = await Promise.all([api.session(), api.progress()]);
  element("#title").textContent = session.title;
  element("#mode").textContent = session.mode;
  element("#notes").textContent = session.notes.join(" ");
  // A measurement of the far range has no σ, of no pipeline.
  document.body.classList.toggle("without-sigma", session.world === "far_range");
  document.title = `${session.title} – Boresight monitor`;

  const camera = new CameraPanel(session);
  const parameters = new ParameterPanel();
  const ground = new GroundPanel();
  const phase = new PhasePanel(session);
  const redraw = () => model.stage.draw();
  const model =
    session.world === "docking"
      ? new DockingModel(session, await api.scene(), redraw)
      : session.world === "far_range"
        ? new FarRangeModel(session, redraw)
        : new MiddleRangeModel(session, redraw);
  let latest: api.Frame | null = null;

  const waiting = element("#waiting");
  const panels = document.querySelectorAll<HTMLElement>(".panel");
  const listener = {
    show(frame: api.Frame) {
      latest = frame;
      waiting.hidden = true;
      document.body.classList.remove("waiting");
      camera.show(frame);
      parameters.show(frame.report);
      header(frame.report);
      controls();
    },
    wait(state: api.Progress | null) {
      document.body.classList.add("waiting");
      panels.forEach((panel) => (panel.dataset["waiting"] = `waiting for frame ${player.frame}`));
      waiting.hidden = state === null;
      if (state) {
        waiting.textContent = state.failure
          ? `The run has ended: ${state.failure}`
          : `Processing: next frame ${state.processed} of ${state.to - 1}`;
      }
    },
    change: () => controls(),
  };
  // A reader who asks for little motion starts the pictures by hand.
  const startsPlaying = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  const player = new Player(session, progress.from, progress.to - 1, listener, startsPlaying);
  listener.wait(null);

  function header(report: api.Report): void {
    element("#clock").textContent = `${report.time_utc.slice(0, 23).replace("T", "  ")} UTC`;
    element("#group").textContent = report.group;
    const status = element("#status");
    status.textContent = report.status.replaceAll("_", " ");
    const isGood = report.status === "measured" || report.status === "detected";
    status.className = `pill ${isGood ? "good" : report.status === "range_only" || report.status.startsWith("doubtful") ? "fair" : "bad"}`;
    const name = report.model.world === "docking" ? (session.cameras[report.model.camera]?.name ?? "") : "";
    element("#camera-name").textContent = name;
    document.body.dataset["frame"] = String(report.frame);
  }

  const slider = element<HTMLInputElement>("#slider");
  const number = element<HTMLInputElement>("#frame");
  const speed = element<HTMLSelectElement>("#speed");
  for (const input of [slider, number]) {
    input.min = String(player.first);
    input.max = String(player.last);
  }
  speed.append(...SPEEDS.map((value) => new Option(`${value}×`, String(value))));

  function controls(): void {
    slider.value = String(player.frame);
    if (document.activeElement !== number) {
      number.value = String(player.frame);
    }
    speed.value = String(player.speed);
    document.body.dataset["playing"] = String(player.playing);
    element("#play-icon").setAttribute("d", player.playing ? "M4 3h3v10H4zM9 3h3v10H9z" : "M4 2v12l9-6z");
  }

  function toggleTruth(): void {
    const isOn = !camera.truth;
    camera.truth = phase.truth = model.truth = isOn;
    document.body.classList.toggle("with-truth", isOn);
    element("#truth").setAttribute("aria-pressed", String(isOn));
    again();
  }

  function toggleOverlay(): void {
    camera.overlay = !camera.overlay;
    element("#overlay").setAttribute("aria-pressed", String(camera.overlay));
    camera.draw();
  }

  /** Draws the frame that is shown once more. */
  function again(): void {
    camera.draw();
    ground.draw();
    phase.draw();
    if (latest) {
      model.show(latest.report.model);
    }
    model.stage.invalidate();
    redraw();
  }

  const keys = element<HTMLDialogElement>("#keys");
  const second = Math.max(1, Math.round(session.rate_hz));
  const actions: Record<string, (shift: boolean) => void> = {
    " ": () => player.toggle(),
    ArrowLeft: (shift) => player.step(shift ? -second : -1),
    ArrowRight: (shift) => player.step(shift ? second : 1),
    Home: () => player.step(player.first - player.frame),
    End: () => player.step(player.last - player.frame),
    "+": () => player.faster(1),
    "=": () => player.faster(1),
    "-": () => player.faster(-1),
    t: toggleTruth,
    o: toggleOverlay,
    "?": () => (keys.open ? keys.close() : keys.showModal()),
  };
  addEventListener("keydown", (event) => {
    const isTyping = event.target === number || event.target === speed;
    if (event.ctrlKey || event.metaKey || event.altKey || (isTyping && event.key !== "Escape")) {
      return;
    }
    const action = actions[event.key];
    if (action) {
      event.preventDefault();
      action(event.shiftKey);
    }
  });
  for (const [id, key] of [
    ["start", "Home"], ["back", "ArrowLeft"], ["play", " "], ["forward", "ArrowRight"], ["end", "End"],
    ["truth", "t"], ["overlay", "o"], ["help", "?"],
  ] as const) {
    element(`#${id}`).addEventListener("click", () => actions[key]?.(false));
  }
  slider.addEventListener("input", () => player.seek(Number(slider.value)));
  number.addEventListener("change", () => {
    player.seek(Number(number.value));
    number.blur();
  });
  speed.addEventListener("change", () => {
    player.speed = Number(speed.value);
    speed.blur();
  });
  onResize(again);
  onThemeChange(() => {
    ground.restyle();
    phase.build();
    again();
  });

  let modelFrame: api.Frame | null = null;
  setInterval(() => {
    if (latest && latest !== modelFrame) {
      modelFrame = latest;
      model.show(latest.report.model);
    }
    redraw();
  }, MODEL_MS);
  let slowFrame: api.Frame | null = null;
  setInterval(() => {
    if (latest && latest !== slowFrame) {
      slowFrame = latest;
      ground.show(latest.report);
      phase.show(latest.report);
    }
  }, SLOW_MS);

  let counted = 0;
  let counting = performance.now();
  const refresh = async () => {
    const now = performance.now();
    const rate = ((player.counts.shown - counted) * 1000) / (now - counting);
    [counted, counting] = [player.counts.shown, now];
    element("#rate").textContent = player.playing ? `${rate.toFixed(1)} /s` : "";
    const frame = player.frame;
    const [state, history, track] = await Promise.all([api.progress(), api.history(), api.groundTrack(frame)]);
    const span = Math.max(1, state.to - state.from);
    element("#buffered").style.width = `${(100 * (state.processed - state.from)) / span}%`;
    phase.setHistory(history);
    ground.setTrack(track);
  };
  const repeat = () =>
    void refresh()
      // The server is gone: the page keeps its content and retries.
      .catch(() => undefined)
      .then(() => setTimeout(repeat, PROGRESS_MS));
  repeat();
  controls();
  Object.assign(globalThis, { boresight: { counts: player.counts } });
}

start().catch((error: unknown) => {
  const waiting = element("#waiting");
  waiting.hidden = false;
  waiting.textContent = `The monitor cannot start: ${String(error)}`;
});
