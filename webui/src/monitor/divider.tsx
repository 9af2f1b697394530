import { useRef } from "preact/hooks";
import { share_within } from "./windows";

interface Props {
  share: number;
  change: (share: number) => void;
  /// As it is until somebody moves it.
  reset: () => void;
}

const step = 0.03;

/// Between two windows that lie above each other: dragged, or moved by keys while it has the focus; a double click makes it as usual.
export function Divider({ share, change, reset }: Props) {
  const bar = useRef<HTMLDivElement>(null);
  const drag = (event: PointerEvent): void => {
    if (!bar.current!.hasPointerCapture(event.pointerId)) return;
    const box = bar.current!.parentElement!.getBoundingClientRect();
    change(share_within((event.clientY - box.top) / box.height));
  };
  const key = (event: KeyboardEvent): void => {
    const next = { ArrowUp: share - step, ArrowDown: share + step, Home: 0, End: 1, Enter: null }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    if (next === null) reset();
    else change(share_within(next));
  };
  return (
    <div ref={bar} class="divider" role="separator" tabIndex={0} aria-orientation="horizontal" aria-label="Share of the field window" aria-valuemin={20} aria-valuemax={85}
         aria-valuenow={Math.round(share * 100)} data-show="divider" onPointerDown={(event) => bar.current!.setPointerCapture(event.pointerId)} onPointerMove={drag}
         onDblClick={reset} onKeyDown={key} />
  );
}
