// Reports in a browser: every chart is drawn, values show on hover, the page has an error nowhere and can ask nothing of any network.
// Run by `npm test --prefix monitor`, with BORESIGHT naming the command.

import assert from "node:assert/strict";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, problemsOf, run } from "./browser.js";

const STUDY = `
title = "two frames of ARGON"
scenario = "argon"
seed = 5
frames = "2000..2002"
[stop]
cases = 8
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "normal", mean = 0.8, sigma = 0.1 }
`;

/** How each kind of report is made in the directory DIR, and what it must show. */
const REPORTS = {
  "far range": {
    words: ["run", "argon", "--frames", "9000..9060", "--out", "DIR"],
    headings: [
      /^Worst frames$/,
      /^Figures by day, with published values$/,
      /^Errors of the direction over time$/,
      /^Causes/,
      /^Track of the target in pixels$/,
      /^A whole image, and the superimposed images of an orbit$/,
      /^Stars identified in each image$/,
      /^Attitude of the camera/,
      /^Angles of the aberration correction$/,
      /^Position of the chaser/,
      /^Not on this page$/,
    ],
    pictures: 3,
  },
  docking: {
    words: ["run", "docking", "--frames", "24000..24060", "--out", "DIR"],
    headings: [/^Worst fields$/, /^Figures$/, /^Parameters of the motion$/, /^Accuracy of the motion$/, /^Typical fields/],
    pictures: 1,
  },
  study: {
    words: ["study", "run", "STUDY", "--out", "DIR"],
    headings: [/^Worst cases$/, /^Figures$/, /^Varied settings$/],
    pictures: 0,
  },
  visibility: {
    words: ["visibility", "uasc-far-range", "--frames", "0", "--out", "DIR"],
    headings: [/^Detection against magnitude$/, /^Stars over the sky$/, /^Exposure window against range$/],
    pictures: 0,
  },
  "middle range": {
    words: ["run", "middle-range", "--frames", "0..40", "--out", "DIR"],
    headings: [/^Worst frames$/, /^The approach in pictures$/, /^Range error$/, /^Figures$/],
    pictures: 3,
  },
  gate: {
    before() {
      const [good, baseline, worse] = ["far range", "baseline", "worse"].map((name) => join(directory, name));
      run("gate", "baseline", good, "--out", baseline, "--reason", "it was good enough", "--block-length", "6");
      cpSync(good, worse, { recursive: true });
      loseEverySecond(worse);
      mkdirSync(join(directory, "gate"));
    },
    words: ["gate", "BASELINE", "WORSE", "--report", "REPORT"],
    headings: [/^Changes of the figures$/, /^Frames with changed verdict$/],
    pictures: 1,
  },
};

/** Takes the answer out of every second row of a run, on purpose: without its checksums. */
function loseEverySecond(directory) {
  const path = join(directory, "measurements.csv");
  const [head, ...rows] = readFileSync(path, "utf8").trimEnd().split("\n");
  const names = head.split(",");
  const lost = ([frame]) => names.map((name, i) => (i === 0 ? frame : name === "status" ? "no_target" : "")).join(",");
  writeFileSync(path, `${[head, ...rows.map((row, i) => (i % 2 ? lost(row.split(",")) : row))].join("\n")}\n`);
  rmSync(join(directory, "SHA256SUMS"));
}

let chromium;
let directory;
before(async () => {
  directory = mkdtempSync(join(tmpdir(), "boresight-report-"));
  const study = join(directory, "study.toml");
  writeFileSync(study, STUDY);
  for (const [name, { before, words }] of Object.entries(REPORTS)) {
    before?.();
    const paths = {
      DIR: join(directory, name),
      STUDY: study,
      BASELINE: join(directory, "baseline"),
      WORSE: join(directory, "worse"),
      REPORT: join(directory, name, "report.html"),
    };
    run(...words.map((word) => paths[word] ?? word));
  }
  chromium = await browser();
});
after(async () => {
  await chromium?.close();
  rmSync(directory, { recursive: true, force: true });
});

const address = (name) => pathToFileURL(join(directory, name, "report.html")).href;

/** Opens a report as a reader does, from its file. */
async function open(name, options = {}) {
  const page = await chromium.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  const own = address(name);
  const problems = problemsOf(page, (asked) => asked === own || asked.startsWith("data:") || asked.startsWith("blob:"));
  await page.goto(own);
  await page.waitForFunction(() => [...document.querySelectorAll(".plot")].every((plot) => plot.querySelector(".main-svg")));
  return { page, problems };
}

