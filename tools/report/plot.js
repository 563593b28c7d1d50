// Axes, lines, bands and marks in SVG, with d3's scales and shapes.

const markShapes = [d3.symbolCircle, d3.symbolSquare, d3.symbolTriangle, d3.symbolDiamond, d3.symbolCross, d3.symbolStar, d3.symbolWye];

function markPath(style, area = 44) {
    return d3.symbol().type(markShapes[style.mark]).size(area)();
}

function tickText(value) {
    const exponent = exponentOf(value);
    if (exponent >= -3 && exponent <= 4) return formatChosen(value);
    const mantissa = Math.round((value / 10 ** exponent) * 10) / 10;
    return (mantissa === 1 ? "" : `${mantissa}·`) + "10" + superscript(exponent);
}

// Leading digits of ticks, the roundest first: as many are taken as there is room for.
const tickDigits = [[1], [2, 5], [3, 1.5, 4, 7, 6, 8, 9]];

/// Ticks at least `gap` pixels apart: powers of ten, and where those are few numbers between them.
function logTicks(scale, gap) {
    const [low, high] = scale.domain();
    const decades = Math.log10(high / low);
    const exponents = d3.range(Math.floor(Math.log10(low)), Math.ceil(Math.log10(high)) + 1);
    const perDecade = Math.abs(scale(10) - scale(1));
    const step = Math.max(1, Math.ceil(gap / perDecade));
    const taken = [];
    const take = (value) => {
        if (value < low * 0.999 || value > high * 1.001) return;
        if (taken.every((other) => Math.abs(scale(other) - scale(value)) >= gap)) taken.push(value);
    };
    for (const digits of tickDigits.slice(0, decades > 2.2 ? 1 : decades > 0.9 ? 2 : 3))
        for (const digit of digits)
            for (const exponent of exponents)
                if (step === 1 || exponent % step === 0) take(Number(`${digit}e${exponent}`));
    return taken.sort((p, q) => p - q).map((value) => ({ value, text: tickText(value) }));
}

const tickGaps = { x: 58, y: 24 };

/// Room for the ticks' texts at the left.
function leftFor(y) {
    const longest = d3.max(logTicks(y, tickGaps.y), ({ text }) => text.length) || 1;
    return Math.round(14 + 7 * longest);
}

/// A logarithmic scale around positive values, with a margin on both ends.
function logScale(values, range, margin = 1.25) {
    const positive = values.filter((value) => isNumber(value) && value > 0);
    const low = positive.length ? d3.min(positive) / margin : 1;
    const high = positive.length ? d3.max(positive) * margin : 10;
    // A single value still gets a range in which ticks make sense.
    const widening = Math.max(1, Math.sqrt(6 / (high / low)));
    return d3.scaleLog().domain([low / widening, high * widening]).range(range);
}

function svgIn(container, width, height, label) {
    return d3.select(container).append("svg").attr("width", width).attr("height", height)
        .attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img").attr("aria-label", label);
}

/// Grid, ticks and axis names. `frame`: {left, right, top, bottom}, the edges of the plotted area.
function drawAxes(svg, frame, x, y, names, ticks = {}) {
    const grid = svg.append("g").attr("class", "grid").attr("aria-hidden", true);
    const xTicks = ticks.x || logTicks(x, tickGaps.x);
    const yTicks = logTicks(y, tickGaps.y);
    grid.selectAll("line.x").data(xTicks).join("line").attr("class", "x")
        .attr("x1", (d) => x(d.value)).attr("x2", (d) => x(d.value)).attr("y1", frame.top).attr("y2", frame.bottom);
    grid.selectAll("line.y").data(yTicks).join("line").attr("class", "y")
        .attr("x1", frame.left).attr("x2", frame.right).attr("y1", (d) => y(d.value)).attr("y2", (d) => y(d.value));
    grid.selectAll("text.x").data(xTicks).join("text").attr("class", "x").attr("text-anchor", "middle")
        .attr("x", (d) => x(d.value)).attr("y", frame.bottom + 16).text((d) => d.text);
    grid.selectAll("text.y").data(yTicks).join("text").attr("class", "y").attr("text-anchor", "end")
        .attr("x", frame.left - 7).attr("y", (d) => y(d.value)).attr("dy", "0.35em").text((d) => d.text);
    grid.append("path").attr("class", "axis")
        .attr("d", `M${frame.left},${frame.top}V${frame.bottom}H${frame.right}`);
    grid.append("text").attr("class", "name").attr("x", frame.right).attr("y", frame.bottom + 33)
        .attr("text-anchor", "end").text(names.x);
    grid.append("text").attr("class", "name").attr("x", 0).attr("y", frame.top - 9).text(names.y);
}

let clipCount = 0;

/// A group that draws inside the frame only.
function clippedTo(svg, frame) {
    const id = `clip-${++clipCount}`;
    svg.append("clipPath").attr("id", id).append("rect").attr("x", frame.left).attr("y", frame.top)
        .attr("width", frame.right - frame.left).attr("height", frame.bottom - frame.top);
    return svg.append("g").attr("clip-path", `url(#${id})`);
}

/// `series`: {style, points: [{x, y, low, high}]}; points without a positive value interrupt the line.
function drawSeries(svg, clip, x, y, series) {
    const isDrawn = (point) => isNumber(point.x) && point.x > 0 && isNumber(point.y) && point.y > 0;
    const hasBand = (point) => isDrawn(point) && isNumber(point.low) && isNumber(point.high);
    const floor = y.domain()[0];
    const colour = `c${series.style.colour}`;
    if (series.points.some(hasBand))
        clip.append("path").attr("class", `band ${colour}`).datum(series.points)
            .attr("d", d3.area().defined(hasBand).x((d) => x(d.x))
                .y0((d) => y(Math.max(d.low, floor))).y1((d) => y(d.high)));
    clip.append("path").attr("class", `line ${colour} d${series.style.dash}`).datum(series.points)
        .attr("d", d3.line().defined(isDrawn).x((d) => x(d.x)).y((d) => y(d.y)));
    svg.append("g").attr("class", `marks ${colour}`).selectAll("path").data(series.points.filter(isDrawn)).join("path")
        .attr("class", "mark").attr("d", markPath(series.style))
        .attr("transform", (d) => `translate(${x(d.x)},${y(d.y)})`);
}

/// The key of a series in a legend: its line and mark.
function seriesKey(style) {
    const holder = element("span", { class: "key", "aria-hidden": "true" });
    const svg = d3.select(holder).append("svg").attr("width", 30).attr("height", 14).attr("viewBox", "0 0 30 14");
    svg.append("path").attr("class", `line c${style.colour} d${style.dash}`).attr("d", "M1,7H29");
    svg.append("g").attr("class", `marks c${style.colour}`).append("path").attr("class", "mark")
        .attr("d", markPath(style)).attr("transform", "translate(15,7)");
    return holder;
}

/// The key of a line that is no series: "guide" or "floor".
function lineKey(kind) {
    const holder = element("span", { class: "key", "aria-hidden": "true" });
    d3.select(holder).append("svg").attr("width", 30).attr("height", 14).attr("viewBox", "0 0 30 14")
        .append("path").attr("class", kind).attr("d", "M1,7H29");
    return holder;
}
