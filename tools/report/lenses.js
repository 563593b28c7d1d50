// What a lens' terms cost and buy: fit error, time, and error of the picture.

/// Results through a lens' variant, in one scene or all (null).
function resultsThrough(model, lens, scene) {
    return model.results.filter((result) => isThrough(result, lens) && (scene === null || result.scene === scene));
}

/// {title, unit, series: [{label, style, points}], levels: [{label, value}]}
function lensPanels(model, camera, scene) {
    const entries = model.lenses.filter((lens) => lens.camera === camera);
    const fits = entries.filter((lens) => isNumber(lens.terms)).sort((a, b) => a.terms - b.terms);
    const others = entries.filter((lens) => !isNumber(lens.terms));
    const ink = seriesStyle(0);
    const ofLens = (title, unit, keys) => ({
        title, unit,
        series: keys.map(([key, label], i) => ({ label, style: keys.length > 1 ? seriesStyle(i) : ink,
            points: fits.map((lens) => ({ x: lens.terms, y: lens[key] })) })),
        levels: others.filter((lens) => keys.length === 1 && lens[keys[0][0]] > 0).map((lens) => ({ label: lens.variant || lens.description, value: lens[keys[0][0]] })),
    });
    const ofPictures = (title, unit, key) => {
        const estimators = [...new Set(fits.flatMap((lens) => resultsThrough(model, lens, scene)).map((result) => result.estimator))];
        const errorOf = (lens, estimator) => {
            const found = resultsThrough(model, lens, scene).find((result) => result.estimator === estimator);
            return found && found[key] ? found[key].relMse : null;
        };
        return {
            title, unit,
            series: estimators.map((estimator, i) => ({ label: estimator, style: seriesStyle(i, i),
                points: fits.map((lens) => ({ x: lens.terms, y: errorOf(lens, estimator) })) })),
            levels: others.flatMap((lens) => estimators.map((estimator) => ({ label: `${lens.variant || lens.description}, ${estimator}`, value: errorOf(lens, estimator) }))),
        };
    };
    const panels = [
        ofLens("Fit error of directions", "mrad", [["fitErrorMrad", ""]]),
        ofLens("Fit error of positions", "µm", [["fitErrorMicrons", ""]]),
        ofLens("A camera ray", "ns", [["rayNs", ""]]),
        ofLens("A connection", "ns", [["connectNs", ""]]),
        ofPictures("Picture after equal time", "relMSE", "equalTime"),
        ofPictures("Picture of equal samples", "relMSE", "equalSamples"),
    ];
    panels.forEach((panel) => { panel.levels = panel.levels.filter((level) => isNumber(level.value) && level.value > 0); });
    return panels.filter((panel) => panel.series.some((s) => s.points.some((point) => isNumber(point.y) && point.y > 0)));
}

function drawLensPanel(panel, container, width) {
    const height = Math.round(Math.min(240, Math.max(190, width * 0.66)));
    const frame = { left: 48, right: width - 12, top: 12, bottom: height - 42 };
    const points = panel.series.flatMap((s) => s.points).filter((point) => isNumber(point.y) && point.y > 0);
    const x = logScale(points.map((point) => point.x), [frame.left, frame.right], 1.2);
    const y = logScale([...points.map((point) => point.y), ...panel.levels.map((level) => level.value)], [frame.bottom, frame.top], 1.4);
    const svg = svgIn(container, width, height, `${panel.title} in ${panel.unit} over terms`);
    let free = -Infinity;
    const xTicks = [...new Set(points.map((point) => point.x))].sort((a, b) => a - b)
        .filter((value) => { const isFree = x(value) - free >= 26; if (isFree) free = x(value); return isFree; })
        .map((value) => ({ value, text: String(value) }));
    drawAxes(svg, frame, x, y, { x: "terms", y: "" }, { x: xTicks });
    const clip = clippedTo(svg, frame);
    let above = -Infinity;
    for (const level of [...panel.levels].sort((a, b) => b.value - a.value)) {
        const place = y(level.value);
        clip.append("path").attr("class", "level").attr("d", `M${frame.left},${place}H${frame.right}`);
        // Names of levels that lie together go below each other.
        const text = Math.max(place - 4, above + 13);
        above = text;
        svg.append("text").attr("class", "level-name").attr("x", frame.right - 2).attr("y", text).attr("text-anchor", "end").text(level.label);
    }
    for (const s of panel.series) drawSeries(svg, clip, x, y, s);
}

