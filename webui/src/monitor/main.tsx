import { render } from "preact";
import "../style.css";
import "./monitor.css";
import { page_place } from "./field_pointer";
import { MonitorPage } from "./monitor_page";
import { MonitorSession } from "./monitor_session";
import { group_channel } from "./windows";

const session = new MonitorSession();
session.start();
const group = group_channel();
if (group !== null) session.join(group);

/// For tests and for whoever measures the page.
const monitor = {
  /// Of the field window.
  get drawn() { return session.statistics.drawn; },
  /// Of the last second.
  get drawn_per_second() { return session.statistics.per_second(performance.now()); },
  /// Team pictures that came.
  get messages() { return session.feed.messages; },
  /// Between two drawings of the last 5 s.
  get longest_gap_ms() { return session.statistics.longest_gap_ms(performance.now()); },
  /// A drawing takes, without what the browser does of its own afterwards; mean of late.
  get draw_ms() { return session.statistics.mean_ms; },
  /// Of the team picture that is shown. [s]
  get t() { return session.feed.drawn.value?.t ?? null; },
  get picture() { return session.feed.drawn.value; },
  /// Is the channel of a robot's pictures open?
  get is_listening() { return session.pictures.is_listening; },
  /// Of a robot, in pixels of the page; null without a pose.
  place_of(id: number) { return page_place(session, document.querySelector<HTMLCanvasElement>('[data-show="field"]')!, id); },
};
declare global {
  interface Window { tassilo_monitor: typeof monitor }
}
window.tassilo_monitor = monitor;

render(<MonitorPage session={session} />, document.getElementById("app")!);
