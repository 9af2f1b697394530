import { expect, test } from "vitest";
import { team_picture, team_thing } from "./testing";
import { opponents_words, team_ball_words, worst_sigma } from "./team_words";

test("who sees the ball is told, how long ago and how sure; or that nobody does", () => {
  expect(team_ball_words(team_picture(1))).toBe("nobody knows where it is");
  expect(team_ball_words({ team_ball: { ...team_thing(), robots: [2, 7], age: 0.42 } })).toBe("seen by 2, 7 · 0.4\u00a0s\u00a0ago · ±\u00a05.0\u00a0cm");
  expect(team_ball_words({ team_ball: { ...team_thing(), robots: [], cov: [] } })).toBe("seen by nobody of late · 0.0\u00a0s\u00a0ago");
});

test("the worst direction is no better than either axis, and the same however the ball is turned", () => {
  for (let angle = 0; angle < 3.2; angle += 0.1) {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const [xx, xy, yy] = [0.09 * c * c + 0.01 * s * s, 0.08 * c * s, 0.09 * s * s + 0.01 * c * c];
    expect(worst_sigma([xx, xy, 0, 0, xy, yy])).toBeCloseTo(0.3);
  }
});

test("opponents are counted", () => {
  const opponent = { ...team_thing(), id: 1, team: "magenta" as const };
  expect([[], [opponent], [opponent, opponent]].map((opponents) => opponents_words({ opponents }))).toEqual(["no opponent is known", "1 opponent", "2 opponents"]);
});
