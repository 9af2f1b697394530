// Are the definitions of standard types, as a log carries them, those that ROS 2 has? Compared with Foxglove's copy of them, of all releases since Humble.
//
// usage: node e2e/compare_definitions.mjs FILE
// FILE: definitions as `write_definitions` prints them: "TYPE\n" and the text of a schema, ended by a line "%%". Prints how many were compared; exit code 1 and what differs when one does.
import { readFileSync } from "node:fs";
import rosmsg from "@foxglove/rosmsg";
import * as known from "@foxglove/rosmsg-msgs-common";

const shape = (fields) => fields.filter(({ isConstant }) => !isConstant)
  .map(({ name, type, isArray, arrayLength }) => `${type}${isArray ? `[${arrayLength ?? ""}]` : ""} ${name}`);

let compared = 0, differing = 0;
for (const text of readFileSync(process.argv[2], "utf8").split("%%\n").filter((part) => part.trim() !== "")) {
  for (const { name, definitions } of rosmsg.parse(text.slice(text.indexOf("\n") + 1), { ros2: true }).map((one, i) => ({ ...one, name: i === 0 ? text.slice(0, text.indexOf("\n")) : one.name }))) {
    for (const release of ["ros2humble", "ros2iron", "ros2jazzy"]) {
      const theirs = known[release][name] ?? known[release][name.replace("/msg/", "/")];
      if (theirs === undefined) continue;
      ++compared;
      const [a, b] = [shape(definitions), shape(theirs.definitions)];
      if (JSON.stringify(a) === JSON.stringify(b)) continue;
      ++differing;
      console.error(`${name} of ${release}:\n  ours   ${a.join(", ")}\n  theirs ${b.join(", ")}`);
    }
  }
}
console.log(`${compared} definitions compared, ${differing} differ`);
process.exit(differing === 0 && compared > 0 ? 0 : 1);
