// The page around view and plots: several results, tables, themes, keys, sizes, and what is missing or damaged.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { launch, open } from "./browser.mjs";
import { fill, fracture, membrane, page as pageOf } from "./make_report.mjs";
import { colours, decode } from "./png.mjs";
import { dataOf, madeFile, reportFile, write } from "./reports.mjs";

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const shot = async (page) => decode(await page.screenshot());

describe("several results", () => {
  const file = reportFile("pair");
  const { results } = dataOf(file);
  /** Results are called by the last part of their names. */
  const last = ({ name }) => name.split("/").at(-1);
  let page, context, complaints;
  before(async () => ({ page, context, complaints } = await open(browser, file)));
  after(() => context.close());

  test("have a picture each, and one set of controls", async () => {
    assert.equal(await page.locator(".gl canvas").count(), results.length);
    assert.equal(await page.getByLabel("State", { exact: true }).count(), 1);
    const picture = await shot(page);
    for (const canvas of await page.locator(".gl canvas").all()) assert.ok(colours(picture, await canvas.boundingBox()).size > 30);
    assert.deepEqual(await page.locator(".panel h3").allTextContents(), results.map(last));
  });

  test("show each the state nearest to the parameter", async () => {
    const all = [...new Set(results.flatMap((r) => r.view.states.map((s) => s.value)))].sort((a, b) => a - b);
    assert.deepEqual(await page.evaluate(() => window.riven.state().values), all);
    for (const [index, value] of all.entries()) {
      await page.evaluate((i) => window.riven.setState(i), index);
      const notes = await page.locator(".panel-note").allTextContents();
      results.forEach((result, n) => {
        const distances = result.view.states.map((s) => Math.abs(s.value - value));
        const nearest = distances.indexOf(Math.min(...distances));
        assert.ok(notes[n].includes(`state ${nearest + 1} of ${result.view.states.length}`), notes[n]);
      });
    }
  });

  test("are drawn over each other in plots, in colours and dashes of their own", async () => {
    const lines = await page.evaluate(() => window.riven.plots()[0].lines.map((l) => l.label));
    for (const result of results) assert.ok(lines.some((label) => label.startsWith(`${last(result)}: `)), result.name);
    const styles = await page.locator(".plot").first().locator(".sample path").evaluateAll((paths) => paths.map((p) => `${p.getAttribute("stroke")} ${p.getAttribute("stroke-dasharray")}`));
    assert.equal(new Set(styles).size, styles.length);
  });

  test("stand side by side in tables and texts", async () => {
    const heads = await page.locator("#run thead th").allTextContents();
    assert.deepEqual(heads.slice(1), results.map(last));
    const verdicts = results.some((r) => r.verdicts.length > 0);
    if (verdicts) assert.equal((await page.locator("#numbers .verdicts thead th").allTextContents()).filter((t) => t.startsWith("ours: ")).length, results.filter((r) => r.verdicts.length > 0).length);
    assert.deepEqual(await page.locator("#case .text h3").allTextContents(), results.map(last));
    assert.deepEqual(complaints, []);
  });
});

describe("tables and texts", () => {
  let page, context;
  before(async () => ({ page, context } = await open(browser, madeFile("membrane"))));
  after(() => context.close());

  test("verdicts: published, reference, ours, deviation", async () => {
    const rows = await page.locator("#numbers .verdicts tbody tr").evaluateAll((trs) => trs.map((tr) => [...tr.children].map((td) => td.textContent)));
    const { verdicts } = membrane();
    assert.equal(rows.length, verdicts.length);
    const [what, at, published, reference, ours, deviation, verdict, limit] = rows[0];
    assert.deepEqual([what, at, published, deviation, limit, verdict], ["force right x", "stretch 1.5", "", "+0.004 %", "0.1 %", "✓ ok"]);
    assert.deepEqual([reference, ours], ["24.8568 kN", "24.8578 kN"]); // 18166 * (1.5 - 1.5^-5), and 0.004 % more
    assert.equal(rows.filter((row) => row[6] === "✗ missed").length, 1);
  });

  test("small values of units without prefixes have a dot before the power", async () => {
    const result = { ...fracture("small", { view: null }), metrics: [{ name: "mass", value: 5e-6, unit: "kg" }] };
    const { page, context } = await open(browser, write("small", fill(pageOf(result))));
    assert.match(await page.locator("#numbers").innerText(), /5·10⁻⁶ kg/);
    await context.close();
  });

  test("texts of the data never become elements", async () => {
    assert.match(await page.locator("#case pre").first().textContent(), /<script>alert\(1\)<\/script> & co\./);
    assert.equal(await page.locator("#case pre script, #numbers b").count(), 0);
    assert.match(await page.locator("#numbers").textContent(), /<b>by hand<\/b>/);
  });

  test("the tabs of the case show resolved values and the log", async () => {
    await page.getByRole("tab", { name: /Resolved/ }).click();
    assert.match(await page.locator("#case pre").textContent(), /\[solver\]/);
    await page.keyboard.press("ArrowRight");
    assert.match(await page.locator("#case pre").textContent(), /step 1\/5/);
  });
});

