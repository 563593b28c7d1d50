// Efficiency over that of the first estimator, as bars from 1; and the time to a given error.

function barColumns(width) {
    const isNarrow = width < 560;
    return { isNarrow, rowHeight: isNarrow ? 44 : 27, left: isNarrow ? 8 : 190, right: width - (isNarrow ? 8 : 168) };
}

function drawBars(model, groups, scale, isLast, container, width) {
    const { isNarrow, rowHeight, left, right } = barColumns(width);
    const rows = groups.flatMap((group) => group.results.map((result, i) => ({ group, result, isFirst: i === 0 })));
    const top = 8;
    const gap = groups.length > 1 ? 24 : 0;
    let y = top;
    const places = rows.map((row) => {
        if (row.isFirst && gap > 0) y += gap;
        const place = y;
        y += rowHeight;
        return place;
    });
    const bottom = y + 4;
    const svg = svgIn(container, width, bottom + (isLast ? 40 : 20), `Efficiency in ${groups[0].scene} over the first estimator's, with intervals`);
    const x = scale.copy().range([left, right]);
    const ticks = logTicks(x, tickGaps.x);
    const grid = svg.append("g").attr("class", "grid").attr("aria-hidden", true);
    grid.selectAll("line").data(ticks).join("line").attr("x1", (d) => x(d.value)).attr("x2", (d) => x(d.value)).attr("y1", top).attr("y2", bottom);
    grid.selectAll("text").data(ticks).join("text").attr("text-anchor", "middle").attr("x", (d) => x(d.value)).attr("y", bottom + 15).text((d) => d.text);
    if (isLast) grid.append("text").attr("class", "name").attr("text-anchor", "end").attr("x", right).attr("y", bottom + 32).text("× the efficiency of the first; further right is better");
    rows.forEach((row, i) => {
        const style = styleOf(model, row.result);
        const line = places[i] + (isNarrow ? 30 : rowHeight / 2);
        const { efficiencyRatio: ratio, efficiencyRatioLow: low, efficiencyRatioHigh: high } = row.result;
        const isKnown = isNumber(ratio) && ratio > 0;
        if (row.isFirst && gap > 0)
            svg.append("text").attr("class", "group").attr("x", 0).attr("y", places[i] - 8).text(cameraPhrase(row.group.camera));
        const label = svg.append("g").attr("transform", `translate(${isNarrow ? 8 : 14},${isNarrow ? places[i] + 12 : line})`);
        label.append("g").attr("class", `marks c${style.colour}`).append("path").attr("class", "mark").attr("d", markPath(style));
        label.append("text").attr("x", 12).attr("dy", "0.35em").text(labelOf(row.result)).call(shortenTo, (isNarrow ? width * 0.5 : left - 40));
        if (isKnown)
            svg.append("rect").attr("class", `bar c${style.colour}`).attr("x", Math.min(x(1), x(ratio)))
                .attr("width", Math.max(1.5, Math.abs(x(ratio) - x(1)))).attr("y", line - 6).attr("height", 12);
        if (isKnown && isNumber(low) && isNumber(high) && low > 0 && high > low)
            svg.append("path").attr("class", "whisker").attr("d", `M${x(low)},${line}H${x(high)}M${x(low)},${line - 4}v8M${x(high)},${line - 4}v8`);
        svg.append("text").attr("class", "value").attr("x", isNarrow ? width - 8 : right + 10).attr("text-anchor", isNarrow ? "end" : "start")
            .attr("y", isNarrow ? places[i] + 12 : line).attr("dy", "0.35em")
            .text(!isKnown ? notTold : row.isFirst ? "1 (the first)" : formatInterval(ratio, low, high));
    });
    svg.append("path").attr("class", "one").attr("d", `M${x(1)},${top}V${bottom}`);
}

/// Cuts a text that is wider than its column; the whole is its title.
function shortenTo(selection, room) {
    const node = selection.node();
    const whole = node.textContent;
    const fits = () => !node.getComputedTextLength || node.getComputedTextLength() <= room;
    let length = whole.length;
    while (length > 4 && !fits()) node.textContent = whole.slice(0, --length) + "…";
    if (length < whole.length) selection.append("title").text(whole);
}

function extrapolated(result) {
    return result.isExtrapolated ? element("abbr", { title: "extrapolated beyond the end of the runs" }, "†") : "";
}

function timeCell(result) {
    return element("span", {}, formatInterval(result.secondsToTarget, result.secondsToTargetLow, result.secondsToTargetHigh),
        isNumber(result.secondsToTarget) ? extrapolated(result) : "");
}

function efficiencyTable(model) {
    const { targetRelMse, seconds } = model.settings;
    const at = (value, unit) => (isNumber(value) ? ` ${formatChosen(value)}${unit}` : "");
    const columns = [
        { head: "scene", isText: true, text: (r) => r.scene, sort: (r) => r.scene },
        { head: "camera", isText: true, text: (r) => r.camera, sort: (r) => r.camera },
        { head: "estimator", isText: true, text: labelOf, sort: labelOf },
        { head: `time to relMSE${at(targetRelMse, "")} / s`, text: timeCell, sort: (r) => r.secondsToTarget },
        { head: "efficiency / (1/s)", text: (r) => formatInterval(r.efficiency, r.efficiencyLow, r.efficiencyHigh), sort: (r) => r.efficiency },
        { head: `relMSE after${at(seconds, " s")}`, text: (r) => formatNumber((r.equalTime || {}).relMse), sort: (r) => (r.equalTime || {}).relMse },
        { head: "relMSE at equal samples", text: (r) => equalSamplesText(r.equalSamples), sort: (r) => (r.equalSamples || {}).relMse },
    ];
    return dataTable("Time to a given error, and error after a given time", columns, model.results);
}

function equalSamplesText(equal) {
    if (!equal || !isNumber(equal.relMse)) return notTold;
    return `${formatNumber(equal.relMse)} at ${formatCount(equal.samples)}`;
}

function drawEfficiency(model, section) {
    if (model.results.length === 0) return false;
    const ratios = model.results.flatMap((r) => [r.efficiencyRatio, r.efficiencyRatioLow, r.efficiencyRatioHigh, 1]);
    const isCompared = model.groups.some((group) => group.results.length > 1);
    section.append(element("p", {}, "Efficiency is 1 / (relMSE × seconds) at the end of the runs",
        isCompared ? "; bars are its ratio to that of the first estimator of the same scene and camera, with 95 % intervals, on one logarithmic scale for all." : "."));
    const scenes = [...new Set(model.results.map((result) => result.scene))];
    const scale = logScale(ratios, [0, 1], 1.15);
    if (isCompared)
        section.append(element("div", { class: "bars" }, scenes.map((scene) => {
            const groups = model.groups.filter((group) => group.scene === scene && group.results.length > 0);
            const plot = element("div", { class: "plot" });
            drawToWidth(plot, (container, width) => drawBars(model, groups, scale, scene === scenes[scenes.length - 1], container, width));
            return element("figure", {}, element("figcaption", {}, strong(scene)), plot);
        })));
    section.append(efficiencyTable(model));
    if (model.results.some((result) => result.isExtrapolated && isNumber(result.secondsToTarget)))
        section.append(element("p", { class: "small muted" }, "† extrapolated by 1/time beyond the end of the runs."));
    return true;
}
