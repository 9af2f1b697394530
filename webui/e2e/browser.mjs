// The pages as a person uses them, in a browser, against a server: whether what is shown is what was sent, and whether changes take effect.
//
// usage: node e2e/browser.mjs [--screenshots DIR] [--browser PROGRAM] --url URL
//        node e2e/browser.mjs [--screenshots DIR] [--browser PROGRAM] -- COMMAND...
// COMMAND starts a server that prints its address (http://...); it is ended afterwards. Exit code 77: skipped, no browser.
// The source must go on for a minute, see a ball and free space, and be a field where `localization: boundary` has walls to go by.
import assert from "node:assert/strict";
import { lose_connection, open_page, run, until } from "./run.mjs";

/// The scenes a page receives, by their frame. A recording that begins anew has the same frames again; the last one counts.
function scenes_of(page) {
  const scenes = new Map();
  page.on("websocket", (socket) => {
    if (!socket.url().endsWith("/ws/scene")) return;
    socket.on("framereceived", ({ payload }) => {
      const scene = JSON.parse(payload);
      scenes.set(scene.frame, scene);
      scenes.last = scene;
    });
  });
  return scenes;
}

/// The number in a text as the pages write it: "−1.23 m" is -1.23.
function number_in(text) {
  const match = /[−-]?\d+(\.\d+)?/.exec(text);
  assert.ok(match, `no number in '${text}'`);
  return { value: Number(match[0].replace("−", "-")), half_digit: 0.5 * 10 ** -((match[1]?.length ?? 1) - 1) };
}

/// A shown number is a value rounded to the digits that are shown; null is a dash.
function assert_shows(text, value, what) {
  if (value === null) return assert.equal(text.trim(), "–", what);
  const shown = number_in(text);
  assert.ok(Math.abs(shown.value - value) <= shown.half_digit * (1 + 1e-9) + 1e-9, `${what}: shows '${text}', the scene has ${value}`);
}

function assert_bearing(text, value, what) {
  if (value === null) return assert.equal(text.trim(), "–", what);
  assert_shows(text, Math.abs((value * 180) / Math.PI), what);
  if (!/^0\.0°/.test(text)) assert.ok(text.includes(value > 0 ? "left" : "right"), `${what}: '${text}' is on the wrong side`);
}

async function texts(page, row, cell) {
  return page.locator(`[data-show="seen"] [data-show="${row}"] [data-show="${cell}"]`).allInnerTexts();
}

/// All numbers of the table against the scene of the frame that the table names.
async function compare_with_scene(page, scenes) {
  const frame = Number(await page.locator('[data-show="frame"]').innerText());
  const scene = scenes.get(frame);
  assert.ok(scene, `frame ${frame} is shown but was never received`);
  for (const [row, things] of [["ball", scene.balls], ["robot", scene.robots]]) {
    const distances = await texts(page, row, "distance");
    const bearings = await texts(page, row, "bearing");
    assert.equal(distances.length, things.length, `rows of ${row}`);
    things.forEach((thing, i) => {
      assert_shows(distances[i], thing.distance, `distance of ${row} ${i}`);
      assert_bearing(bearings[i], thing.bearing, `bearing of ${row} ${i}`);
    });
  }
  const goals = await texts(page, "goal", "bearing");
  assert.equal(goals.length, scene.goals.length, "rows of goals");
  scene.goals.forEach((goal, i) => assert_bearing(goals[i], goal.bearing, `bearing of goal ${i}`));
  assert.equal(await page.locator('[data-show="seen"] [data-show="track"]').count(), scene.tracks.length, "rows of tracks");
  if (scene.pose) {
    assert_shows((await texts(page, "pose", "x"))[0], scene.pose.x, "x of the pose");
    assert_shows((await texts(page, "pose", "y"))[0], scene.pose.y, "y of the pose");
    assert_shows((await texts(page, "pose", "theta"))[0], (scene.pose.theta * 180) / Math.PI, "theta of the pose");
  }
  for (const [subject, reason] of Object.entries(scene.why)) {
    assert.equal(await page.locator(`[data-show="why-${subject}"]`).innerText(), reason);
  }
  for (const [stage, ms] of Object.entries(scene.timing_ms)) {
    if (stage !== "total") assert.ok(await page.locator(`[data-show="time-${stage}"]`).count() === 1, `no bar for ${stage}, ${ms} ms`);
  }
  return scene;
}

