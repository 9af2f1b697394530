import { useEffect, useRef } from "preact/hooks";
import type { Observable } from "../link/observable";
import { follow_size } from "../canvas/follow_size";
import { type Palette, palette_of } from "../canvas/pen";
import type { Size } from "../canvas/transform";

interface Props {
  /// For those who cannot see it: what it shows, and where the same stands in words.
  label: string;
  /// The drawing is made anew when one of them was replaced, or the canvas has another size, or the page other colors.
  sources: readonly Observable<unknown>[];
  draw: (context: CanvasRenderingContext2D, size: Size, palette: Palette, density: number) => void;
}

/// A canvas as large as the page gives it, sharp on every screen.
export function CanvasView({ label, sources, draw }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const latest = useRef(draw);
  latest.current = draw;

  useEffect(() => {
    const element = canvas.current!;
    const context = element.getContext("2d", { alpha: false })!;
    let palette = palette_of(element);
    const redraw = (): void => latest.current(context, element, palette, density());
    const density = (): number => Math.max(1, Math.min(devicePixelRatio, 3));
    const end_following = follow_size(element, density, redraw);
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const recolor = (): void => {
      palette = palette_of(element);
      redraw();
    };
    dark.addEventListener("change", recolor);
    const ends = sources.map((source) => source.subscribe(redraw));
    return () => {
      end_following();
      dark.removeEventListener("change", recolor);
      for (const end of ends) end();
    };
  }, sources);

  // Whatever else the drawing depends on made the component show anew.
  useEffect(() => {
    const element = canvas.current!;
    if (element.width > 1) latest.current(element.getContext("2d", { alpha: false })!, element, palette_of(element), Math.max(1, Math.min(devicePixelRatio, 3)));
  }, [draw]);

  return <canvas ref={canvas} class="plan" role="img" aria-label={label} />;
}
