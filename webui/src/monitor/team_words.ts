import { covariance_ellipse } from "../canvas/ellipse";
import { plus_minus } from "../format";
import type { TeamPicture } from "../link/monitor_api";
import { duration_words } from "./moment";

/// Standard deviation along the worst direction, [m]; covariance  row-major x, y, vx, vy.
export function worst_sigma(covariance: readonly number[]): number {
  return covariance_ellipse([0, 0], covariance, 1, 4)?.major ?? NaN;
}

/// Who sees the team's ball, how old that is, and how sure.
export function team_ball_words({ team_ball }: Pick<TeamPicture, "team_ball">): string {
  if (team_ball === undefined) return "nobody knows where it is";
  const { robots, age, cov } = team_ball;
  return [robots.length === 0 ? "seen by nobody of late" : `seen by ${robots.join(", ")}`, `${duration_words(age)} ago`.replace(/ /g, "\u00a0"), plus_minus(worst_sigma(cov))].filter((words) => words !== "").join(" · ");
}

export function opponents_words({ opponents }: Pick<TeamPicture, "opponents">): string {
  return opponents.length === 0 ? "no opponent is known" : opponents.length === 1 ? "1 opponent" : `${opponents.length} opponents`;
}
