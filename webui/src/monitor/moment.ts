/// The time that is shown: the newest as it comes, or one that was looked back at.
export interface Moment {
  readonly is_live: boolean;
  /// Of what was looked back at: does it go on? Live always does.
  readonly playing: boolean;
  /// [s]
  readonly t: number;
  readonly speed: number;
}

/// What can be looked at, [s].
export interface Span {
  readonly begin: number;
  readonly end: number;
}

export type Mode = "live" | "log";

export const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10] as const;

/// A log begins at its beginning and waits; a game is looked at as it is.
export function first_moment(mode: Mode, span: Span): Moment {
  return mode === "live" ? { is_live: true, playing: true, t: span.end, speed: 1 } : { is_live: false, playing: false, t: span.begin, speed: 1 };
}

function within(t: number, { begin, end }: Span): number {
  return Math.min(Math.max(t, begin), Math.max(begin, end));
}

/// After so many seconds of the page's clock. What is no longer remembered is not shown any more; playing on to the present is live.
export function advanced(moment: Moment, mode: Mode, span: Span, seconds: number): Moment {
  if (moment.is_live) return moment.t === span.end ? moment : { ...moment, t: span.end };
  const t = moment.playing ? moment.t + moment.speed * seconds : moment.t;
  if (moment.playing && t >= span.end) return mode === "live" ? live(moment, span) : { ...moment, playing: false, t: within(span.end, span) };
  const kept = within(t, span);
  return kept === moment.t ? moment : { ...moment, t: kept };
}

export function live(moment: Moment, span: Span): Moment {
  return { ...moment, is_live: true, playing: true, t: span.end, speed: 1 };
}

/// Whoever comes from live wants to look at this moment.
export function sought(moment: Moment, span: Span, t: number): Moment {
  return { ...moment, is_live: false, playing: moment.playing && !moment.is_live, t: within(t, span) };
}

export function stepped(moment: Moment, span: Span, seconds: number): Moment {
  return { ...moment, is_live: false, playing: false, t: within(moment.t + seconds, span) };
}

/// Play or pause; at a log's end it plays from its beginning.
export function toggled(moment: Moment, span: Span): Moment {
  if (moment.is_live) return { ...moment, is_live: false, playing: false };
  if (moment.playing) return { ...moment, playing: false };
  return { ...moment, playing: true, t: moment.t >= span.end ? span.begin : moment.t };
}

export function with_speed(moment: Moment, speed: number): Moment {
  return { ...moment, speed: Math.min(Math.max(speed, speeds[0]), speeds[speeds.length - 1]!) };
}

/// The next one of the speeds, up or down.
export function next_speed(speed: number, up: boolean): number {
  const others = speeds.filter((other) => (up ? other > speed : other < speed));
  return (up ? others[0] : others[others.length - 1]) ?? speed;
}

/// Times before are no dates, but of a log whose clock began with the source, [s].
const first_date = 1e9;

const two = (value: number): string => String(value).padStart(2, "0");

/// As a clock on the wall shows it, to a tenth of a second; of a log without dates, since its clock's beginning.
export function clock_words(t: number): string {
  const tenths = Math.floor(t * 10 + 1e-6);
  if (t < first_date) return `${Math.floor(tenths / 600)}:${two(Math.floor(tenths / 10) % 60)}.${tenths % 10}`;
  const date = new Date(tenths * 100);
  return `${two(date.getHours())}:${two(date.getMinutes())}:${two(date.getSeconds())}.${tenths % 10}`;
}

/// For a file's name: sorts by time, no colons.
export function file_words(t: number): string {
  const thousandths = String(Math.floor((t % 1) * 1000 + 1e-3)).padStart(3, "0");
  if (t < first_date) return `t${Math.floor(t)}.${thousandths}`;
  const date = new Date(t * 1000);
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())}_${two(date.getHours())}-${two(date.getMinutes())}-${two(date.getSeconds())}.${thousandths}`;
}

/// How long, in the unit a person would choose; always short.
export function duration_words(seconds: number): string {
  const s = Math.max(seconds, 0);
  if (s < 9.95) return `${s.toFixed(1)} s`;
  if (s < 99.5) return `${Math.round(s)} s`;
  const minutes = Math.floor(Math.round(s) / 60);
  if (minutes < 60) return `${minutes}:${two(Math.round(s) % 60)} min`;
  return `${Math.floor(minutes / 60)}:${two(minutes % 60)} h`;
}

/// Live, but nothing came for so long, is not now any more, [s].
export const longest_now = 1.5;

/// Where in what can be looked at the moment is. silence  since the last news of live, [s]
export function age_words(moment: Moment, mode: Mode, span: Span, silence = 0): string {
  if (mode === "log") return `${duration_words(moment.t - span.begin)} of ${duration_words(span.end - span.begin)}`;
  if (moment.is_live) return silence > longest_now ? `${duration_words(silence)} ago` : "now";
  return `${duration_words(span.end - moment.t)} ago`;
}
