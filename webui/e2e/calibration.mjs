// Calibration of the camera as a person does it, in a browser: names the target, lets views be captured, forgets one, solves, looks at the result, saves.
//
// usage: node e2e/calibration.mjs [options] --url URL
//        node e2e/calibration.mjs [options] -- COMMAND...
// options: --screenshots DIR  --browser PROGRAM
//          --target TEXT   that the source shows, dots:7x7:0.04:0.01
//          --model NAME    division, plumb_bob or equidistant
//          --views N       so many are waited for before it is solved
//          --by-hand       views are captured by key, not by themselves: for a source whose every image shows the target elsewhere
//          --patience S    for views, and for solving
// COMMAND starts a server that prints its address (http://...); it is ended afterwards. Exit code 77: skipped, no browser.
// The source must show the target over and over. The server must be able to save; its camera file is written.
import assert from "node:assert/strict";
import { open_page, run, until } from "./run.mjs";

async function main(url, browser, screenshots, { target, model, views: wanted, "by-hand": by_hand, patience: patience_s }) {
  const patience = 1000 * Number(patience_s);
  // Refusals are part of the test.
  const { context, page, picture, step, show, api: ask, end } = await open_page(browser, url, { screenshots, prefix: "calibration_", refusals: /status of 4(00|09)/ });
  const api = (method, name, data) => ask(method, `/api/calibration${name}`, data);
  const state = () => api("GET", "");
  const canvas = show("calibration-picture");
  const shown = async (name) => canvas.getAttribute(`data-${name}`);
  const begin = show("begin");
  const field = (row, name) => page.locator(`[data-target="${row}"] [data-field="${name}"]`);
  const blur = () => page.evaluate(() => document.activeElement?.blur());
  /// As a person types it.
  const type_target = async (row, text) => {
    const [kind, size, pitch, radius] = text.split(":");
    await page.locator(`[data-target="${row}"] select`).selectOption(kind);
    const [columns, rows] = size.split("x");
    for (const [name, value] of Object.entries({ columns, rows, pitch, ...(kind === "dots" ? { radius } : {}) })) await field(row, name).fill(value);
  };

  await page.goto(url);   // its token becomes a cookie
  // A server that was just started has no source yet.
  await until("the calibration is there", () => state().then(() => true, () => false));
  assert.equal((await state()).file.refusal, "", "the server cannot save, so that cannot be tested");
  await api("DELETE", "/views");

  await step("the page shows the live picture before it is begun", async () => {
    await page.goto(url);
    await page.getByRole("navigation").getByRole("link", { name: "Calibration" }).click();
    await until("frames come", async () => /^-?\d+$/.test((await shown("frame")) ?? ""));
    const first = await shown("frame");
    await until("and go on", async () => (await shown("frame")) !== first);
    assert.match(await show("verdict").innerText(), /not begun/i);
    assert.ok(await show("capture").isDisabled() && await show("solve").isDisabled() && await show("save").isDisabled());
    await picture("not_begun");
  });

  await step("a target that is none is refused with the reason, and does not begin", async () => {
    await type_target(0, target);
    await field(0, "pitch").fill("40");
    assert.match(await show("target-error-0").innerText(), /lengths are in meters/);
    await begin.click();
    await new Promise((done) => setTimeout(done, 300));
    assert.equal((await state()).is_on, false);
    assert.equal(await page.evaluate(() => document.activeElement?.dataset.field), "pitch", "the field that is wrong is gone to");
    await picture("wrong_target", false);
  });

  await step("targets are typed field by field, several of them, and taken over", async () => {
    await type_target(0, target);
    assert.equal(await show("target-error-0").count(), 0);
    assert.match(await show("target-command-0").innerText(), new RegExp(`tassilo calibrate target ${target} `));
    await page.getByRole("button", { name: "Add another" }).click();
    assert.match(await show("target-error-1").innerText(), /twice/);
    await type_target(1, "checker:5x4:0.033");
    await show("use-targets").click();
    await until("the server has both", async () => (await state()).targets.length === 2);
    assert.deepEqual((await state()).targets, [target, "checker:5x4:0.033"]);
    await page.getByRole("button", { name: "remove target 2" }).click();
    await field(0, "columns").press("Enter");
    await until("the server has one", async () => (await state()).targets.length === 1);
    await until("the page says so", async () => (await show("targets-state").innerText()) === "in use");
  });

  await step("a lens model is chosen", async () => {
    await page.locator(`input[value="${model}"]`).check();
    await until("the server has it", async () => (await state()).model === model);
  });

  await step("what the server refuses is told, and can be put away", async () => {
    await page.route("**/api/calibration", (route) => (route.request().method() === "PUT" ? route.fulfill({ status: 400, contentType: "text/plain", body: "target: is of another world" }) : route.fallback()));
    await begin.click();
    assert.match(await show("refusal").innerText(), /of another world/);
    await show("refusal").getByRole("button").click();
    assert.equal(await show("refusal").count(), 0);
    await page.unroute("**/api/calibration");
  });

  await step(`views are captured ${by_hand ? "by key" : "by themselves"}, and the coverage grows`, async () => {
    if ((await show("automatic").isChecked()) === by_hand) await show("automatic").click();
    await until("the server knows how", async () => (await state()).is_automatic === !by_hand);
    await begin.click();
    await until("it is on", async () => (await state()).is_on);
    await blur();
    let covered = 0, told = false, points = false;
    const end = Date.now() + patience;
    for (let have = 0; have < Number(wanted); have = await page.locator("[data-view]").count()) {
      assert.ok(Date.now() < end, `${have} views after ${patience} ms; it says: ${await show("verdict").innerText()}`);
      if (by_hand) await page.keyboard.press("c");
      const now = Number((await shown("covered")) ?? "0");
      assert.ok(now >= covered, `the coverage shrank from ${covered} to ${now} cells`);
      covered = now;
      points ||= Number((await shown("points")) ?? "0") > 0;
      if (!told && /captured/i.test(await show("verdict").innerText())) {
        told = true;
        await until("it is read aloud, too", async () => /captured/.test(await show("spoken").innerText()));
        await picture("captured", false);
      }
      await new Promise((done) => setTimeout(done, 60));
    }
    assert.ok(told, "no capture was told");
    if (!points) await until("points are shown over the picture", async () => Number((await shown("points")) ?? "0") > 0, patience);
    await until("cells are covered", async () => Number(await shown("covered")) > 0);
    await picture("views");
  });

  await step("a view is captured by key, however alike the views are", async () => {
    const before = (await state()).views.length;
    await until("one more", async () => {
      await page.keyboard.press("c");
      await new Promise((done) => setTimeout(done, 500));
      return (await state()).views.length > before;
    }, patience);
  });

  await step("a view that is pointed at shows its points, and is forgotten", async () => {
    // Nothing comes in between.
    if (await show("automatic").isChecked()) await show("automatic").click();
    await until("it waits", async () => !(await state()).is_automatic);
    await until("the page has all", async () => (await page.locator("[data-view]").count()) === (await state()).views.length);
    const { views } = await state();
    const last = page.locator(`[data-view="${views.at(-1).id}"]`);
    await last.hover();
    await until("its points are shown", async () => (await shown("pointed")) === views.at(-1).id);
    await page.mouse.move(5, 5);
    await until("and no longer", async () => (await shown("pointed")) === "");
    await last.getByRole("button", { name: /^forget/ }).focus();
    await until("by keyboard, too", async () => (await shown("pointed")) === views.at(-1).id);
    await picture("pointed");
    await page.keyboard.press("Enter");
    await until("it is forgotten", async () => !(await state()).views.some(({ id }) => id === views.at(-1).id));
    await until("the page says so", async () => (await last.count()) === 0);
    await blur();
  });

  await step("the camera is worked out, with all that tells how good it is", async () => {
    // Solving ends it, so that no view drops the result.
    if (!by_hand) await show("automatic").click();
    await until("it goes on", async () => (await state()).is_automatic === !by_hand);
    await page.evaluate(() => document.activeElement?.blur());
    await until("it can be solved", () => show("solve").isEnabled());
    await page.keyboard.press("s");
    await until("it is being worked out, or was", async () => {
      const { is_solving, is_automatic, result, failure } = await state();
      return !is_automatic && (is_solving || result !== null || failure !== "");
    });
    await until("there is a result or a failure", async () => {
      const { is_solving, result, failure } = await state();
      return !is_solving && (result !== null || failure !== "");
    }, patience);
    const { result, failure, views } = await state();
    assert.equal(failure, "");
    await until("its numbers are shown", async () => (await show("rms").innerText()) === result.rms_px.toFixed(3));
    assert.equal(await show("values").locator("tbody tr").count(), result.values.length);
    assert.equal(await show("cross-validated").innerText(), result.cross_validated_rms_px?.toFixed(3) ?? "–");
    assert.equal(await show("warnings").locator("li").count(), result.warnings.length);
    for (const { id, rejected } of views.filter((view) => view.rejected !== "")) assert.ok((await page.locator(`[data-view="${id}"]`).innerText()).includes(rejected));
    await until("the picture of the residuals is loaded", () => show("residuals").evaluate((image) => image.complete && image.naturalWidth > 0).catch(() => false));
    assert.equal(await page.getByRole("navigation").getByLabel("not saved").count(), 1, "the badge says that it is not saved");
    await picture("result");
  });

  await step("it is saved", async () => {
    await show("save").click();
    await until("the file has it", async () => (await state()).file.is_saved);
    await until("the page says so", async () => (await show("saved").innerText()) === "saved");
    assert.equal(await page.getByRole("navigation").getByRole("link", { name: "Calibration" }).getByLabel("not saved").count(), 0);
    assert.ok(await show("save").isDisabled());
  });

  await step("another page asks nothing more, and coming back loses nothing", async () => {
    await page.getByRole("navigation").getByRole("link", { name: "Stages" }).click();
    let asked = 0;
    page.on("request", (request) => { if (/\/api\/calibration$/.test(request.url())) ++asked; });
    await new Promise((done) => setTimeout(done, 300));
    asked = 0;
    await new Promise((done) => setTimeout(done, 1200));
    assert.equal(asked, 0);
    await page.getByRole("navigation").getByRole("link", { name: "Calibration" }).click();
    await show("rms").waitFor();
    await new Promise((done) => setTimeout(done, 1500));
    assert.ok(asked >= 2 && asked <= 9, `${asked} questions in 1.5 s`);
  });

  await step("dark", async () => {
    await page.emulateMedia({ colorScheme: "dark" });
    await until("the picture of the residuals is loaded", () => show("residuals").evaluate((image) => image.complete && image.naturalWidth > 0).catch(() => false));
    await picture("dark");
  });

  await step("as narrow as a telephone, nothing sticks out", async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await new Promise((done) => setTimeout(done, 300));
    const [wide, who] = await page.evaluate(() => {
      const { clientWidth, scrollWidth } = document.documentElement;
      const sticking = [...document.querySelectorAll("main *")].filter((element) => element.getBoundingClientRect().right > clientWidth + 0.5);
      return [scrollWidth - clientWidth, sticking.slice(0, 5).map((element) => `${element.tagName} ${element.className}`).join(", ")];
    });
    assert.ok(wide <= 0, `the page is ${wide} px too wide: ${who}`);
    await picture("phone_dark", false);
    await page.emulateMedia({ colorScheme: "light" });
    await picture("phone");
    await page.setViewportSize({ width: 1440, height: 1000 });
  });

  await step("all views are forgotten when that is asked twice, and too few of them fail with the reason", async () => {
    await show("forget-all").click();
    await page.getByRole("button", { name: "no", exact: true }).click();
    assert.ok((await state()).views.length > 0);
    await show("forget-all").click();
    await page.getByRole("button", { name: "forget them" }).click();
    await until("all are gone", async () => (await state()).views.length === 0);
    await until("nothing is covered", async () => (await shown("covered")) === "0");
    await blur();
    await until("one view", async () => {
      await page.keyboard.press("c");
      await new Promise((done) => setTimeout(done, 500));
      return (await state()).views.length > 0;
    }, patience);
    await until("it can be asked for", async () => show("solve").isEnabled());
    await page.keyboard.press("s");
    // Refused at once, or found out by trying.
    await until("the reason is told", async () => (await show("failure").count()) + (await show("refusal").count()) > 0, patience);
    await picture("failure");
  });

  await step("large, to be read from afar", async () => {
    await page.keyboard.press("f");
    await until("it is large", async () => (await show("full").getAttribute("aria-pressed")) === "true");
    await new Promise((done) => setTimeout(done, 400));
    await picture("large", false);
    await page.keyboard.press("f");
    await until("it is small again", async () => (await show("full").getAttribute("aria-pressed")) === "false");
  });

  await step("it ends", async () => {
    await begin.click();
    await until("it is off", async () => !(await state()).is_on);
    await until("the page says so", async () => /not begun/i.test(await show("verdict").innerText()));
    await api("DELETE", "/views");
  });

  await end();
}

await run("calibration.mjs", main, {
  target: { type: "string", default: "dots:7x7:0.04:0.01" }, model: { type: "string", default: "division" }, views: { type: "string", default: "6" },
  "by-hand": { type: "boolean", default: false }, patience: { type: "string", default: "120" },
});
