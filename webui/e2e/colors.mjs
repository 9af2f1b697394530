// Color training as a person does it, in a browser: draws samples, looks at what comes of them, saves, goes back, and measures how soon a drawn sample is seen.
//
// usage: node e2e/colors.mjs [--screenshots DIR] [--browser PROGRAM] --url URL
//        node e2e/colors.mjs [--screenshots DIR] [--browser PROGRAM] -- COMMAND...
// COMMAND starts a server that prints its address (http://...); it is ended afterwards. Exit code 77: skipped, no browser.
// The source must go on for some minutes. The server must be able to save; its files are written.
import assert from "node:assert/strict";
import { open_page, run, until } from "./run.mjs";

/// From the pointer event to the picture that shows what came of it, the median of so many. [ms]
const latency_limit_ms = 100, latency_count = 20;

async function main(url, browser, screenshots) {
  // A draft that another browser overtook is meant to be refused.
  const { context, page, picture, step, show, api: ask, end } = await open_page(browser, url, { screenshots, prefix: "colors_", refusals: /status of 409/ });
  page.on("dialog", (dialog) => void dialog.accept());
  const api = (method, name, data) => ask(method, `/api/training${name}`, data);
  const canvas = show("color-picture");
  /// A point of the picture's canvas, in shares of it.
  const at = async (x, y) => {
    const box = await canvas.boundingBox();
    return [box.x + x * box.width, box.y + y * box.height];
  };
  const drag = async (...points) => {
    const [from, ...rest] = await Promise.all(points.map(([x, y]) => at(x, y)));
    await page.mouse.move(...from);
    await page.mouse.down();
    for (const point of rest) await page.mouse.move(...point, { steps: 3 });
    await page.mouse.up();
  };
  const click = async (x, y) => page.mouse.click(...(await at(x, y)));
  /// Of all a canvas shows, one number.
  const print_of = (selector) => page.locator(selector).evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    let hash = 17;
    for (let i = 0; i < data.length; i += 4) hash = (Math.imul(hash, 31) + data[i] + 256 * data[i + 1] + 65536 * data[i + 2]) | 0;
    return hash;
  });
  const pixels_of = async (name) => Number((await page.locator(`[data-class="${name}"] [data-show="pixels"]`).innerText()).replace(/\D/g, "") || "0");
  const samples = async () => (await api("GET", "")).samples;
  /// The server's draft, once the page has sent what it has.
  const count_is = (wanted) => until(`the server has ${wanted} samples`, async () => (await samples()).length === wanted);
  const changed_percent = async () => Number(/[\d.]+/.exec(await show("changed").innerText())?.[0]);

  await page.goto(url);   // its token becomes a cookie
  // A server that was just started has no source yet.
  await until("the training is there", () => api("GET", "").then(() => true, () => false));
  const before = await api("GET", "");
  assert.equal(before.files.refusal, "", "the server cannot save, so that cannot be tested");
  let own = before.samples.length;

  await step("the live picture comes, with the classes of the table over it", async () => {
    await page.goto(url);
    await page.getByRole("navigation").getByRole("link", { name: "Colors" }).click();
    await until("frames come", async () => /^-?\d+$/.test((await canvas.getAttribute("data-frame")) ?? ""));
    const first = await canvas.getAttribute("data-frame");
    await until("and go on", async () => (await canvas.getAttribute("data-frame")) !== first);
    await picture("live");
  });

  await step("frozen it stays", async () => {
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("Space");
    await page.getByRole("button", { name: "Continue" }).waitFor();
    const frozen = await canvas.getAttribute("data-frame");
    await new Promise((done) => setTimeout(done, 400));
    assert.equal(await canvas.getAttribute("data-frame"), frozen);
    await page.keyboard.press("Space");
    await until("it goes on", async () => (await canvas.getAttribute("data-frame")) !== frozen);
  });

  await step("a rectangle on the live picture keeps it, and is trained", async () => {
    await page.keyboard.press("3");
    await page.locator('[data-class="green"] [aria-pressed="true"]').waitFor();
    await page.keyboard.press("r");
    const [uv, histogram, had] = [await print_of('[data-show="uv"]'), await print_of('[data-show="histogram"]'), await pixels_of("green")];
    await drag([0.1, 0.82], [0.3, 0.95]);
    await count_is(++own);
    await until("its pixels are counted", async () => (await pixels_of("green")) > had);
    await until("the UV plane shows them", async () => (await print_of('[data-show="uv"]')) !== uv);
    await until("the histogram shows them", async () => (await print_of('[data-show="histogram"]')) !== histogram);
    assert.equal(await page.locator("[data-image][aria-pressed=true]").count(), 1, "the picture is in the strip");
    await picture("rectangle");
  });

  await step("a live picture is kept by a key, and forgotten when that is asked twice", async () => {
    await page.keyboard.press("l");
    await until("live goes on", async () => (await page.locator('[data-show="live"][aria-pressed=true]').count()) === 1);
    const { images } = await api("GET", "");
    const [drawn] = (await samples()).slice(-1).map(({ image }) => image);
    const before_it = await canvas.getAttribute("data-frame");
    await until("another frame", async () => (await canvas.getAttribute("data-frame")) !== before_it);
    await page.keyboard.press("k");
    await until("it is kept", async () => (await api("GET", "")).images.length === images.length + 1);
    await page.getByRole("button", { name: "forget picture" }).click();
    await page.getByRole("button", { name: "forget it" }).click();
    await until("it is forgotten", async () => (await api("GET", "")).images.length === images.length);
    await page.locator(`[data-image="${drawn}"]`).click();
    assert.ok(await page.getByRole("button", { name: "forget picture" }).isDisabled(), "a picture with samples cannot be forgotten");
    await page.evaluate(() => document.activeElement?.blur());
  });

  await step("a polygon, with a corner too many taken back", async () => {
    await page.keyboard.press("p");
    for (const corner of [[0.55, 0.8], [0.75, 0.8], [0.95, 0.2]]) await click(...corner);
    await page.keyboard.press("Backspace");
    for (const corner of [[0.75, 0.92], [0.55, 0.92]]) await click(...corner);
    await page.mouse.move(...(await at(0.6, 0.85)));
    await picture("polygon_begun", false);
    await page.keyboard.press("Enter");
    await count_is(++own);
    assert.equal((await samples()).at(-1).polygon.length, 4);
    await page.keyboard.press("p");
    for (const corner of [[0.3, 0.1], [0.4, 0.1], [0.4, 0.3]]) await click(...corner);
    await page.keyboard.press("Escape");
    await new Promise((done) => setTimeout(done, 300));
    assert.equal((await samples()).length, own, "what was dropped is no sample");
  });

  await step("a brush of another class and size", async () => {
    await page.keyboard.press("2");
    await page.keyboard.press("b");
    const radius = await show("radius").innerText();
    for (let n = 0; n < 4; ++n) await page.keyboard.press("[");
    assert.notEqual(await show("radius").innerText(), radius);
    await drag([0.1, 0.635], [0.5, 0.635], [0.9, 0.635]);
    await count_is(++own);
    const { stroke, radius: drawn, class: color } = (await samples()).at(-1);
    assert.ok(stroke.length >= 2 && drawn === Number.parseFloat(await show("radius").innerText()) && color === "white");
  });

  await step("undo and redo by keyboard, to the beginning and back", async () => {
    for (let n = 1; n <= 3; ++n) await page.keyboard.press(n % 2 === 0 ? "u" : "Control+z");
    await count_is(own - 3);
    await page.keyboard.press("Control+Shift+Z");
    await page.keyboard.press("Control+y");
    await page.keyboard.press("Control+Shift+Z");
    await count_is(own);
  });

  await step("samples are selected, deleted and brought back; a class is cleared and brought back", async () => {
    await page.keyboard.press("s");
    await click(0.2, 0.9);
    await page.getByRole("button", { name: "delete", exact: true }).first().waitFor();
    await picture("selected");
    await page.keyboard.press("Delete");
    await count_is(own - 1);
    await page.keyboard.press("u");
    await count_is(own);
    const green = (await samples()).filter((sample) => sample.class === "green").length;
    await page.getByRole("button", { name: "clear green" }).click();
    await count_is(own - green);
    await page.keyboard.press("Control+z");
    await count_is(own);
  });

  await step("a rectangle without a pointer", async () => {
    await page.keyboard.press("3");
    await page.keyboard.press("r");
    await canvas.focus();
    for (let n = 0; n < 3; ++n) await page.keyboard.press("Shift+ArrowDown");
    await page.keyboard.press("Enter");
    await page.keyboard.press("Shift+ArrowRight");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await count_is(++own);
    const { rectangle: [x0, y0, x1, y1] } = (await samples()).at(-1);
    assert.deepEqual([x1 - x0, y1 - y0], [11, 2]);
    await page.keyboard.press("u");
    await count_is(--own);
  });

  await step("the brightness by hand, by keyboard and pointer, and trained again", async () => {
    await page.keyboard.press("3");
    const low = show("brightness-low");
    const trained = Number(await low.getAttribute("aria-valuenow"));
    await low.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    await until("the server has it", async () => (await api("GET", "")).brightness.green?.[0] === trained + 2);
    const box = await page.locator(".track").boundingBox();
    await page.mouse.move(box.x + box.width * 0.97, box.y + 30);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.9, box.y + 30, { steps: 8 });
    await page.mouse.up();
    const high = Number(await show("brightness-high").getAttribute("aria-valuenow"));
    await until("the server has that too", async () => (await api("GET", "")).brightness.green?.[1] === high);
    assert.ok(Math.abs(high - 0.9 * 255) < 3, `the highest is ${high}`);
    await picture("by_hand");
    // One drag, one step back.
    await page.keyboard.press("u");
    await until("as before the drag", async () => (await api("GET", "")).brightness.green?.[1] !== high);
    await page.locator(".brightness").getByRole("button", { name: "reset" }).click();
    await until("trained again", async () => (await api("GET", "")).brightness.green === undefined);
  });

  await step("a parameter, refused when it is out of range, and back", async () => {
    const row = page.locator('[data-option="closing_px"]');
    await row.getByRole("textbox").fill("9");
    await row.getByRole("textbox").press("Enter");
    await until("the server has it", async () => (await api("GET", "")).options.find(({ key }) => key === "closing_px").value === 9);
    await row.getByRole("textbox").fill("900");
    await row.getByRole("textbox").press("Enter");
    await row.locator('[data-show="error-closing_px"]').waitFor();
    await row.getByRole("textbox").press("Escape");
    await row.getByRole("button", { name: /^reset/ }).click();
    await until("the default is back", async () => (await api("GET", "")).options.find(({ key }) => key === "closing_px").changed === false);
  });

  await step("another browser is told of, and nothing of ours is lost", async () => {
    const { version, samples: theirs, brightness } = await api("GET", "");
    await api("PUT", "/draft", { version, samples: theirs.slice(0, -1), options: {}, brightness });
    await show("notice").waitFor();
    assert.match(await show("notice").innerText(), /another browser/);
    await picture("other_browser", false);
    await show("notice").getByRole("button").click();
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("u");
    await count_is(own);
  });

  await step("the difference to the table in use, until the draft is saved and used", async () => {
    await page.locator('[data-mode="difference"]').click();
    await until("something changes", async () => (await changed_percent()) > 0);
    await page.mouse.move(...(await at(0.5, 0.5)));
    await picture("difference");
    const tables = (await api("GET", "")).history.length;
    await page.getByRole("textbox", { name: /notes/ }).fill("by the test");
    await show("save").click();
    await until("a table more", async () => (await api("GET", "")).history.length > tables);
    const { is_saved, history, images, samples: kept } = await api("GET", "");
    assert.ok(is_saved && history[0].in_use && history[0].notes.includes("by the test"));
    assert.ok(images.filter(({ id }) => kept.some(({ image }) => image === id)).every((image) => image.kept), "pictures with samples are in files");
    await until("nothing changes any more", async () => (await changed_percent()) === 0);
    await until("the page says so", async () => (await show("saved").innerText()) === "saved");
  });

  await step("back to the table before, and to the new one", async () => {
    const { history } = await api("GET", "");
    for (const { id } of [history[1], history[0]]) {
      await page.locator(`[data-table="${id}"]`).getByRole("button").click();
      await until("it is in use", async () => (await api("GET", "")).history.find((table) => table.id === id).in_use);
      await until("and compared with", async () => ((await changed_percent()) === 0) === (id === history[0].id));
      if (id === history[1].id) await picture("rolled_back");
    }
  });

  await step("leaving with edits that are not saved asks", async () => {
    await page.keyboard.press("u");
    await until("it is not saved", async () => (await show("saved").innerText()) === "not saved");
    let asked = false;
    page.once("dialog", () => { asked = true; });
    await page.reload();
    assert.ok(asked, "the page was left without a word");
    await until("the draft is the server's", async () => (await show("undo").isDisabled()));
    own = (await samples()).length;
  });

  await step(`what is drawn is seen within ${latency_limit_ms} ms`, async () => {
    await page.locator('[data-mode="overlay"]').click();
    await page.locator("[data-image]").first().click();
    await page.keyboard.press("3");
    await page.keyboard.press("r");
    await until("the picture is there", async () => (await page.locator(".no-picture").count()) === 0);
    const measures = () => page.evaluate(() => performance.getEntriesByName("resegmented").map(({ duration }) => duration));
    const { width, height } = (await api("GET", "")).images[0];
    /// The median of so many.
    const round = async () => {
      const earlier = (await measures()).length;
      for (let n = 0; n < latency_count; ++n) {
        const [x, y] = [0.05 + 0.04 * (n % 20), 0.8];
        await drag([x, y], [x + 0.03, y + 0.05]);
        await until("it is drawn", async () => (await measures()).length === earlier + n + 1);
      }
      const durations = (await measures()).slice(earlier).sort((a, b) => a - b);
      const median = (durations[latency_count / 2 - 1] + durations[latency_count / 2]) / 2;
      console.log(`latency at ${width}x${height}: median ${median.toFixed(1)} ms, worst ${durations.at(-1).toFixed(1)} ms of ${latency_count}`);
      for (let n = 0; n < latency_count; ++n) await page.keyboard.press("u");
      await count_is(own);
      return median;
    };
    // A machine that does other work for a while says nothing about the page.
    const medians = [];
    while (medians.length < 3 && !(Math.min(...medians) < latency_limit_ms)) medians.push(await round());
    assert.ok(Math.min(...medians) < latency_limit_ms, `the medians are ${medians.map((ms) => ms.toFixed(1)).join(", ")} ms`);
  });

  await step("zoomed, a small thing is large, and is drawn on", async () => {
    await page.mouse.move(...(await at(0.5, 0.6)));
    for (let n = 0; n < 4; ++n) await page.mouse.wheel(0, -300);
    await page.keyboard.press("+");
    await drag([0.5, 0.5], [0.6, 0.6]);
    await count_is(own + 1);
    const { rectangle: [x0, , x1], image } = (await samples()).at(-1);
    const { width } = (await api("GET", "")).images.find(({ id }) => id === image);
    assert.ok(x1 - x0 < 0.06 * width, `${x1 - x0} of ${width} pixels`);
    await picture("zoomed", false);
    await page.keyboard.press("u");
    await page.keyboard.press("f");
    await count_is(own);
  });

  await step("dark", async () => {
    await page.emulateMedia({ colorScheme: "dark" });
    await until("quality is known", async () => /held-out/.test(await show("quality-state").innerText()));
    await picture("dark");
  });

  await step("as narrow as a telephone, nothing sticks out, and fingers draw", async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await new Promise((done) => setTimeout(done, 200));
    const [wide, who] = await page.evaluate(() => {
      const { clientWidth, scrollWidth } = document.documentElement;
      const sticking = [...document.querySelectorAll("main *")].filter((element) => element.getBoundingClientRect().right > clientWidth + 0.5);
      return [scrollWidth - clientWidth, sticking.slice(0, 5).map((element) => `${element.tagName} ${element.className}`).join(", ")];
    });
    assert.ok(wide <= 0, `the page is ${wide} px too wide: ${who}`);
    await picture("phone_dark");
    await page.emulateMedia({ colorScheme: "light" });
    const session = await context.newCDPSession(page);
    await page.evaluate(() => document.querySelector('[data-show="color-picture"]').scrollIntoView({ block: "center" }));
    const touch = async (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await touch("touchStart", await at(0.2, 0.8));
    await touch("touchMove", await at(0.3, 0.85));
    await touch("touchMove", await at(0.35, 0.9));
    await touch("touchEnd");
    await count_is(own + 1);
    // Two fingers zoom, and draw nothing.
    await touch("touchStart", await at(0.4, 0.5));
    await touch("touchStart", await at(0.4, 0.5), await at(0.6, 0.5));
    await touch("touchMove", await at(0.2, 0.5), await at(0.8, 0.5));
    await touch("touchEnd");
    await new Promise((done) => setTimeout(done, 300));
    assert.equal((await samples()).length, own + 1);
    await picture("phone");
    await page.getByRole("button", { name: "whole picture" }).click();
    await show("undo").click();
    await count_is(own);
  });

  await end();
}

await run("colors.mjs", main);
