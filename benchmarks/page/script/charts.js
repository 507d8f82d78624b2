// Charts: a figure with its heading, its canvas and the numbers behind it.

const waitingCharts = [];  // [canvas, makeConfig]: made when the page holds them, for a canvas takes its size from there
const liveCharts = new Map();  // canvas -> Chart

// chart: () => a configuration for Chart.js, or null where there is nothing to draw; numbers: for table().
function chartFigure({id, title, note, chart, numbers, wide = false, height = null}) {
  const figure = node("figure", {id, class: wide ? "wide" : null}, [
    node("figcaption", {}, [node("h3", {}, title), note ? node("p", {}, note) : ""]),
  ]);
  if (!chart) {
    figure.append(node("p", {class: "empty"}, "Nothing to show."));
    return figure;
  }
  const canvas = node("canvas", {role: "img", "aria-label": `Chart: ${title}. ${note ?? ""}${numbers ? " Its numbers follow as a table." : ""}`});
  const box = node("div", {class: "canvas-box", style: height ? `height:${height}px` : null}, canvas);
  figure.append(box);
  waitingCharts.push([canvas, chart]);
  if (numbers) {
    figure.append(numbersBehind(numbers));
  }
  return figure;
}

// The table is made when it is opened for the first time.
function numbersBehind(numbers) {
  const details = node("details", {class: "numbers"}, node("summary", {}, "Numbers"));
  details.addEventListener("toggle", () => details.children.length > 1 || details.append(table(numbers)), {once: true});
  return details;
}

function startWaitingCharts() {
  for (const [canvas, chart] of waitingCharts.splice(0)) {
    liveCharts.set(canvas, new Chart(canvas, chart()));
    liveCharts.get(canvas).remake = chart;
  }
}

function endChartsIn(section) {
  for (const [canvas, chart] of liveCharts) {
    if (section.contains(canvas)) {
      chart.destroy();
      liveCharts.delete(canvas);
    }
  }
}

// The same charts in the theme's present colours; `ratio`: device pixels a pixel, for print.
function recolourCharts(ratio = window.devicePixelRatio) {
  for (const [canvas, chart] of [...liveCharts]) {
    const remake = chart.remake;
    chart.destroy();
    const config = remake();
    config.options.devicePixelRatio = ratio;
    const next = new Chart(canvas, config);
    next.remake = remake;
    liveCharts.set(canvas, next);
  }
}

// Intervals (low, high) and boxes (lower, upper) of a dataset's points, along the axis that it names.
const spansPlugin = {
  id: "spans",
  beforeDatasetDraw(chart, {index, meta}) {
    const dataset = chart.data.datasets[index];
    if (!dataset.spans || meta.hidden) {
      return;
    }
    const flat = dataset.spans === "x";
    const along = flat ? meta.xScale : meta.yScale;
    const line = (point, place, from, to, width) => {
      if (!known(from) || !known(to)) {
        return;
      }
      const a = along.getPixelForValue(from), b = along.getPixelForValue(to);
      chart.ctx.lineWidth = width;
      chart.ctx.beginPath();
      chart.ctx.moveTo(flat ? a : place.x, flat ? place.y : a);
      chart.ctx.lineTo(flat ? b : place.x, flat ? place.y : b);
      chart.ctx.stroke();
    };
    chart.ctx.save();
    chart.ctx.strokeStyle = dataset.borderColor;
    dataset.data.forEach((point, i) => {
      chart.ctx.globalAlpha = 1;
      line(point, meta.data[i], point.low, point.high, 1.25);
      chart.ctx.globalAlpha = 0.4;
      line(point, meta.data[i], point.lower, point.upper, 9);
    });
    chart.ctx.restore();
  },
};

function setChartDefaults() {
  Chart.register(spansPlugin);
  const defaults = Chart.defaults;
  defaults.animation = false;
  defaults.responsive = true;
  defaults.maintainAspectRatio = false;
  defaults.parsing = false;
  defaults.normalized = true;
  defaults.font.family = getComputedStyle(document.body).fontFamily;
  defaults.font.size = 12;
  defaults.plugins.legend.display = false;
  defaults.plugins.tooltip.displayColors = false;
  defaults.plugins.tooltip.callbacks.title = () => "";
  defaults.plugins.tooltip.callbacks.label = (item) => item.raw.words || `${significant(item.raw.x)}, ${significant(item.raw.y)}`;
  defaults.interaction.mode = "nearest";
  defaults.interaction.intersect = true;
}

