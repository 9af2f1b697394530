import { Observable } from "../link/observable";

/// Which windows the page shows: both, or one that was split off.
export const page_views = [
  { id: "both", title: "Both" },
  { id: "field", title: "Field" },
  { id: "table", title: "Table" },
] as const;
export type PageView = (typeof page_views)[number]["id"];

function view_of_address(): PageView {
  return page_views.find(({ id }) => location.hash === `#/${id}`)?.id ?? "both";
}

/// Follows the page's address.
export function page_view(): Observable<PageView> {
  const view = new Observable<PageView>(view_of_address());
  addEventListener("hashchange", () => view.set(view_of_address()));
  return view;
}

/// A window of its own; this page then shows the other one. Where the browser forbids new windows, it stays as it is.
export function split_off(view: "field" | "table"): void {
  const opened = open(`#/${view}`, `tassilo-monitor-${view}`, "popup,width=1200,height=760");
  if (opened !== null) location.hash = view === "field" ? "#/table" : "#/field";
}

const group_key = "tassilo.monitor.group";

/// Joins this page with the windows that were split off from it, which inherit its session's storage: what one says, all others hear. Null where browsers forbid it.
export function group_channel(): BroadcastChannel | null {
  try {
    const group = sessionStorage.getItem(group_key) ?? String(Math.random());
    sessionStorage.setItem(group_key, group);
    return new BroadcastChannel(`tassilo-monitor ${group}`);
  } catch {
    return null;
  }
}

/// Of ten robots with title and head, [px].
const height_of_table = 370;

/// Share of the height that is the field's, until somebody moves the divider: the table needs no more than ten rows, and gets no more than half.
export function usual_share(height: number): number {
  return Math.min(Math.max(1 - height_of_table / height, 0.5), 0.7);
}

export function share_within(share: number): number {
  return Math.min(Math.max(share, 0.2), 0.85);
}
