// The first screen: what won, by how much, how many terms a lens needs, and where the numbers come from.

function strong(text) {
    return element("strong", {}, text);
}

/// "bdpt needs 0.31 × the time of pt (0.28–0.34)"; after the first of them just "lt 3.1 × (2.9–3.5)".
function needs(result, first, isLong) {
    const { value, low, high } = timeRatio(result);
    if (!isNumber(value)) return [`${labelOf(result)}: ${notTold}`];
    const parts = intervalParts(value, low, high);
    return [isLong ? `${labelOf(result)} needs ` : `${labelOf(result)} `, strong(`${parts.value}\u00a0×`),
            isLong ? ` the time of ${labelOf(first)}` : "",
            parts.range ? element("span", { class: "muted" }, ` (${parts.range})`) : ""];
}

/// Of many configurations the best of each estimator, else all; the best first.
function toldOf(group, first) {
    const byTime = group.results.filter((result) => result !== first)
        .sort((a, b) => (timeRatio(a).value ?? Infinity) - (timeRatio(b).value ?? Infinity));
    if (byTime.length <= 4) return byTime;
    return byTime.filter((result, i) => byTime.findIndex((other) => other.estimator === result.estimator) === i);
}

/// "16 terms", "32 terms" -> "16", "32 terms".
function withoutRepeats(variants) {
    const isAllTerms = variants.every((variant) => variant.endsWith(" terms"));
    return variants.map((variant, i) => (isAllTerms && i < variants.length - 1 ? variant.slice(0, -6) : variant));
}

/// "bdpt", "pt or bdpt", "bdpt (16 or 32 terms)".
function winnerName(winners) {
    if (winners.length === 1) return labelOf(winners[0]);
    if (new Set(winners.map((result) => result.estimator)).size === 1)
        return `${winners[0].estimator} (${joined(withoutRepeats(winners.map((result) => result.variant || "plain")), "or")})`;
    return joined(winners.map(labelOf), "or");
}

function verdictOf(group) {
    const first = group.results[0];
    const { best, tied } = winnerOf(group);
    if (!first) return { name: "–", words: ["Nothing was measured."] };
    if (group.results.length === 1)
        return { name: labelOf(first), words: ["The only one measured; its efficiency ", best
            ? `is ${formatInterval(best.efficiency, best.efficiencyLow, best.efficiencyHigh)} / s.` : `is ${notTold}.`] };
    if (!best) return { name: "–", words: [`Which is the most efficient is ${notTold}.`] };
    const told = toldOf(group, first);
    const words = tied.length > 0 ? [`which of these ${tied.length + 1} is ${notTold}. `] : [];
    words.push(told.map((result, i) => [i > 0 ? ", " : "", ...needs(result, first, i === 0)]), ".");
    if (told.length < group.results.length - 1)
        words.push(` The best of each estimator; all ${group.results.length} are under `, element("a", { href: "#efficiency" }, "Efficiency"), ".");
    const inOrder = group.results.filter((result) => result === best || tied.includes(result));
    return { name: winnerName(inOrder), words };
}

function cautionsOf(group) {
    const cautions = [];
    if (group.reference && group.reference.isTooNoisy)
        cautions.push(`the reference is too noisy: ${group.reference.verdict || "its own error is not small against those measured"}`);
    if (!group.reference) cautions.push("no reference");
    const bad = group.results.filter((result) => result.badSamples > 0);
    for (const result of bad)
        cautions.push(`${formatCount(result.badSamples)} samples of ${labelOf(result)} were not finite and are left out`);
    return cautions;
}

function caution(text) {
    return element("span", { class: "caution" }, "⚠ ", text);
}

function answerRow(model, group) {
    const { name, words } = verdictOf(group);
    const cautions = cautionsOf(group);
    return element("div", { class: "answer" },
        element("dt", {}, element("span", { class: "scene" }, group.scene),
            element("span", { class: "muted" }, group.camera === "own" ? "" : ` through ${group.camera}`)),
        element("dd", {}, element("span", { class: "winner" }, name), " ", element("span", {}, ...words),
            cautions.map((text) => [" ", caution(text)])));
}

