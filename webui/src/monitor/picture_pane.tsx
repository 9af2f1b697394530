import { useEffect, useRef, useState } from "preact/hooks";
import { useValue } from "../link/observable";
import { place_of_robot } from "./columns";
import type { MonitorSession } from "./monitor_session";

/// The annotated picture of the chosen robot, or why there is none.
export function PicturePane({ session, id }: { session: MonitorSession; id: number }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const words = useValue(session.pictures.words);
  const is_there = useValue(session.pictures.picture) !== null;
  const [is_large, set_large] = useState(false);
  const robot = useValue(session.feed.read)?.robots.find((other) => other.id === id);

  useEffect(() => {
    const element = canvas.current!;
    const context = element.getContext("2d", { alpha: false })!;
    const draw = (): void => {
      const bitmap = session.pictures.picture.value;
      if (bitmap === null) return;
      if (element.width !== bitmap.width || element.height !== bitmap.height) {
        element.width = bitmap.width;
        element.height = bitmap.height;
      }
      context.drawImage(bitmap, 0, 0);
    };
    draw();
    return session.pictures.picture.subscribe(draw);
  }, [session]);

  return (
    <section class={`robot-picture ${is_large ? "large" : ""}`} aria-label={`Robot ${id}`} data-show="robot">
      <header>
        <h3>Robot {id} <span class="faint">{robot ? place_of_robot(robot) : "not there"}</span></h3>
        <button type="button" class="close" aria-label="close the picture" title="close (Escape)" data-show="close-robot" onClick={() => session.select(null)}>×</button>
      </header>
      <figure class={`picture ${is_there ? "" : "empty"} ${is_there && words !== "" ? "old" : ""}`}>
        <button type="button" class="enlarge" disabled={!is_there} aria-pressed={is_large} aria-label={`large picture of robot ${id}`} title="larger, smaller" onClick={() => set_large(!is_large)}>
          <canvas ref={canvas} role="img" aria-label={`camera picture of robot ${id} with what it found in it`} data-show="robot-picture" data-there={is_there} />
        </button>
        {!is_there && <figcaption data-show="robot-picture-words">{words}</figcaption>}
      </figure>
      {is_there && words !== "" && <p class="warning-text" data-show="robot-picture-words">{words}</p>}
    </section>
  );
}
