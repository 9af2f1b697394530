import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { useValue } from "../link/observable";
import { title_of } from "./color_class";
import type { ColorsSession } from "./colors_session";
import { cell_at, classes_of_cell, used_window, UvPlane, whole_plane } from "./uv_plane";

/// The UV plane: how often the chosen class has which colors, and the cells of all classes.
export function UvPane({ colors }: { colors: ColorsSession }) {
  const { result, color } = useValue(colors.training.view);
  const probe = useValue(colors.probe);
  const canvas = useRef<HTMLCanvasElement>(null);
  const plane = useMemo(() => new UvPlane(), []);
  const [is_whole, set_whole] = useState(false);
  const [cell, set_cell] = useState<{ u: number; v: number } | null>(null);
  const table = result?.table ?? null;
  const seen = result?.seen?.class === color ? result.seen : null;
  const picture = { table, density: seen?.density ?? null, color };
  const window = useMemo(() => (is_whole ? whole_plane : used_window(picture)), [is_whole, table, seen]);

  useEffect(() => {
    const element = canvas.current!;
    const draw = (): void => {
      const size = Math.max(1, Math.round(element.clientWidth * Math.min(devicePixelRatio, 2)));
      if (element.width !== size) element.width = element.height = size;
      plane.draw(element.getContext("2d", { alpha: false })!, size, picture, window, cell ?? probe);
    };
    draw();
    const resize = new ResizeObserver(draw);
    resize.observe(element);
    return () => resize.disconnect();
  }, [table, seen, color, window, probe, cell]);

  const point = (event: PointerEvent): void => {
    const box = canvas.current!.getBoundingClientRect();
    set_cell(cell_at(event.clientX - box.left, event.clientY - box.top, box.width, window));
  };
  const shown = cell ?? probe;
  const classes = shown === null || table === null ? [] : classes_of_cell(table, shown.u, shown.v);
  return (
    <div class="uv">
      <header>
        <h3>Colors, U right and V up</h3>
        <label class="inline"><input type="checkbox" checked={is_whole} onChange={(event) => set_whole(event.currentTarget.checked)} />all</label>
      </header>
      <canvas ref={canvas} role="img" data-show="uv" onPointerMove={point} onPointerDown={point} onPointerLeave={() => set_cell(null)}
              aria-label={`plane of chroma with the cells of each class, and where pixels of ${title_of(color)} lie`} />
      <p class="under" data-show="uv-cell">
        {shown === null ? <span class="faint">{seen === null || seen.most === 0 ? "no pixels of this class yet" : `up to ${seen.most} pixels a cell`}</span>
          : <>U {shown.u} · V {shown.v} · {classes.length === 0 ? "no class" : classes.map(title_of).join(", ")}</>}
      </p>
    </div>
  );
}
