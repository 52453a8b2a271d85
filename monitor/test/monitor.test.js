// The page in a browser: it opens, its panels change, its numbers are those of the run, its overlay lies on the features.
// Run by `npm test --prefix monitor`, with BORESIGHT naming the command.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { browser, goTo, monitor, open, pause, PATIENCE_MS, run } from "./browser.js";

/** How far the middle of what is drawn may lie from that of what it marks, px of the camera. */
const OVERLAY_PX = 1.5;

const WORLDS = {
  docking: { frames: [24000, 24050], feature: "cross", good: "measured" },
  argon: { frames: [2000, 2040], feature: "target", good: "detected" },
};

let chromium;
let directory;
before(async () => {
  directory = mkdtempSync(join(tmpdir(), "boresight-monitor-"));
  for (const [scenario, { frames }] of Object.entries(WORLDS)) {
    run("run", scenario, "--frames", frames.join(".."), "--out", join(directory, scenario));
  }
  chromium = await browser();
});
after(async () => {
  await chromium?.close();
  rmSync(directory, { recursive: true, force: true });
});

/** The rows of a CSV table without quotes, by the first column. */
function table(path) {
  const [head, ...lines] = readFileSync(path, "utf8").trim().split("\n");
  const names = head.split(",");
  return new Map(
    lines.map((line) => {
      const cells = line.split(",");
      return [Number(cells[0]), Object.fromEntries(names.map((name, i) => [name, cells[i]]))];
    }),
  );
}

/** The numbers and texts of the panel of parameters. */
function panel(page) {
  return page.$$eval("#parameters tr[data-name]", (rows) =>
    rows.map((row) => ({
      name: row.dataset.name,
      value: row.querySelector(".measured").dataset.value,
      text: row.querySelector(".measured").textContent,
      sigma: row.querySelector(".sigma").dataset.value,
    })),
  );
}

const shot = async (page, selector) => (await page.locator(selector).screenshot()).toString("base64");

/** Grey of the camera's canvas within a box of camera pixels, with the place of each in camera pixels. */
function pixels(page, { x, y, reach }) {
  return page.$eval(
    "#camera > canvas",
    (canvas, { x, y, reach }) => {
      const [scale, left, top] = ["scale", "left", "top"].map((name) => Number(canvas.dataset[name]));
      const first = [Math.round(left + scale * (x - reach)), Math.round(top + scale * (y - reach))];
      const side = Math.round(2 * reach * scale);
      const { data } = canvas.getContext("2d").getImageData(...first, side, side);
      return Array.from({ length: side * side }, (_, i) => ({
        // The middle of a canvas pixel is half a pixel from its corner.
        x: (first[0] + (i % side) + 0.5 - left) / scale,
        y: (first[1] + Math.floor(i / side) + 0.5 - top) / scale,
        rgb: [...data.slice(4 * i, 4 * i + 3)],
      }));
    },
    { x, y, reach },
  );
}

function middle(points, weight) {
  const total = points.reduce((sum, point) => sum + weight(point), 0);
  assert.ok(total > 0, "there is nothing to take the middle of");
  return ["x", "y"].map((axis) => points.reduce((sum, point) => sum + weight(point) * point[axis], 0) / total);
}

