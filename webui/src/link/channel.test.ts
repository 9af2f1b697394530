import { describe, expect, test } from "vitest";
import { numbers_from } from "../testing";
import { Channel, type ChannelState, type ChannelWorld, delay_before, first_delay_ms, longest_delay_ms, type Socket } from "./channel";

/// Sockets and time in the test's hands.
class World implements ChannelWorld {
  time = 0;
  sockets: (Socket & { closed: boolean })[] = [];
  private timers: { at: number; call: () => void }[] = [];
  fails = false;

  open(): Socket {
    if (this.fails) throw new Error("no sockets today");
    const socket = {
      binaryType: "", onopen: null, onmessage: null, onclose: null, closed: false,
      close() { this.closed = true; },
    };
    this.sockets.push(socket);
    return socket;
  }
  now(): number {
    return this.time;
  }
  after(ms: number, call: () => void): () => void {
    const timer = { at: this.time + ms, call };
    this.timers.push(timer);
    return () => { this.timers = this.timers.filter((other) => other !== timer); };
  }
  pass(ms: number): void {
    this.time += ms;
    const due = this.timers.filter(({ at }) => at <= this.time);
    this.timers = this.timers.filter(({ at }) => at > this.time);
    for (const { call } of due) call();
  }
  get last() {
    return this.sockets[this.sockets.length - 1]!;
  }
  get timers_left(): number {
    return this.timers.length;
  }
}

function begun() {
  const world = new World();
  const messages: unknown[] = [];
  const states: ChannelState["kind"][] = [];
  const channel = new Channel(world, (data) => messages.push(data), (state) => states.push(state.kind));
  channel.start();
  return { world, messages, states, channel };
}

describe("delays", () => {
  test("never shrink from try to try, and are bounded", () => {
    expect(delay_before(0)).toBe(first_delay_ms);
    for (let n = 0; n < 2000; ++n) {
      expect(delay_before(n + 1)).toBeGreaterThanOrEqual(delay_before(n));
      expect(delay_before(n)).toBeLessThanOrEqual(longest_delay_ms);
    }
  });

  test("grow while connections say nothing, and begin anew after a message", () => {
    const { world, channel } = begun();
    const waits: number[] = [];
    const lose = (): void => {
      world.last.onclose!();
      if (channel.state.kind === "waiting") waits.push(channel.state.until - world.time);
      world.pass(longest_delay_ms);
    };
    lose();
    world.last.onopen!();   // it opens, but there is no message
    lose();
    lose();
    world.last.onopen!();
    world.last.onmessage!({ data: "scene" });
    lose();
    expect(waits).toEqual([0, 1, 2, 0].map(delay_before));
  });
});

test("messages arrive in order, of all sockets one after another", () => {
  const { world, messages } = begun();
  world.last.onmessage!({ data: 1 });
  world.last.onmessage!({ data: 2 });
  world.last.onclose!();
  world.pass(first_delay_ms);
  world.last.onmessage!({ data: 3 });
  expect(messages).toEqual([1, 2, 3]);
});

test("an older socket is not listened to any more", () => {
  const { world, messages, channel, states } = begun();
  const old = world.last;
  old.onclose!();
  world.pass(first_delay_ms);
  const before = states.length;
  old.onopen!();
  old.onmessage!({ data: "late" });
  old.onclose!();
  expect(messages).toEqual([]);
  expect(states.length).toBe(before);
  expect(channel.state.kind).toBe("connecting");
});

test("trying at once ends the waiting, and only the waiting", () => {
  const { world, channel } = begun();
  channel.retry();
  expect(world.sockets.length).toBe(1);
  world.last.onclose!();
  channel.retry();
  expect(world.sockets.length).toBe(2);
  world.pass(longest_delay_ms);   // the timer is gone as well
  expect(world.sockets.length).toBe(2);
});

test("a socket that cannot even be made is tried again", () => {
  const { world, channel } = begun();
  world.last.onclose!();
  world.fails = true;
  world.pass(first_delay_ms);
  expect(channel.state.kind).toBe("waiting");
  world.fails = false;
  world.pass(longest_delay_ms);
  expect(channel.state.kind).toBe("connecting");
});

test("whatever happens, one socket at most is in use and one timer at most runs; stopped, there is none of either", () => {
  for (let seed = 0; seed < 50; ++seed) {
    const random = numbers_from(seed, 0, 1);
    const { world, channel, messages } = begun();
    for (let i = 0; i < 200; ++i) {
      const socket = world.sockets[Math.floor(random() * world.sockets.length)]!;
      const what = random();
      if (what < 0.3) socket.onclose!();
      else if (what < 0.4) socket.onopen!();
      else if (what < 0.5) socket.onmessage!({ data: i });
      else if (what < 0.6) channel.retry();
      else if (what < 0.65) channel.stop();
      else if (what < 0.75) channel.start();
      else world.pass(3000 * random());
      const timers = channel.state.kind === "waiting" ? 1 : 0;
      expect(world.timers_left, `seed ${seed}, step ${i}`).toBe(timers);
    }
    channel.stop();
    expect(world.timers_left).toBe(0);
    expect(world.last.closed || channel.state.kind === "closed").toBe(true);
    const [opened, heard] = [world.sockets.length, messages.length];
    for (const socket of world.sockets) {
      socket.onmessage!({ data: "after the end" });
      socket.onclose!();
    }
    world.pass(longest_delay_ms);
    expect([world.sockets.length, messages.length, channel.state.kind]).toEqual([opened, heard, "closed"]);
  }
});
