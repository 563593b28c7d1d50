// Numbers as text: as many digits as their intervals bear.

const notTold = "not to be told";
const thinSpace = "\u202f";
const timesTen = "\u00a0×\u00a010";  // never at the end of a line

function isNumber(value) {
    return typeof value === "number" && Number.isFinite(value);
}

function superscript(exponent) {
    return String(exponent).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
}

/// Fixed decimals (negative: rounded to tens, hundreds …), a true minus, thousands set apart.
function fixed(value, decimals) {
    const step = 10 ** Math.max(0, -decimals);
    const text = (decimals > 0 ? value : Math.round(value / step) * step).toFixed(Math.max(0, decimals));
    const [whole, fraction] = text.replace("-", "").split(".");
    const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, thinSpace) : whole;
    return (text.startsWith("-") && Number(text) !== 0 ? "−" : "") + grouped + (fraction ? "." + fraction : "");
}

function exponentOf(value) {
    // By its text, so that 999.7 counts as the 1000 it is shown as.
    return value === 0 ? 0 : Number(Math.abs(value).toExponential(3).split("e")[1]);
}

function isUnwieldy(exponent) {
    return exponent < -3 || exponent > 5;
}

function formatNumber(value, digits = 3) {
    if (!isNumber(value)) return notTold;
    if (value === 0) return "0";
    const exponent = exponentOf(value);
    if (isUnwieldy(exponent))
        return fixed(value / 10 ** exponent, digits - 1) + timesTen + superscript(exponent);
    return fixed(value, digits - 1 - exponent);
}

/// A number somebody chose: no more digits than it needs.
function formatChosen(value) {
    const text = formatNumber(value);
    return text.includes("×") ? text : text.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
}

function formatCount(value) {
    return isNumber(value) ? fixed(value, 0) : notTold;
}

/// Decimals that show an interval's half width to one or two digits, the value to two at least and four at most.
function decimalsFor(halfWidth, exponent) {
    const order = Math.floor(Math.log10(halfWidth));
    const decimals = -order + (halfWidth / 10 ** order < 2 ? 1 : 0);
    return Math.max(1 - exponent, Math.min(decimals, 3 - exponent));
}

/// Ends so far apart, by their ratio, that no number of decimals suits both.
function isWide(low, high) {
    const [less, more] = [Math.abs(low), Math.abs(high)].sort((a, b) => a - b);
    return low * high > 0 && more > 2 * less;
}

/// {value, range}: "0.31" and "0.28–0.34"; no range where there is no interval.
function intervalParts(value, low, high) {
    if (!isNumber(value)) return { value: notTold, range: "" };
    if (!isNumber(low) || !isNumber(high) || high <= low) return { value: formatNumber(value), range: "" };
    const dash = low < 0 ? " to " : "–";
    if (isWide(low, high)) return { value: formatNumber(value, 2), range: formatNumber(low, 2) + dash + formatNumber(high, 2) };
    const exponent = exponentOf(value === 0 ? (high - low) / 2 : value);
    const scale = isUnwieldy(exponent) ? 10 ** exponent : 1;
    const decimals = decimalsFor((high - low) / 2 / scale, scale === 1 ? exponent : 0);
    const suffix = scale === 1 ? "" : timesTen + superscript(exponent);
    return {
        value: fixed(value / scale, decimals) + suffix,
        range: fixed(low / scale, decimals) + dash + fixed(high / scale, decimals) + suffix,
    };
}

function formatInterval(value, low, high) {
    const parts = intervalParts(value, low, high);
    return parts.range ? `${parts.value} (${parts.range})` : parts.value;
}

function formatSeconds(value) {
    return isNumber(value) ? `${formatChosen(value)} s` : notTold;
}

function joined(words, last = "and") {
    return words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} ${last} ${words[words.length - 1]}`;
}
