import { count, missing } from "../format";
import { useValue } from "../link/observable";
import type { ClassQuality } from "../link/training_api";
import { ClassDot } from "./class_dot";
import { color_classes, title_of } from "./color_class";
import type { ColorsSession } from "./colors_session";

/// All classes: which is drawn, what it has, and how good it is on samples that it was not trained with.
export function ClassTable({ colors }: { colors: ColorsSession }) {
  const { color: chosen, result, quality, history, training } = useValue(colors.training.view);
  return (
    <section class="classes" aria-label="Classes">
      <header>
        <h2>Classes</h2>
        <span class="faint" data-show="quality-state">{history.present.samples.length === 0 ? "" : quality === null ? "quality is being measured" : "quality on held-out samples"}</span>
      </header>
      <table>
        <thead>
          <tr>
            <th>class</th>
            <th class="number">samples</th>
            <th class="number pixels">pixels</th>
            <th class="number" title="share of its pixels that are found">found</th>
            <th class="number" title="share of what is found that is right">right</th>
            <th><span class="unseen">clear</span></th>
          </tr>
        </thead>
        <tbody>
          {color_classes.map((color, label) => {
            const entry = result?.classes[label];
            const samples = history.present.samples.filter((sample) => sample.class === color).length;
            const judged = quality?.classes[color];
            return (
              <tr key={color} class={color === chosen ? "chosen" : ""} data-class={color}>
                <th scope="row">
                  <button type="button" class="class-choice" aria-pressed={color === chosen} aria-keyshortcuts={String(label)} title={`draw ${title_of(color)} (${label})`}
                          onClick={() => colors.choose(color)}>
                    <kbd>{label}</kbd>
                    <ClassDot color={color} />
                    {title_of(color)}
                  </button>
                </th>
                <td class="number">{samples === 0 ? <span class="faint">{missing}</span> : samples}</td>
                <td class="number pixels" data-show="pixels">{entry === undefined || entry.pixels === 0 ? <span class="faint">{missing}</span> : count(entry.pixels)}</td>
                <td class="number"><Share of={judged} which="recall" /></td>
                <td class="number"><Share of={judged} which="precision" /></td>
                <td>
                  <button type="button" class="plain" disabled={samples === 0 && history.present.brightness[color] === undefined}
                          aria-label={`clear ${title_of(color)}`} title="take all its samples away; undo brings them back"
                          onClick={() => colors.clear_class(color)}>
                    clear
                  </button>
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
      {training !== null && history.present.samples.length === 0 && (
        <p class="faint">Choose a class, then draw on the picture where that color is. More pictures, in light and shade, make a better table.</p>
      )}
      {result !== null && result.warnings.length > 0 && (
        <ul class="warnings" data-show="warnings">
          {result.warnings.map((warning) => <li key={warning}>{warning}</li>)}
        </ul>
      )}
    </section>
  );
}

/// Below this a class will be missed, or seen where it is not, often enough to matter.
const poor_share = 0.9;

function Share({ of, which }: { of: ClassQuality | undefined; which: "recall" | "precision" }) {
  const share = of?.[which];
  if (share == null) return <span class="faint">{missing}</span>;
  return <span class={share < poor_share ? "poor" : undefined}>{(100 * share).toFixed(1)} %</span>;
}
