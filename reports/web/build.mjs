// Bundles src/ into page.{js,css} (report) and compare.{js,css} (comparison) beside this file. Called by the build in a copy of this folder.
import { readFileSync } from "node:fs";
import { build } from "esbuild";

const licence = readFileSync("node_modules/uplot/LICENSE", "utf8").trim();
await build({
  entryPoints: { page: "src/main.js", compare: "src/compare.js" },
  outdir: ".",
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2021",
  legalComments: "inline",
  banner: { js: `/*! This page draws its lines with uPlot.\n${licence.replaceAll("*/", "* /")}\n*/` },
  logLevel: "warning",
});
