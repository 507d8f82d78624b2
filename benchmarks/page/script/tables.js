// Elements and tables. Texts only ever become text nodes, so nothing in a file's name is read as HTML.

// node("p", {class: "note"}, ["text", other])
function node(name, attributes = {}, children = []) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) {
      element.addEventListener(key.slice(2), value);
    } else if (value === true) {
      element.setAttribute(key, "");
    } else if (value !== false && value !== null && value !== undefined) {
      element.setAttribute(key, value);
    }
  }
  element.append(...[children].flat());
  return element;
}

const seriesLabel = (series) => node("span", {class: "series"}, [swatch(series), node("span", {}, series)]);
const resultBadge = (result) =>
  node("span", {class: `badge ${kResults[result] ? result : "unknown"}`, title: kResultMeanings[result]}, result || kNone);

// A share with its interval, as a number and as a mark on a line from 0 to 100 %.
function shareCell(share) {
  if (!known(share.share)) {
    return kNone;
  }
  return node("span", {}, [percent(share.share), " ", node("span", {class: "range"}, `(${interval(share)})`)]);
}

function gauge(share, colour = "var(--ink)") {
  if (!known(share.share)) {
    return "";
  }
  const x = (value) => (4 + 92 * value).toFixed(1);
  return svg("svg", {class: "gauge", width: 100, height: 14, viewBox: "0 0 100 14", "aria-hidden": "true"}, [
    svg("path", {d: "M4 7 H96", style: "stroke:var(--line)", "stroke-width": 2}),
    svg("path", {d: `M${x(share.low)} 7 H${x(share.high)}`, style: `stroke:${colour}`, "stroke-width": 3}),
    svg("circle", {cx: x(share.share), cy: 7, r: 4, style: `fill:${colour}`}),
  ]);
}

// columns: [{name, title, text: left aligned, value: for sorting, cell: what is shown}]. With `sortable`, headings are
// buttons that sort the rows in place.
// A long table scrolls in a box of its own.
function table({caption, columns, rows, sortable = true, id = null}) {
  const body = node("tbody");
  const fill = (list) => body.replaceChildren(...list.map((row) => tableRow(columns, row)));
  const heads = columns.map((column) => headCell(column, sortable && column.name !== ""));
  if (sortable) {
    heads.forEach((head, place) => {
      head.querySelector("button")?.addEventListener("click", () => fill(sortBy(heads, head, rows, columns[place].value)));
    });
  }
  fill(rows);
  const box = rows.length > 15 ? "scroll long" : "scroll";
  return node("div", {}, [
    node("p", {class: "caption"}, caption),
    node("div", {class: box, tabindex: "0", role: "region", "aria-label": caption},
      node("table", {id, "aria-label": caption}, [node("thead", {}, node("tr", {}, heads)), body])),
  ]);
}

function headCell(column, sortable) {
  const attributes = {scope: "col", class: column.text ? "text" : null, title: column.title};
  return node("th", attributes, sortable ? node("button", {type: "button"}, column.name) : column.name);
}

function tableRow(columns, row) {
  return node("tr", {}, columns.map((column, place) => {
    const content = column.cell ? column.cell(row) : column.value(row);
    const attributes = {class: column.text ? "text" : null};
    return place === 0 ? node("th", {...attributes, scope: "row"}, [content]) : node("td", attributes, [content]);
  }));
}

// Turns the direction if the column led already; numbers begin with the largest, texts with A.
function sortBy(heads, head, rows, valueOf) {
  const was = head.getAttribute("aria-sort");
  const first = rows.some((row) => typeof valueOf(row) === "number") ? "descending" : "ascending";
  const next = was === null ? first : was === "ascending" ? "descending" : "ascending";
  heads.forEach((other) => other.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", next);
  return sorted(rows, valueOf, next === "ascending");
}

// What is not known comes last, whatever the direction.
function sorted(rows, valueOf, ascending) {
  const missing = (value) => value === null || value === undefined || value === "" || Number.isNaN(value);
  const keyed = rows.map((row) => [valueOf(row), row]);
  keyed.sort(([a], [b]) => {
    if (missing(a) || missing(b)) {
      return missing(a) - missing(b);
    }
    const order = typeof a === "number" && typeof b === "number" ? a - b : kCompareTexts(String(a), String(b));
    return ascending ? order : -order;
  });
  return keyed.map(([, row]) => row);
}

function legend(names) {
  return node("ul", {class: "legend", "aria-label": "Methods"}, names.map((name) => node("li", {}, seriesLabel(name))));
}
