/// What a page does for as long as it is open.

/// Before each drawing of the screen, with its time [ms].
export function on_every_frame(call: (now: number) => void): void {
  const on_screen = (now: number): void => {
    call(now);
    requestAnimationFrame(on_screen);
  };
  requestAnimationFrame(on_screen);
}

/// Now, and again so long after each time it is done [ms].
export function again_and_again(ask: () => Promise<void>, pause_ms: number): void {
  const again = async (): Promise<void> => {
    await ask();
    setTimeout(again, pause_ms);
  };
  void again();
}
