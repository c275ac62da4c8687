// The page: contents, folds, methods, copies, and signs where something scrolls.

for (const swatch of all(".swatch")) swatch.style.background = swatch.dataset.colour;

// the figure of the fit has the reported method, and others on request
for (const toggle of all(".method-toggles input")) {
  const show = () => {
    for (const shown of all(`#fit .method-${toggle.dataset.method}`)) shown.classList.toggle("hidden", !toggle.checked);
    // the axes are those of the methods that are shown
    for (const panel of all("#fit svg").flatMap((svg) => svg.panels)) panel.startWithShown();
  };
  toggle.addEventListener("change", show);
  show();
}

// a link into a fold opens it
const openTarget = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  const folds = target.matches("section") ? all(":scope > details.fold", target) : [];
  for (let fold = target.closest("details"); fold; fold = fold.parentElement.closest("details")) folds.push(fold);
  if (folds.every((fold) => fold.open)) return;
  for (const fold of folds) fold.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", openTarget);
// the address may have it already
for (const link of all('a[href^="#"]')) link.addEventListener("click", () => setTimeout(openTarget));
openTarget();
for (const button of all("[data-unfold], [data-fold]")) {
  const selector = button.dataset.unfold ?? button.dataset.fold;
  button.addEventListener("click", () => { for (const fold of all(selector)) fold.open = "unfold" in button.dataset; });
}

// paper shows everything but the recordings that are folded, and the lines for simulators
const unfolded = [];
addEventListener("beforeprint", () => {
  for (const fold of all("details:not([open]):not(.trial):not(.lines)")) {
    fold.open = true;
    unfolded.push(fold);
  }
});
addEventListener("afterprint", () => { for (const fold of unfolded.splice(0)) fold.open = false; });

// a page from a disk may have no clipboard
const copyText = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    document.execCommand("copy");
    field.remove();
  }
};
for (const button of all("button.copy")) {
  const words = button.textContent;
  button.addEventListener("click", async () => {
    const source = button.dataset.copyFrom;
    await copyText(source ? document.getElementById(source).textContent : button.dataset.copy);
    speak("copied");
    button.textContent = "copied";
    setTimeout(() => { button.textContent = words; }, 1500);
  });
}

// what is wider than its place shows that it scrolls, and a keyboard reaches it
const SCROLLS = ".scroll, .contents > div";
const signs = (box) => {
  const rest = box.scrollWidth - box.clientWidth;
  const doesScroll = rest > 1;
  box.classList.toggle("more-left", doesScroll && box.scrollLeft > 1);
  box.classList.toggle("more-right", doesScroll && box.scrollLeft < rest - 1);
  // a figure that has the focus scrolls by itself
  if (!doesScroll || box.querySelector("svg[tabindex]")) box.removeAttribute("tabindex");
  else box.setAttribute("tabindex", "0");
};
const sizes = new ResizeObserver((entries) => { for (const { target } of entries) signs(target.closest(SCROLLS)); });
for (const box of all(SCROLLS)) {
  box.addEventListener("scroll", () => signs(box), { passive: true });
  sizes.observe(box);
  if (box.firstElementChild) sizes.observe(box.firstElementChild);
}