for (const [scenario, { frames, feature, good }] of Object.entries(WORLDS)) {
  for (const mode of ["live", "replay"]) {
    describe(`${scenario}, ${mode}`, () => {
      let served;
      let page;
      let problems;
      let measurements;
      before(async () => {
        const words = mode === "live" ? [scenario, "--frames", frames.join("..")] : [join(directory, scenario)];
        served = await monitor(...words);
        ({ page, problems } = await open(chromium, served.url, { viewport: { width: 1600, height: 1200 } }));
        measurements = table(join(directory, scenario, "measurements.csv"));
      });
      after(async () => {
        await page?.close();
        assert.equal(await served?.stop(), 0, "Ctrl-C ends the monitor in order");
      });

      test("the parameters on the page are those of the run", async () => {
        for (const frame of [frames[0] + 3, frames[1] - 1]) {
          await goTo(page, frame);
          const row = measurements.get(frame);
          assert.equal(row.status, good, "the test needs a frame that was measured");
          assert.equal((await page.textContent("#status")).replaceAll(" ", "_"), good);
          let compared = 0;
          for (const { name, value, text, sigma } of await panel(page)) {
            for (const [column, shown] of [[name, value], [`sigma_${name}`, sigma]]) {
              const written = row[column];
              if (written) {
                // Angles of a replay have been in radians and back: a few units in the last place.
                const tolerance = mode === "live" ? 0 : 1e-15 * Math.abs(Number(written)) * 8;
                assert.ok(Math.abs(Number(shown) - Number(written)) <= tolerance, `${column}: ${shown}, ${written}`);
                compared += 1;
              }
            }
            if (value) {
              const decimals = (text.split(".")[1] ?? "").length;
              assert.equal(text, Number(value).toFixed(decimals), name);
            }
          }
          assert.ok(compared >= 6, `${compared} numbers were compared`);
        }
      });

      test("every panel shows something that changes from frame to frame", async () => {
        const panels = ["#camera > canvas", "#model > canvas", "#parameters", "#phase .chart"];
        // In a second of docking the station moves by less than a pixel of the map.
        panels.push(...(scenario === "argon" ? ["#ground > canvas"] : []));
        const looks = [];
        for (const frame of [frames[0] + 5, frames[1] - 2]) {
          await goTo(page, frame);
          looks.push(await Promise.all(panels.map((selector) => shot(page, selector))));
        }
        panels.forEach((selector, i) => assert.notEqual(looks[0][i], looks[1][i], selector));
        const colours = await page.$eval("#ground > canvas", (canvas) => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return new Set(new Uint32Array(data.buffer)).size;
        });
        assert.ok(colours > 8, `the map has ${colours} colours`);
      });

      test("the overlay lies on what it marks", async () => {
        await goTo(page, frames[1] - 1);
        const { overlay } = await page.evaluate((n) => fetch(`api/frames/${n}.json`).then((r) => r.json()), frames[1] - 1);
        const shape = overlay.find(({ kind }) => kind === feature);
        const box = { x: shape.x_px, y: shape.y_px, reach: shape.size_px * 1.05 };
        const drawn = await pixels(page, box);
        await page.keyboard.press("o");
        const bare = await pixels(page, box);
        await page.keyboard.press("o");
        const grey = (point) => point.rgb[0];
        const peak = Math.max(...bare.map(grey));
        const bright = middle(bare, (point) => (grey(point) > 0.6 * peak ? 1 : 0));
        const changed = new Set(drawn.filter(({ rgb }, i) => rgb.some((v, c) => Math.abs(v - bare[i].rgb[c]) > 40)));
        const figure = middle([...changed], () => 1);
        const off = Math.hypot(bright[0] - figure[0], bright[1] - figure[1]);
        assert.ok(off < OVERLAY_PX, `${off.toFixed(2)} px between the ${feature} and what is drawn`);
        // And both are where the pipeline says.
        assert.ok(Math.hypot(figure[0] - shape.x_px, figure[1] - shape.y_px) < OVERLAY_PX, `${figure}`);
      });

      test("keys play, step, seek and show the truth", async () => {
        await page.keyboard.press("Home");
        await page.waitForFunction((n) => document.body.dataset.frame === n, String(frames[0]));
        await page.keyboard.press("ArrowRight");
        await page.waitForFunction((n) => document.body.dataset.frame === n, String(frames[0] + 1));
        await page.keyboard.press("+");
        assert.equal(await page.inputValue("#speed"), "2");
        await page.keyboard.press("-");
        await page.keyboard.press("t");
        assert.ok(await page.locator("#parameters td.truth").first().isVisible());
        await page.keyboard.press("t");
        assert.ok(!(await page.locator("#parameters td.truth").first().isVisible()));
        await page.keyboard.press("?");
        assert.ok(await page.locator("#keys").isVisible());
        await page.keyboard.press("Escape");
        await page.keyboard.press("Space");
        await page.waitForFunction((n) => document.body.dataset.frame === n, String(frames[1] - 1), {
          timeout: PATIENCE_MS,
        });
        const { shown } = await page.evaluate(() => boresight.counts);
        assert.ok(shown > 15, `${shown} pictures were shown while playing`);
      });

      test("there was no error and no request to anywhere else", () => assert.deepEqual(problems, []));
    });
  }
}