/** Of every chart: its traces, those that have anything to draw, and the marks that are on the page. */
const charts = (page) =>
  page.$$eval(".plot", (plots) =>
    plots.map((plot) => ({
      caption: plot.closest("figure").querySelector("figcaption").textContent,
      traces: plot.data.length,
      filled: plot.data.filter(({ x, z, lat }) => (x ?? z ?? lat)?.length > 0).length,
      marks: plot.querySelectorAll(".scatterlayer path, .barlayer path, .heatmaplayer image, .layer.frontplot path").length,
      width: plot.querySelector(".main-svg").getBoundingClientRect().width,
    })),
  );

/** Numbers beside an axis that cover the next one. */
const overprinted = (page) =>
  page.$$eval(".plot", (plots) =>
    plots.flatMap((plot) => {
      const axes = Map.groupBy(plot.querySelectorAll(`[class^="y"][class$="tick"] > text`), (text) => text.parentNode.getAttribute("class"));
      return [...axes].flatMap(([axis, texts]) => {
        const boxes = texts.map((text) => text.getBoundingClientRect()).sort((a, b) => a.top - b.top);
        // Boxes of letters have room above and below the digits.
        const covers = boxes.some((box, i) => i > 0 && box.top < boxes[i - 1].bottom - 0.3 * box.height);
        return covers ? [`${axis} of ${plot.closest("section").id}`] : [];
      });
    }),
  );

for (const [name, { headings, pictures }] of Object.entries(REPORTS)) {
  describe(name, () => {
    for (const colorScheme of ["light", "dark"]) {
      test(`${colorScheme}: what is asked for is there and drawn, without an error and without a request`, async (context) => {
        const { page, problems } = await open(name, { colorScheme });
        context.after(() => page.close());
        const found = await page.$$eval("main h2", (all) => all.map(({ textContent }) => textContent));
        headings.forEach((heading) => assert.ok(found.some((text) => heading.test(text)), `${heading} in ${found}`));
        for (const { caption, filled, marks } of await charts(page)) {
          assert.ok(filled > 0 && marks > 0, `nothing is drawn: ${caption}`);
        }
        // A picture that cannot be decoded has no size.
        const sizes = await page.$$eval(".picture image", (images) =>
          Promise.all(
            images.map(async (image) => {
              const picture = new Image();
              picture.src = image.href.baseVal;
              await picture.decode();
              return picture.naturalWidth;
            }),
          ),
        );
        assert.ok(sizes.length >= pictures && sizes.every((size) => size > 20), `pictures: ${sizes}`);
        const grey = (text) => Number(/\d+/.exec(text)[0]);
        const ground = await page.$eval("body", (body) => getComputedStyle(body).backgroundColor);
        const ink = await page.$eval(".plot .xtick text, .plot .infolayer text", (text) => text.style.fill);
        const [dark, light] = colorScheme === "dark" ? [ground, ink] : [ink, ground];
        assert.ok(grey(dark) < 80 && grey(light) > 180, `ground ${ground}, ink ${ink}`);
        const cut = await page.$$eval("section > .table", (tables) =>
          tables.filter((table) => table.scrollWidth > table.clientWidth + 1).map((table) => table.closest("section").id),
        );
        assert.deepEqual(cut, [], "tables that are cut at the right");
        assert.deepEqual(await overprinted(page), []);
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        assert.ok(beyond <= 0, `the page is ${beyond} px wider than the window`);
        assert.deepEqual(problems, []);
      });
    }

    test("on a telephone nothing but a table in its box is wider than the screen", async (context) => {
      const { page, problems } = await open(name, { viewport: { width: 390, height: 844 } });
      context.after(() => page.close());
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
      const beyond = await page.$$eval("body *", (all) =>
        all
          .filter((part) => part.checkVisibility() && !part.closest(".table") && !part.closest("svg"))
          .filter((part) => part.getBoundingClientRect().right > innerWidth + 1)
          .map((part) => `${part.tagName} ${part.className}`),
      );
      assert.deepEqual(beyond, []);
      // The caption of a table is read without scrolling.
      const captions = await page.$$eval("caption span", (all) =>
        all.filter((text) => text.checkVisibility()).map((text) => text.getBoundingClientRect().right - innerWidth),
      );
      assert.ok(captions.every((excess) => excess <= 0), `captions: ${captions}`);
      assert.deepEqual(problems, []);
    });

    test("a verdict is on top, in words, with what is poor or good and against what", async (context) => {
      const { page } = await open(name);
      context.after(() => page.close());
      const findings = await page.$$eval("header #verdict .findings li", (all) =>
        all.map((item) => ({ grade: item.querySelector(".grade").textContent, text: item.textContent })),
      );
      assert.ok(findings.length > 0, "no findings");
      const grades = ["poor", "fair", "good", "not judged"];
      for (const { grade, text } of findings) {
        assert.ok(grades.includes(grade) && text.length > 20, text);
      }
      const summary = await page.$$eval("#verdict .summary dt", (all) => all.map(({ textContent }) => textContent));
      assert.deepEqual(summary, grades.filter((grade) => findings.some((finding) => finding.grade === grade)));
    });

    test("no visible text is a key of a file, and no heading or caption numbers a figure of a paper", async (context) => {
      const { page } = await open(name);
      context.after(() => page.close());
      const { keys, numbered } = await page.evaluate(() => {
        const shown = [];
        const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
        for (let node = walker.nextNode(); node; node = walker.nextNode()) {
          if (!node.parentElement.closest("script, style, code, .facts")) {
            shown.push(node.textContent);
          }
        }
        const titles = [...document.querySelectorAll("h2, figcaption, caption, p")].map(({ textContent }) => textContent);
        // Names of files keep their underscores.
        const isKey = (text) => /\b[a-z]+_[a-z_0-9]+\b(?!\.(csv|json|parquet|toml))/.test(text);
        return { keys: shown.filter(isKey), numbered: titles.filter((text) => /\b(Fig|Figs|Table|Eq|Eqs)\.? \d/.test(text)) };
      });
      assert.deepEqual(keys, []);
      assert.deepEqual(numbered, []);
    });

    test("no section is empty", async (context) => {
      const { page } = await open(name);
      context.after(() => page.close());
      const empty = await page.$$eval("main section", (all) =>
        all.filter((section) => !section.querySelector("table, .plot, .picture, dl")).map(({ id }) => id),
      );
      assert.deepEqual(empty, []);
    });

    test("on paper it is light, and no chart is wider than the sheet", async (context) => {
      const { page, problems } = await open(name, { colorScheme: "dark" });
      context.after(() => page.close());
      await page.emulateMedia({ media: "print" });
      await page.waitForFunction(() => getComputedStyle(document.body).backgroundColor === "rgb(255, 255, 255)");
      // 210 mm less two margins of 14 mm, at 96 px an inch.
      const paper = (210 - 2 * 14) * (96 / 25.4);
      // The charts are told of the paper after the style is: they are given the time to be drawn again.
      const fits = (most) =>
        [...document.querySelectorAll(".plot .main-svg")].every((chart) => chart.getBoundingClientRect().width <= most);
      await page.waitForFunction(fits, paper, { timeout: 20_000 }).catch(() => {});
      for (const { caption, width } of await charts(page)) {
        assert.ok(width <= paper, `${width} px: ${caption}`);
      }
      assert.deepEqual(problems, []);
    });
  });
}

