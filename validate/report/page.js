
"use strict";
// The value under the pointer, or the one that the arrow keys choose, in words below its chart.
for (const chart of document.querySelectorAll(".chart")) {
  const values = [...chart.querySelectorAll("[data-value]")];
  const shown = chart.parentElement.querySelector("output");
  let at = -1;
  shown.textContent = "The pointer or the arrow keys read a value.";
  const show = (next) => {
    if (at >= 0) values[at].classList.remove("on");
    at = next;
    values[at].classList.add("on");
    shown.textContent = values[at].dataset.value;
  };
  chart.addEventListener("keydown", (event) => {
    const last = values.length - 1;
    const next = {
      ArrowRight: at < last ? at + 1 : 0, ArrowDown: at < last ? at + 1 : 0,
      ArrowLeft: at > 0 ? at - 1 : last, ArrowUp: at > 0 ? at - 1 : last, Home: 0, End: last,
    }[event.key];
    if (next === undefined || last < 0) return;
    event.preventDefault();
    show(next);
  });
  chart.addEventListener("pointerover", (event) => {
    const value = event.target.closest("[data-value]");
    if (value) show(values.indexOf(value));
  });
}