for (const scenario of Object.keys(WORLDS)) {
  for (const [width, height] of [[1280, 720], [1024, 768], [820, 1180]]) {
    test(`${scenario}: every panel is on a screen of ${width} × ${height}, and every number in its panel`, async (context) => {
      const served = await monitor(join(directory, scenario));
      context.after(() => served.stop());
      const { page, problems } = await open(chromium, served.url, { viewport: { width, height } });
      context.after(() => page.close());
      await page.keyboard.press("t");
      const box = (selector) => page.locator(selector).boundingBox();
      for (const id of ["camera", "model", "parameters", "ground", "phase"]) {
        const at = await box(`#${id}`);
        const isOn = at.x >= 0 && at.y >= 0 && at.x + at.width <= width && at.y + at.height <= height;
        assert.ok(isOn && at.width > 200 && at.height > 150, `#${id}: ${Object.values(at)}`);
      }
      const [panel, table, title, legend] = await Promise.all(
        ["#parameters", "#parameters table", "#camera h2 span", "#legend span >> nth=0"].map(box),
      );
      // A measurement of the far range has no σ.
      const shown = await page.locator("#parameters .sigma").evaluateAll((cells) => cells.filter((cell) => cell.checkVisibility()).length);
      assert.equal(shown > 10, scenario === "docking", `${shown} cells of σ`);
      assert.ok(await page.locator("#legend .truth").isVisible(), "the legend names the truth");
      assert.ok(table.x + table.width <= panel.x + panel.width, `the table ends ${table.x + table.width - panel.x - panel.width} px beyond`);
      assert.ok(legend.x >= title.x + title.width || legend.y >= title.y + title.height, "the legend lies on the title");
      assert.deepEqual(problems, []);
    });
  }
}

for (const [scenario, { frames }] of Object.entries(WORLDS)) {
  describe(`${scenario}, as a reader opens it`, () => {
    let served;
    let page;
    let problems;
    before(async () => {
      served = await monitor(join(directory, scenario));
    });
    after(async () => {
      await served?.stop();
    });

    test("it plays when it is opened, and not for a reader who asks for little motion", async (context) => {
      ({ page, problems } = await open(chromium, served.url, { plays: true }));
      context.after(() => page.close());
      await page.waitForFunction((first) => Number(document.body.dataset.frame) > first + 3, frames[0], { timeout: PATIENCE_MS });
      assert.deepEqual(problems, []);
      const still = await open(chromium, served.url, { plays: true, reducedMotion: "reduce" });
      context.after(() => still.page.close());
      await still.page.waitForTimeout(500);
      assert.equal(await still.page.getAttribute("body", "data-frame"), String(frames[0]));
    });

    test("after a seek every panel is dimmed at once, until the frame is there", async (context) => {
      ({ page, problems } = await open(chromium, served.url));
      context.after(() => page.close());
      await page.keyboard.press("Home");
      await page.waitForFunction((n) => document.body.dataset.frame === n, String(frames[0]));
      const wanted = frames[1] - 1;
      let release;
      const held = new Promise((resolve) => (release = resolve));
      await page.route(`**/api/frames/${wanted}.json`, async (route) => {
        await held;
        await route.continue();
      });
      // What the page shows in the same moment, before any answer.
      const seen = await page.evaluate((frame) => {
        const slider = document.querySelector("#slider");
        slider.value = String(frame);
        slider.dispatchEvent(new Event("input"));
        return [...document.querySelectorAll(".panel")].map((panel) => ({
          id: panel.id,
          label: getComputedStyle(panel, "::after").content,
          shown: getComputedStyle(panel, "::after").visibility,
          opacity: Number(getComputedStyle(panel.querySelector("canvas, table, .chart")).opacity),
        }));
      }, wanted);
      assert.equal(seen.length, 5);
      for (const { id, label, shown, opacity } of seen) {
        assert.ok(label.includes(`waiting for frame ${wanted}`) && shown === "visible" && opacity < 0.5, `${id}: ${label} ${shown} ${opacity}`);
      }
      await page.waitForTimeout(300);
      assert.ok(await page.evaluate(() => document.body.classList.contains("waiting")), "it waits as long as the frame is not there");
      release();
      await page.waitForFunction((n) => document.body.dataset.frame === n, String(wanted), { timeout: PATIENCE_MS });
      assert.ok(!(await page.evaluate(() => document.body.classList.contains("waiting"))), "nothing is dimmed with the frame");
      assert.deepEqual(problems, []);
    });

    test("it is no wider than a telephone of 390 px, with and without the truth", async (context) => {
      ({ page, problems } = await open(chromium, served.url, { viewport: { width: 390, height: 844 } }));
      context.after(() => page.close());
      for (const isOn of [false, true]) {
        if (isOn) {
          await page.click("#truth");
        }
        await pause(page);
        const { width, outside } = await page.evaluate(() => ({
          width: document.documentElement.scrollWidth,
          outside: [...document.querySelectorAll("header > *, footer > *, .panel")]
            .filter((part) => part.checkVisibility() && part.getBoundingClientRect().right > innerWidth + 0.5)
            .map((part) => part.id || part.tagName),
        }));
        assert.ok(width <= 390, `the page is ${width} px wide`);
        assert.deepEqual(outside, [], "parts beyond the edge");
      }
      for (const id of ["camera", "parameters", "model", "ground", "phase"]) {
        const { width, height } = await page.locator(`#${id}`).boundingBox();
        assert.ok(width > 340 && height > 150, `#${id}: ${width} × ${height}`);
      }
      assert.deepEqual(problems, []);
    });
  });
}

