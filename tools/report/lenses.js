// What a lens' terms cost and buy: fit error, time, and error of the picture.

/// Results through a lens' variant, in one scene or all (null).
function resultsThrough(model, lens, scene) {
    return model.results.filter((result) => isThrough(result, lens) && (scene === null || result.scene === scene));
}

function misfitIn(model, lens, scene) {
    return model.fitErrors.find((error) => isThrough(error, lens) && (scene === null || error.scene === scene)) || null;
}

/// An estimate around zero tells only how large it is at most.
function misfitText(misfit) {
    if (!misfit || !isNumber(misfit.relMse)) return "–";
    const { relMse, relMseLow, relMseHigh } = misfit;
    if (isNumber(relMseHigh) && (relMse <= 0 || relMseLow <= 0)) return `< ${formatNumber(Math.max(0, relMseHigh), 2)}`;
    return formatNumber(relMse, 2);
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
    const misfits = fits.map((lens) => ({ lens, misfit: misfitIn(model, lens, scene) })).filter(({ misfit }) => misfit);
    const misfitPanel = { title: "Picture, the fit alone", unit: "relMSE without noise", levels: [], series: [{ label: "", style: ink,
        points: misfits.map(({ lens, misfit }) => ({ x: lens.terms, y: misfit.relMse, low: misfit.relMseLow, high: misfit.relMseHigh })) }] };
    const panels = [
        ofLens("Fit error of directions", "mrad", [["fitErrorMrad", ""]]),
        ofLens("Fit error of positions", "µm", [["fitErrorMicrons", ""]]),
        ofLens("A camera ray", "ns", [["rayNs", ""]]),
        ofLens("A connection", "ns", [["connectNs", ""]]),
        misfitPanel,
        ofPictures("Picture after equal time", "relMSE", "equalTime"),
        ofPictures("Picture of equal samples", "relMSE", "equalSamples"),
    ];
    panels.forEach((panel) => { panel.levels = panel.levels.filter((level) => isNumber(level.value) && level.value > 0); });
    return panels.filter((panel) => panel.series.some((s) => s.points.some((point) => isNumber(point.y) && point.y > 0)));
}

function drawLensPanel(panel, terms, container, width) {
    const height = Math.round(Math.min(250, Math.max(214, width * 0.66)));
    const frame = { right: width - 12, top: 26, bottom: height - 42 };
    const points = panel.series.flatMap((s) => s.points).filter((point) => isNumber(point.y) && point.y > 0);
    const y = logScale([...points.map((point) => point.y), ...panel.levels.map((level) => level.value)], [frame.bottom, frame.top], 1.4);
    frame.left = leftFor(y);
    const x = logScale(terms, [frame.left, frame.right], 1.2);
    const svg = svgIn(container, width, height, `${panel.title} in ${panel.unit} over terms`);
    let free = -Infinity;
    const xTicks = terms
        .filter((value) => { const isFree = x(value) - free >= 26; if (isFree) free = x(value); return isFree; })
        .map((value) => ({ value, text: String(value) }));
    drawAxes(svg, frame, x, y, { x: "terms", y: panel.unit }, { x: xTicks });
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

function lensFigure(panel, terms) {
    const plot = element("div", { class: "plot" });
    drawToWidth(plot, (container, width) => drawLensPanel(panel, terms, container, width));
    const named = panel.series.filter((s) => s.label);
    return element("figure", { class: "lens" },
        element("figcaption", {}, strong(panel.title)), plot,
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
    const nameOf = (lens) => (isOneCamera ? lens.variant : [lens.camera, lens.variant].filter(Boolean).join(", "));
    return dataTable(caption, [
        { head: isOneCamera ? "lens" : "camera", isText: true, sort: nameOf,
          text: (lens) => element("span", {}, nameOf(lens), element("span", { class: "muted model" }, lens.description || "")) },
        { head: "terms", key: "terms", text: (lens) => (isNumber(lens.terms) ? formatCount(lens.terms) : "–"), sort: (lens) => lens.terms },
        { head: "fit error / mrad", ...number("fitErrorMrad", 2) },
        { head: "fit error / µm", ...number("fitErrorMicrons", 2) },
        { head: "ray / ns", ...number("rayNs") },
        { head: "connection / ns", ...number("connectNs") },
        ...(entries.some((lens) => misfitIn(model, lens, scene)) ? [{ head: "relMSE, fit alone", text: (lens) => misfitText(misfitIn(model, lens, scene)),
            sort: (lens) => (misfitIn(model, lens, scene) || {}).relMse }] : []),
        ...estimators.flatMap((estimator) => [pictureColumn(estimator, "equalTime", "equal time"), pictureColumn(estimator, "equalSamples", "equal samples")]),
    ].filter(({ key }) => !key || entries.some((lens) => isNumber(lens[key]))), entries);
}

function drawLens(model, camera) {
    const entries = model.lenses.filter((lens) => lens.camera === camera);
    const isShown = (scene) => entries.some((lens) => resultsThrough(model, lens, scene).length > 0 || misfitIn(model, lens, scene));
    const scenes = [...new Set([...model.scenes, ...model.fitErrors.map((error) => error.scene)])].filter(isShown);
    const body = element("div");
    const draw = (scene) => {
        const panels = lensPanels(model, camera, scene);
        const terms = [...new Set(entries.map((lens) => lens.terms).filter(isNumber))].sort((a, b) => a - b);
        body.replaceChildren(...(terms.length > 1 ? [element("div", { class: "lens-panels" }, panels.map((panel) => lensFigure(panel, terms)))] : []), lensTable(model, `${camera}: terms, fit, time, picture`, entries, scene));
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
    if (others.length > 0) section.append(lensTable({ ...model, results: [], fitErrors: [] }, traded.length > 0 ? "Other cameras" : "What rays and connections cost", others, null));
    return true;
}
