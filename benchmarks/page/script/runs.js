// The table of all runs: searched, sorted, paged, and handed out as CSV.

const kPage = 50;
const kRunColumns = [
  {name: "Run", value: (run) => run.run},
  {name: "Result", text: true, value: (run) => run.result, cell: (run) => resultBadge(run.result)},
  {name: "Method", text: true, value: (run) => run.series, cell: (run) => seriesLabel(run.series)},
  {name: "Data set", text: true, value: (run) => run.set},
  {name: "Pair", text: true, value: (run) => run.pair},
  {name: "Window", text: true, value: (run) => run.window, cell: (run) => windowWords(run.window)},
  {name: "Seed", value: (run) => run.seed},
  {name: "Robots", value: (run) => run.robots},
  {name: "Overlap", value: (run) => run.overlap, cell: (run) => (known(run.overlap) ? `${digits(100 * run.overlap, 0)} %` : kNone)},
  {name: "Confidence", value: (run) => run.confidence, cell: (run) => digits(run.confidence, 3)},
  {name: "Error [m]", value: (run) => run.error_m, cell: (run) => significant(run.error_m)},
  {name: "Error [deg]", value: (run) => run.error_deg, cell: (run) => significant(run.error_deg)},
  {name: "Time", value: (run) => run.align_s, cell: (run) => duration(run.align_s)},
  {name: "Iterations", value: (run) => run.iterations, cell: (run) => whole(run.iterations)},
  {name: "Reason", text: true, value: (run) => run.reason},
];
const runsView = {column: 0, ascending: true, page: 0, search: ""};
const searchTexts = [];  // of each run, made when it is first searched

function drawRuns(list) {
  const section = document.getElementById("runs");
  runsView.page = 0;
  if (runs.length === 0) {
    section.replaceChildren();
    return;
  }
  const body = node("tbody");
  const heads = kRunColumns.map((column, place) => node("th", {scope: "col", class: column.text ? "text" : null},
    node("button", {type: "button", onclick: () => { turnTo(place); refresh(); }}, column.name)));
  const where = node("span", {class: "quiet", id: "runs-where", role: "status"});
  const step = (name, label, by) => node("button", {type: "button", "aria-label": label, onclick: () => { runsView.page += by; refresh(); }}, name);
  const back = step("←", "Previous page", -1), on = step("→", "Next page", 1);
  const search = node("input", {
    type: "search", id: "search-runs", placeholder: "Search runs", "aria-label": "Search runs", value: runsView.search,
    oninput: (event) => { runsView.search = event.target.value; runsView.page = 0; refresh(); }});
  let ordered = [];
  const refresh = () => {
    const column = kRunColumns[runsView.column];
    ordered = sorted(list.filter(matchesSearch), column.value, runsView.ascending);
    const pages = Math.max(1, Math.ceil(ordered.length / kPage));
    runsView.page = Math.min(Math.max(0, runsView.page), pages - 1);
    const from = runsView.page * kPage;
    body.replaceChildren(...ordered.slice(from, from + kPage).map((run) => runRow(run, ordered)));
    heads.forEach((head, place) => place === runsView.column
      ? head.setAttribute("aria-sort", runsView.ascending ? "ascending" : "descending") : head.removeAttribute("aria-sort"));
    where.textContent = ordered.length ? `${whole(from + 1)}–${whole(Math.min(from + kPage, ordered.length))} of ${whole(ordered.length)}` : "no runs";
    back.disabled = runsView.page === 0;
    on.disabled = runsView.page === pages - 1;
  };
  refresh();
  section.replaceChildren(
    node("h2", {}, "All runs"),
    node("div", {class: "tools"}, [
      search, node("button", {type: "button", id: "download-csv", onclick: () => download(ordered)}, "Download as CSV"),
      node("span", {class: "pages"}, [where, back, on])]),
    node("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "All runs"}, node("table", {id: "runs-table"}, [
      node("caption", {class: "unseen"}, "All runs that the filter leaves"), node("thead", {}, node("tr", {}, heads)), body])),
  );
}

function turnTo(place) {
  runsView.ascending = runsView.column === place ? !runsView.ascending : true;
  runsView.column = place;
  runsView.page = 0;
}

function matchesSearch(run) {
  if (!runsView.search.trim()) {
    return true;
  }
  searchTexts[run.index] ??= [run.run, run.result, run.status, run.series, run.set, run.pair, run.window, run.reason].join(" ").toLowerCase();
  return runsView.search.toLowerCase().split(/\s+/).every((word) => searchTexts[run.index].includes(word));
}

function runRow(run, list) {
  const cells = kRunColumns.map((column, place) => {
    const content = column.cell ? column.cell(run) : column.value(run) ?? kNone;
    if (place === 0) {
      return node("td", {}, node("button", {type: "button", "aria-label": `Open run ${run.run}`}, String(content)));
    }
    const isReason = column === kRunColumns.at(-1);
    return node("td", {class: isReason ? "text reason" : column.text ? "text" : null, title: isReason ? run.reason : null}, [content]);
  });
  return node("tr", {"data-run": run.run, onclick: () => openViewer(run, list)}, cells);
}

function csvCell(value) {
  if (value === null || value === undefined) {
    return "";
  }
  const text = String(value);
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

function csvOf(list) {
  const names = Object.keys(study.columns);
  const lines = [[...names, ...figureNames].map(csvCell).join(",")];
  for (const run of list) {
    const figures = study.figures.map((figure) => figure.values[run.index]);
    lines.push([...names.map((name) => run[name]), ...figures].map(csvCell).join(","));
  }
  return lines.join("\n") + "\n";
}

function download(list) {
  const url = URL.createObjectURL(new Blob([csvOf(list)], {type: "text/csv"}));
  const link = node("a", {href: url, download: "rows.csv"});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
