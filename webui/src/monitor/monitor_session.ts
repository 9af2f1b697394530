import { reason } from "../link/api";
import { browser_world, Channel, type ChannelWorld } from "../link/channel";
import { type Condition, condition_of } from "../link/condition";
import { type MonitorApi, monitor_api, type MonitorState, type NewsItem, type TeamPicture, type Trail } from "../link/monitor_api";
import { again_and_again, on_every_frame } from "../link/loops";
import { NewestDecoder } from "../link/newest";
import { Observable } from "../link/observable";
import type { FieldCamera } from "./field_camera";
import { DrawStatistics } from "./draw_statistics";
import type { FieldContent } from "./field_drawing";
import { type Layers, layers_from } from "./layers";
import type { Measure } from "./measuring";
import { advanced, first_moment, live, type Mode, type Moment, next_speed, sought, type Span, stepped, toggled, with_speed } from "./moment";
import { RobotPictures } from "./robot_pictures";
import { TeamFeed } from "./team_feed";
import { trail_seconds, Trails } from "./trails";

/// What the time bar shows.
export interface TimeView {
  readonly mode: Mode;
  readonly moment: Moment;
  readonly span: Span;
  /// Is there anything to look back at?
  readonly can_look_back: boolean;
  /// Live: since the last team picture came. [s]
  readonly silence: number;
}

/// What windows that belong together tell each other: all show the same time and the same robot. "hello": a new one asks.
type Told = "hello" | { readonly moment: Moment; readonly selected: number | null };

const remembered_layers = "tassilo.monitor.layers";

/// Between two pictures of the past, where the server does not say, [s].
const usual_step = 1 / 30;
/// While the past is played, pictures are asked for no more often than they are made, [ms].
const play_interval_ms = 30;
/// What was refused, or could not be had, is asked for again after this, [ms].
const again_ms = 1000;
/// Numbers that change faster cannot be read, [ms].
const publish_interval_ms = 200;
/// Older ones are forgotten.
const most_news = 500;
/// Trails grow by what is shown; after a leap they are asked for, [s].
const longest_stride = 0.25;

/// Everything between the monitor's page and the server, for as long as the page is open.
export class MonitorSession {
  readonly feed = new TeamFeed();
  readonly trails = new Trails();
  readonly statistics = new DrawStatistics();
  readonly state = new Observable<MonitorState | null>(null);
  readonly time = new Observable<TimeView | null>(null);
  readonly condition = new Observable<Condition>({ tone: "warning", text: "connecting" });
  readonly news = new Observable<readonly NewsItem[]>([]);
  readonly selected = new Observable<number | null>(null);
  readonly layers: Observable<Layers>;
  readonly camera = new Observable<FieldCamera>(null);
  readonly measure = new Observable<Measure | null>(null);
  /// Is one finger to measure? A mouse always does.
  readonly measuring = new Observable(false);
  /// Only read aloud.
  readonly said = new Observable("");
  readonly pictures: RobotPictures;
  /// Called once a picture of the screen, after the newest was taken.
  readonly on_screen = new Set<(now: number) => void>();
  /// The trails were replaced.
  readonly trails_changed = new Observable(0);
  private moment: Moment = { is_live: true, playing: true, t: 0, speed: 1 };
  private asked_state = 0;
  private trouble = "";
  private past_trouble = "";
  private wanted_t: number | null = null;
  private wanted_at = -Infinity;
  private last_tick: number | null = null;
  private last_publish = -Infinity;
  private last_news = -Infinity;
  /// Of the news, all that there are up to this number are known.
  private news_until = 0;
  private last_shown: number | null = null;
  private others: BroadcastChannel | null = null;
  /// What another window told before the server did.
  private told_early: Moment | null = null;
  private readonly channel: Channel;
  private readonly past: NewestDecoder<number, TeamPicture | null>;
  private readonly past_trails: NewestDecoder<number, { t: number; trails: Trail[] }>;

  constructor(private readonly api: MonitorApi = monitor_api, world: (path: string) => ChannelWorld = browser_world) {
    this.layers = new Observable(layers_from(memory(remembered_layers)));
    this.pictures = new RobotPictures(api, world);
    this.channel = new Channel(world("/ws/team"), (data) => this.feed.message(String(data), performance.now()), () => this.judge());
    this.past = new NewestDecoder((t) => this.ask_past(t), (picture) => {
      if (picture !== null && !this.moment.is_live && picture.t !== this.feed.drawn.value?.t) this.feed.show(picture);
    });
    this.past_trails = new NewestDecoder(async (t) => ({ t, trails: await api.trails(t, trail_seconds) }), ({ t, trails }) => {
      this.trails.take(trails, t);
      this.trails_changed.set(this.trails_changed.value + 1);
    });
  }

