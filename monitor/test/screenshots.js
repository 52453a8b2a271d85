// Makes docs/images/monitor-docking.png, monitor-far-range.png and report.png. `npm run screenshots --prefix monitor`.

import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { browser, goTo, monitor, open, run } from "./browser.js";

/** Thousands of frames are processed before. */
const PATIENCE_MS = 600_000;
const PICTURES = [
  { words: ["docking", "--from", "17500"], frame: 21115, name: "monitor-docking", keys: [] },
  { words: ["argon", "--frames", "9000..12000"], frame: 10200, name: "monitor-far-range", keys: ["t"] },
];

const image = (name) => fileURLToPath(new URL(`../../docs/images/${name}.png`, import.meta.url));

const chromium = await browser();
for (const { words, frame, name, keys } of PICTURES) {
  const served = await monitor(...words);
  const { page } = await open(chromium, served.url);
  await goTo(page, frame, PATIENCE_MS);
  for (const key of keys) {
    await page.keyboard.press(key);
  }
  await page.waitForTimeout(1500);
  await page.screenshot({ path: image(name) });
  await page.close();
  await served.stop();
}

const directory = mkdtempSync(join(tmpdir(), "boresight-report-"));
run("run", "argon", "--out", join(directory, "argon"));
const page = await chromium.newPage({ viewport: { width: 1280, height: 900 } });
await page.goto(pathToFileURL(join(directory, "argon", "report.html")).href);
await page.waitForTimeout(1500);
await page.locator("#errors").screenshot({ path: image("report") });
rmSync(directory, { recursive: true, force: true });
await chromium.close();
