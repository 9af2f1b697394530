import { describe, expect, test } from "vitest";
import type { Socket } from "../link/channel";
import { DrawStatistics } from "./draw_statistics";
import { RobotPictures } from "./robot_pictures";
import { TeamFeed } from "./team_feed";
import { team_picture } from "./testing";

const turns = async (): Promise<void> => {
  for (let i = 0; i < 10; ++i) await Promise.resolve();
};

describe("team pictures", () => {
  const text = (t: number): string => JSON.stringify(team_picture(t));
  test("the newest is drawn, older ones are passed over, tables change less often", () => {
    const feed = new TeamFeed(200);
    let read = 0;
    feed.read.subscribe(() => ++read);
    for (let i = 0; i < 60; ++i) {
      feed.message(text(i), i * 33);
      if (i % 2 === 1) feed.tick(i * 33, true);
      if (i % 2 === 1) expect(feed.drawn.value?.t).toBe(i);
    }
    expect(feed.messages).toBe(60);
    expect(read).toBeLessThanOrEqual(11);
  });
  test("while one looks back, what comes is not shown, and back live it is", () => {
    const feed = new TeamFeed();
    feed.message(text(1), 0);
    feed.tick(0, true);
    feed.show(team_picture(0.5));
    feed.message(text(2), 10);
    feed.tick(10, false);
    expect(feed.drawn.value?.t).toBe(0.5);
    feed.tick(20, true);
    expect(feed.drawn.value?.t).toBe(2);
  });
  test("what is no team picture is counted, and the one before stays", () => {
    const feed = new TeamFeed();
    feed.message(text(1), 0);
    feed.tick(0, true);
    feed.message("{", 1);
    feed.tick(1, true);
    expect([feed.broken, feed.drawn.value?.t]).toEqual([1, 1]);
  });
});

describe("pictures of a robot", () => {
  class FakeSocket implements Socket {
    binaryType = "";
    onopen = null;
    onmessage: ((event: { data: unknown }) => void) | null = null;
    onclose = null;
    closed = false;
    constructor(readonly path: string) {}
    close(): void { this.closed = true; }
  }
  const made = () => {
    const sockets: FakeSocket[] = [];
    const asked: [number, number][] = [];
    const closed: string[] = [];
    const pictures = new RobotPictures(
      { picture: async (robot, t) => { asked.push([robot, t]); return t < 5 ? null : new Blob([`${robot} at ${t}`]); } },
      (path) => ({ open: () => { const socket = new FakeSocket(path); sockets.push(socket); return socket; }, now: () => 0, after: () => () => {} }),
      async (blob) => { const name = await blob.text(); return { name, close: () => closed.push(name) } as unknown as ImageBitmap; });
    const shown = (): string | undefined => (pictures.picture.value as unknown as { name: string } | null)?.name;
    return { pictures, sockets, asked, closed, shown };
  };
  const settle = () => new Promise((done) => setTimeout(done, 5));
  const live = (id: number, has_picture = true) => ({ id, robot: { has_picture }, t: null, playing: true });

  test("the channel is open only while it is looked at, and of one robot only", async () => {
    const { pictures, sockets, shown } = made();
    pictures.follow(live(3), 0);
    pictures.follow(live(3), 10);
    expect(sockets.map(({ path }) => path)).toEqual(["/ws/picture3"]);
    sockets[0]!.onmessage!({ data: new Blob(["three"]) });
    await settle();
    expect(shown()).toBe("three");
    pictures.follow(live(4), 20);
    expect(sockets.map(({ closed }) => closed)).toEqual([true, false]);
    expect(shown(), "another robot's picture is not its own").toBe(undefined);
    pictures.follow(null, 30);
    expect(sockets.every(({ closed }) => closed)).toBe(true);
    expect(pictures.is_listening).toBe(false);
  });
  test("who sends none is not listened to, and it is said", () => {
    const { pictures, sockets } = made();
    pictures.follow(live(3, false), 0);
    expect(sockets).toHaveLength(0);
    expect(pictures.words.value).toBe("robot 3 sends no pictures");
    pictures.follow({ id: 3, robot: null, t: null, playing: true }, 0);
    expect(pictures.words.value).toBe("robot 3 is not there");
  });
  test("of the past they are asked for, once a time; where there is none it is said", async () => {
    const { pictures, sockets, asked, shown, closed } = made();
    const past = (t: number) => ({ id: 2, robot: { has_picture: true }, t, playing: false });
    pictures.follow(past(7), 0);
    pictures.follow(past(7), 10);
    await settle();
    expect(asked).toEqual([[2, 7]]);
    expect(shown()).toBe("2 at 7");
    pictures.follow(past(3), 20);
    await settle();
    pictures.follow(past(3), 30);
    expect(shown()).toBe(undefined);
    expect(pictures.words.value).toBe("no picture of this time");
    expect(closed).toEqual(["2 at 7"]);
    expect(sockets).toHaveLength(0);
  });
  test("while it is played, no more often than ten times a second", async () => {
    const { pictures, asked } = made();
    for (let i = 0; i < 60; ++i) {
      pictures.follow({ id: 2, robot: null, t: 10 + i / 30, playing: true }, i * 33);
      await turns();
    }
    expect(asked.length).toBeLessThanOrEqual(21);
  });
});

test("what was drawn is counted, of the last second and with its gaps", () => {
  const statistics = new DrawStatistics();
  for (let t = 0; t <= 3000; t += 50) if (t < 1000 || t > 1400) statistics.add(t, 2);
  expect(statistics.per_second(3000)).toBe(20);
  expect(statistics.longest_gap_ms(3000)).toBe(500);
  expect(statistics.longest_gap_ms(4000), "nothing since is a gap, too").toBe(1000);
  expect(statistics.mean_ms).toBeCloseTo(2);
});
