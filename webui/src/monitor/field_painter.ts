import { follow_size } from "../canvas/follow_size";
import { type Palette, palette_of } from "../canvas/pen";
import type { Size } from "../canvas/transform";
import { draw_team } from "./field_drawing";
import type { MonitorSession } from "./monitor_session";

/// Draws the field window, at most once a picture of the screen, and only when something changed.
export class FieldPainter {
  private readonly context: CanvasRenderingContext2D;
  private palette: Palette;
  private is_old = true;
  private readonly ends: (() => void)[] = [];

  constructor(readonly canvas: HTMLCanvasElement, private readonly session: MonitorSession) {
    this.context = canvas.getContext("2d", { alpha: false })!;
    this.palette = palette_of(canvas);
    const { feed, state, layers, camera, selected, measure, trails_changed } = session;
    const anew = (): void => { this.is_old = true; };
    for (const source of [feed.drawn, layers, camera, selected, measure, trails_changed]) this.ends.push(source.subscribe(anew));
    let plan = state.value?.field;
    this.ends.push(state.subscribe(() => {
      if (state.value?.field === plan) return;
      plan = state.value?.field;
      anew();
    }));
    // A canvas that changed its size is empty, and would be seen so.
    this.ends.push(follow_size(canvas, () => this.density, () => this.draw(performance.now())));
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const recolor = (): void => {
      this.palette = palette_of(canvas);
      anew();
    };
    dark.addEventListener("change", recolor);
    this.ends.push(() => dark.removeEventListener("change", recolor));
    const on_screen = (now: number): void => {
      if (this.is_old) this.draw(now);
    };
    session.on_screen.add(on_screen);
    this.ends.push(() => session.on_screen.delete(on_screen));
  }

  get density(): number {
    return Math.max(1, Math.min(devicePixelRatio, 3));
  }

  get size(): Size {
    return this.canvas;
  }

  end(): void {
    for (const end of this.ends) end();
  }

  private draw(now: number): void {
    this.is_old = false;
    const begin = performance.now();
    draw_team(this.context, this.canvas, this.palette, this.density, this.session.content());
    this.session.statistics.add(now, performance.now() - begin);
  }
}