  /// From now on, windows that belong together show the same.
  join(channel: BroadcastChannel): void {
    this.others = channel;
    channel.onmessage = ({ data }: MessageEvent<Told>) => {
      if (data === "hello") return this.tell();
      this.selected.set(data.selected);
      if (this.can_look_back) this.take(data.moment);
      else this.told_early = data.moment;
    };
    channel.postMessage("hello" satisfies Told);
  }

  private tell(): void {
    this.others?.postMessage({ moment: this.current(), selected: this.selected.value } satisfies Told);
  }

  start(): void {
    on_every_frame((now) => {
      this.tick(now);
      for (const call of this.on_screen) call(now);
    });
    again_and_again(() => this.ask_state(), 1000);
    setInterval(() => this.judge(), 250);
    addEventListener("online", () => this.retry());
    // Nobody looks: the radio link has better things to carry, and the robot need not draw.
    document.addEventListener("visibilitychange", () => this.follow_picture(performance.now()));
  }

  retry(): void {
    this.channel.retry();
  }

  get mode(): Mode {
    return this.state.value?.mode ?? "live";
  }

  /// What the field window shows now.
  content(): FieldContent {
    return {
      picture: this.feed.drawn.value, plan: this.state.value?.field ?? null, layers: this.layers.value, trails: this.trails, camera: this.camera.value,
      selected: this.selected.value, measure: this.measure.value,
    };
  }

  toggle_layer(key: keyof Layers): void {
    this.layers.set({ ...this.layers.value, [key]: !this.layers.value[key] });
    remember(remembered_layers, JSON.stringify(this.layers.value));
  }

  select(id: number | null): void {
    this.selected.set(id);
    this.tell();
    this.said.set(id === null ? "no robot is chosen" : `robot ${id}`);
  }

  /// The next one by number, or the one before.
  select_next(by: 1 | -1): void {
    const ids = (this.feed.drawn.value?.robots ?? []).map(({ id }) => id);
    if (ids.length === 0) return;
    const at = this.selected.value === null ? (by > 0 ? -1 : 0) : ids.indexOf(this.selected.value);
    this.select(ids[(at + by + ids.length) % ids.length]!);
  }

  /// Escape ends the innermost first; tells whether there was anything to end.
  cancel(): boolean {
    if (this.measure.value !== null || this.measuring.value) {
      this.measure.set(null);
      this.measuring.set(false);
    } else if (this.selected.value !== null) {
      this.select(null);
    } else {
      return false;
    }
    return true;
  }

  // Time

  toggle_play(): void {
    this.go(toggled(this.current(), this.span()));
  }

  seek(t: number): void {
    this.go(sought(this.current(), this.span(), t));
  }

  step(pictures: number): void {
    this.move(pictures * (this.state.value?.step ?? usual_step));
  }

  move(seconds: number): void {
    this.go(stepped(this.current(), this.span(), seconds));
  }

  to_begin(): void {
    this.seek(this.span().begin);
  }

  /// Live, or a log's end.
  to_end(): void {
    if (this.mode === "live") this.go(live(this.moment, this.span()));
    else this.seek(this.span().end);
  }

  set_speed(speed: number): void {
    this.go(with_speed(this.current(), speed));
  }

  change_speed(up: boolean): void {
    if (!this.moment.is_live) this.set_speed(next_speed(this.moment.speed, up));
  }

  private get can_look_back(): boolean {
    return this.state.value !== null && this.state.value.begin !== null && this.state.value.end !== null;
  }

  private span(now = performance.now()): Span {
    const { begin = null, end = null } = this.state.value ?? {};
    const drawn = this.feed.drawn.value?.t ?? 0;
    if (end === null) return { begin: drawn, end: drawn };
    // The server's clock goes on between two answers.
    const last = this.mode === "live" ? end + (now - this.asked_state) / 1000 : end;
    return { begin: begin ?? last, end: last };
  }

  /// Live is what is shown, which is a little before the newest.
  private current(): Moment {
    return this.moment.is_live ? { ...this.moment, t: this.feed.drawn.value?.t ?? this.span().end } : this.moment;
  }

  private go(moment: Moment): void {
    if (!this.can_look_back) return;
    this.take(moment);
    this.tell();
  }

  private take(moment: Moment): void {
    const was_live = this.moment.is_live;
    this.moment = moment;
    this.wanted_at = -Infinity;
    if (moment.is_live && !was_live) this.past_trouble = "";
    // What is shown is of this time already.
    if (was_live && moment.t === this.feed.drawn.value?.t) this.wanted_t = moment.t;
    this.publish(performance.now());
    this.judge();
  }

