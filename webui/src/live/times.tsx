import { fixed } from "../format";
import type { StageTime } from "../link/live";
import { type Observable, useValue } from "../link/observable";

/// Stages that are no part of the total, which begins with the decoded frame.
const outside_total = new Set(["decode", "wait"]);

/// Time of each stage, smoothed; bars are shares of the longest.
export function Times({ timing }: { timing: Observable<readonly StageTime[]> }) {
  const times = useValue(timing);
  if (times.length === 0) return null;
  const total = times.find(({ stage }) => stage === "total");
  const stages = times.filter(({ stage }) => stage !== "total");
  const inside = stages.filter(({ stage }) => !outside_total.has(stage));
  const longest = Math.max(...inside.map(({ ms }) => ms), 1e-6);
  return (
    <section>
      <header>
        <h2>Time</h2>
        <span class="faint">{total && `${fixed(total.ms, 2)} ms in all, `}mean of a second</span>
      </header>
      <table class="times">
        <tbody>
          {stages.map(({ stage, ms }) => (
            <tr key={stage} data-show={`time-${stage}`}>
              <th scope="row">{stage.replace("_", " ")}</th>
              <td class="bar-cell">
                {outside_total.has(stage)
                  ? <span class="faint">before the vision, not in the total</span>
                  : <span class="time-bar" style={{ width: `${(100 * ms) / longest}%` }} />}
              </td>
              <td class="number">{fixed(ms, 3)} ms</td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