describe("looks", () => {
  test("light and dark follow the system, and the button", async () => {
    const ground = async (page) => (await shot(page)).at(20, 10).reduce((a, b) => a + b) / 3;
    const light = await open(browser, madeFile("membrane"), { colorScheme: "light" });
    assert.ok((await ground(light.page)) > 230);
    await light.page.getByRole("button", { name: "Light or dark" }).click();
    assert.ok((await ground(light.page)) < 50);
    const box = await light.page.locator(".gl canvas").boundingBox();
    await light.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.deepEqual((await shot(light.page)).at(box.x + 4, box.y + 4), [0x16, 0x1b, 0x22]);
    await light.context.close();
    const dark = await open(browser, madeFile("fracture"), { colorScheme: "dark" });
    assert.ok((await ground(dark.page)) < 50);
    assert.deepEqual(dark.complaints, []);
    await dark.context.close();
  });

  for (const [width, height] of [[1280, 720], [1920, 1080], [800, 900]]) {
    test(`fits ${width} x ${height}`, async () => {
      const { page, context } = await open(browser, madeFile("pair"), { viewport: { width, height } });
      const { scroll, inner } = await page.evaluate(() => ({ scroll: document.documentElement.scrollWidth, inner: window.innerWidth }));
      assert.ok(scroll <= inner, `${scroll} px wide`);
      if (width > 1000) {
        for (const part of [".panels", ".controls", ".plot >> nth=0"]) {
          const box = await page.locator(part).boundingBox();
          assert.ok(box.y >= 0 && box.y + box.height <= height, `${part} is seen without scrolling`);
        }
        const view = await page.locator(".panels").boundingBox();
        assert.ok(view.width * view.height > 0.25 * width * height, "the view is big");
      }
      await context.close();
    });
  }
});

describe("the keyboard", () => {
  test("reaches every control in order, with a visible focus", async () => {
    const { page, context } = await open(browser, madeFile("fracture"));
    const reached = [];
    for (let n = 0; n < 80; ++n) {
      await page.keyboard.press("Tab");
      const focus = await page.evaluate(() => {
        const element = document.activeElement;
        if (element === document.body) return null; // behind the last one
        const name = element.getAttribute("aria-label") ?? element.closest("label")?.textContent ?? element.textContent;
        return { name: name.trim(), outline: getComputedStyle(element).outlineStyle };
      });
      if (focus === null) break;
      if (n > 0) assert.notEqual(focus.outline, "none", focus.name);
      reached.push(focus.name);
    }
    const wanted = ["View", "Light or dark", "Keys", "Play", "State", "Field", "Colour map", "Range of the colours", "Scale of the deformation", "Hide damaged points", "Reset view", "Save picture", "History: x axis", "History: columns"];
    const order = wanted.map((name) => reached.indexOf(name));
    assert.deepEqual(order.filter((at) => at < 0), [], `reached ${reached}`);
    assert.deepEqual(order, [...order].sort((a, b) => a - b));
    await context.close();
  });

  test("? lists the keys, escape closes the list", async () => {
    const { page, context } = await open(browser, madeFile("fracture"));
    await page.keyboard.press("?");
    const dialog = page.getByRole("dialog");
    assert.match(await dialog.textContent(), /space.*play/s);
    await page.keyboard.press("Escape");
    assert.equal(await dialog.isVisible(), false);
    await context.close();
  });
});

