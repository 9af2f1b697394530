import { describe, expect, test } from "vitest";
import { Refused } from "../link/api";
import type { ChannelWorld, Socket } from "../link/channel";
import type { MonitorApi, MonitorState, TeamPicture } from "../link/monitor_api";
import { MonitorSession } from "./monitor_session";
import { pose, robot, team_picture } from "./testing";

/// A server whose answers wait until they are let go.
function made(state: Partial<MonitorState>) {
  const asked: number[] = [];
  const waiting: (() => void)[] = [];
  const trails: number[] = [];
  const news_after: number[] = [];
  const server = { refuses: "" };
  const api: MonitorApi = {
    state: async () => ({ version: "", mode: "live", field: null, begin: 100, end: 160, ...state }),
    at: (t) => new Promise<TeamPicture>((done, fail) => {
      asked.push(t);
      waiting.push(() => (server.refuses === "" ? done({ ...team_picture(t, [robot(1, {}, pose(0, 0))]), news: 3 }) : fail(new Refused(404, server.refuses))));
    }),
    trails: async (t) => { trails.push(t); return []; },
    news: async (after) => { news_after.push(after); return [1, 2, 3].filter((number) => number > after).map((number) => ({ number, t: 100 + number, robot: 1, text: "appeared" })); },
    picture: async () => null,
  };
  const sockets: Socket[] = [];
  const world = (): ChannelWorld => ({
    open: () => {
      const socket: Socket = { binaryType: "", onopen: null, onmessage: null, onclose: null, close: () => {} };
      sockets.push(socket);
      return socket;
    },
    now: () => performance.now(), after: () => () => {},
  });
  const session = new MonitorSession(api, world);
  const settle = () => new Promise((done) => setTimeout(done, 0));
  const answer = async (): Promise<void> => {
    waiting.shift()?.();
    await settle();
  };
  const hear = (t: number): void => sockets[0]!.onmessage!({ data: JSON.stringify(team_picture(t, [robot(1, {}, pose(0, 0))])) });
  return { session, asked, waiting, trails, news_after, sockets, server, settle, answer, hear };
}

describe("looking back", () => {
  test("one request is under way at a time, and the newest wanted time wins", async () => {
    const { session, asked, waiting, answer } = made({});
    await session.ask_state();
    session.tick(0);
    for (let i = 0; i < 10; ++i) {
      session.seek(110 + i);
      session.tick(16 * (i + 1));
    }
    expect(asked).toEqual([110]);
    await answer();
    expect(asked).toEqual([110, 119]);
    expect(waiting).toHaveLength(1);
    await answer();
    expect(session.feed.drawn.value?.t).toBe(119);
    session.tick(300);
    session.tick(316);
    expect(asked, "what is there is not asked for again").toEqual([110, 119]);
  });
  test("an answer that comes after it went live again is not shown", async () => {
    const { session, answer, hear, sockets } = made({});
    await session.ask_state();
    expect(sockets).toHaveLength(1);
    hear(159);
    session.tick(0);
    session.seek(120);
    session.tick(16);
    session.to_end();
    await answer();
    hear(160);
    session.tick(32);
    expect(session.feed.drawn.value?.t).toBe(160);
    expect(session.time.value?.moment.is_live).toBe(true);
  });
  test("pausing live asks for nothing: what is shown is of this time", async () => {
    const { session, asked, hear } = made({});
    await session.ask_state();
    hear(159.5);
    session.tick(0);
    session.toggle_play();
    session.tick(16);
    session.tick(32);
    expect(session.time.value?.moment).toMatchObject({ is_live: false, playing: false, t: 159.5 });
    expect(asked).toEqual([]);
  });
  test("where there is nothing it is said, what is shown stays, and it is asked again, but not at once", async () => {
    const { session, asked, answer, server } = made({ mode: "log" });
    server.refuses = "there is nothing of this time";
    await session.ask_state();
    session.tick(0);
    await answer();
    for (let now = 16; now < 900; now += 16) session.tick(now);
    expect(asked).toEqual([100]);
    session.tick(1100);
    expect(asked).toEqual([100, 100]);
    server.refuses = "";
    await answer();
    expect(session.feed.drawn.value?.t).toBe(100);
  });
  test("trails are asked for after a leap, and grow by what is shown otherwise", async () => {
    const { session, trails, answer, settle } = made({ mode: "log", step: 0.1 });
    await session.ask_state();
    let now = 0;
    const shown = async (): Promise<void> => {
      session.tick(now += 16);
      await answer();
      session.tick(now += 16);
      await settle();
    };
    await shown();
    expect(trails).toEqual([100]);
    for (let i = 0; i < 5; ++i) {
      session.step(1);
      await shown();
    }
    expect(trails).toEqual([100]);
    session.seek(140);
    await shown();
    expect(trails).toEqual([100, 140]);
  });
});

test("a log has no channel, begins at its beginning, and waits", async () => {
  const { session, sockets, asked } = made({ mode: "log" });
  await session.ask_state();
  session.tick(0);
  session.tick(5000);
  expect(sockets).toHaveLength(0);
  expect(asked).toEqual([100]);
  expect(session.time.value?.moment).toMatchObject({ is_live: false, playing: false, t: 100 });
});

test("nothing can be looked back at while the server remembers nothing", async () => {
  const { session, asked, hear } = made({ begin: null, end: null });
  await session.ask_state();
  hear(5);
  session.tick(0);
  session.seek(3);
  session.toggle_play();
  session.tick(300);
  expect(asked).toEqual([]);
  expect(session.time.value).toMatchObject({ can_look_back: false, moment: { is_live: true } });
});

test("news are asked for when there are new ones, once each", async () => {
  const { session, news_after, answer, settle } = made({ mode: "log" });
  await session.ask_state();
  session.tick(0);
  await answer();
  session.tick(16);
  await settle();
  for (let now = 32; now < 5000; now += 16) session.tick(now);
  expect(news_after).toEqual([0]);
  expect(session.news.value.map(({ number }) => number)).toEqual([1, 2, 3]);
});

test("Escape ends the innermost first", () => {
  const { session } = made({});
  session.selected.set(3);
  session.measure.set({ from: [0, 0], to: [1, 1] });
  expect(session.cancel()).toBe(true);
  expect([session.measure.value, session.selected.value]).toEqual([null, 3]);
  expect(session.cancel()).toBe(true);
  expect(session.selected.value).toBe(null);
  expect(session.cancel()).toBe(false);
});
