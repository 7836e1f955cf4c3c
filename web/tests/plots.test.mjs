// Plots of histories: lines, files, zoom, values under the cursor.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { launch, open } from "./browser.mjs";
import { colours, decode, difference } from "./png.mjs";
import { fill, fracture, membrane, pack, page as pageOf } from "./make_report.mjs";
import { dataOf, madeFile, reportFile, unpack, write } from "./reports.mjs";

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const shot = async (page) => decode(await page.screenshot());
const plot = (page, n) => page.locator(".plot").nth(n);
const rest = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** name -> values of each column of a history. */
function columnsOf(history) {
  const values = unpack(history.values);
  return new Map(history.columns.map(({ name }, c) => [name, values.subarray(c * history.rows, (c + 1) * history.rows)]));
}

for (const name of ["membrane", "fracture"]) {
  describe(`the plots of ${name}`, () => {
    const file = reportFile(name);
    const result = dataOf(file).results[0];
    const history = result.histories[0];
    let page, context, complaints;
    before(async () => ({ page, context, complaints } = await open(browser, file)));
    after(() => context.close());

    test("have a line per column, with a point for each number in it", async () => {
      const plots = await page.evaluate(() => window.riven.plots());
      const lines = plots.flatMap((p) => p.lines);
      assert.ok(plots.length >= result.histories.length);
      const first = history.columns[1].name;
      assert.equal(plots[0].lines[0].label, first.replaceAll("_", " "));
      for (const { label, points } of lines) {
        const column = result.histories.map((h) => [...columnsOf(h)].find(([n]) => n.replaceAll("_", " ") === label)).find(Boolean);
        assert.equal(points, column[1].filter(Number.isFinite).length, label);
      }
    });

    test("energies share a plot, the error of their balance has its own", async () => {
      const energy = result.histories.find((h) => h.name === "energy");
      if (!energy) return;
      const plots = await page.evaluate(() => window.riven.plots());
      const balance = plots.find((p) => p.title === "Energy balance");
      assert.deepEqual(balance.lines.map((l) => l.label), ["balance error"]);
      assert.equal(plots.find((p) => p.title === "Energy").lines.length, energy.columns.length - 2);
    });

    test("download as CSV with exactly the numbers of the data", async () => {
      const [saved] = await Promise.all([page.waitForEvent("download"), plot(page, 0).getByRole("button", { name: "CSV" }).click()]);
      assert.match(saved.suggestedFilename(), /history\.csv$/);
      const [head, ...rows] = readFileSync(await saved.path(), "utf8").trimEnd().split("\n");
      assert.equal(head, history.columns.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name)).join(","));
      assert.equal(rows.length, history.rows);
      const columns = [...columnsOf(history).values()];
      rows.forEach((row, r) => {
        const numbers = row.split(",").map((cell) => (cell === "nan" ? NaN : Number(cell)));
        assert.deepEqual(numbers, columns.map((column) => column[r]));
      });
    });

    test("show the value under the cursor with all digits", async () => {
      const box = await plot(page, 0).locator(".u-over").boundingBox();
      await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2);
      const [x, y] = (await plot(page, 0).locator(".chart-tip td").allTextContents()).map(parseFloat);
      const columns = columnsOf(history);
      const row = columns.get(history.columns[0].name).indexOf(x);
      assert.ok(row >= 0, `${x} is one of the rows`);
      assert.equal(y, columns.get(history.columns[1].name)[row]);
      await page.mouse.move(5, 5);
    });

    test("hide the values when the pointer leaves", async () => {
      assert.equal(await plot(page, 0).locator(".chart-tip").isVisible(), false);
    });

    test("zoom by drag, and back by a double click", async () => {
      const box = await plot(page, 0).locator(".u-over").boundingBox();
      await rest(page);
      const start = await shot(page);
      await page.mouse.move(box.x + box.width * 0.3, box.y + box.height * 0.2);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.8, { steps: 4 });
      await page.mouse.up();
      await page.mouse.move(5, 5);
      await rest(page);
      assert.ok(difference(start, await shot(page), box) > 0.005);
      await page.mouse.dblclick(box.x + box.width * 0.5, box.y + box.height * 0.5);
      await page.mouse.move(5, 5);
      await rest(page);
      assert.ok(difference(start, await shot(page), box) < 0.005);
    });

    test("mark the shown state", async () => {
      const box = await plot(page, 0).locator(".u-over").boundingBox();
      const xs = [...columnsOf(history).values()][0];
      const [low, high] = [Math.min(...xs), Math.max(...xs)];
      const placeOf = (state) => box.x + (box.width * (result.view.states[state].value - low)) / (high - low);
      const pictureAt = async (state) => {
        await page.evaluate((n) => window.riven.setState(n), state);
        await rest(page);
        return shot(page);
      };
      const [one, other] = [await pictureAt(0), await pictureAt(1)];
      // A line is drawn between pixels too, so its colour is not exact: where the pictures differ, there a mark came or went.
      const changed = [];
      for (let x = Math.ceil(box.x); x < box.x + box.width - 2; ++x)
        if (difference(one, other, { x, y: box.y, width: 2, height: box.height }) > 0.25) changed.push(x);
      const near = (state) => changed.filter((x) => Math.abs(x - placeOf(state)) < 3);
      assert.ok(near(0).length > 0 && near(1).length > 0, `${changed} for ${placeOf(0)}, ${placeOf(1)}`);
      assert.equal(near(0).length + near(1).length, changed.length, `${changed}`);
    });

    test("show other columns over another one", async () => {
      const before = await page.evaluate(() => window.riven.plots()[0].lines.map((l) => l.label));
      await plot(page, 0).locator("summary").first().click();
      await plot(page, 0).locator(".menu input").nth(1).uncheck();
      const after = await page.evaluate(() => window.riven.plots()[0].lines.map((l) => l.label));
      assert.deepEqual(after, before.slice(1));
      await plot(page, 0).locator(".menu input").nth(1).check();
      await page.keyboard.press("Escape");
      const box = await plot(page, 0).locator(".u-over").boundingBox();
      const start = await shot(page);
      await plot(page, 0).locator("select").selectOption({ index: 1 });
      await rest(page);
      assert.ok(difference(start, await shot(page), box) > 0.002);
      assert.deepEqual(complaints, []);
    });
  });
}