describe("what is missing or damaged is said", () => {
  let files = 0;
  const damaged = (change) => {
    const data = pageOf(fracture("damaged"));
    change(data.results[0], data);
    return write(`damaged-${++files}`, fill(data));
  };
  const openText = async (file, options) => {
    const opened = await open(browser, file, options);
    return { ...opened, text: await opened.page.locator("body").innerText() };
  };
  /** Base64 in which one byte in the middle is another one. */
  const spoil = (packed) => {
    const bytes = Buffer.from(packed.data, "base64");
    bytes[bytes.length >> 1] ^= 0x55;
    packed.data = bytes.toString("base64");
  };

  test("damaged points: a message, and plots all the same", async () => {
    const { text, page, context, complaints } = await openText(damaged((r) => spoil(r.view.positions)));
    assert.match(text, /The data of the points of "damaged" are damaged/);
    assert.equal(await page.locator(".plot").count(), 3);
    assert.equal(await page.locator("#run tbody tr").count(), 4);
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test("a damaged state: a message when it comes to be shown; others stay", async () => {
    const { page, context, complaints } = await openText(damaged((r) => spoil(r.view.states[2].values[2])));
    await page.getByLabel("Range of the colours").selectOption("state");
    await page.evaluate(() => window.riven.setState(2));
    await page.evaluate(() => window.riven.setField("strain_energy_density"));
    await page.getByText(/"strain_energy_density" at state 3 of "damaged" are damaged/).waitFor();
    await page.evaluate(() => window.riven.setState(3));
    assert.equal(await page.evaluate(() => window.riven.state().state), 3);
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test("a damaged history: a message, and the view all the same", async () => {
    const { text, page, context } = await openText(damaged((r) => spoil(r.histories[0].values)));
    assert.match(text, /The data of the history "history" are damaged/);
    assert.deepEqual((await page.evaluate(() => window.riven.plots())).map((p) => p.title), ["Energy", "Energy balance"]);
    assert.equal(await page.locator(".gl canvas").count(), 1);
    await context.close();
  });

  test("wrong counts, wrong format, no data, half a file", async () => {
    const cases = [
      [damaged((r) => (r.view.states.at(-1).values[0].count -= 1)), /expected 7680/],
      [damaged((_, data) => (data.format = 2)), /have format 2/],
      [write("empty", fill("{}")), /holds no result/],
      [write("half", fill(JSON.stringify(pageOf(fracture())).slice(0, 5000))), /The data of this page are damaged/],
    ];
    for (const [file, expected] of cases) {
      const { text, context, complaints } = await openText(file);
      assert.match(text, expected);
      assert.deepEqual(complaints, []);
      await context.close();
    }
  });

  test("without WebGL 2: a message, and plots and tables", async () => {
    const before = () => {
      const getContext = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...rest);
      };
    };
    const { text, page, context, complaints } = await openText(madeFile("membrane"), { before });
    assert.match(text, /needs WebGL 2/);
    assert.equal(await page.locator(".plot canvas").count(), 3);
    assert.equal(await page.locator("#numbers table").count(), 2);
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test("without DecompressionStream: a message, and tables", async () => {
    const { text, page, context, complaints } = await openText(madeFile("membrane"), { before: () => delete window.DecompressionStream });
    assert.match(text, /too old to unpack the data/);
    assert.equal(await page.locator("#numbers table").count(), 2);
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test("why there are no metrics", async () => {
    const stuck = (name) => ({ ...fracture(name, { status: "failed", view: null }), metrics: [], histories: [] });
    const bare = (name) => ({ ...fracture(name, { status: "finished", view: null }), metrics: [] });
    const cases = [
      [[stuck("a")], /The run reached no state\./],
      [[stuck("a"), stuck("b")], /The runs reached no state\./],
      [[bare("a")], /This result has no metrics: its case has no probes\./],
      [[bare("a"), bare("b")], /These results have no metrics: their cases have no probes\./],
    ];
    for (const [results, expected] of cases) {
      const { text, context } = await openText(write(`metrics-${++files}`, fill(pageOf(...results))));
      assert.match(text, expected);
      await context.close();
    }
  });

  test("a run that failed, and one that was thinned", async () => {
    const failed = await openText(madeFile("failed"));
    assert.match(failed.text, /The run failed/);
    assert.match(failed.text, /no field files/);
    await failed.context.close();
    const thinned = await openText(madeFile("fracture"));
    assert.match(thinned.text, /Of 10 240 points, 2 560 are shown/);
    assert.match(thinned.text, /interrupted/);
    await thinned.context.close();
  });
});

test("the page holds the marker once, and the licences of what it is made of", () => {
  const html = readFileSync(new URL("../dist/report.html", import.meta.url), "utf8");
  assert.equal(html.split('<script id="riven-data" type="application/json">{}</script>').length, 2);
  for (const name of ["@kitware/vtk.js", "uplot", "gl-matrix"]) assert.ok(html.includes(`\n${name} `), name);
  assert.equal(/https?:\/\/(?!www\.w3\.org|www\.kitware)[^\s"'`)]*\.(js|css|woff2?)/.test(html), false, "nothing is loaded from elsewhere");
});