function leadText(model) {
    const compared = model.groups.filter((group) => new Set(group.results.map((result) => result.estimator)).size > 1);
    if (compared.length < 2) return "";
    const wins = new Map();
    let open = 0;
    for (const group of compared) {
        const { best, tied } = winnerOf(group);
        if (!best || tied.some((result) => result.estimator !== best.estimator)) open += 1;
        else wins.set(best.estimator, (wins.get(best.estimator) || 0) + 1);
    }
    if (wins.size === 0) return `In none of ${compared.length} comparisons can a winner be told.`;
    const counts = [...wins].sort((a, b) => b[1] - a[1]).map(([name, count], i) => `${name} ${i === 0 ? "wins " : ""}${count}`);
    return `Of ${compared.length} comparisons, ${joined(counts)}` + (open > 0 ? `; in ${open} no winner can be told.` : ".");
}

/// The fewest terms beyond which no picture of equal time gets better by what can be told.
function lensAdvice(model, camera) {
    const entries = model.lenses.filter((lens) => lens.camera === camera);
    const fits = entries.filter((lens) => isNumber(lens.terms)).sort((a, b) => a.terms - b.terms);
    const comparisons = new Map();
    for (const lens of fits)
        for (const result of model.results) {
            if (!isThrough(result, lens)) continue;
            if (!result.equalTime || !isNumber(result.equalTime.relMse)) continue;
            const key = JSON.stringify([result.scene, result.estimator]);
            if (!comparisons.has(key)) comparisons.set(key, []);
            const last = (result.curve || [])[(result.curve || []).length - 1] || {};
            const { relMse: error, relMseLow, relMseHigh } = result.equalTime;
            // Without an interval of its own, that of the curve's end, as a factor.
            const bound = (own, ofCurve) => (isNumber(own) ? own : isNumber(ofCurve) && last.relMse > 0 ? (error * ofCurve) / last.relMse : error);
            comparisons.get(key).push({ lens, error, low: bound(relMseLow, last.relMseLow), high: bound(relMseHigh, last.relMseHigh) });
        }
    const told = [...comparisons.values()].filter((points) => points.length > 1);
    let advised = null;
    for (const points of told) {
        const best = points.reduce((a, b) => (b.error < a.error ? b : a));
        const enough = points.find((point) => point.low <= best.high).lens;
        if (!advised || enough.terms > advised.terms) advised = enough;
    }
    const misfits = new Map(fits.map((lens) => [lens, misfitOf(model, lens)]));
    return { camera, entries, fits, advised, misfits, target: model.settings.targetRelMse };
}

/// The most that a fit alone adds to the relMSE of any scene measured, at the upper end of its interval; null: not measured.
function misfitOf(model, lens) {
    const highs = model.fitErrors.filter((error) => isThrough(error, lens)).map((error) => error.relMseHigh ?? error.relMse).filter(isNumber);
    return highs.length > 0 ? Math.max(0, ...highs) : null;
}

/// Where no pictures of equal time compare terms: the fewest whose misfit is below a tenth of the error aimed at.
function enoughByMisfit({ fits, misfits, target }) {
    return isNumber(target) ? fits.find((lens) => misfits.get(lens) !== null && misfits.get(lens) < 0.1 * target) : undefined;
}

function fitText(lens, misfit) {
    const errors = [];
    if (isNumber(lens.fitErrorMrad)) errors.push(`${formatNumber(lens.fitErrorMrad, 2)} mrad`);
    if (isNumber(lens.fitErrorMicrons)) errors.push(`${formatNumber(lens.fitErrorMicrons, 2)} µm`);
    const parts = [];
    if (errors.length > 0) parts.push(`fit error ${errors[0]}${errors[1] ? ` (${errors[1]})` : ""}`);
    if (isNumber(misfit)) parts.push(`at most ${formatNumber(misfit, 2)} of relMSE by the fit alone`);
    if (isNumber(lens.rayNs)) parts.push(`${formatNumber(lens.rayNs)} ns a ray`);
    return parts.join(", ");
}

function lensAnswer(advice) {
    const { fits, advised, entries, misfits } = advice;
    const exact = entries.find((lens) => !isNumber(lens.terms) && isNumber(lens.rayNs) && /trac/i.test(`${lens.variant} ${lens.description}`));
    const against = (lens) => (exact && lens && exact.rayNs > 0 && isNumber(lens.rayNs)
        ? ` An exact trace takes ${formatNumber(exact.rayNs)} ns.` : "");
    if (fits.length === 0) return { name: "no terms to choose", words: entries.map((lens) => lens.description || lens.variant).filter(Boolean).join("; ") };
    if (fits.length === 1)
        return { name: `${fits[0].terms} terms`, words: `The only fit measured: ${fitText(fits[0], misfits.get(fits[0]))}.${against(fits[0])}` };
    const enough = advised ? undefined : enoughByMisfit(advice);
    const sentence = (lens) => {
        const facts = fitText(lens, misfits.get(lens));
        return `${facts.charAt(0).toUpperCase()}${facts.slice(1)}.${against(lens)}`;
    };
    if (enough)
        return { name: `${enough.terms} terms`, words: `The fewest by whose fit alone less than a tenth of the target relMSE arises; pictures of equal time were not compared. ${sentence(enough)}` };
    if (!advised)
        return { name: notTold, words: `No pictures through different numbers of terms were measured; fits of ${joined(fits.map((lens) => String(lens.terms)))} terms are below.` };
    const isMost = advised === fits[fits.length - 1];
    const why = isMost ? "Fewer give worse pictures in equal time; more were not measured."
        : "More gain nothing that can be told in pictures of equal time.";
    return { name: `${advised.terms} terms`, words: `${why} ${sentence(advised)}` };
}

