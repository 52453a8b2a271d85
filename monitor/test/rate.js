// How many pictures a second the page shows, and what the processors do meanwhile. `npm run rate --prefix monitor`, with
// BORESIGHT naming the command. Linux: it reads /proc.

import { readdirSync, readFileSync } from "node:fs";
import { browser, monitor, open } from "./browser.js";

const SECONDS = 20;
/** Clock ticks of /proc a second. */
const TICKS = 100;

/** Processor time of a process, s; 0 when it has gone. */
function cpu(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
    return (Number(fields[11]) + Number(fields[12])) / TICKS;
  } catch {
    return 0;
  }
}

/** Those of the browser: its command line and its children's have the same profile, or its processes the same parent. */
function family(ancestor) {
  const parents = new Map();
  for (const name of readdirSync("/proc")) {
    try {
      parents.set(Number(name), Number(readFileSync(`/proc/${name}/stat`, "utf8").split(") ")[1].split(" ")[1]));
    } catch {
      // Not a process, or gone.
    }
  }
  const isOf = (pid) => pid === ancestor || (parents.has(pid) && isOf(parents.get(pid)));
  return [...parents.keys()].filter((pid) => pid !== ancestor && isOf(pid));
}

for (const words of [["docking", "--from", "15000"], ["argon", "--frames", "9000..12000"]]) {
  const served = await monitor(...words);
  const chromium = await browser();
  const { page } = await open(chromium, served.url);
  await page.waitForTimeout(3000);
  const browsers = family(process.pid).filter((pid) => pid !== served.pid);
  const total = () => browsers.reduce((sum, pid) => sum + cpu(pid), 0);
  const before = { server: cpu(served.pid), browser: total(), time: performance.now() };
  await page.keyboard.press("Space");
  await page.waitForTimeout(SECONDS * 1000);
  const { shown, late } = await page.evaluate(() => boresight.counts);
  const seconds = (performance.now() - before.time) / 1000;
  const cores = (after, first) => ((after - first) / seconds).toFixed(2);
  console.log(
    `${words[0]}: ${(shown / seconds).toFixed(1)} pictures a second, ${late} late of ${shown}; cores: boresight ` +
      `${cores(cpu(served.pid), before.server)}, browser ${cores(total(), before.browser)}`,
  );
  await chromium.close();
  await served.stop();
}
