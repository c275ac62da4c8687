// Tables: sorted by a click on a head, saved as CSV.

// "2.829 ± 0.014" is 2.829, "9.4 of 10.0" is 9.4; null where there is no number
const numberOf = (text) => {
  const match = /^[(+]?([−-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)/.exec(text.trim());
  return match ? Number(match[1].replace("−", "-")) : null;
};
const cellText = (row, column) => {
  const cell = row.cells[column];
  return cell ? (cell.dataset.sort ?? cell.textContent.trim()) : "";
};
const isMissing = (text) => text === "" || text === "–";

// rows in a new sequence: numbers by value, words by letters, gaps last; a sum stays last
const sortBy = (table, column, isFalling) => {
  const body = table.tBodies[0];
  const rows = [...body.rows].filter((row) => !row.classList.contains("sum"));
  const isNumeric = rows.map((row) => cellText(row, column)).every((text) => isMissing(text) || numberOf(text) !== null);
  rows.sort((a, b) => {
    const [left, right] = [cellText(a, column), cellText(b, column)];
    if (isMissing(left) || isMissing(right)) return isMissing(left) - isMissing(right);
    const order = isNumeric ? numberOf(left) - numberOf(right) : left.localeCompare(right, "en", { numeric: true });
    return isFalling ? -order : order;
  });
  body.prepend(...rows);
};

const makeSortable = (table) => {
  const heads = [...table.tHead.rows[0].cells];
  for (const [column, head] of heads.entries()) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "sort";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const isFalling = head.ariaSort === "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.ariaSort = isFalling ? "descending" : "ascending";
      sortBy(table, column, isFalling);
    });
  }
};

// paper repeats the head of a table on each page, but not one with buttons
const sortButtons = new Map();
addEventListener("beforeprint", () => {
  for (const button of all("thead .sort")) {
    sortButtons.set(button, button.parentElement);
    button.replaceWith(...button.childNodes);
  }
});
addEventListener("afterprint", () => {
  for (const [button, head] of sortButtons) {
    button.append(...head.childNodes);
    head.append(button);
  }
  sortButtons.clear();
});

// what a person reads in a cell, without words for screen readers
const shownText = (cell) => {
  const copy = cell.cloneNode(true);
  for (const spoken of all(".spoken", copy)) spoken.remove();
  for (const raised of all("sup", copy)) raised.textContent = `^${raised.textContent}`;
  for (const unit of all(".unit", copy)) unit.textContent = ` (${unit.textContent})`;
  return copy.textContent.trim().replaceAll("−", "-");
};
const csvOf = (table) => {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return `${[...table.rows].map((row) => [...row.cells].map((cell) => quoted(shownText(cell))).join(",")).join("\n")}\n`;
};
const addCsv = (table) => {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "csv";
  button.textContent = "CSV";
  button.setAttribute("aria-label", `CSV of the table ${table.dataset.name}`);
  button.addEventListener("click", () => {
    const link = document.createElement("a");
    link.download = `${table.dataset.name}.csv`;
    link.href = `data:text/csv;charset=utf-8,${encodeURIComponent(csvOf(table))}`;
    link.click();
  });
  const under = document.createElement("p");
  under.className = "under";
  under.append(button);
  table.closest(".scroll").after(under);
};

for (const table of all("table[data-name]")) {
  if (table.tBodies[0].rows.length > 1) makeSortable(table);
  addCsv(table);
}