test("a reader who points at a chart is told the value, and finds the numbers in the table behind", async (context) => {
  const { page } = await open("far range");
  context.after(() => page.close());
  const chart = page.locator("#errors .plot");
  await chart.scrollIntoViewIfNeeded();
  const { x, y } = await chart.locator(".scatterlayer .points path").first().boundingBox();
  await page.mouse.move(x + 2, y + 2, { steps: 3 });
  const told = await page.locator("#errors .hovertext").first().textContent();
  assert.match(told, /frame 9\d{3}.*°/);
  assert.ok(!(await page.locator("#errors details table").isVisible()));
  await page.locator("#errors summary").click();
  assert.ok(await page.locator("#errors details table").isVisible());
  assert.ok((await page.locator("#errors details tbody tr").count()) >= 10);
});

test("the page cannot reach anything, even if a script in it tried", async (context) => {
  let requests = 0;
  const server = createServer((_, response) => {
    requests += 1;
    response.writeHead(200, { "Access-Control-Allow-Origin": "*" }).end();
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  context.after(() => server.close());
  const page = await chromium.newPage();
  context.after(() => page.close());
  await page.goto(address("docking"));
  const outcome = await page.evaluate(async (url) => {
    const element = (name, values) =>
      new Promise((resolve) => {
        const made = Object.assign(document.createElement(name), values);
        made.onload = () => resolve("loaded");
        made.onerror = () => resolve("refused");
        document.head.append(made);
      });
    const form = Object.assign(document.createElement("form"), { action: url, method: "post" });
    document.body.append(form);
    form.submit();
    navigator.sendBeacon(url);
    return Promise.all([
      fetch(url).then(() => "loaded", () => "refused"),
      element("img", { src: url }),
      element("script", { src: url }),
      element("link", { rel: "stylesheet", href: url }),
    ]);
  }, `http://127.0.0.1:${server.address().port}/`);
  assert.deepEqual(outcome, ["refused", "refused", "refused", "refused"]);
  await page.waitForTimeout(300);
  assert.equal(requests, 0);
});