/** The target of this frame is there and the pipeline misses it. */
const MISSED = 145;

describe("argon, a frame that is missed, of a plan of five days", () => {
  let served;
  let page;
  before(async () => {
    served = await monitor("argon");
    ({ page } = await open(chromium, served.url));
    await goTo(page, MISSED);
    // What is written on the picture, and how often a dashed line of the phase chart begins anew.
    await page.evaluate(() => {
      globalThis.drawn = { words: [], pieces: 0 };
      const own = CanvasRenderingContext2D.prototype;
      const { clearRect, fillText, beginPath, moveTo, stroke } = own;
      let begun = 0;
      Object.assign(own, {
        clearRect(...box) {
          // The picture is drawn anew.
          if (this.canvas.closest("#camera")) {
            drawn.words = [];
          }
          clearRect.apply(this, box);
        },
        fillText(text, x, y) {
          if (this.canvas.closest("#camera")) {
            const { width } = this.measureText(text);
            drawn.words.push({ text, x, y, width, height: Number.parseFloat(this.font) });
          }
          fillText.call(this, text, x, y);
        },
        beginPath() {
          begun = 0;
          beginPath.call(this);
        },
        moveTo(x, y) {
          begun += 1;
          moveTo.call(this, x, y);
        },
        stroke() {
          if (this.canvas.closest("#phase") && this.getLineDash().length > 0) {
            drawn.pieces = begun;
          }
          stroke.call(this);
        },
      });
    });
    await page.keyboard.press("t");
    await page.waitForTimeout(1200);
  });
  after(async () => {
    await page?.close();
    await served?.stop();
  });

  test("the true place of the target is named, and no word lies on another", async () => {
    assert.notEqual(await page.textContent("#status"), "detected", "the test needs a frame that is missed");
    const words = await page.evaluate(() => drawn.words);
    assert.ok(words.length > 10 && words.some(({ text }) => text === "target"), words.map(({ text }) => text).join());
    for (const [i, a] of words.entries()) {
      for (const b of words.slice(0, i)) {
        const liesOn = a.x < b.x + b.width && b.x < a.x + a.width && Math.abs(a.y - b.y) < a.height;
        assert.ok(!liesOn, `${a.text} lies on ${b.text}`);
      }
    }
  });

  test("no line of the plan crosses the time between two days", async () => {
    assert.equal(await page.evaluate(() => drawn.pieces), 5);
  });
});
