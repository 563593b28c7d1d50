// Error over samples or seconds, scene by scene and camera by camera.

/// What may be plotted. `power`: how the error falls with samples, by which the guide line goes.
const errorMeasures = [
    { key: "relMse", name: "relMSE", power: -1 },
    { key: "relMseTrimmed", name: "relMSE without the worst 0.1 %", power: -1 },
    { key: "mse", name: "MSE", power: -1 },
    { key: "mae", name: "mean absolute error", power: -0.5 },
    { key: "flip", name: "HDR-FLIP", power: null },
];

function slopeText(result) {
    if (!isNumber(result.slope)) return `slope ${notTold}`;
    const text = `slope ${formatInterval(result.slope, result.slopeLow, result.slopeHigh)}`;
    if (!isNumber(result.slopeLow) || !isNumber(result.slopeHigh)) return text;
    return result.slopeLow > -1 || result.slopeHigh < -1 ? `${text}, not −1` : text;
}

function curvePoints(result, measure, isOverTime) {
    return (result.curve || []).map((step) => ({
        step, x: isOverTime ? step.seconds : step.samples, y: step[measure.key],
        low: measure.key === "relMse" ? step.relMseLow : null, high: measure.key === "relMse" ? step.relMseHigh : null,
    }));
}

function stepText(point, measure, isOverTime) {
    const value = measure.key === "relMse" ? formatInterval(point.y, point.low, point.high) : formatNumber(point.y);
    return isOverTime ? `${value} after ${formatSeconds(point.x)}` : value;
}

class ConvergenceFigure {
    constructor(model, group, view) {
        this.model = model;
        this.group = group;
        this.view = view;
        this.cursor = null;
        this.hidden = new Set();
        this.steps = [...new Set(group.results.flatMap((result) => (result.curve || []).map((step) => step.samples)))]
            .sort((a, b) => a - b);
        this.plot = element("div", {
            class: "plot", tabindex: 0, role: "group", onkeydown: (event) => this.onKey(event),
            "aria-label": `Convergence of ${group.title}. Left and right arrow keys read the values.`,
            onblur: () => this.setCursor(null),
        });
        this.readout = element("output", { class: "readout", "aria-live": "polite" });
        this.legend = element("ul", { class: "legend" });
        this.node = element("figure", { class: "convergence" },
            element("figcaption", {}, strong(group.title)), this.plot, this.readout, this.legend,
            this.warning());
        this.drawing = drawToWidth(this.plot, (container, width) => this.draw(container, width));
        this.setCursor(null);
    }

    warning() {
        const { reference } = this.group;
        if (!reference) return element("p", { class: "caution small" }, "⚠ There is no reference here.");
        if (!reference.isTooNoisy) return null;
        return element("p", { class: "caution small" }, "⚠ The reference is too noisy to tell errors near its own: ",
            reference.verdict || "");
    }

    redraw() {
        this.drawing.redraw();
        this.setCursor(this.cursor);
    }

    series() {
        return this.group.results.filter((result) => !this.hidden.has(result)).map((result) => ({
            result, style: styleOf(this.model, result), points: curvePoints(result, this.view.measure, this.view.isOverTime),
        }));
    }

