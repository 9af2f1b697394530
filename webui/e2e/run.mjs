// What the tests in a browser share: arguments, the server, the browser, and waiting.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { accessSync, constants, mkdirSync } from "node:fs";
import path from "node:path";
import { parseArgs } from "node:util";
import { chromium } from "playwright-core";

function program_in_path(names) {
  for (const name of names) {
    for (const folder of (process.env.PATH ?? "").split(path.delimiter)) {
      try {
        accessSync(path.join(folder, name), constants.X_OK);
        return path.join(folder, name);
      } catch { /* not here */ }
    }
  }
  return "";
}

export const patience_ms = 20000;

/// Starts the server and waits for its address. `end` ends it, and waits for that.
function start_server([program, ...rest]) {
  return new Promise((resolve, reject) => {
    const child = spawn(program, rest, { stdio: ["ignore", "pipe", "pipe"] });
    let said = "";
    const gone = new Promise((done) => child.once("exit", done));
    const end = async () => {
      child.kill("SIGTERM");
      const stubborn = setTimeout(() => child.kill("SIGKILL"), 5000);
      await gone;
      clearTimeout(stubborn);
    };
    const timer = setTimeout(() => end().then(() => reject(new Error(`no address within ${patience_ms} ms; it said: ${said}`))), patience_ms);
    const listen = (data) => {
      said += data;
      const url = /https?:\/\/[^\s"']+(?=\s)/.exec(said)?.[0];
      if (url === undefined) return;
      clearTimeout(timer);
      resolve({ url, end });
    };
    child.stdout.on("data", listen);
    child.stderr.on("data", listen);
    child.once("error", reject);
    child.once("exit", (code) => {
      clearTimeout(timer);
      reject(new Error(`the server ended with ${code}; it said: ${said}`));
    });
  });
}

export async function until(what, holds, patience = patience_ms) {
  const end = Date.now() + patience;
  for (;;) {
    const result = await holds();
    if (result) return result;
    if (Date.now() > end) throw new Error(`waited ${patience} ms in vain: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

/// Runs `main(url, browser, screenshots, options)` as the command line says, and sets the exit code. `own` are options of this test, as of parseArgs.
export async function run(name, main, own = {}) {
  const { values: options, positionals: command } = parseArgs({
    options: { screenshots: { type: "string", default: "" }, browser: { type: "string", default: "" }, url: { type: "string", default: "" }, ...own },
    allowPositionals: true,
  });
  if ((options.url === "") === (command.length === 0)) {
    console.error(`${name}: needs either --url URL or -- COMMAND...`);
    process.exit(2);
  }
  const program = options.browser || program_in_path(["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"]);
  if (program === "") {
    console.log("skipped: no chromium-headless-shell or chromium; tools/install_deps.sh --references installs one");
    process.exit(77);
  }
  if (options.screenshots !== "") mkdirSync(options.screenshots, { recursive: true });
  const server = options.url === "" ? await start_server(command) : { url: options.url, end: async () => {} };
  let browser;
  try {
    browser = await chromium.launch({
      executablePath: program,
      args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
             "--disable-dev-shm-usage"],
    });
    await main(server.url, browser, options.screenshots, options);
    console.log("all steps passed");
  } catch (error) {
    console.error(error);
    process.exitCode = 1;
  } finally {
    await browser?.close();
    await server.end();
  }
}

/// Another page of `context` loses all its channels, says so and marks what it shows as old, and is live again by itself. `live`: what its condition says then.
export async function lose_connection({ context, picture, url, live }) {
  const other = await context.newPage();
  let lost = false;
  const sockets = [];
  await other.routeWebSocket(/\/ws\//, (socket) => {
    if (lost) return void socket.close();
    sockets.push(socket);
    socket.connectToServer();
  });
  await other.goto(new URL("/", url).href);
  const condition = other.locator('[data-show="condition"]');
  const says = (words) => until(`the page says ${words}`, async () => words.test((await condition.innerText()).trim()));
  await says(live);
  lost = true;
  for (const socket of sockets) await socket.close();
  await says(/connection lost, next try in/);
  await other.locator('[data-show="content"].old').waitFor();
  await picture("lost", false, other);
  lost = false;
  await says(live);
  await other.close();
}

/// A page of its own to work on. `prefix` begins the names of its screenshots; `refusals` are the answers that the test provokes, and that the browser tells as errors.
/// picture(name), step(name, work), show(name), api(method, path, data); end() closes it, and fails when the page had errors.
export async function open_page(browser, url, { screenshots, prefix, refusals }) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, colorScheme: "light" });
  context.setDefaultTimeout(patience_ms);
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("console", (message) => {
    // 503: a server answers before its source is open, and pages ask again.
    if (message.type() === "error" && !refusals.test(message.text()) && !/status of 503/.test(message.text())) faults.push(`console: ${message.text()}`);
  });
  let number = 0;
  return {
    context, page, faults,
    picture: async (name, full = true, of = page) => {
      if (screenshots === "") return;
      await of.evaluate(() => scrollTo(0, 0));   // the bar stays at the top of the screen, not of the picture
      await of.screenshot({ path: path.join(screenshots, `${prefix}${String(++number).padStart(2, "0")}_${name}.png`), fullPage: full });
    },
    step: async (name, work) => {
      await work();
      console.log(`ok: ${name}`);
    },
    show: (name) => page.locator(`[data-show="${name}"]`),
    api: async (method, name, data) => {
      const response = await context.request.fetch(new URL(name, url).href, { method, ...(data === undefined ? {} : { data }) });
      assert.ok(response.ok(), `${method} ${name}: ${response.status()} ${response.ok() ? "" : await response.text()}`);
      return response.json();
    },
    end: async () => {
      await context.close();
      assert.deepEqual(faults, []);
    },
  };
}
