// The field view: pictures, states, colours, clipping, picking.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { launch, open } from "./browser.mjs";
import { bar, fill, FRACTURE, fracture, MEMBRANE, pack, page as pageOf } from "./make_report.mjs";
import { colours, decode, difference, near } from "./png.mjs";
import { colourOf, dataOf, fieldAt, madeFile, magnitudes, reportFile, unpack, write } from "./reports.mjs";

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const shot = async (page) => decode(await page.screenshot());
const canvasBox = (page) => page.locator(".gl canvas").first().boundingBox();
const state = (page) => page.evaluate(() => window.riven.state());
const places = (page, points) => page.evaluate((of) => of.map((p) => window.riven.placeOf(p)), points);
/** Every so many-th point: enough to be sure, few enough to be quick. */
const sample = (count, wanted = 40) => Array.from({ length: wanted }, (_, n) => Math.floor(((n + 0.5) * count) / wanted));
const rest = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

for (const name of ["membrane", "fracture"]) {
  describe(`the view of ${name}`, () => {
    const file = reportFile(name);
    const data = dataOf(file);
    const result = data.results[0];
    const last = result.view.states.length - 1;
    let page, complaints, requests, context;
    before(async () => ({ page, complaints, requests, context } = await open(browser, file)));
    after(() => context.close());

    test("opens by file:// without network, other requests or complaints", () => {
      assert.deepEqual(complaints, []);
      assert.deepEqual(requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
      assert.equal(requests.filter((url) => url.startsWith("file:")).length, 1);
    });

    test("starts at the last state, at scale 1", async () => {
      const now = await state(page);
      assert.equal(now.state, last);
      assert.equal(now.deformation, 1);
      assert.deepEqual(now.values, result.view.states.map((s) => s.value));
    });

    test("shows pictures with many colours, which differ between states", async () => {
      const box = await canvasBox(page);
      await page.evaluate(() => window.riven.setField("displacement", "magnitude"));
      const end = await shot(page);
      await page.evaluate(() => window.riven.setState(1));
      await rest(page);
      const early = await shot(page);
      assert.ok(colours(end, box).size > 30, `${colours(end, box).size} colours`);
      // A sheet at rest has one colour; a field that is nowhere the same shows as a change of most of the body.
      assert.ok(difference(end, early, box) > 0.1, `differs in ${difference(end, early, box)}`);
    });

    test("points have the colours of their values", async () => {
      await page.evaluate((s) => window.riven.setState(s), last);
      await page.evaluate(() => window.riven.setField("displacement", "magnitude"));
      await rest(page);
      const { range, map: mapName } = await state(page);
      const ranges = result.view.states.map((_, s) => magnitudes(fieldAt(result, "displacement", s)));
      const low = Math.min(...ranges.map((v) => v.reduce((a, b) => Math.min(a, b))));
      const high = Math.max(...ranges.map((v) => v.reduce((a, b) => Math.max(a, b))));
      assert.ok(Math.abs(range[0] - low) <= 1e-6 * high && Math.abs(range[1] - high) <= 1e-6 * high, `${range} for ${low}, ${high}`);
      const map = data.colour_maps.find((m) => m.name === mapName);
      const points = sample(result.view.points);
      const picture = await shot(page);
      const where = await places(page, points);
      const wrong = points.filter((p, n) => {
        const expected = colourOf(map, (ranges[last][p] - low) / (high - low));
        return !near(picture.at(where[n].x - 0.5, where[n].y - 0.5), expected, 3);
      });
      // Where points nearly touch on the screen, rounding to a pixel may give the neighbour's colour.
      assert.ok(wrong.length <= points.length * 0.05, `${wrong.length} of ${points.length} have another colour`);
    });

    test("points lie at undeformed + scale * displacement", async () => {
      const positions = unpack(result.view.positions);
      const { values: u } = fieldAt(result, "displacement", last);
      const points = sample(result.view.points, 12);
      for (const scale of [0, 1, 1.5]) {
        await page.getByLabel("Scale of the deformation", { exact: true }).fill(String(scale));
        await page.keyboard.press("Enter");
        await page.waitForFunction((s) => window.riven.state().deformation === s, scale);
        await rest(page);
        const where = await places(page, points);
        const world = points.map((p) => [0, 1].map((a) => positions[3 * p + a] + scale * u[3 * p + a]));
        // Pixels per metre from the two points that are farthest apart in y; y goes up, pixels go down.
        const tops = world.map(([, y]) => y);
        const [i, j] = [tops.indexOf(Math.max(...tops)), tops.indexOf(Math.min(...tops))];
        const pixels = (where[j].y - where[i].y) / (world[i][1] - world[j][1]);
        where.forEach((place, n) => {
          const x = where[0].x + (world[n][0] - world[0][0]) * pixels;
          const y = where[0].y - (world[n][1] - world[0][1]) * pixels;
          assert.ok(Math.hypot(place.x - x, place.y - y) < 0.1, `point ${points[n]} at scale ${scale}`);
        });
      }
      await page.getByLabel("Scale of the deformation", { exact: true }).fill("1");
      await page.keyboard.press("Enter");
    });

    test("the slider and the keys choose the state", async () => {
      const slider = page.getByLabel("State", { exact: true });
      await slider.fill("1");
      await page.waitForFunction(() => window.riven.state().state === 1);
      await slider.press("Home");
      await page.waitForFunction(() => window.riven.state().state === 0);
      await slider.press("ArrowRight");
      await page.waitForFunction(() => window.riven.state().state === 1);
      await page.locator(".frame").first().focus();
      await page.keyboard.press("End");
      await page.waitForFunction((s) => window.riven.state().state === s, last);
      await page.keyboard.press("ArrowLeft");
      await page.waitForFunction((s) => window.riven.state().state === s, last - 1);
      assert.match(await page.locator(".state").textContent(), new RegExp(`${result.parameter.name} .* \\(${last} of ${last + 1}\\)`));
    });

    test("plays to the end, and stops at a key", async () => {
      await page.locator(".frame").first().focus();
      await page.keyboard.press("Home");
      await page.waitForFunction(() => window.riven.state().state === 0);
      await page.keyboard.press("Space");
      await page.waitForFunction(() => window.riven.state().playing && window.riven.state().state === 1);
      await page.keyboard.press("Space");
      assert.equal((await state(page)).playing, false);
      await page.getByRole("button", { name: "Play" }).click();
      await page.waitForFunction((s) => window.riven.state().state === s && !window.riven.state().playing, last, { timeout: 60000 });
    });

    test("another field, map and range are shown", async () => {
      const box = await canvasBox(page);
      const before = await shot(page);
      const other = result.view.fields.findLast((f) => f.name !== "displacement").name;
      await page.getByLabel("Field", { exact: true }).selectOption(other);
      await page.waitForFunction((f) => window.riven.state().field === f, other);
      await rest(page);
      const fields = await shot(page);
      assert.ok(difference(before, fields, box) > 0.05);
      const map = data.colour_maps.at(-1).name;
      await page.getByLabel("Colour map").selectOption(map);
      await page.waitForFunction((m) => window.riven.state().map === m, map);
      await rest(page);
      const maps = await shot(page);
      assert.ok(difference(fields, maps, box) > 0.05);
      await page.getByLabel("Range of the colours").selectOption("typed");
      const high = page.getByLabel("Highest colour");
      await page.waitForFunction(() => Array.isArray(window.riven.state().range));
      await high.fill(String((await high.inputValue()) * 4 + 1));
      await high.press("Enter");
      await rest(page);
      assert.ok(difference(maps, await shot(page), box) > 0.05);
      await page.getByLabel("Range of the colours").selectOption("all");
      await page.getByLabel("Colour map").selectOption(data.colour_maps[0].name);
    });

    test("the tip of a point has its number and exactly its values", async () => {
      await page.evaluate((s) => window.riven.setState(s), last);
      const positions = unpack(result.view.positions);
      const u = fieldAt(result, "displacement", last).values;
      for (const point of sample(result.view.points, 5)) {
        const [{ x, y }] = await places(page, [point]);
        await page.mouse.move(x, y);
        await page.locator(".frame .tip", { hasText: `point ${point}` }).waitFor();
        const rows = await page.locator(".frame .tip tr").evaluateAll((trs) => trs.map((tr) => [tr.children[0].textContent, [...tr.children[1].children].map((div) => div.textContent)]));
        for (const field of result.view.fields) {
          const [, texts] = rows.find(([title]) => title === field.name);
          const numbers = texts.flatMap((text) => text.split(", ").map(parseFloat));
          const { values } = fieldAt(result, field.name, last);
          const expected = [...values.subarray(point * field.components, (point + 1) * field.components)];
          assert.deepEqual(numbers.map(Math.fround), expected, field.name);
        }
        const picked = await page.evaluate(([px, py]) => window.riven.pickAt(px, py), [x, y]);
        assert.equal(picked.point, point);
        assert.deepEqual(picked.undeformed, [...positions.subarray(3 * point, 3 * point + 3)]);
        assert.deepEqual(picked.deformed, [0, 1, 2].map((a) => positions[3 * point + a] + u[3 * point + a]));
      }
      await page.mouse.move(5, 5);
      assert.equal(await page.locator(".frame .tip").isVisible(), false);
    });

    test("wheel and drag move the view, reset brings it back", async () => {
      await page.getByRole("button", { name: "Reset view" }).click();
      await rest(page);
      const box = await canvasBox(page);
      const [start] = await places(page, [0]);
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await page.mouse.wheel(0, -300);
      await rest(page);
      const [zoomed] = await places(page, [0]);
      const middle = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
      const factor = (zoomed.x - middle.x) / (start.x - middle.x);
      assert.ok(factor > 1.2 && Math.abs((zoomed.y - middle.y) / (start.y - middle.y) - factor) < 0.02, `zoomed by ${factor}`);
      await page.mouse.down();
      await page.mouse.move(middle.x + 40, middle.y - 25, { steps: 4 });
      await page.mouse.up();
      await rest(page);
      const [moved] = await places(page, [0]);
      assert.ok(Math.abs(moved.x - zoomed.x - 40) < 0.5 && Math.abs(moved.y - zoomed.y + 25) < 0.5);
      await page.locator(".frame").first().focus();
      await page.keyboard.press("r");
      await rest(page);
      const [back] = await places(page, [0]);
      assert.ok(Math.hypot(back.x - start.x, back.y - start.y) < 0.5);
    });

    test("a picture is saved with title and colour bar", async () => {
      const box = await canvasBox(page);
      const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save picture" }).click()]);
      assert.match(file.suggestedFilename(), /\.png$/);
      const picture = decode(readFileSync(await file.path()));
      assert.ok(picture.width > box.width && picture.height > box.height + 30);
      assert.ok(colours(picture, { x: 0, y: 0, width: picture.width, height: 34 }).size > 5, "a title");
      const right = { x: picture.width - 90, y: 60, width: 20, height: picture.height - 120 };
      assert.ok(colours(picture, right).size > 50, "a colour bar");
    });

    test("nothing was complained of, and nothing asked of the network", () => {
      assert.deepEqual(complaints, []);
      assert.deepEqual(requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
    });
  });
}

describe("values by formula", () => {
  test("what is under the pointer is what the formulas say", async () => {
    const { page, context } = await open(browser, madeFile("membrane"));
    const points = MEMBRANE.points();
    await page.evaluate(() => window.riven.setState(2));
    for (const point of sample(points.length, 6)) {
      const [{ x, y }] = await places(page, [point]);
      const picked = await page.evaluate(([px, py]) => window.riven.pickAt(px, py), [x, y]);
      const p = points[point];
      assert.equal(picked.point, point);
      assert.equal(picked.state, 2);
      assert.deepEqual(picked.fields.displacement, MEMBRANE.displacement(p, 2).map(Math.fround));
      assert.deepEqual(picked.fields.nominal_stress, MEMBRANE.stress(p, 2).map(Math.fround));
      assert.deepEqual(picked.fields.strain_energy_density, [Math.fround(MEMBRANE.energy(p, 2))]);
    }
    await context.close();
  });
});

describe("clip by damage", () => {
  test("hides the points with more damage, and only those", async () => {
    const file = reportFile("fracture");
    const result = dataOf(file).results[0];
    const last = result.view.states.length - 1;
    const damage = fieldAt(result, "damage", last).values;
    const { page, context } = await open(browser, file);
    assert.deepEqual((await state(page)).shown, [result.view.points]);
    // A value that occurs: points that have it are not hidden.
    const values = [...new Set(damage)].filter((d) => d > 0).sort((x, y) => x - y);
    const threshold = values[Math.floor(values.length / 2)];
    await page.getByLabel("Hide points with damage above").fill(String(threshold));
    await page.getByLabel("Hide damaged points").check();
    await page.waitForFunction(() => window.riven.state().clip !== null);
    await rest(page);
    const kept = damage.filter((d) => !(d > threshold)).length;
    assert.ok(kept < result.view.points);
    assert.deepEqual((await state(page)).shown, [kept]);
    const worst = damage.indexOf(Math.max(...damage));
    const [place] = await places(page, [worst]);
    assert.equal(place.shown, false);
    await page.getByLabel("Hide damaged points").uncheck();
    await page.waitForFunction(() => window.riven.state().clip === null);
    assert.deepEqual((await state(page)).shown, [result.view.points]);
    await context.close();
  });

  test("what was hidden shows the ground", async () => {
    const { page, context } = await open(browser, madeFile("fracture"));
    const points = FRACTURE.points();
    const hidden = points.findIndex(([x, y]) => x > -0.005 && y > 0 && FRACTURE.damage([x, y], 48e-6) > 0.5);
    const [place] = await places(page, [hidden]);
    const ground = [255, 255, 255];
    assert.ok(!near((await shot(page)).at(place.x, place.y), ground, 3));
    await page.getByLabel("Hide damaged points").check();
    await page.waitForFunction(() => window.riven.state().clip !== null);
    await rest(page);
    assert.ok(near((await shot(page)).at(place.x, place.y), ground, 3));
    await context.close();
  });

  test("is offered only where there is damage", async () => {
    const { page, context } = await open(browser, madeFile("membrane"));
    assert.equal(await page.getByLabel("Hide damaged points").count(), 0);
    await page.getByLabel("undeformed").check();
    await rest(page);
    const box = await canvasBox(page);
    const faint = [0xb9, 0xbf, 0xc8].join();
    assert.ok(colours(await shot(page), box).has(faint), "the undeformed body is shown in the hole");
    await context.close();
  });
});

describe("solids and meshes", () => {
  test("a block turns under the pointer, and is looked at along its axes", async () => {
    const { page, context, complaints } = await open(browser, madeFile("block"));
    const box = await canvasBox(page);
    const start = await shot(page);
    assert.ok(colours(start, box).size > 100);
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 300, box.y + 160, { steps: 5 });
    await page.mouse.up();
    await rest(page);
    assert.ok(difference(start, await shot(page), box) > 0.1);
    // Points 0 and 23 are the ends of an edge along x: from x one sees it end on.
    await page.getByRole("button", { name: "x", exact: true }).click();
    await rest(page);
    const [near0, far0] = await places(page, [0, 23]);
    await page.getByRole("button", { name: "z", exact: true }).click();
    await rest(page);
    const [a, b] = await places(page, [0, 23]);
    assert.ok(b.x - a.x > 200 && Math.abs(a.y - b.y) < 30, "along z, x goes to the right");
    assert.ok(Math.hypot(near0.x - far0.x, near0.y - far0.y) < 0.5 * (b.x - a.x), "along x, it goes away");
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test("of two points in a line, the one in front is picked", async () => {
    const { page, context } = await open(browser, madeFile("block"));
    await page.getByRole("button", { name: "z", exact: true }).click();
    await page.evaluate(() => window.riven.setState(0));
    await rest(page);
    // Point 12 + 24 * 6 is in the middle of the lowest layer (z = 0); the eye is above the highest.
    const [{ x, y }] = await places(page, [12 + 24 * 6 + 24 * 12 * 7]);
    const picked = await page.evaluate(([px, py]) => window.riven.pickAt(px, py), [x, y]);
    assert.equal(picked.point, 12 + 24 * 6 + 24 * 12 * 7);
    await context.close();
  });

  test("a cut through a block shows what was inside", async () => {
    const { page, context } = await open(browser, madeFile("block"));
    await page.getByLabel("Hide damaged points").check(); // x > 115 mm: points 12 to 23 of each row
    await page.getByRole("button", { name: "x", exact: true }).click();
    await page.waitForFunction(() => window.riven.state().clip !== null);
    await rest(page);
    assert.deepEqual((await state(page)).shown, [12 * 12 * 8]);
    const inside = 11 + 24 * 6 + 24 * 12 * 4;
    const [{ x, y }] = await places(page, [inside]);
    assert.ok(!near((await shot(page)).at(x, y), [255, 255, 255], 3));
    assert.equal((await page.evaluate(([px, py]) => window.riven.pickAt(px, py), [x, y])).point, inside);
    await context.close();
  });

  test("a mesh has colours between those of its nodes", async () => {
    const { page, context, complaints } = await open(browser, madeFile("mesh"));
    const box = await canvasBox(page);
    // 25 x 25 nodes: without interpolation there were at most 625 colours.
    assert.ok(colours(await shot(page), box).size > 1000);
    assert.deepEqual(complaints, []);
    await context.close();
  });
});

describe("what is shown first", () => {
  const shown = async (result) => {
    const { page, context, complaints } = await open(browser, write(`first-${result.name}`, fill(pageOf(result))));
    assert.deepEqual(complaints, []);
    return { page, context };
  };

  test("the field that the program chose, where there is such a field", async () => {
    for (const [field, expected] of [["strain_energy_density", "strain_energy_density"], ["temperature", "damage"]]) {
      const result = fracture(`chosen-${field}`);
      result.view.field = field;
      const { page, context } = await shown(result);
      assert.equal((await state(page)).field, expected);
      await context.close();
    }
  });

  test("the whole range in its boxes", async () => {
    const result = fracture("range");
    const d = result.view.fields.findIndex((f) => f.name === "damage");
    for (const { values } of result.view.states) values[d] = pack("float32", unpack(values[d]).map((v) => 0.005603 * v - 0.001234));
    const { page, context } = await shown(result);
    await page.evaluate(() => window.riven.setField("damage"));
    for (const label of ["Lowest colour", "Highest colour"]) {
      const [room, wide, value] = await page.getByLabel(label).evaluate((input) => [input.clientWidth, input.scrollWidth, input.value]);
      assert.ok(value.length > 6 && wide <= room, `${label}: ${value} is ${wide} wide in ${room}`);
    }
    await context.close();
  });

  test("a bar is more than a hairline", async () => {
    const { page, context } = await shown(bar());
    const [place] = await places(page, [100]);
    const picture = await shot(page);
    const ground = picture.at(place.x, place.y - 30);
    const rows = Array.from({ length: 41 }, (_, n) => n - 20).filter((y) => !near(picture.at(place.x, place.y + y), ground, 20));
    assert.ok(rows.length >= 6, `${rows.length} px`);
    await context.close();
  });
});
