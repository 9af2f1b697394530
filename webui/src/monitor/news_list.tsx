import { useValue } from "../link/observable";
import { clock_words } from "./moment";
import type { MonitorSession } from "./monitor_session";

/// So many are shown; older ones are rarely asked for.
const shown_news = 60;

/// What happened until the time that is shown, newest first; a click looks at it.
export function NewsList({ session }: { session: MonitorSession }) {
  const news = useValue(session.news);
  const until = useValue(session.feed.read)?.news ?? 0;
  const happened = news.filter(({ number }) => number <= until).slice(-shown_news).reverse();
  return (
    <section class="news" aria-label="News">
      <h3>News</h3>
      {happened.length === 0 && <p class="faint">nothing yet</p>}
      <ol data-show="news">
        {happened.map(({ number, t, robot, text }) => (
          <li key={number}>
            <button type="button" class="plain" title="look at this time" onClick={() => session.seek(t)}><time>{clock_words(t)}</time></button>
            <span>{robot !== null && <b>{robot}</b>} {text}</span>
          </li>
        ))}
      </ol>
    </section>
  );
}
