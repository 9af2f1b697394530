import { useCallback, useMemo, useState } from "preact/hooks";
import { draw_field_view } from "../canvas/field_view";
import type { Palette } from "../canvas/pen";
import { AutomaticReach, furthest, reaches } from "../canvas/reach";
import { draw_robot_view } from "../canvas/robot_view";
import type { Size } from "../canvas/transform";
import { useValue } from "../link/observable";
import type { Session } from "../session";
import { CanvasView } from "./canvas_view";
import { Health } from "./health";
import { PictureView } from "./picture_view";
import { RecordingBar } from "./recording";
import { Seen } from "./seen";
import { Tiles } from "./tiles";
import { Times } from "./times";

export function LiveView({ session }: { session: Session }) {
  return (
    <div class="live">
      <h1 class="unseen">Live</h1>
      <div class="looks">
        <PictureView picture={session.picture} />
        <RecordingBar session={session} />
        <div class="plans">
          <RobotPlan session={session} />
          <FieldPlanView session={session} />
        </div>
        <div class="inner">
          <Times timing={session.live.timing} />
          <Health session={session} />
        </div>
      </div>
      <div class="facts">
        <Tiles session={session} />
        <Seen scene={session.live.read} />
      </div>
    </div>
  );
}

function RobotPlan({ session }: { session: Session }) {
  const [chosen, set_chosen] = useState<number | null>(null);
  const automatic = useMemo(() => new AutomaticReach(), []);
  const draw = useCallback((context: CanvasRenderingContext2D, size: Size, palette: Palette, density: number) => {
    const scene = session.live.drawn.value;
    const fitting = automatic.next(scene ? furthest(scene) : 0, performance.now());
    draw_robot_view(context, size, palette, density, scene, chosen ?? fitting);
  }, [chosen]);
  return (
    <section class="plan-box">
      <header>
        <h2>From above</h2>
        <label class="inline">
          reach
          <select value={chosen ?? ""} onChange={(event) => set_chosen(event.currentTarget.value === "" ? null : Number(event.currentTarget.value))}>
            <option value="">automatic</option>
            {reaches.map((reach) => <option key={reach} value={reach}>{reach} m</option>)}
          </select>
        </label>
      </header>
      <CanvasView label="what the robot sees, from above, forward up: free space, lines, goals, robots and ball with their uncertainty; the tables say the same in words"
                  sources={[session.live.drawn]} draw={draw} />
    </section>
  );
}

function FieldPlanView({ session }: { session: Session }) {
  const scene = useValue(session.live.read);
  const draw = useCallback((context: CanvasRenderingContext2D, size: Size, palette: Palette, density: number) => {
    draw_field_view(context, size, palette, density, session.live.drawn.value, session.server.value?.field);
  }, []);
  const lost = scene !== null && scene.pose === null;
  return (
    <section class="plan-box">
      <header>
        <h2>On the field</h2>
        {lost && <span class="faint">pose unknown</span>}
      </header>
      <CanvasView label="the field from above with the robot and what it sees; the pose stands in the table below"
                  sources={[session.live.drawn, session.server]} draw={draw} />
    </section>
  );
}