/** Labels are written on canvases, so what is written there is recorded. */
function record() {
  const fillText = CanvasRenderingContext2D.prototype.fillText;
  window.written = [];
  CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
    window.written.push(text);
    return fillText.call(this, text, ...rest);
  };
}

/** Gives columns of a history other values; `of` (row) by name. */
function overwrite(history, of) {
  const { rows } = history;
  const values = unpack(history.values);
  history.columns.forEach(({ name }, c) => of[name] && values.set(Array.from({ length: rows }, (_, row) => of[name](row)), c * rows));
  history.values = pack("float64", values);
}

test("axes of columns without a common word have the title of the history, and room for long labels", async () => {
  const result = membrane();
  overwrite(result.histories[1], { balance_error: (row) => -0.0011 + 2.75e-5 * row });
  const { page, context } = await open(browser, write("energy-axes", fill(pageOf(result))), { before: record, viewport: { width: 1280, height: 1300 } });
  const written = await page.evaluate(() => window.written);
  assert.ok(written.includes("energy [kJ]"), `${written}`);
  assert.ok(written.includes("−0.0010"), `${written}`);
  const room = await plot(page, 2).locator(".uplot").evaluate((u) => {
    const ctx = document.createElement("canvas").getContext("2d");
    ctx.font = `12px ${getComputedStyle(u).fontFamily}`;
    return { left: u.querySelector(".u-over").offsetLeft, label: ctx.measureText("−0.0010").width };
  });
  assert.ok(room.left >= 18 + 9 + room.label, JSON.stringify(room)); // title, tick and gap, label
  await context.close();
});

test("columns without any number get no plot", async () => {
  const result = membrane();
  overwrite(result.histories[1], { balance_error: () => NaN });
  const { page, context, complaints } = await open(browser, write("no-balance", fill(pageOf(result))));
  assert.deepEqual((await page.evaluate(() => window.riven.plots())).map((p) => p.title), ["History", "Energy"]);
  assert.deepEqual(complaints, []);
  await context.close();
});

test("results over different parameters share states by number, and plots name what they leave out", async () => {
  const { page, context, complaints } = await open(browser, write("mixed", fill(pageOf(membrane("sheet"), fracture("plate")))));
  const text = await page.locator("#view").innerText();
  assert.match(text, /Results over stretch and over time: the slider goes by state number\./);
  assert.match(await page.locator(".state").innerText(), /^state 7 of 7$/);
  const notes = () => page.locator(".panel-note").allTextContents();
  assert.match((await notes()).join(), /^stretch 3 \(state 5 of 5\).*time 48 µs \(state 7 of 7\)/);
  await page.evaluate(() => window.riven.setState(3));
  assert.match((await notes()).join(), /^stretch 2 \(state 3 of 5\).*time 24 µs \(state 4 of 7\)/);
  assert.match(await plot(page, 0).innerText(), /Not over stretch, so left out: plate \(over time\)\./);
  await plot(page, 0).locator("select").selectOption({ label: "time" });
  assert.match(await plot(page, 0).innerText(), /Not over time, so left out: sheet \(over stretch\)\./);
  assert.deepEqual(complaints, []);
  await context.close();
});

test("axes have prefixes that make numbers legible, and powers of ten on log axes", async () => {
  const { page, context, complaints } = await open(browser, madeFile("block"), { before: record });
  const written = await page.evaluate(() => window.written);
  for (const text of ["force [kN]", "time [ms]", "40", "stress amplitude [GPa]", "cycles", "10⁶", "x", "undeformed: 240 × 120 × 80 mm"]) assert.ok(written.includes(text), text);
  assert.deepEqual(complaints, []);
  await context.close();
});