    draw(container, width) {
        const { measure, isOverTime } = this.view;
        const height = Math.round(Math.min(340, Math.max(250, width * 0.68)));
        const frame = { right: width - 10, top: 26, bottom: height - 42 };
        const series = this.series();
        const points = series.flatMap((s) => s.points);
        const floor = measure.key === "relMse" && this.group.reference ? this.group.reference.relMse : null;
        const shown = points.map((p) => p.y);
        const lowest = d3.min(shown.filter((value) => value > 0));
        // A floor far below would squeeze the curves: the legend tells it then.
        this.isFloorShown = isNumber(floor) && floor > 0 && isNumber(lowest) && floor > lowest / 300;
        const y = logScale(this.isFloorShown ? [...shown, floor] : shown, [frame.bottom, frame.top]);
        frame.left = leftFor(y);
        const x = logScale(points.map((p) => p.x), [frame.left, frame.right], 1.35);
        const svg = svgIn(container, width, height,
            `${measure.name} of ${this.group.title} over ${isOverTime ? "seconds" : "samples a pixel"}`);
        drawAxes(svg, frame, x, y, { x: isOverTime ? "seconds" : "samples a pixel", y: measure.name });
        const clip = clippedTo(svg, frame);
        if (this.isFloorShown)
            clip.append("path").attr("class", "floor").attr("d", `M${frame.left},${y(floor)}H${frame.right}`);
        if (measure.power !== null) this.drawGuide(clip, x, y, series);
        for (const s of series) drawSeries(svg, clip, x, y, s);
        this.cursorLayer = svg.append("g").attr("class", "cursor").attr("aria-hidden", true);
        this.scales = { x, y, frame };
        this.drawLegend();
        svg.on("pointermove", () => this.setCursor(this.nearestStep(d3.mouse(svg.node())[0])))
            .on("pointerleave", () => this.setCursor(null));
        if (points.every((p) => !isNumber(p.y)))
            svg.append("text").attr("class", "empty").attr("x", (frame.left + frame.right) / 2)
                .attr("y", (frame.top + frame.bottom) / 2).attr("text-anchor", "middle").text(notTold);
    }

    /// Through the middle of the first points, as 1/N for squared errors.
    drawGuide(clip, x, y, series) {
        const firsts = series.map((s) => s.points.find((p) => p.x > 0 && p.y > 0)).filter(Boolean);
        if (firsts.length === 0) return;
        const mean = (key) => Math.exp(d3.mean(firsts, (p) => Math.log(p[key])));
        const [low, high] = x.domain();
        const at = (value) => mean("y") * (value / mean("x")) ** this.view.measure.power;
        clip.append("path").attr("class", "guide").attr("d", `M${x(low)},${y(at(low))}L${x(high)},${y(at(high))}`);
    }

    /// The value at the cursor, else the slope.
    legendText(result) {
        const { measure, isOverTime } = this.view;
        if (this.cursor === null) return measure.key === "relMse" ? slopeText(result) : "";
        const point = curvePoints(result, measure, isOverTime).find((p) => p.step.samples === this.steps[this.cursor]);
        return point ? stepText(point, measure, isOverTime) : "–";
    }

    drawLegend() {
        const { measure } = this.view;
        const { reference } = this.group;
        const items = this.group.results.map((result) => element("li", {},
            element("button", { type: "button", class: "series", "aria-pressed": !this.hidden.has(result), title: "show or hide",
                                onclick: (event) => this.toggle(result, event.currentTarget) },
                seriesKey(styleOf(this.model, result)), element("span", {}, labelOf(result))),
            element("span", { class: "muted" }, this.legendText(result))));
        if (measure.power !== null)
            items.push(element("li", {}, lineKey("guide"), element("span", { class: "muted" },
                `slope ${measure.power === -1 ? "−1" : "−½"}, to compare`)));
        if (reference && measure.key === "relMse")
            items.push(element("li", {}, lineKey("floor"), element("span", { class: "muted" },
                `the reference’s own error: ${formatNumber(reference.relMse, 2)}${this.isFloorShown ? "" : ", below this plot"}`)));
        this.legend.replaceChildren(...items);
    }

    toggle(result, button) {
        const place = [...this.legend.querySelectorAll("button")].indexOf(button);
        if (!this.hidden.delete(result)) this.hidden.add(result);
        this.redraw();
        this.legend.querySelectorAll("button")[place].focus();
    }

    nearestStep(pixel) {
        const distance = (step) => {
            const places = this.series().flatMap((s) => s.points).filter((p) => p.step.samples === step && p.x > 0);
            return d3.min(places, (p) => Math.abs(this.scales.x(p.x) - pixel));
        };
        const distances = this.steps.map(distance);
        const nearest = d3.scan(distances, (a, b) => (isNumber(a) ? a : Infinity) - (isNumber(b) ? b : Infinity));
        return nearest === undefined ? null : nearest;
    }