/// Different colors on a canvas; 1 is a blank one.
function colors_on(page, selector) {
  return page.locator(selector).evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
}

async function option_state(api, key) {
  const stages = await api("GET", "/api/stages");
  for (const stage of stages) {
    for (const option of [...stage.options, ...stage.alternatives.flatMap((a) => a.options)]) if (option.key === key) return option;
  }
  throw new Error(`the server has no option ${key}`);
}

async function main(url, browser, screenshots) {
  // A refused change is meant to be refused.
  const { context, page, faults, picture, step, api, end } = await open_page(browser, url, { screenshots, prefix: "", refusals: /status of 400/ });
  const origin = new URL(url).origin;
  page.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url()) && new URL(request.url()).origin !== origin) faults.push(`request elsewhere: ${request.url()}`);
  });
  const scenes = scenes_of(page);
  const view = (name) => page.getByRole("navigation").getByRole("link", { name }).click();

  await step("picture and scene arrive", async () => {
    await page.goto(url);
    await page.locator('[data-show="picture"][data-there="true"]').waitFor();
    await page.locator('[data-show="seen"]').waitFor();
    await until("live", async () => (await page.locator('[data-show="condition"]').innerText()).trim() === "live");
    assert.ok((await colors_on(page, '[data-show="picture"]')) > 50, "the picture is blank");
    for (const plan of [0, 1]) assert.ok((await colors_on(page, `canvas.plan >> nth=${plan}`)) > 5, `plan ${plan} is blank`);
    await page.locator('[data-show="health"]').waitFor();
  });

  await step("frozen, the numbers are those of the scene, and stay", async () => {
    await page.keyboard.press("Space");
    await page.getByRole("button", { name: "Continue" }).waitFor();
    const scene = await compare_with_scene(page, scenes);
    const frame_of_picture = await page.locator('[data-show="picture"]').getAttribute("data-frame");
    if (frame_of_picture) assert.equal(Number(frame_of_picture), scene.frame, "picture and numbers are of different frames");
    await until("later scenes", () => scenes.last.frame !== scene.frame);
    await new Promise((done) => setTimeout(done, 500));
    assert.equal((await compare_with_scene(page, scenes)).frame, scene.frame, "a frozen page goes on");
    await picture("frozen");
    await page.getByRole("button", { name: "Continue" }).click();
    await until("it goes on", async () => Number(await page.locator('[data-show="frame"]').innerText()) !== scene.frame);
    await page.evaluate(() => document.activeElement?.blur());
    await picture("live");
  });

  await step("a recording is begun and ended by the keyboard, and its numbers are the server's", async () => {
    const bar = page.locator('[data-show="recording"]');
    await page.getByRole("button", { name: "Record", exact: true }).focus();
    await page.keyboard.press("Enter");
    const stop = page.getByRole("button", { name: "Stop recording" });
    await stop.waitFor();
    await until("frames are recorded", async () => Number((await page.locator('[data-show="recording-frames"]').innerText()).replace(/\D/g, "")) >= 15);
    assert.match(await bar.innerText(), /recording 0:\d\d, \d+ frames, [\d.]+\s?MB/);
    await picture("recording");
    await stop.press("Enter");
    await page.getByRole("button", { name: "Record", exact: true }).waitFor();
    const last = await until("it is finished", async () => {
      const state = await api("GET", "/api/recording");
      return !state.on && !state.finishing && state;
    });
    assert.deepEqual([last.trouble, last.dropped], ["", 0]);
    await until("the page shows it", async () => (await page.locator('[data-show="recording-frames"]').innerText()) === String(last.frames));
    assert.equal(await page.locator('[data-show="recording-place"]').getAttribute("title"), `${last.folder}/${last.name}`);
    await bar.getByText("recorded", { exact: true }).waitFor();
  });

  await step("another alternative takes effect while running", async () => {
    await view("Stages");
    await page.locator('[data-stage="localization"] input[value="boundary"]').click();
    await until("the server has it", async () => {
      const stages = await api("GET", "/api/stages");
      return stages.find(({ key }) => key === "localization").alternatives.find(({ name }) => name === "boundary").chosen;
    });
    await until("scenes show it", () => scenes.last.pose === null || scenes.last.pose.kind !== "model");
    await page.locator('[data-stage="localization"] .choice.chosen', { hasText: "boundary" }).waitFor();
    await picture("stages");
  });

  await step("an option takes effect, is marked, and goes back", async () => {
    const before = await option_state(api, "free_space_max_range");
    await page.getByRole("searchbox").fill("max_range");
    const row = page.locator('[data-option="free_space_max_range"]');
    await row.getByRole("textbox").fill("1.5");
    await row.getByRole("textbox").press("Enter");
    await until("the server has it", async () => (await option_state(api, "free_space_max_range")).value === 1.5);
    await until("scenes show it", () => scenes.last.free_space?.ranges.every((range) => range === null || range <= 1.5 + 1e-6));
    await row.getByText("changed", { exact: true }).waitFor();
    await picture("stages_search");
    await row.getByRole("button", { name: /^reset/ }).click();
    await until("the server has the old one", async () => (await option_state(api, "free_space_max_range")).value === before.value);
    await until("the field shows it", async () => Number(await row.getByRole("textbox").inputValue()) === before.value);
  });

  await step("a value out of range is refused beside the field, and nothing changes", async () => {
    await page.getByRole("searchbox").fill("ball_max");
    const before = await option_state(api, "ball_max");
    const row = page.locator('[data-option="ball_max"]');
    await row.getByRole("textbox").fill("5000");
    await row.getByRole("textbox").press("Enter");
    const error = row.locator('[data-show="error-ball_max"]');
    await error.waitFor();
    assert.match(await error.innerText(), /ball_max|100/);
    assert.equal(await row.getByRole("textbox").inputValue(), "5000", "what was typed can be corrected");
    assert.equal((await option_state(api, "ball_max")).value, before.value);
    await picture("stages_refused");
    await row.getByRole("textbox").press("Escape");
    await until("the old value is back", async () => Number(await row.getByRole("textbox").inputValue()) === before.value && (await error.count()) === 0);
    await row.getByRole("textbox").fill("many");
    await row.getByRole("textbox").press("Tab");
    await error.waitFor();
    assert.match(await error.innerText(), /must be a number/);
    await row.getByRole("button", { name: /^reset/ }).click();
    await error.waitFor({ state: "detached" });
  });

  await step("the alternative goes back, by keyboard", async () => {
    await page.getByRole("searchbox").fill("");
    await page.locator('[data-stage="localization"] input[value="boundary"]').focus();
    await page.keyboard.press("ArrowUp");
    await until("scenes show it", () => scenes.last.pose === null || !/_lines?$/.test(scenes.last.pose.kind));
  });

  await step("dark", async () => {
    await page.emulateMedia({ colorScheme: "dark" });
    const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.ok(/\d+/g.exec(ground) && Math.max(...ground.match(/\d+/g).slice(0, 3).map(Number)) < 60, `the ground is ${ground}`);
    await view("Stages");
    await picture("stages_dark");
    await view("Live");
    await page.locator('[data-show="picture"][data-there="true"]').waitFor();
    await page.locator('[data-show="health"]').waitFor();
    await picture("live_dark");
  });

  await step("as narrow as a telephone, nothing sticks out", async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    for (const name of ["Live", "Stages"]) {
      await view(name);
      await page.locator('[data-show="picture"][data-there="true"]').waitFor();
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(wide <= 0, `${name} is ${wide} px too wide`);
      await picture(`${name.toLowerCase()}_phone`);
    }
    await page.emulateMedia({ colorScheme: "light" });
    await view("Live");
    await picture("live_phone_light");
  });

  await step("a lost connection is told, what is shown is marked as old, and it comes back by itself", () =>
    lose_connection({ context, picture, url, live: /^live/ }));

  await end();
}

await run("browser.mjs", main);
