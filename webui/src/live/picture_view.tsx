import { useEffect, useRef, useState } from "preact/hooks";
import type { Observable } from "../link/observable";
import type { Picture } from "../session";

/// The annotated picture, drawn when the screen is ready for it.
export function PictureView({ picture }: { picture: Observable<Picture | null> }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [there, set_there] = useState(picture.value !== null);

  useEffect(() => {
    const element = canvas.current!;
    const context = element.getContext("2d", { alpha: false })!;
    const draw = (): void => {
      if (picture.value === null) return;
      const { bitmap, frame } = picture.value;
      if (element.width !== bitmap.width || element.height !== bitmap.height) {
        element.width = bitmap.width;
        element.height = bitmap.height;
      }
      context.drawImage(bitmap, 0, 0);
      element.dataset["frame"] = frame === null ? "" : String(frame);
      set_there(true);
    };
    draw();
    return picture.subscribe(draw);
  }, [picture]);

  return (
    <figure class={`picture ${there ? "" : "empty"}`}>
      <canvas ref={canvas} role="img" aria-label="camera picture with what was found in it, and from above; the tables say the same in words"
              data-show="picture" data-there={there} />
      {!there && <figcaption>no picture yet</figcaption>}
    </figure>
  );
}
