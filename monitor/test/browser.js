// What the scripts here share: the command, a monitor that runs, and a browser that looks at pages.

import { spawn, spawnSync } from "node:child_process";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

/** The command, built with the page in it. */
const boresight =
  process.env.BORESIGHT ?? fileURLToPath(new URL("../../target/release/boresight", import.meta.url));

/** Longer than anything takes on a busy machine. */
export const PATIENCE_MS = 60_000;

/** Runs the command to its end. That the answer is no (status 1) is an answer. */
export function run(...words) {
  const { status } = spawnSync(boresight, words, { stdio: ["ignore", "ignore", "inherit"] });
  if (status !== 0 && status !== 1) {
    throw new Error(`boresight ${words.join(" ")} ended with ${status}`);
  }
}

/** Starts a monitor; what it gives has its address, its process, and ends it. */
export async function monitor(...words) {
  const child = spawn(boresight, ["monitor", ...words, "--bind", "127.0.0.1:0"], {
    stdio: ["ignore", "ignore", "pipe"],
  });
  const lines = createInterface({ input: child.stderr });
  const url = await new Promise((resolve, reject) => {
    lines.on("line", (line) => {
      const found = /http:\/\/\S+/.exec(line);
      found ? resolve(found[0]) : console.error(line);
    });
    child.on("exit", (code) => reject(new Error(`the monitor ended with ${code}`)));
  });
  const stop = () =>
    new Promise((resolve) => {
      child.removeAllListeners("exit");
      child.on("exit", (code) => resolve(code));
      child.kill("SIGINT");
    });
  return { url, pid: child.pid, stop };
}

export async function browser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-background-networking"],
  });
}

/** Gathers what must not happen on a page: errors, and requests for what is not its own. */
export function problemsOf(page, isOwn) {
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("request", (request) => {
    if (!isOwn(request.url())) {
      problems.push(`a request to ${request.url()}`);
    }
  });
  return problems;
}

/** Opens the monitor's page, which plays, and pauses it unless `plays` is true. */
export async function open(browser, url, { plays = false, ...options } = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme: "dark", ...options });
  const problems = problemsOf(page, (asked) => asked.startsWith(url));
  await page.goto(url);
  await page.waitForFunction(() => document.body.dataset.frame !== undefined, null, { timeout: PATIENCE_MS });
  if (!plays) {
    await pause(page);
  }
  return { page, problems };
}

/** Pauses the page if it plays; it may have stopped at the last frame by itself. */
export async function pause(page) {
  await page.evaluate(() => document.body.dataset.playing === "true" && document.querySelector("#play").click());
}

/** Goes to a frame, waits until it is shown, and until the panels that are drawn less often show it too. */
export async function goTo(page, frame, patience = PATIENCE_MS) {
  await page.fill("#frame", String(frame));
  await page.keyboard.press("Enter");
  await page.waitForFunction((wanted) => document.body.dataset.frame === wanted, String(frame), { timeout: patience });
  await page.waitForTimeout(1200);
}
