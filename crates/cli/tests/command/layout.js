// Faults of the layout of a page, as it is on the screen now. Each is a text; a page without faults gives an empty list.
(async ({ width, isPrint }) => {
  // on paper 7 pt, less the rounding of a scale
  const LETTER_PX_MIN = isPrint ? 9.3 : 9;
  const CONTRAST_MIN = 4.5;
  const PAGE_PX = (297 - 30) * 96 / 25.4;
  const faults = [];
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const isVisible = (element) => element.checkVisibility({ visibilityProperty: true }) && element.getClientRects().length > 0;
  const name = (element) => `${element.tagName.toLowerCase()}${element.id && `#${element.id}`}.${element.getAttribute("class") ?? ""} "${element.textContent.trim().slice(0, 40)}"`;

  // nothing is wider than the screen, but for what scrolls by itself
  if (document.documentElement.scrollWidth > width) faults.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  const outside = all("body *").filter((element) => !element.closest(".scroll, .contents, .spoken, svg") && isVisible(element));
  for (const element of outside) {
    const { right, left } = element.getBoundingClientRect();
    if (right > width + 1 || left < -1) faults.push(`${name(element)} reaches from ${left} to ${right} px`);
  }
  const boxes = all(".scroll").filter(isVisible);
  for (const box of boxes) {
    const rest = box.scrollWidth - box.clientWidth;
    if (rest > 1 && (width >= 1200 || isPrint)) faults.push(`${name(box)} is cut by ${rest} px`);
    if (rest > 1 && box.querySelector(".units-of-constant")) faults.push(`the numbers to paste are cut by ${rest} px`);
    if (rest > 1 && !isPrint && !box.matches(".more-right")) faults.push(`${name(box)} does not show that it scrolls`);
    if (rest > 1 && !isPrint && !box.matches("[tabindex='0']") && !box.querySelector("svg[tabindex='0']")) faults.push(`a keyboard cannot scroll ${name(box)}`);
  }

  // letters of figures are readable, and no label stands over an axis or over another label
  const figures = all("figure svg").filter(isVisible);
  for (const svg of figures) {
    const scale = svg.getScreenCTM().a;
    const texts = all("text", svg).filter(isVisible);
    const letter = Math.min(...texts.map((text) => Number(text.getAttribute("font-size")) * scale));
    if (letter < LETTER_PX_MIN) faults.push(`letters of ${letter} px in ${svg.dataset.figure}`);
    const boxOf = (text) => text.getBoundingClientRect();
    const sheet = boxOf(svg);
    for (const text of texts) {
      const own = boxOf(text);
      if (own.left < sheet.left - 1 || own.right > sheet.right + 1) faults.push(`${name(text)} is cut in ${svg.dataset.figure}`);
    }
    const axes = all("g.panel .frame polyline", svg).map((line) => line.getBoundingClientRect()).filter((box) => box.height > 2);
    for (const text of texts.filter((text) => !text.closest(".ticks, .frame"))) {
      const own = boxOf(text);
      const isOver = (axis) => own.left < axis.left && own.right > axis.left && own.top < axis.bottom && own.bottom > axis.top;
      if (axes.some(isOver)) faults.push(`${name(text)} stands over an axis of ${svg.dataset.figure}`);
    }
    const labels = texts.filter((text) => text.closest(".label"));
    for (const [index, label] of labels.entries()) {
      const own = boxOf(label);
      const meets = (other) => own.left < other.right && other.left < own.right && own.top + 3 < other.bottom && other.top + 3 < own.bottom;
      if (labels.slice(index + 1).some((other) => meets(boxOf(other)))) faults.push(`${name(label)} meets another label of ${svg.dataset.figure}`);
    }
  }

  // text differs from what is behind it
  const channels = (colour) => /rgba?\(([^)]*)\)/.exec(colour)[1].split(/[ ,/]+/).map(Number);
  const light = (colour) => {
    const [red, green, blue] = channels(colour).map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (channels(colour)[3] !== 0) return colour;
    }
    return "rgb(255, 255, 255)";
  };
  const check = (element, colour, background) => {
    const ratio = contrast(colour, background);
    if (ratio < CONTRAST_MIN) faults.push(`${name(element)}: contrast ${ratio.toFixed(2)}, ${colour} on ${background}`);
  };
  const letters = (element) => parseFloat(getComputedStyle(element).fontSize);
  const hasText = (element) => [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent.trim());
  const written = outside.concat(all(".scroll *").filter((element) => !element.closest("svg") && isVisible(element))).filter(hasText);
  for (const element of written) check(element, getComputedStyle(element).color, behind(element));
  const small = isPrint ? written.filter((element) => letters(element) < LETTER_PX_MIN) : [];
  for (const element of small) faults.push(`letters of ${letters(element)} px in ${name(element)}`);
  for (const hash of isPrint ? all(".files .hash").filter(isVisible) : []) {
    const lines = hash.getBoundingClientRect().height / parseFloat(getComputedStyle(hash).lineHeight);
    if (lines > 2.5) faults.push(`a hash has ${lines} lines`);
  }
  for (const svg of figures) {
    const sheet = getComputedStyle(svg.querySelector(".sheet")).fill;
    for (const text of all("text", svg).filter((text) => isVisible(text) && !text.closest(".reason-of-cut"))) check(text, getComputedStyle(text).fill, sheet);
  }

  // curves differ from the sheet and from the bands behind them (3:1: WCAG 2.2, 1.4.11)
  const GRAPHIC_CONTRAST_MIN = 3;
  for (const svg of figures) {
    const sheet = channels(getComputedStyle(svg.querySelector(".sheet")).fill);
    const bands = all(".bands [fill-opacity], .bands [opacity]", svg).map((band) => {
      const [share, colour] = [Number(band.getAttribute("fill-opacity") ?? band.getAttribute("opacity")), channels(getComputedStyle(band).fill)];
      return `rgb(${colour.slice(0, 3).map((value, index) => share * value + (1 - share) * sheet[index]).join(", ")})`;
    });
    for (const curve of all(".spectrum polyline", svg).filter(isVisible)) {
      const { stroke } = getComputedStyle(curve);
      for (const background of [`rgb(${sheet.slice(0, 3).join(", ")})`, ...bands]) {
        const ratio = contrast(stroke, background);
        if (ratio < GRAPHIC_CONTRAST_MIN) faults.push(`a curve of ${svg.dataset.figure}: contrast ${ratio.toFixed(2)}, ${stroke} on ${background}`);
      }
    }
    if (svg.dataset.figure === "figure-7-spectrum" && bands.length === 0) faults.push("figure 7 has no bands");
  }

  // a flag stays whole at the end of a line
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode;
    if (node.parentElement.closest("script, style, svg, pre") || !isVisible(node.parentElement)) continue;
    for (const flag of node.textContent.matchAll(/--[a-z]+/g)) {
      const range = document.createRange();
      range.setStart(node, flag.index);
      range.setEnd(node, flag.index + flag[0].length);
      if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) faults.push(`${flag[0]} is parted in "${node.textContent.trim().slice(0, 60)}"`);
    }
  }

  // on paper nothing is parted that fits on one page
  if (isPrint) {
    for (const element of all("figure:not(.parted), .scroll:not(.long), .part").filter((element) => isVisible(element) && !element.matches(".parted .scroll"))) {
      const { height } = element.getBoundingClientRect();
      if (height > PAGE_PX) faults.push(`${name(element)} is ${height} px high`);
      if (getComputedStyle(element).breakInside !== "avoid") faults.push(`${name(element)} may be parted`);
    }
    // a panel stays whole, with its title: text at its left end, above it
    for (const part of all(".part").filter(isVisible)) {
      const sheet = part.getBoundingClientRect();
      for (const panel of all("g.panel", part)) {
        const { top, bottom } = panel.getBoundingClientRect();
        if (top < sheet.top && bottom > sheet.top + 1 && panel.querySelector(".ticks text") && !all(".trial", part).length) faults.push(`a panel of ${part.dataset.figure} is parted`);
      }
      for (const title of all(".load text", part).filter((title) => !all(".trial", part).length)) {
        const [at, end] = [title.getBoundingClientRect().top, sheet.bottom];
        if (at < end && at > end - 40) faults.push(`${name(title)} is parted from its panel`);
      }
    }
    for (const fold of all("details:not(.trial):not(.lines)")) if (!fold.open) faults.push(`${name(fold)} is folded on paper`);
  }
  if (figures.length < 2 || written.length < 30) faults.push(`only ${figures.length} figures and ${written.length} texts were looked at`);
  return faults;
})
