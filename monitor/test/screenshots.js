// Makes docs/images/monitor-docking.png and monitor-far-range.png. `npm run screenshots --prefix monitor`.

import { fileURLToPath } from "node:url";
import { browser, goTo, monitor, open } from "./browser.js";

/** Thousands of frames are processed before. */
const PATIENCE_MS = 600_000;
const PICTURES = [
  { words: ["docking", "--from", "17500"], frame: 21115, name: "monitor-docking", keys: [] },
  { words: ["argon", "--frames", "9000..12000"], frame: 10200, name: "monitor-far-range", keys: ["t"] },
];

const chromium = await browser();
for (const { words, frame, name, keys } of PICTURES) {
  const served = await monitor(...words);
  const { page } = await open(chromium, served.url);
  await goTo(page, frame, PATIENCE_MS);
  for (const key of keys) {
    await page.keyboard.press(key);
  }
  await page.waitForTimeout(1500);
  await page.screenshot({ path: fileURLToPath(new URL(`../../docs/images/${name}.png`, import.meta.url)) });
  await page.close();
  await served.stop();
}
await chromium.close();