function axis(title, options = {}) {
  return {
    type: "linear",
    title: {display: Boolean(title), text: title},
    grid: {color: colours.line, drawTicks: false, borderColor: colours.quiet},
    ...options,
    ticks: {padding: 6, maxRotation: 0, ...options.ticks},
  };
}

const percentAxis = (title, options = {}) =>
  axis(title, {min: 0, max: 100, ...options, ticks: {stepSize: 20, callback: (value) => `${value} %`}});

// Powers of ten, and 2 and 5 between them where there is room.
// The axis reaches a little beyond the values.
function logAxis(title, format, values) {
  const isMark = (value) => {
    const mantissa = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
    return [1, 2, 5].some((mark) => Math.abs(mantissa - mark) < 1e-6);
  };
  const callback = (value) => (isMark(value) ? format(value) : null);
  const positive = values.filter((value) => known(value) && value > 0);
  const least = positive.reduce((a, b) => Math.min(a, b), Infinity), most = positive.reduce((a, b) => Math.max(a, b), 0);
  const ends = positive.length ? {min: least / 1.15, max: most * 1.15} : {};
  return axis(title, {type: "logarithmic", ...ends, ticks: {callback, autoSkip: true, maxTicksLimit: 9}});
}

// Cut in its middle: names of one kind differ at their ends.
function shortened(text, most) {
  const end = Math.floor((most - 1) / 2);
  return text.length > most ? `${text.slice(0, most - 1 - end)}…${text.slice(-end)}` : text;
}

// Names at 0, 1, 2, ...; the data keep within half a step of them.
function namedAxis(names, title, longest) {
  const ticks = {autoSkip: false, maxRotation: 60, callback: (at) => (Number.isInteger(at) && at in names ? shortened(names[at], longest) : "")};
  return axis(title, {
    min: -0.5, max: names.length - 0.5,
    grid: {display: false, borderColor: colours.quiet}, ticks,
    afterBuildTicks: (scale) => { scale.ticks = names.map((_, at) => ({value: at})); },
  });
}

// The same from top to bottom, with a line between each two names.
function rowsAxis(names, longest) {
  const between = ({tick}) => (Number.isInteger(tick.value) ? "transparent" : colours.line);
  return {
    ...namedAxis(names, "", longest), reverse: true,
    grid: {drawTicks: false, borderColor: colours.quiet, color: between},
    afterBuildTicks: (scale) => { scale.ticks = names.flatMap((_, at) => [{value: at}, {value: at + 0.5}]); },
  };
}

// Where the k-th of n series stands beside a name.
const dodge = (k, n, width = 0.62) => (n <= 1 ? 0 : (k / (n - 1) - 0.5) * width * Math.min(1, n / 5 + 0.3));

const isOpenMarker = (marker) => ["cross", "crossRot", "star"].includes(marker);

function seriesStyle(series, radius = 4.5) {
  const {colour, marker, dash} = look(series);
  return {
    label: series, borderColor: colour, backgroundColor: colour, pointStyle: marker, borderDash: dash,
    pointRadius: radius, pointHoverRadius: radius + 2, pointBorderWidth: isOpenMarker(marker) ? 2 : 1, borderWidth: 2,
  };
}

// Below one another, one row of marks a name; `point(series, name)` gives {x, low, high, ...} or null.
function rowsChart({names, series, point, xAxis}) {
  const narrow = window.innerWidth < 640;
  const datasets = series.map((name, k) => ({
    ...seriesStyle(name), spans: "x", showLine: false,
    data: names.map((row, at) => ({at, found: point(name, row)})).filter(({found}) => found !== null)
      .map(({at, found}) => ({...found, y: at + dodge(k, series.length)})),
  }));
  return {
    type: "scatter",
    data: {datasets},
    options: {scales: {x: xAxis, y: rowsAxis(names, narrow ? 14 : 26)}},
  };
}
// A canvas has a largest size.
const rowsHeight = (names, series) => Math.min(6000, Math.max(140, 64 + names.length * Math.max(26, 10 + 9 * series.length)));

// From left to right in the order of `names`, one line a series.
function stepsChart({names, series, point, xTitle, yAxis}) {
  const datasets = series.map((name, k) => ({
    ...seriesStyle(name), spans: "y", showLine: true, fill: false,
    data: names.map((column, at) => ({at, found: point(name, column)})).filter(({found}) => found !== null)
      .map(({at, found}) => ({...found, x: at + dodge(k, series.length, 0.3)})),
  }));
  return {
    type: "line",
    data: {datasets},
    options: {scales: {x: namedAxis(names, xTitle, 12), y: yAxis}},
  };
}
