// Builds the page anew and compares it with the committed one: what ships must be what the sources say.

import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "vite";

const MARKER = '<script id="riven-data" type="application/json">{}</script>';
const root = fileURLToPath(new URL("..", import.meta.url));
const outDir = mkdtempSync(join(tmpdir(), "riven-report-"));

function complaint(committed, built) {
  if (!built.equals(committed)) return "dist/report.html is not what the sources give: run `npm run build` and commit it";
  if (committed.toString("utf8").split(MARKER).length !== 2) return "dist/report.html must have the data element exactly once";
  return null;
}

try {
  await build({ root, logLevel: "warn", build: { outDir, emptyOutDir: true } });
  const committed = readFileSync(join(root, "dist/report.html"));
  const found = complaint(committed, readFileSync(join(outDir, "report.html")));
  if (found) {
    console.error(found);
    process.exitCode = 1;
  } else {
    console.log(`dist/report.html is up to date: ${(committed.length / 1024).toFixed(0)} KiB`);
  }
} finally {
  rmSync(outDir, { recursive: true });
}
