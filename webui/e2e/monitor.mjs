// The monitor's page as a person uses it, in a browser. Against a server that is live: looks, switches layers, looks back, chooses a robot, measures, saves, resizes; and how
// often the field is drawn. Against one that reads a log: looks, plays it to its end, and measures how often it is drawn while it plays.
//
// usage: node e2e/monitor.mjs [options] --url URL
//        node e2e/monitor.mjs [options] -- COMMAND...
// options: --screenshots DIR  --browser PROGRAM
//          --robots N       so many are waited for, 10
//          --least-rate N   drawn a second, over 5 s; 0: it is only told. 0
//          --only troubles  only whether the troubles of robots are told
//          --only match     only a look at a simulated match, through the eyes of one robot, too
// COMMAND starts a server that prints its address (http://...); it is ended afterwards. Exit code 77: skipped, no browser.
// The server must have heard the robots for half a minute, or its log be as long, and at least one must have a pose and move.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { lose_connection, open_page, run, until } from "./run.mjs";

const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function main(url, browser, screenshots, { robots: wanted, "least-rate": least_rate, only }) {
  // Pictures of a time of which there is none are part of the test.
  const { context, page, picture, step, show, api, end } = await open_page(browser, url, { screenshots, prefix: "monitor_", refusals: /status of 404/ });
  const told = (path) => page.evaluate((name) => window.tassilo_monitor[name], path);
  const place_of = (id) => page.evaluate((robot) => window.tassilo_monitor.place_of(robot), id);
  const shown_picture = () => told("picture");
  const condition = async () => (await show("condition").innerText()).trim();
  const rows = () => page.locator("table.robots tbody tr");

  /// Robots on the field that nothing else covers, so that a click or a color is theirs; the one that is most alone first.
  const lonely = async () => {
    const placed = [];
    for (const { id, presence, team } of (await shown_picture()).robots) {
      const at = await place_of(id);
      if (at !== null) placed.push({ id, presence, team, at });
    }
    const distance = (a, b) => (a.id === b.id ? Infinity : Math.hypot(a.at[0] - b.at[0], a.at[1] - b.at[1]));
    const alone = placed.map((robot) => ({ ...robot, room: Math.min(...placed.map((other) => distance(robot, other))) }));
    return alone.sort((a, b) => Number(b.presence === "here") - Number(a.presence === "here") || b.room - a.room);
  };
  /// Share of pixels around a place of the page that are not the ground.
  const painted = ([x, y], radius) => show("field").evaluate((canvas, [px, py, r]) => {
    const box = canvas.getBoundingClientRect();
    const scale = canvas.width / box.width;
    const side = Math.max(1, Math.round(2 * r * scale));
    const { data } = canvas.getContext("2d").getImageData(Math.round((px - box.left - r) * scale), Math.round((py - box.top - r) * scale), side, side);
    const ground = canvas.getContext("2d").getImageData(1, 1, 1, 1).data;
    let other = 0;
    for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - ground[0]) + Math.abs(data[i + 1] - ground[1]) + Math.abs(data[i + 2] - ground[2]) > 60) ++other;
    return other / (data.length / 4);
  }, [x, y, radius]);
  /// All pixels of the field, as one number.
  const print_of = () => show("field").evaluate((canvas) => {
    const words = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer);
    let sum = 0;
    for (const word of words) sum = (Math.imul(sum, 31) + word) | 0;
    return sum;
  });
  const saved = async (button) => {
    const [file] = await Promise.all([page.waitForEvent("download"), button.click()]);
    return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
  };
  /// Drawings and messages a second, over 5 s.
  const measure_rate = async () => {
    const before = { drawn: await told("drawn"), messages: await told("messages") };
    const begin = Date.now();
    await pause(5000);
    const seconds = (Date.now() - begin) / 1000;
    const rate = ((await told("drawn")) - before.drawn) / seconds;
    const heard = ((await told("messages")) - before.messages) / seconds;
    console.log(JSON.stringify({
      robots: (await shown_picture()).robots.length, seconds: Number(seconds.toFixed(2)), drawn_per_second: Number(rate.toFixed(1)), messages_per_second: Number(heard.toFixed(1)),
      longest_gap_ms: Math.round(await told("longest_gap_ms")), draw_ms: Number((await told("draw_ms")).toFixed(2)),
    }));
    assert.ok(rate >= Number(least_rate), `${rate} drawn a second, must be ${least_rate}`);
    return heard;
  };
  const drawn_after = async (act) => {
    const before = await told("drawn");
    await act();
    await until("the field is drawn anew", async () => (await told("drawn")) > before);
  };

  /// A log waits at its beginning, plays when it is told to, and ends.
  const log = async () => {
    const { begin, end: log_end } = await api("GET", "/api/monitor");
    await step("a log waits at its beginning", async () => {
      await until("a picture is shown", async () => (await told("picture")) !== null);
      await until("it says so", async () => (await condition()) === "log, paused");
      assert.ok(Math.abs((await told("t")) - begin) < 1, `begins at ${await told("t")}, the log at ${begin}`);
      assert.equal(await show("live").count(), 0, "there is no live in a log");
      await picture("log", false);
    });
    await step("plays when it is told to, as fast as it should", async () => {
      await page.keyboard.press("Space");
      await until("robots are there", async () => (await rows().count()) > 0);
      const t = await told("t");
      await measure_rate();
      const played = (await told("t")) - t;
      assert.ok(played > 3.5 && played < 7, `5 s are ${played} s`);
      await picture("log_played", false);
    });
    await step("shows the picture of a robot, or says that there is none", async () => {
      await page.keyboard.press("Space");
      await rows().first().click();
      await until("one of both", async () => (await page.locator('[data-show="robot-picture"][data-there="true"]').count()) === 1
        || /no picture of this time/.test(await show("robot-picture-words").innerText()));
      await page.keyboard.press("Escape");
    });
    await step("goes to its end by key, stops there, and begins anew", async () => {
      await page.keyboard.press("End");
      await until("its end is shown", async () => Math.abs((await told("t")) - log_end) < 1);
      await picture("log_end", false);
      await page.keyboard.press("Space");
      await until("it begins anew", async () => (await condition()) === "log, playing" && (await told("t")) < begin + 5);
      await page.keyboard.press("Home");
    });
  };

  await page.goto(url);   // its token becomes a cookie
  if ((await api("GET", "/api/monitor")).mode === "log") {
    await log();
    return end();
  }

  if (only === "troubles") {
    await step("troubles of robots are told where they are listed", async () => {
      await until(`${wanted} robots are there`, async () => (await rows().count()) >= Number(wanted));
      const ill = (await shown_picture()).robots.filter(({ troubles }) => troubles.length > 0);
      assert.ok(ill.length > 0, "a robot has troubles");
      for (const { id, troubles } of ill) {
        const row = page.locator(`table.robots tbody tr[data-robot="${id}"]`);
        // Numbers in it go on while it is looked at.
        const words = troubles[0].split(/[:\d]/)[0].trim();
        await until(`robot ${id}: ${words}`, async () => (await row.innerText()).includes(words));
      }
      await picture("troubles");
    });
    return end();
  }

  if (only === "match") {
    await step("a match is shown, and what a robot's rendered camera sees", async () => {
      await until(`${wanted} robots know where they are, and one sees the ball`, async () => {
        const robots = (await shown_picture())?.robots ?? [];
        const placed = robots.filter(({ scene: { pose }, role }) => pose !== null && role !== "");
        return placed.length >= Number(wanted) && robots.some(({ scene: { balls } }) => balls.length > 0);
      });
      await until("the team knows where the ball is", async () => (await shown_picture()).team_ball !== undefined);
      await page.setViewportSize({ width: 1280, height: 800 });  // of the picture in the README
      // Some seconds of play, for the trails.
      await pause(6000);
      const { robots } = await shown_picture();
      const seers = robots.filter(({ scene: { balls } }) => balls.length > 0);
      const { id } = seers.find(({ role }) => role === "striker") ?? seers[0] ?? robots[0];
      await page.locator(`table.robots tbody tr[data-robot="${id}"]`).click();
      await until("its picture is there", async () => (await page.locator('[data-show="robot-picture"][data-there="true"]').count()) === 1);
      await pause(1000);
      await picture("match");
    });
    return end();
  }

  await step("the robots are there, in the table and on the field", async () => {
    await until(`${wanted} robots are there`, async () => (await rows().count()) >= Number(wanted));
    await until("it is live", async () => (await condition()) === "live");
    const ids = await rows().evaluateAll((all) => all.map((row) => Number(row.dataset.robot)));
    assert.deepEqual(ids, [...ids].sort((a, b) => a - b), "rows by number");
    const { robots } = await shown_picture();
    assert.deepEqual(ids, robots.map(({ id }) => id).sort((a, b) => a - b));
    await until("a robot is painted where it says it is", async () => {
      const first = (await lonely())[0];
      return first !== undefined && (await painted(first.at, 5)) > 0.5;
    });
    await pause(1500);
    await picture("live", false);
  });

  await step("the field is drawn as often as it should be", async () => {
    assert.ok((await measure_rate()) > 0, "team pictures come");
  });

  await step("the table says what the team picture says, and its columns stay where they are", async () => {
    const lefts = () => page.locator("table.robots thead th").evaluateAll((all) => all.map((cell) => Math.round(cell.getBoundingClientRect().left)));
    const before = await lefts();
    for (const robot of (await shown_picture()).robots) {
      const row = page.locator(`tr[data-robot="${robot.id}"]`);
      assert.equal((await row.locator('[data-column="team"]').innerText()).trim(), robot.team === "unknown" ? "–" : robot.team);
      if (robot.troubles.length > 0) assert.equal((await row.locator('[data-column="troubles"]').innerText()).trim(), robot.troubles.join("; "));
      if (robot.loss === null) assert.equal((await row.locator('[data-column="loss"]').innerText()).trim(), "–");
    }
    const texts = () => page.locator("table.robots tbody").innerText();
    const first = await texts();
    await until("numbers change", async () => (await texts()) !== first);
    assert.deepEqual(await lefts(), before);
  });

  await step("robots without a pose are listed beside the field", async () => {
    const without = (await shown_picture()).robots.filter(({ scene }) => scene.pose === null).map(({ id }) => String(id));
    const listed = (await show("without-pose").count()) === 0 ? [] : await show("without-pose").getByRole("button").allInnerTexts();
    assert.deepEqual(listed, without);
  });

  await step("who sees the team's ball is said, and it is drawn where they know it", async () => {
    const known = async () => (await shown_picture()).team_ball;
    await until("the team knows its ball", async () => (await known()) !== undefined);
    await until("it is said", async () => /^seen by \d.*\sago · ±/.test((await show("team-ball").innerText()).trim()));
    const words = (await show("team-ball").innerText()).match(/^seen by ([\d, ]+)/)[1].split(",").map(Number);
    const ids = (await shown_picture()).robots.map(({ id }) => id);
    assert.ok(words.every((id) => ids.includes(id)), `${words} of ${ids}`);
    assert.match(await show("opponents").innerText(), /opponent/);
  });

  await step("paused, nothing moves; layers go and come back, and are remembered", async () => {
    await show("play").click();
    await until("it says so", async () => /looking back, paused/.test(await condition()));
    await pause(500);
    const held = await print_of();
    const t = await told("t");
    await pause(700);
    assert.equal(await told("t"), t);
    assert.equal(await print_of(), held, "nothing moves while it is paused");
    let changed = 0;
    for (const box of await page.locator("[data-layer]").all()) {
      const before = await print_of();
      await drawn_after(() => box.click());
      if ((await print_of()) !== before) ++changed;
      await drawn_after(() => box.click());
      assert.equal(await print_of(), before, "switched twice is as before");
    }
    assert.ok(changed >= 3, `only ${changed} layers change the picture`);
    const lines = page.locator('[data-layer="lines"]');
    await lines.click();
    await picture("lines", false);
    await page.reload();
    await until("the robots are there again", async () => (await rows().count()) >= Number(wanted));
    assert.ok(await lines.isChecked(), "it is remembered");
    await lines.click();
  });

  await step("looks back by the scrubber, by key, plays faster and slower, and returns to live", async () => {
    await until("it is live", async () => (await condition()) === "live");
    const live_t = await told("t");
    const scrubber = show("scrubber");
    const box = await scrubber.boundingBox();
    await page.mouse.move(box.x + box.width - 8, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.6 * box.width, box.y + box.height / 2, { steps: 12 });
    await page.mouse.up();
    const span = await api("GET", "/api/monitor");
    await until("an older picture is shown", async () => (await told("t")) < live_t - 0.1 * (span.end - span.begin));
    assert.match(await show("age").innerText(), /ago/);
    await pause(500);
    await picture("looking_back", false);
    const before = await told("t");
    await page.keyboard.press("ArrowLeft");
    await until("one picture back", async () => (await told("t")) < before);
    const back = await told("t");
    assert.ok(before - back < 0.5, `one picture is ${before - back} s`);
    await page.keyboard.press("ArrowRight");
    await until("and on", async () => (await told("t")) > back);
    const paused = await told("t");
    await show("speed").selectOption("5");
    await page.keyboard.press("Space");
    await pause(2000);
    await page.keyboard.press("Space");
    const played = (await told("t")) - paused;
    assert.ok(played > 6 && played < 14, `5 times as fast, 2 s are ${played} s`);
    await until("it is paused", async () => /paused/.test(await condition()));
    await page.keyboard.press("l");
    await until("it is live", async () => (await condition()) === "live" && (await told("t")) > live_t);
    assert.equal((await show("age").innerText()).trim(), "now");
  });

  await step("a click on a robot opens its picture, Escape closes it and its channel", async () => {
    let chosen = null;
    await until("a robot is hit", async () => {
      const [first] = await lonely();
      await page.mouse.click(...first.at);
      if ((await show("robot").count()) === 0) return false;
      chosen = Number(/\d+/.exec(await show("robot").getAttribute("aria-label"))[0]);
      return chosen === first.id;
    });
    assert.ok(await page.locator(`tr[data-robot="${chosen}"]`).evaluate((row) => row.classList.contains("chosen")), "its row is marked");
    await page.keyboard.press("Escape");
    await show("robot").waitFor({ state: "detached" });
    const { robots } = await shown_picture();
    const with_picture = robots.find((robot) => robot.has_picture && robot.presence === "here");
    if (with_picture !== undefined) {
      await page.locator(`tr[data-robot="${with_picture.id}"]`).click();
      await page.locator('[data-show="robot-picture"][data-there="true"]').waitFor();
      assert.ok(await told("is_listening"));
      await drawn_after(() => {});
      await picture("robot", false);
      await show("close-robot").click();
      await until("its channel is closed", async () => !(await told("is_listening")));
    }
    const without = robots.find((robot) => !robot.has_picture);
    if (without !== undefined) {
      await page.locator(`tr[data-robot="${without.id}"]`).click();
      await until("it says so", async () => (await show("robot-picture-words").innerText()) === `robot ${without.id} sends no pictures`);
      await page.keyboard.press("Escape");
    }
  });

  await step("a drag measures; Escape ends it; the wheel zooms where the pointer is", async () => {
    const box = await show("field").boundingBox();
    const [x, y] = [box.x + 0.3 * box.width, box.y + 0.8 * box.height];
    await page.mouse.move(x, y);
    const from = await show("place").innerText();
    await page.mouse.down();
    await page.mouse.move(x + 120, y - 90, { steps: 5 });
    const to = await show("place").innerText();
    await page.mouse.up();
    const numbers = (text) => text.match(/[−-]?\d+\.\d+/g).map((number) => Number(number.replace("−", "-")));
    const [distance, dx, dy, angle] = numbers(await show("measure").innerText());
    const [x0, y0] = numbers(from), [x1, y1] = numbers(to);
    assert.ok(Math.abs(dx - (x1 - x0)) < 0.021 && Math.abs(dy - (y1 - y0)) < 0.021, `${dx}, ${dy} between ${from} and ${to}`);
    assert.ok(Math.abs(distance - Math.hypot(dx, dy)) < 0.02);
    assert.ok(Math.abs(angle - (Math.atan2(90, 120) * 180) / Math.PI) < 1, `the angle is ${angle}`);
    await picture("measured", false);
    await page.keyboard.press("Escape");
    assert.equal(await show("measure").innerText(), "");
    await page.mouse.move(x, y);
    const before = numbers(await show("place").innerText());
    await page.mouse.wheel(0, -400);
    await page.mouse.move(x + 1, y);
    await page.mouse.move(x, y);
    const after = numbers(await show("place").innerText());
    assert.ok(Math.hypot(after[0] - before[0], after[1] - before[1]) < 0.05, "the place under the pointer stays");
    await page.mouse.move(x + 100, y);
    const meters = numbers(await show("place").innerText())[0] - after[0];
    assert.ok(meters < (dx / 120) * 100 * 0.9, "it is larger");
    await drawn_after(() => {});
    await picture("zoomed", false);
    await page.keyboard.press("f");
  });

  await step("the field is saved as a picture, the table as text, both with their time", async () => {
    const png = await saved(show("save-field"));
    assert.match(png.name, /^field_\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d\.\d{3}\.png$/);
    assert.deepEqual([...png.bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
    const size = await show("field").evaluate((canvas) => [canvas.width, canvas.height]);
    assert.deepEqual([png.bytes.readUInt32BE(16), png.bytes.readUInt32BE(20)], size, "as large as on the screen");
    const csv = await saved(show("save-table"));
    assert.match(csv.name, /^robots_.*\.csv$/);
    assert.equal(csv.bytes.toString().trim().split("\r\n").length, 1 + (await rows().count()));
  });

  await step("the divider moves by pointer and by key, and each window can be alone", async () => {
    const height = async () => (await show("field").boundingBox()).height;
    const before = await height();
    const bar = await show("divider").boundingBox();
    await page.mouse.move(bar.x + bar.width / 2, bar.y + bar.height / 2);
    await page.mouse.down();
    await page.mouse.move(bar.x + bar.width / 2, bar.y - 100, { steps: 5 });
    await page.mouse.up();
    const dragged = await height();
    assert.ok(Math.abs(before - dragged - 100) < 15, `100 px up, from ${before} to ${dragged}`);
    await show("divider").focus();
    await page.keyboard.press("ArrowDown");
    await until("it is higher", async () => (await height()) > dragged);
    await page.keyboard.press("Enter");
    const [other] = await Promise.all([page.waitForEvent("popup"), show("split-table").click()]);
    await until("the other window has the table", async () => (await other.locator("table.robots tbody tr").count()) >= Number(wanted));
    assert.equal(await other.locator('[data-show="field"]').count(), 0);
    assert.equal(await page.locator("table.robots").count(), 0, "this one has the field alone");
    await until("the other window has the time", () => other.locator('[data-show="play"]').isEnabled());
    await other.locator('[data-show="play"]').click();
    await until("both are paused", async () => /paused/.test(await condition()));
    // What was looked back at may be remembered less often than it came.
    await until("at the same time", async () => Math.abs((await told("t")) - (await other.evaluate(() => window.tassilo_monitor.t))) < 0.2);
    const first = (await shown_picture()).robots[0].id;
    await other.locator(`tr[data-robot="${first}"]`).click();
    await until("both chose the same robot", async () => (await show("robot").count()) === 1 && (await show("robot").getAttribute("aria-label")) === `Robot ${first}`);
    await page.keyboard.press("Escape");
    await other.locator('[data-show="live"]').click();
    await until("both are live", async () => (await condition()) === "live");
    await picture("table_alone", false, other);
    await other.close();
    await picture("field_alone", false);
    await page.getByRole("navigation").getByRole("link", { name: "Both" }).click();
    await page.locator("table.robots").waitFor();
  });

  await step("small screens, dark", async () => {
    const too_wide = () => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    for (const [name, width, height] of [["laptop", 1024, 700], ["phone", 390, 844]]) {
      await page.setViewportSize({ width, height });
      for (const colorScheme of ["light", "dark"]) {
        await drawn_after(() => page.emulateMedia({ colorScheme }));
        assert.ok((await too_wide()) <= 0, `${name}: ${await too_wide()} px too wide`);
        if (name === "laptop") assert.ok((await page.evaluate(() => document.documentElement.scrollHeight - innerHeight)) <= 0, "all fits the screen");
        await picture(`${name}_${colorScheme}`, name === "phone");
      }
    }
    await drawn_after(() => page.setViewportSize({ width: 1440, height: 1000 }));
    await picture("dark", false);
    await page.emulateMedia({ colorScheme: "light" });
  });

  await step("a lost connection is told, what is shown is marked as old, and it comes back by itself", () =>
    lose_connection({ context, picture, url, live: /^live$/ }));

  await end();
}

await run("monitor.mjs", main, { robots: { type: "string", default: "10" }, "least-rate": { type: "string", default: "0" }, only: { type: "string", default: "" } });