  /// Once a picture of the screen.
  tick(now: number): void {
    const elapsed = this.last_tick === null ? 0 : Math.min((now - this.last_tick) / 1000, 1);
    this.last_tick = now;
    const was_live = this.moment.is_live;
    if (this.can_look_back) this.moment = advanced(this.moment, this.mode, this.span(), elapsed);
    if (this.moment.is_live) this.wanted_t = null;
    else this.want(now);
    this.feed.tick(now, this.moment.is_live && this.mode === "live");
    const picture = this.feed.drawn.value;
    if (picture !== null && picture.t !== this.last_shown) {
      const stride = this.last_shown === null ? Infinity : picture.t - this.last_shown;
      this.trails.add(picture);
      if (this.can_look_back && (stride < 0 || stride > longest_stride)) this.past_trails.put(picture.t);
      this.last_shown = picture.t;
    }
    if (picture !== null) this.ask_news(picture.news, now);
    this.follow_picture(now);
    if (now - this.last_publish >= publish_interval_ms || was_live !== this.moment.is_live) this.publish(now);
  }

  private want(now: number): void {
    const { t, playing } = this.moment;
    const is_asked = t === this.wanted_t && (this.past_trouble === "" || now - this.wanted_at < again_ms);
    if (is_asked || (playing && now - this.wanted_at < play_interval_ms)) return;
    [this.wanted_t, this.wanted_at] = [t, now];
    this.past.put(t);
  }

  private async ask_past(t: number): Promise<TeamPicture | null> {
    try {
      const picture = await this.api.at(t);
      this.past_trouble = "";
      return picture;
    } catch (error) {
      this.past_trouble = reason(error);
      return null;
    }
  }

  private follow_picture(now: number): void {
    const id = this.selected.value;
    if (id === null || document.hidden) return this.pictures.follow(null, now);
    const picture = this.feed.drawn.value;
    const robot = picture?.robots.find((other) => other.id === id) ?? null;
    this.pictures.follow({ id, robot, t: this.moment.is_live ? null : (picture?.t ?? this.moment.t), playing: this.moment.playing }, now);
  }

  private publish(now: number): void {
    this.last_publish = now;
    if (this.state.value === null) return;
    this.time.set({ mode: this.mode, moment: this.current(), span: this.span(now), can_look_back: this.can_look_back, silence: (this.feed.silence(now) ?? 0) / 1000 });
  }

  /// Once a second.
  async ask_state(): Promise<void> {
    try {
      const state = await this.api.state();
      const before = this.state.value;
      this.asked_state = performance.now();
      this.trouble = "";
      // Canvases need not be drawn anew for the span.
      this.state.set(before !== null && JSON.stringify(before.field) === JSON.stringify(state.field) ? { ...state, field: before.field } : state);
      if (before === null || before.mode !== state.mode) this.begin(state);
    } catch (error) {
      this.trouble = reason(error);
    }
    this.judge();
  }

  private begin({ mode }: MonitorState): void {
    this.moment = first_moment(mode, this.span());
    if (mode === "live") this.channel.start();
    else this.channel.stop();
    if (this.told_early !== null) this.take(this.told_early);
    this.told_early = null;
    this.publish(performance.now());
  }

  /// newest  number that there is of them
  private ask_news(newest: number, now: number): void {
    if (this.moment.is_live && newest < this.news_until) {   // the server was started anew, and counts anew
      this.news_until = 0;
      this.news.set([]);
    }
    if (newest <= this.news_until || now - this.last_news < again_ms) return;
    this.last_news = now;
    const after = this.news_until;
    void this.api.news(after).then((news) => {
      if (after !== this.news_until) return;
      this.news_until = Math.max(newest, ...news.map(({ number }) => number));
      this.news.set([...this.news.value, ...news].slice(-most_news));
    }, () => { /* asked again */ });
  }

  private judge(): void {
    const condition = this.condition_now(performance.now());
    const shown = this.condition.value;
    if (shown.text !== condition.text || shown.tone !== condition.tone) this.condition.set(condition);
  }

  private condition_now(now: number): Condition {
    if (this.state.value === null) return { tone: this.trouble === "" ? "warning" : "bad", text: this.trouble || "connecting" };
    if (this.mode === "log") {
      if (this.trouble !== "") return { tone: "bad", text: `connection lost: ${this.trouble}` };
      if (this.past_trouble !== "") return { tone: "warning", text: this.past_trouble };
      return { tone: "good", text: this.moment.playing ? "log, playing" : "log, paused" };
    }
    const condition = condition_of({
      scene: this.channel.state, frozen: false, ended: false, trouble: this.trouble, silence_ms: this.feed.silence(now), now,
    }, "team picture");
    if (this.moment.is_live || condition.tone === "bad") return condition;
    return { tone: "warning", text: this.past_trouble || (this.moment.playing ? "looking back, playing" : "looking back, paused") };
  }
}

/// Browsers may forbid it; then nothing is remembered.
export function memory(key: string): string | null {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(key, value);
  } catch {
    // as well
  }
}
