import { useEffect, useRef } from "preact/hooks";
import { useValue } from "../link/observable";
import type { ColorsSession } from "./colors_session";
import { FramePainter } from "./frame_painter";

/// What the draft makes of the live picture while a kept one is drawn on.
export function LivePreview({ colors }: { colors: ColorsSession }) {
  const shown = useValue(colors.pictures.shown);
  const is_on = useValue(colors.pictures.preview);
  if (shown.kind === "live") return null;
  return (
    <section class="preview" aria-label="Live picture with this table">
      <header>
        <h2>Live, with this table</h2>
        <label class="inline"><input type="checkbox" checked={is_on} onChange={(event) => colors.pictures.preview.set(event.currentTarget.checked)} />show</label>
      </header>
      {is_on && <PreviewCanvas colors={colors} />}
    </section>
  );
}

function PreviewCanvas({ colors }: { colors: ColorsSession }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const painter = new FramePainter();
    const context = canvas.current!.getContext("2d", { alpha: false })!;
    let requested = 0;
    const draw = (): void => {
      requested = 0;
      const frame = colors.pictures.live.value;
      const element = canvas.current;
      if (frame === null || element === null) return;
      painter.paint({ frame, mode: "labels", opacity: 1, classifier: colors.training.view.value.classifier, in_use: null });
      if (element.width !== frame.width || element.height !== frame.height) {
        element.width = frame.width;
        element.height = frame.height;
      }
      context.drawImage(painter.canvas, 0, 0);
    };
    const request = (): void => {
      if (requested === 0) requested = requestAnimationFrame(draw);
    };
    const ends = [colors.pictures.live, colors.training.view].map((source) => source.subscribe(request));
    request();
    return () => {
      cancelAnimationFrame(requested);
      for (const end of ends) end();
    };
  }, [colors]);
  return <canvas ref={canvas} width={640} height={480} role="img" aria-label="classes of the live picture with the draft's table" data-show="preview" />;
}
