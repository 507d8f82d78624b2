// Which runs are shown. A filter lists what is left out, so that nothing is left out at first.

const kFilters = [
  {key: "method", name: "Method", valueOf: (run) => run.method, words: (value) => value || "unnamed"},
  {key: "profile", name: "Profile", valueOf: profileOf, words: (value) => value || "none"},
  {key: "set", name: "Data set", valueOf: (run) => run.set, words: (value) => value || "unnamed"},
  {key: "window", name: "Window", valueOf: (run) => run.window, words: windowWords, order: windowsInOrder},
  {key: "truth", name: "The maps", valueOf: (run) => run.truth, words: (value) => truthWords[value] || value || "not known"},
];
const leftOut = new Map(kFilters.map((filter) => [filter.key, new Set()]));

// What was changed in a profile is chosen together with it.
function profileOf(run) {
  return run.options ? `${run.profile} ${run.options}` : run.profile;
}

function shownRuns() {
  const active = kFilters.filter((filter) => leftOut.get(filter.key).size > 0);
  return runs.filter((run) => active.every((filter) => !leftOut.get(filter.key).has(filter.valueOf(run))));
}

const isFiltered = () => [...leftOut.values()].some((values) => values.size > 0);

function drawFilters(onChange) {
  const panel = document.getElementById("filters");
  const reset = node("button", {type: "button", id: "reset-filters", onclick: () => { clearFilters(); onChange(); }}, "Show all runs");
  const close = node("button", {type: "button", onclick: toggleFilters}, "Close");
  panel.replaceChildren(...kFilters.map((filter) => filterField(filter, onChange)),
                        node("div", {class: "filter-ends"}, [reset, close]));
  document.getElementById("open-filters").addEventListener("click", toggleFilters);
  panel.addEventListener("keydown", (event) => event.key === "Escape" && toggleFilters());
}

function toggleFilters() {
  const panel = document.getElementById("filters");
  const button = document.getElementById("open-filters");
  panel.hidden = !panel.hidden;
  button.setAttribute("aria-expanded", String(!panel.hidden));
  (panel.hidden ? button : panel.querySelector("input") || button).focus({preventScroll: true});
}

function filterField(filter, onChange) {
  const values = filter.order ? filter.order(runs) : distinct(runs, filter.valueOf).sort(kCompareTexts);
  const counts = groupBy(runs, filter.valueOf);
  const out = leftOut.get(filter.key);
  const set = (value, isShown) => (isShown ? out.delete(value) : out.add(value));
  const boxes = values.map((value) => node("input", {
    type: "checkbox", "data-filter": filter.key, "data-value": value, checked: !out.has(value),
    onchange: (event) => { set(value, event.target.checked); onChange(); },
  }));
  const all = (isShown) => () => {
    boxes.forEach((box, i) => { box.checked = isShown; set(values[i], isShown); });
    onChange();
  };
  return node("fieldset", {"data-filter": filter.key}, [
    node("legend", {}, [filter.name, " ",
      node("button", {type: "button", class: "small", onclick: all(true), "aria-label": `${filter.name}: all`}, "all"), " ",
      node("button", {type: "button", class: "small", onclick: all(false), "aria-label": `${filter.name}: none`}, "none")]),
    node("div", {class: "choices"}, values.map((value, i) => node("label", {}, [
      boxes[i], node("span", {}, filter.words(value)), node("span", {class: "count"}, whole(counts.get(value).length)),
    ]))),
  ]);
}

function showFilterState() {
  for (const box of document.querySelectorAll("#filters input")) {
    box.checked = !leftOut.get(box.dataset.filter).has(box.dataset.value);
  }
  const button = document.getElementById("open-filters");
  const active = kFilters.filter((filter) => leftOut.get(filter.key).size > 0).length;
  button.textContent = active ? `Filter (${active})` : "Filter";
  button.classList.toggle("on", active > 0);
}

function clearFilters() {
  leftOut.forEach((values) => values.clear());
}

// The filter as the address's end, so that a view can be kept and sent: #without=method:som;window:none
function filterAddress() {
  const parts = [...leftOut].flatMap(([key, values]) => [...values].map((value) => `${key}:${encodeURIComponent(value)}`));
  return parts.length ? `#without=${parts.join(";")}` : "";
}

function readFilterAddress(address) {
  clearFilters();
  const text = address.startsWith("#without=") ? address.slice("#without=".length) : "";
  for (const part of text.split(";").filter(Boolean)) {
    const [key, value] = part.split(":");
    try {
      leftOut.get(key)?.add(decodeURIComponent(value ?? ""));
    } catch {
      // a broken address leaves nothing out
    }
  }
}