function lensFigure(panel) {
    const plot = element("div", { class: "plot" });
    drawToWidth(plot, (container, width) => drawLensPanel(panel, container, width));
    const named = panel.series.filter((s) => s.label);
    return element("figure", { class: "lens" },
        element("figcaption", {}, strong(panel.title), element("span", { class: "muted" }, `, ${panel.unit}`)), plot,
        named.length === 0 ? null : element("ul", { class: "legend" }, named.map((s) => element("li", {}, seriesKey(s.style), element("span", {}, s.label)))));
}

function lensTable(model, caption, entries, scene) {
    const number = (key, digits = 3) => ({ key, text: (lens) => (isNumber(lens[key]) ? formatNumber(lens[key], digits) : "–"), sort: (lens) => lens[key] });
    const estimators = [...new Set(entries.flatMap((lens) => resultsThrough(model, lens, scene)).map((result) => result.estimator))];
    const error = (estimator, key) => (lens) => {
        const found = resultsThrough(model, lens, scene).find((result) => result.estimator === estimator);
        return found && found[key] && isNumber(found[key].relMse) ? found[key].relMse : null;
    };
    const pictureColumn = (estimator, key, name) => ({ head: `${estimator} relMSE, ${name}`,
        text: (lens) => (error(estimator, key)(lens) === null ? "–" : formatNumber(error(estimator, key)(lens))), sort: error(estimator, key) });
    const isOneCamera = new Set(entries.map((lens) => lens.camera)).size === 1;
    return dataTable(caption, [
        isOneCamera ? { head: "lens", isText: true, text: (lens) => lens.variant || lens.description, sort: (lens) => lens.variant }
            : { head: "camera", isText: true, text: (lens) => [lens.camera, lens.variant].filter(Boolean).join(", "), sort: (lens) => lens.camera },
        { head: "model", isText: true, text: (lens) => lens.description || "–", sort: (lens) => lens.description },
        { head: "terms", key: "terms", text: (lens) => (isNumber(lens.terms) ? formatCount(lens.terms) : "–"), sort: (lens) => lens.terms },
        { head: "fit error / mrad", ...number("fitErrorMrad", 2) },
        { head: "fit error / µm", ...number("fitErrorMicrons", 2) },
        { head: "ray / ns", ...number("rayNs") },
        { head: "connection / ns", ...number("connectNs") },
        ...estimators.flatMap((estimator) => [pictureColumn(estimator, "equalTime", "equal time"), pictureColumn(estimator, "equalSamples", "equal samples")]),
    ].filter(({ key }) => !key || entries.some((lens) => isNumber(lens[key]))), entries);
}

function drawLens(model, camera) {
    const entries = model.lenses.filter((lens) => lens.camera === camera);
    const scenes = model.scenes.filter((scene) => entries.some((lens) => resultsThrough(model, lens, scene).length > 0));
    const body = element("div");
    const draw = (scene) => {
        const panels = lensPanels(model, camera, scene);
        const hasFits = panels.some((panel) => new Set(panel.series.flatMap((s) => s.points.map((point) => point.x))).size > 1);
        body.replaceChildren(...(hasFits ? [element("div", { class: "lens-panels" }, panels.map(lensFigure))] : []), lensTable(model, `${camera}: terms, fit, time, picture`, entries, scene));
    };
    draw(scenes.length > 0 ? scenes[0] : null);
    return element("div", { class: "lens-camera" }, element("h3", {}, cameraPhrase(camera)),
        scenes.length < 2 ? (scenes.length === 1 ? element("p", { class: "small muted" }, `Pictures: ${scenes[0]}`) : null)
            : element("div", { class: "controls" }, selectBox("Pictures of scene", scenes.map((scene) => [scene, scene]), draw)),
        body);
}

function drawLenses(model, section) {
    const cameras = [...new Set(model.lenses.map((lens) => lens.camera))];
    if (cameras.length === 0) return false;
    // A camera with one lens, and that without terms, offers nothing to trade.
    const isTrade = (camera) => {
        const entries = model.lenses.filter((lens) => lens.camera === camera);
        return entries.length > 1 || isNumber(entries[0].terms);
    };
    const traded = cameras.filter(isTrade);
    const others = model.lenses.filter((lens) => !isTrade(lens.camera));
    if (traded.length > 0)
        section.append(element("p", {}, "More terms fit better and cost more: what that is worth shows in the picture after equal time, ",
            "whose error has the noise and the misfit of the lens in it. Dashed lines are lenses without terms."),
            ...traded.map((camera) => drawLens(model, camera)));
    if (others.length > 0) section.append(lensTable({ ...model, results: [] }, traded.length > 0 ? "Other cameras" : "What rays and connections cost", others, null));
    return true;
}
