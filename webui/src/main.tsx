import { render } from "preact";
import { App } from "./app";
import { Session } from "./session";
import "./style.css";

const session = new Session();
session.start();

// Space freezes, except where it has a meaning of its own.
addEventListener("keydown", (event) => {
  const target = event.target as HTMLElement;
  if (event.key !== " " || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
  if (target.closest("input, select, textarea, button, a, summary, [contenteditable]")) return;
  event.preventDefault();
  session.toggle_freeze();
});

render(<App session={session} />, document.getElementById("app")!);
