// Functions that gnuplot's SVGs call: one when the mouse pointer comes to rest on a point, one when it leaves the
// point.
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
// Draws a plot whose SVG is still a text: large and folded plots are texts until they come near the window.
const draw = (figure) => {
  const text = figure.querySelector("script");
  if (text) figure.innerHTML = text.textContent;
};
const later = [...document.querySelectorAll("figure > script")].map((text) => text.parentElement);
const near = new IntersectionObserver((figures) => {
  for (const figure of figures) {
    if (!figure.isIntersecting) continue;
    draw(figure.target);
    near.unobserve(figure.target);
  }
}, {rootMargin: "50%"});
for (const figure of later) near.observe(figure);
// Readers of a printed page can't open folded details, so open all of them before printing.
addEventListener("beforeprint", () => {
  later.forEach(draw);
  for (const details of document.querySelectorAll("details")) details.open = true;
});
