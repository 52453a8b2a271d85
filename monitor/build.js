// Bundles the page into dist/: index.html, monitor.js, monitor.css. The executable embeds exactly these.

import { copyFile, mkdir, rm } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

await rm(here("dist"), { recursive: true, force: true });
await mkdir(here("dist"));
await build({
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
