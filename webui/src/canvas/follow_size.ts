/// Keeps a canvas as large as the page gives it, in the pixels of the screen, and has it redrawn when that changes; returns how to end that.
export function follow_size(canvas: HTMLCanvasElement, density: () => number, redraw: () => void): () => void {
  const resize = new ResizeObserver(() => {
    const width = Math.max(1, Math.round(canvas.clientWidth * density()));
    const height = Math.max(1, Math.round(canvas.clientHeight * density()));
    if (width !== canvas.width || height !== canvas.height) {
      canvas.width = width;
      canvas.height = height;
    }
    redraw();
  });
  resize.observe(canvas);
  return () => resize.disconnect();
}
