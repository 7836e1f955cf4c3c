// How long reports take in Chromium, WebGL in software: node tools/measure.mjs REPORT.html...

import { statSync } from "node:fs";
import { resolve } from "node:path";
import { launch, open } from "../tests/browser.mjs";

const browser = await launch();
for (const file of process.argv.slice(2).map((name) => resolve(name))) {
  const start = performance.now();
  const { page, context } = await open(browser, file);
  const ready = performance.now() - start;
  const { values, shown } = await page.evaluate(() => window.riven.state());
  const changes = [];
  for (let state = 0; state < values.length; ++state)
    changes.push(await page.evaluate(async (n) => {
      const begin = performance.now();
      await window.riven.setState(n);
      return performance.now() - begin;
    }, state));
  const heap = (await page.evaluate(() => performance.memory.usedJSHeapSize)) / 1e6;
  changes.sort((a, b) => a - b);
  console.log(`${file}: ${(statSync(file).size / 1e6).toFixed(1)} MB, ${shown.join(" + ")} points, open ${(ready / 1000).toFixed(1)} s, ` +
    `a state ${(changes[changes.length >> 1] / 1000).toFixed(2)} s, heap ${heap.toFixed(0)} MB`);
  await context.close();
}
await browser.close();
