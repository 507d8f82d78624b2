// Light and dark, the colours of the series, and the marks that tell them apart without colours.

const kMarkers = ["circle", "rect", "triangle", "rectRot", "crossRot", "star", "cross", "rectRounded"];
const kDashes = [[], [7, 3], [2, 2], [9, 3, 2, 3], [12, 4], [4, 4], [1, 3], [6, 2, 1, 2, 1, 2]];
const kColours = 8;

// By method; of each the default profile first.
function inOrder(a, b) {
  const rank = (run) => [run.method, run.profile === "default" && !run.options ? "" : `${run.profile} ${run.options}`];
  const [methodA, restA] = rank(a), [methodB, restB] = rank(b);
  return kCompareTexts(methodA, methodB) || kCompareTexts(restA, restB);
}

const firstRuns = [...new Map(runs.map((run) => [run.series, run])).values()];
const allSeries = firstRuns.sort(inOrder).map((run) => run.series);
const seriesPlace = new Map(allSeries.map((name, place) => [name, place]));
let colours = {};

function systemTheme() {
  return window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

function remembered() {
  try {
    return window.localStorage.getItem("gridmerge-theme");
  } catch {
    return null;  // not allowed for this page: then it follows the system
  }
}

function remember(theme) {
  try {
    window.localStorage.setItem("gridmerge-theme", theme);
  } catch {
    // as above
  }
}

function showTheme(theme) {
  document.documentElement.dataset.theme = theme;
  const button = document.getElementById("theme");
  button.textContent = theme === "dark" ? "Light" : "Dark";
  button.setAttribute("aria-label", `Switch to ${theme === "dark" ? "light" : "dark"} colours`);
  readColours();
}

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const read = (name) => style.getPropertyValue(`--${name}`).trim();
  colours = {series: []};
  for (const name of ["paper", "ink", "quiet", "line", "accent"]) {
    colours[name] = read(name);
  }
  for (let i = 0; i < kColours; ++i) {
    colours.series.push(read(`series-${i}`));
  }
  Chart.defaults.color = colours.quiet;
  Chart.defaults.borderColor = colours.line;
}

// Colour, marker and dash of a series: the same in every chart, whatever the filter. After eight colours they begin
// again with other markers and dashes.
function look(series) {
  const place = seriesPlace.get(series);
  const turn = Math.floor(place / kColours);
  return {
    colour: colours.series[place % kColours],
    marker: kMarkers[(place + 3 * turn) % kMarkers.length],
    dash: kDashes[(place + 2 * turn) % kDashes.length],
  };
}

const kSvg = "http://www.w3.org/2000/svg";

function svg(name, attributes, children = []) {
  const node = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) {
    node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}

const kMarkerPaths = {
  circle: "M20 8 m-4 0 a4 4 0 1 0 8 0 a4 4 0 1 0 -8 0",
  rect: "M16.5 4.5 h7 v7 h-7 z",
  triangle: "M20 3.5 l4.3 8 h-8.6 z",
  rectRot: "M20 3 l5 5 l-5 5 l-5 -5 z",
  rectRounded: "M18 4 h4 a2 2 0 0 1 2 2 v4 a2 2 0 0 1 -2 2 h-4 a2 2 0 0 1 -2 -2 v-4 a2 2 0 0 1 2 -2 z",
  cross: "M20 3.5 v9 M15.5 8 h9",
  crossRot: "M16.5 4.5 l7 7 M23.5 4.5 l-7 7",
  star: "M20 3.5 v9 M15.5 8 h9 M17 5 l6 6 M23 5 l-6 6",
};

// The line and the marker of a series, as a picture in a text. Colours follow the theme by themselves.
function swatch(series) {
  const place = seriesPlace.get(series);
  const stroke = `var(--series-${place % kColours})`;
  const mark = look(series);
  return svg("svg", {class: "swatch", width: 40, height: 16, viewBox: "0 0 40 16", "aria-hidden": "true"}, [
    svg("path", {d: "M1 8 H39", style: `stroke:${stroke}`, "stroke-width": 2, "stroke-dasharray": mark.dash.join(" ")}),
    svg("path", {d: kMarkerPaths[mark.marker], style: `stroke:${stroke};fill:${stroke}`, "stroke-width": 2}),
  ]);
}