function lensAnswers(model) {
    const cameras = [...new Set(model.lenses.map((lens) => lens.camera))];
    const rows = cameras.map((camera) => lensAdvice(model, camera))
        .filter(({ entries }) => entries.some((lens) => lens.variant || isNumber(lens.terms)))
        .map((advice) => {
            const { name, words } = lensAnswer(advice);
            return element("div", { class: "answer" }, element("dt", {}, element("span", { class: "scene" }, advice.camera)),
                element("dd", {}, element("span", { class: "winner" }, name), " ", element("span", {}, words)));
        });
    return rows.length === 0 ? null
        : [element("h2", { class: "question" }, "How many terms does the lens need?"), element("dl", { class: "answers" }, rows)];
}

function settingsText({ width, height, seeds, seconds, samples, targetRelMse, threads }) {
    const parts = [];
    if (isNumber(width) && isNumber(height)) parts.push(`${width} × ${height} pixels`);
    if (isNumber(seeds)) parts.push(`${seeds} seeds`);
    if (isNumber(seconds)) parts.push(`${formatSeconds(seconds)} each`);
    if (isNumber(samples)) parts.push(`at most ${formatCount(samples)} samples a pixel`);
    if (isNumber(targetRelMse)) parts.push(`target relMSE ${formatChosen(targetRelMse)}`);
    if (isNumber(threads)) parts.push(`${threads} ${threads === 1 ? "thread" : "threads"}`);
    return parts.join(", ");
}

function machineText({ processor, cores, isa, system, compiler, build }) {
    return [processor, isNumber(cores) ? `${cores} cores` : null, isa, system, compiler, build].filter(Boolean).join(", ");
}

function loadText({ load, cores }) {
    if (!isNumber(load)) return notTold;
    const isBusy = isNumber(cores) && load > 0.5 * cores;
    return formatChosen(load) + (isBusy ? ": the machine was busy, so trust the times less" : "");
}

/// Options break between words, not after their dashes.
function commandText(command) {
    return element("code", {}, String(command).split(/( )/).map((word) => (word.length < 24 ? element("span", { class: "word" }, word) : word)));
}

function provenance(model) {
    const { data } = model;
    const started = data.started ? String(data.started).replace("T", " ").replace("Z", " UTC") : notTold;
    const facts = [
        ["Command", commandText(data.command || notTold)],
        ["Settings", settingsText(model.settings) || notTold],
        ["Machine", machineText(data.machine || {}) || notTold],
        ["Load at the start", loadText(data.machine || {})],
        ["Started", started + (data.version ? ", étendue " + data.version : "")],
        ["Suite", data.isComplete === false ? caution("interrupted: some rows are missing")
            : `complete: ${model.results.length} ${model.results.length === 1 ? "configuration" : "configurations"}`],
    ];
    return element("dl", { class: "facts" },
        facts.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}

function drawAnswers(model, section) {
    const lead = leadText(model);
    if (model.data.isComplete === false)
        section.append(element("p", { class: "warning", role: "status" },
            "The suite was interrupted: what follows is what was measured until then, and some rows are missing."));
    section.append(element("h2", { class: "question" }, "Which estimator is the most efficient?"));
    if (lead) section.append(element("p", { class: "lead" }, lead));
    section.append(model.groups.length === 0 ? element("p", {}, "Nothing was measured.")
        : element("dl", { class: "answers" }, model.groups.map((group) => answerRow(model, group))));
    section.append(...(lensAnswers(model) || []));
    section.append(element("p", { class: "small muted" },
        "Time is what the same relative mean squared error (relMSE) costs; in brackets the 95 % interval over seeds. ",
        "A picture’s error is measured against the reference of its scene and camera."));
    section.append(provenance(model));
}
