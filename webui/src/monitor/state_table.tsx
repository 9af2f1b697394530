import { useValue } from "../link/observable";
import { count, fixed } from "../format";
import type { TeamPicture } from "../link/monitor_api";
import { columns, table_csv } from "./columns";
import { download } from "./download";
import { file_words } from "./moment";
import type { MonitorSession } from "./monitor_session";
import { split_off } from "./windows";

/// What each robot says of itself, and how well it is heard.
export function TableWindow({ session, is_alone }: { session: MonitorSession; is_alone: boolean }) {
  const picture = useValue(session.feed.read);
  const selected = useValue(session.selected);
  const robots = picture === null ? [] : [...picture.robots].sort((a, b) => a.id - b.id);
  const save = (): void => {
    if (picture !== null) download(new Blob([table_csv(picture.t, robots)], { type: "text/csv" }), `robots_${file_words(picture.t)}.csv`);
  };
  return (
    <section class="window table-window" aria-labelledby="table-title">
      <header>
        <h2 id="table-title">Robots</h2>
        <span class="faint counts" data-show="counts">{picture && counts_words(picture)}</span>
        <div class="actions">
          <button type="button" title="save the table as it is shown (c)" disabled={picture === null} onClick={save} data-show="save-table">CSV</button>
          {!is_alone && <button type="button" title="the table in a window of its own" onClick={() => split_off("table")} data-show="split-table">Split off</button>}
        </div>
      </header>
      <div class="wide" tabIndex={0} role="region" aria-labelledby="table-title">
        <table class="robots" style={{ width: `${columns.reduce((sum, column) => sum + column.width_em, 0)}em` }}>
          {/* The last one takes what is left. */}
          <colgroup>{columns.map(({ key, width_em }, i) => <col key={key} style={i + 1 < columns.length ? { width: `${width_em}em` } : {}} />)}</colgroup>
          <thead>
            <tr>
              {columns.map(({ key, title, unit, hint, is_number }) => (
                <th key={key} scope="col" class={is_number ? "number" : undefined} title={hint}>{title}<small>{unit || "\u00a0"}</small></th>
              ))}
            </tr>
          </thead>
          <tbody>
            {robots.map((robot) => (
              <tr key={robot.id} class={`${robot.presence} ${robot.id === selected ? "chosen" : ""}`} data-robot={robot.id} onClick={() => session.select(robot.id)}>
                {columns.map((column) => {
                  const text = column.text(robot);
                  if (column.key === "id") {
                    return (
                      <th key="id" scope="row" class="number">
                        <button type="button" class={`robot-chip ${robot.team}`} aria-pressed={robot.id === selected} aria-label={`robot ${robot.id}`}>{text}</button>
                      </th>
                    );
                  }
                  const tone = text === "–" && column.key !== "pose" ? "faint" : (column.tone?.(robot) ?? "");
                  return <td key={column.key} class={`${column.is_number ? "number " : ""}${tone}`} title={column.is_number ? undefined : text} data-column={column.key}>{text}</td>;
                })}
              </tr>
            ))}
          </tbody>
        </table>
        {picture !== null && robots.length === 0 && <p class="faint">no robot is heard</p>}
      </div>
    </section>
  );
}

function counts_words({ robots, counts }: TeamPicture): string {
  const { heard, refused, late, repeated, bytes_per_second } = counts;
  const passed_over = [[refused, "refused"], [late, "late"], [repeated, "repeated"]].flatMap(([number, word]) => (number === 0 ? [] : [`${count(Number(number))} ${word}`]));
  return [`${robots.length} robots`, `${count(heard)} messages`, ...passed_over, `${fixed(bytes_per_second / 1000, 0)} kB/s`].join(" · ");
}
