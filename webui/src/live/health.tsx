import { count, fixed } from "../format";
import { useValue } from "../link/observable";
import type { Session } from "../session";

/// Whether what is seen here is all there is, and how late.
export function Health({ session }: { session: Session }) {
  const server = useValue(session.server);
  useValue(session.live.read);   // what this page skipped is counted with the scenes
  if (server === null) return null;
  return (
    <section>
      <h2>Health</h2>
      <dl class="pairs health" data-show="health">
        <Fact name="source" value={last_part(server.source.name)} title={`${server.source.name}: ${server.source.description}`} />
        <Fact name="robot" value={server.robot} />
        <Fact name="frames" value={`${count(server.frames)}, ${count(server.dropped)} dropped`} bad={server.dropped > 0.01 * server.frames} />
        {server.latency_ms != null && <Fact name="latency" value={`${fixed(server.latency_ms, 1)} ms`} title="from the capture of a frame to its scene, median of a second" show="latency" />}
        <Fact name="viewers" value={count(server.web.viewers)} title={`${server.web.clients} connections`} show="viewers" />
        <Fact name="messages" value={`${count(server.web.sent)}, ${count(server.web.dropped)} passed over`} />
        <Fact name="this page" value={`${count(session.skipped)} skipped`} />
        <Fact name="configuration" value={`taken over ${server.configuration.taken_over}×`} show="taken-over" />
        <Fact name="version" value={server.version} />
      </dl>
    </section>
  );
}

/// Of a path or an address; there is room for no more, and the rest is told on pointing at it.
function last_part(name: string): string {
  return name.split("/").pop() || name;
}

function Fact({ name, value, title, bad, show }: { name: string; value: string; title?: string; bad?: boolean; show?: string }) {
  return <div><dt>{name}</dt><dd title={title} class={bad ? "bad" : undefined} data-show={show}>{value}</dd></div>;
}
