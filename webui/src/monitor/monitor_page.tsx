import { useEffect, useMemo, useState } from "preact/hooks";
import { useValue } from "../link/observable";
import { KeyHelp } from "../work_page";
import { Divider } from "./divider";
import { FieldWindow } from "./field_window";
import { key_help, press, release } from "./keys";
import { memory, type MonitorSession, remember } from "./monitor_session";
import { TableWindow } from "./state_table";
import { TimeBar } from "./time_bar";
import { page_view, page_views, type PageView, share_within, usual_share } from "./windows";

const remembered_share = "tassilo.monitor.share";

/// Above the windows, about, [px].
const height_of_bars = 115;

function remembered_number(key: string): number | null {
  const number = Number.parseFloat(memory(key) ?? "");
  return Number.isFinite(number) ? number : null;
}

/// Both windows of the monitor, or the one that was split off.
export function MonitorPage({ session }: { session: MonitorSession }) {
  const view = useValue(useMemo(page_view, []));
  useEffect(() => {
    const stop = new AbortController();
    addEventListener("keydown", (event) => {
      if (!event.defaultPrevented && press(session, event)) event.preventDefault();
    }, { signal: stop.signal });
    addEventListener("keyup", (event) => release(session, event), { signal: stop.signal });
    return () => stop.abort();
  }, [session]);
  useEffect(() => {
    document.title = view === "both" ? "Tassilo monitor" : `${page_views.find(({ id }) => id === view)!.title} · Tassilo monitor`;
  }, [view]);
  return (
    <div class={`monitor ${view}`}>
      <Bar session={session} view={view} />
      <TimeBar session={session} />
      <Notices session={session} />
      <Windows session={session} view={view} />
    </div>
  );
}

function Bar({ session, view }: { session: MonitorSession; view: PageView }) {
  const state = useValue(session.state);
  const condition = useValue(session.condition);
  const said = useValue(session.said);
  return (
    <header class="bar">
      <span class="brand">Tassilo monitor</span>
      <nav aria-label="Windows">
        {page_views.map(({ id, title }) => <a key={id} href={`#/${id}`} aria-current={view === id ? "page" : undefined}>{title}</a>)}
      </nav>
      <span class="faint source" data-show="source" title={state?.name}>{state?.name ?? ""}</span>
      <span class={`chip ${condition.tone}`}>
        <span class="dot" aria-hidden="true" />
        <span aria-hidden="true" data-show="condition">{condition.text}</span>
        <span class="unseen" role="status">{condition.text.replace(/\d+ s$/, "some seconds")}</span>
        {condition.text.startsWith("connection lost, next") && <button type="button" class="plain" onClick={() => session.retry()}>try now</button>}
      </span>
      <span class="unseen" role="status">{said}</span>
      <KeyHelp keys={key_help} />
    </header>
  );
}

/// Of the log, of the bus, and of robots: each also stands where it belongs.
function Notices({ session }: { session: MonitorSession }) {
  const damage = useValue(session.state)?.damage ?? "";
  const picture = useValue(session.feed.read);
  const words = [
    ...(damage === "" ? [] : [`the log is damaged: ${damage}`]),
    ...(picture?.troubles ?? []),
    ...(picture?.robots ?? []).flatMap(({ id, troubles }) => troubles.map((trouble) => `robot ${id}: ${trouble}`)),
  ];
  if (words.length === 0) return null;
  const text = words.join(" · ");
  return <p class="notice troubles" role="status" title={text} data-show="troubles">{text}</p>;
}

function Windows({ session, view }: { session: MonitorSession; view: PageView }) {
  const condition = useValue(session.condition);
  const [moved, set_moved] = useState<number | null>(remembered_number(remembered_share));
  const share = moved === null ? usual_share(innerHeight - height_of_bars) : share_within(moved);
  const move = (next: number | null): void => {
    set_moved(next);
    remember(remembered_share, next === null ? "" : next.toFixed(3));
  };
  // What is shown while nothing comes is from before; it must not look as if it were now.
  const is_old = condition.tone === "bad" || condition.text.startsWith("no team picture");
  return (
    <main class={is_old ? "windows old" : "windows"} style={{ "--above": `${share}fr`, "--below": `${1 - share}fr` }} data-show="content">
      <h1 class="unseen">Monitor</h1>
      {view !== "table" && <FieldWindow session={session} is_alone={view === "field"} />}
      {view === "both" && <Divider share={share} change={move} reset={() => move(null)} />}
      {view !== "field" && <TableWindow session={session} is_alone={view === "table"} />}
    </main>
  );
}
