// Bundles the page into dist/: index.html, monitor.js, monitor.css, icon.svg, and licences.txt of the packages in it. The
// executable embeds exactly these. They are committed, so that a program can be built without Node.js; continuous
// integration builds them again and compares.

import { copyFile, mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

await rm(here("dist"), { recursive: true, force: true });
await mkdir(here("dist"));
const { metafile } = await build({
  metafile: true,
  entryPoints: [
    { in: here("src/main.ts"), out: "monitor" },
    { in: here("src/style.css"), out: "monitor" },
  ],
  outdir: here("dist"),
  bundle: true,
  format: "esm",
  target: "es2022",
  minify: true,
  legalComments: "eof",
  logLevel: "info",
});
for (const name of ["index.html", "icon.svg"]) {
  await copyFile(here(`src/${name}`), here(`dist/${name}`));
}

// The packages with code or data in the bundle, in alphabetical order, each with the text of its licence.
const inputs = Object.keys(metafile.inputs).map((input) => input.replaceAll("\\", "/"));
const packages = new Set(inputs.flatMap((input) => input.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.slice(1) ?? []));
const texts = [];
for (const name of [...packages].sort()) {
  const folder = here(`node_modules/${name}`);
  const { version, license } = JSON.parse(await readFile(`${folder}/package.json`, "utf8"));
  const file = (await readdir(folder)).find((entry) => /^licen[sc]e(\.\w+)?$/i.test(entry));
  if (!file) throw new Error(`${name} has no file with its licence`);
  const text = (await readFile(`${folder}/${file}`, "utf8")).replaceAll("\r", "").trim();
  texts.push(`${name} ${version} (${license})\n\n${text}\n`);
}
await writeFile(here("dist/licences.txt"), texts.join(`\n${"-".repeat(72)}\n\n`));
