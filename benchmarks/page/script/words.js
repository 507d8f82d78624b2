// Numbers and names as a person reads them.

const kCompareTexts = new Intl.Collator("en", {numeric: true}).compare;

const kNone = "–";

const kResults = {
  right: "right", wrong: "wrong", missed: "missed", refused: "refused", false: "false", unknown: "unknown",
};
const kResultMeanings = {
  right: "merged, and where it belongs",
  wrong: "merged, but elsewhere",
  missed: "not merged, though it could be",
  refused: "not merged, and rightly so",
  false: "merged, though nothing is shared",
  unknown: "no truth is known",
};

function digits(value, n) {
  return known(value) ? value.toFixed(n).replace("-", "−") : kNone;
}

// So many significant digits, without an exponent where that is shorter.
function significant(value, n = 3) {
  if (!known(value)) {
    return kNone;
  }
  if (value === 0) {
    return "0";
  }
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    return value.toExponential(n - 1).replace("-", "−");
  }
  return digits(value, Math.max(0, n - 1 - Math.floor(Math.log10(size))));
}

const percent = (share) => (known(share) ? `${digits(100 * share, 1)} %` : kNone);

function interval(share) {
  return known(share.low) ? `${digits(100 * share.low, 1)}–${digits(100 * share.high, 1)}` : "";
}

// Up to three significant digits: 0.01, 200.
const brief = (value) => (known(value) ? String(Number(value.toPrecision(3))).replace("-", "−") : kNone);

// Of an axis, `text` is brief.
function duration(seconds, text = significant) {
  if (!known(seconds)) {
    return kNone;
  }
  if (seconds === 0) {
    return "0 s";
  }
  if (seconds < 1e-3) {
    return `${text(seconds * 1e6)} µs`;
  }
  if (seconds < 1) {
    return `${text(seconds * 1e3)} ms`;
  }
  return seconds < 600 ? `${text(seconds)} s` : longDuration(seconds);
}

function longDuration(seconds) {
  const minutes = Math.round(seconds / 60);
  if (minutes < 60) {
    return `${minutes} min`;
  }
  const hours = Math.floor(minutes / 60);
  return hours < 48 ? `${hours} h ${minutes % 60} min` : `${Math.floor(hours / 24)} d ${hours % 24} h`;
}

const whole = (value) => (known(value) ? Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f") : kNone);

const plural = (n, one, many) => `${whole(n)} ${n === 1 ? one : many}`;

const windowWords = (name) => (name === "none" ? "anywhere" : name || "unnamed");
const truthWords = {same: "share something", different: "share nothing", unknown: "not known"};
