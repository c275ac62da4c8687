// Values as text, and small tools.
const SVG = "http://www.w3.org/2000/svg";
const readout = document.querySelector(".readout");

const make = (name, attributes, parent) => {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
};
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// as many decimals as a thousandth of the range is worth
const written = (value, range) => {
  const decimals = clamp(Math.ceil(-Math.log10(Math.abs(range) / 1000)), 0, 9);
  return value.toFixed(decimals).replace("-", "−");
};
// "time (s)" and 3.2 are "time 3.2 s"
const named = (title, value, range) => {
  const parts = /^(.*) \((.*)\)$/.exec(title);
  return parts ? `${parts[1]} ${written(value, range)} ${parts[2]}` : `${title} ${written(value, range)}`.trim();
};
const roundTicks = (from, to, count) => {
  const raw = (to - from) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((times) => times * power).find((step) => step >= raw);
  const ticks = [];
  for (let k = Math.ceil(from / step); k * step <= to; k += 1) ticks.push(k * step);
  return { ticks, step };
};

// elements of a page, as an array
const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const isShown = (element) => !element.closest(".hidden");
// what a person hears who does not see that something was done
const speak = (words) => { document.querySelector("[role=status]").textContent = words; };
