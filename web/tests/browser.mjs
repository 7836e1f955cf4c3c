// Chromium with WebGL in software and no network, and the pages opened in it.

import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const PROGRAMS = [process.env.RIVEN_CHROMIUM, "/usr/bin/chromium", "/usr/bin/google-chrome"];

export function launch() {
  const executablePath = PROGRAMS.find((file) => file && existsSync(file));
  if (!executablePath) throw new Error("no Chromium: install it, or name it in RIVEN_CHROMIUM");
  return chromium.launch({
    executablePath,
    headless: true,
    args: [
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
    ],
  });
}

/** Opens a report by file://, offline; `complaints` collects what the console and the page complain of. */
export async function open(browser, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, ...options });
  await context.setOffline(true);
  const page = await context.newPage();
  const complaints = [];
  const requests = [];
  page.on("console", (message) => {
    if (!["error", "warning"].includes(message.type())) return;
    // Chromium's own words about software WebGL.
    if (!/GPU stall|swiftshader|GL Driver Message/i.test(message.text())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  if (options.before) await page.addInitScript(options.before);
  await page.goto(`file://${file}`);
  await page.evaluate(() => window.riven.ready);
  return { page, context, complaints, requests };
}
