// Puts the parts together, and redraws them when the filter or the theme changes.

const kSections = [
  {id: "overview", name: "Overview", draw: drawOverview},
  {id: "success", name: "Success", draw: drawSuccess},
  {id: "time", name: "Time", draw: drawTime},
  {id: "confidence", name: "Confidence", draw: drawConfidence},
  {id: "convergence", name: "Convergence", draw: drawConvergence},
  {id: "robots", name: "Robots", draw: drawRobots},
  {id: "failures", name: "Failures", draw: drawFailures},
  {id: "runs", name: "Runs", draw: drawRuns},
];

function drawAll() {
  const list = shownRuns();
  endChartsIn(document.body);
  kSections.forEach((section) => section.draw(list));
  startWaitingCharts();
  drawNavigation();
  drawFilterNote(list);
  showFilterState();
}

function drawNavigation() {
  const there = kSections.filter(({id}) => document.getElementById(id).hasChildNodes());
  document.getElementById("sections").replaceChildren(
    ...there.map(({id, name}) => node("a", {href: `#${id}`, onclick: (event) => goTo(event, id)}, name)));
}

// The address keeps the filter, not the place on the page.
function goTo(event, id) {
  event.preventDefault();
  document.getElementById(id).scrollIntoView();
}

function drawFilterNote(list) {
  const note = document.getElementById("filter-note");
  if (!isFiltered()) {
    note.replaceChildren();
    return;
  }
  note.replaceChildren(`The filter shows ${whole(list.length)} of ${plural(runs.length, "run", "runs")}: charts and tables are of these alone.`,
    node("button", {type: "button", onclick: () => { clearFilters(); onFilter(); }}, "Show all runs"));
}

function onFilter() {
  history.replaceState(null, "", filterAddress() || location.pathname + location.search);
  drawAll();
}

function onAddress() {
  readFilterAddress(location.hash);
  drawAll();
}

function chooseTheme(theme) {
  showTheme(theme);
  recolourCharts();
}

function followTheme() {
  document.getElementById("theme").addEventListener("click", () => {
    const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    remember(next);
    chooseTheme(next);
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => remembered() || chooseTheme(systemTheme()));
}

// Paper is white, and finer than a screen.
function followPrint() {
  let theme = null;
  window.addEventListener("beforeprint", () => {
    theme = document.documentElement.dataset.theme;
    document.documentElement.classList.add("printing");
    showTheme("light");
    recolourCharts(Math.max(2, window.devicePixelRatio));
  });
  window.addEventListener("afterprint", () => {
    document.documentElement.classList.remove("printing");
    chooseTheme(theme);
  });
}

function start() {
  showTheme(remembered() || systemTheme());
  setChartDefaults();
  drawAbout();
  readFilterAddress(location.hash);
  drawFilters(onFilter);
  drawAll();
  followTheme();
  followPrint();
  window.addEventListener("hashchange", onAddress);
  markShown();
}

// For whoever measures: charts, tables and small pictures are on the screen. What was drawn in one frame has been shown
// at the next but one.
async function markShown() {
  await Promise.allSettled([...document.images].map((image) => image.decode()));
  requestAnimationFrame(() => requestAnimationFrame(() => performance.mark("gridmerge-shown")));
}

start();
