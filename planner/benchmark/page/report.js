// What gnuplot's pictures call where the pointer rests on a point.
const tip = document.getElementById("tip");
const gnuplot_svg = {
  showHypertext(event, text) {
    tip.textContent = text;
    tip.hidden = false;
    const box = tip.getBoundingClientRect();
    tip.style.left = Math.max(4, Math.min(event.clientX + 14, innerWidth - box.width - 4)) + "px";
    tip.style.top = Math.max(4, event.clientY - box.height - 10) + "px";
  },
  hideHypertext() {
    tip.hidden = true;
  },
};
addEventListener("scroll", gnuplot_svg.hideHypertext, {passive: true});
// On paper nothing can be opened.
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});