    onKey(event) {
        const last = this.steps.length - 1;
        const from = this.cursor;
        const moves = { ArrowRight: from === null ? 0 : Math.min(from + 1, last), ArrowLeft: from === null ? last : Math.max(from - 1, 0),
                        Home: 0, End: last, Escape: null };
        if (!(event.key in moves) || last < 0) return;
        event.preventDefault();
        this.setCursor(moves[event.key]);
    }

    setCursor(index) {
        this.cursor = index;
        this.legend.querySelectorAll("li > .muted").forEach((node, i) => {
            if (i < this.group.results.length) node.textContent = this.legendText(this.group.results[i]);
        });
        if (this.cursorLayer) this.cursorLayer.selectAll("*").remove();
        if (index === null) {
            this.readout.replaceChildren(element("span", { class: "muted" }, "Point at the plot, or use ← and →, to read values."));
            return;
        }
        const { measure, isOverTime } = this.view;
        const samples = this.steps[index];
        const at = this.series().map((s) => ({ s, point: s.points.find((p) => p.step.samples === samples) })).filter((p) => p.point);
        const { x, y, frame } = this.scales;
        if (!isOverTime)
            this.cursorLayer.append("path").attr("d", `M${x(samples)},${frame.top}V${frame.bottom}`);
        for (const { point } of at)
            if (point.x > 0 && point.y > 0)
                this.cursorLayer.append("circle").attr("cx", x(point.x)).attr("cy", y(point.y)).attr("r", 8);
        // The values are for the ears: the legend shows them.
        this.readout.replaceChildren(`${measure.name} at ${formatCount(samples)} ${samples === 1 ? "sample" : "samples"} a pixel`,
            element("span", { class: "unseen" }, ": " + at.map(({ s, point }) => `${labelOf(s.result)} ${stepText(point, measure, isOverTime)}`).join("; ")));
    }
}

function drawConvergence(model, section) {
    const groups = model.groups.filter((group) => group.results.length > 0);
    if (groups.length === 0) return false;
    const view = { isOverTime: false, measure: errorMeasures[0] };
    const figures = groups.map((group) => new ConvergenceFigure(model, group, view));
    const chosen = { scene: null, camera: null };
    const redraw = () => figures.forEach((figure) => figure.redraw());
    const filter = () => figures.forEach((figure) => {
        figure.node.hidden = (chosen.scene !== null && figure.group.scene !== chosen.scene)
            || (chosen.camera !== null && figure.group.camera !== chosen.camera);
    });
    const filterBox = (name, key, values, text) => (values.length < 2 ? null
        : selectBox(name, [[null, "all"], ...values.map((value) => [value, text(value)])], (value) => { chosen[key] = value; filter(); }));
    const measures = errorMeasures.filter(({ key }) => model.results.some((result) => (result.curve || []).some((step) => isNumber(step[key]))));
    section.append(
        element("p", {}, "Means over seeds; bands are 95 % bootstrap intervals. Slopes are fitted to log error over log samples: ",
            "an unbiased estimator of finite variance has −1 over samples. Over seconds the lower curve is the better one."),
        element("div", { class: "controls" },
            radioGroup("Over", [["samples", "samples"], ["seconds", "seconds"]], "samples", (value) => { view.isOverTime = value === "seconds"; redraw(); }),
            measures.length < 2 ? null : selectBox("Error", measures.map((measure) => [measure, measure.name]), (measure) => { view.measure = measure; redraw(); }),
            filterBox("Scene", "scene", model.scenes, (scene) => scene),
            filterBox("Camera", "camera", model.cameras, cameraPhrase)),
        element("div", { class: "figures" }, figures.map((figure) => figure.node)));
    figures.forEach((figure) => figure.redraw());
    return true;
}
