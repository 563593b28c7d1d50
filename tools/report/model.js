// The data in the order in which the page tells it: scene by scene, camera by camera.

function labelOf(result) {
    return result.variant ? `${result.estimator}, ${result.variant}` : result.estimator;
}

function cameraPhrase(camera) {
    return camera === "own" ? "its own camera" : camera;
}

function groupTitle(group) {
    return group.camera === "own" ? group.scene : `${group.scene} through ${group.camera}`;
}

function buildModel(data) {
    const model = {
        data, groups: [], results: data.results || [], lenses: data.lenses || [],
        references: data.references || [], fitErrors: data.fitErrors || [], pictures: data.pictures || [], settings: data.settings || {},
    };
    const groups = new Map();
    const groupOf = ({ scene, camera }) => {
        const key = JSON.stringify([scene, camera]);
        if (!groups.has(key)) {
            groups.set(key, { scene, camera, reference: null, results: [], techniques: [] });
            model.groups.push(groups.get(key));
        }
        return groups.get(key);
    };
    for (const result of model.results) groupOf(result).results.push(result);
    for (const reference of model.references) groupOf(reference).reference = reference;
    for (const technique of data.techniques || [])
        groupOf(technique).techniques.push(...(technique.images || []));
    model.groups.forEach((group) => { group.title = groupTitle(group); });
    model.scenes = [...new Set(model.groups.map((group) => group.scene))];
    model.cameras = [...new Set(model.groups.map((group) => group.camera))];
    model.estimators = [...new Set(model.results.map((result) => result.estimator))];
    model.variants = [...new Set(model.results.map((result) => result.variant).filter(Boolean))];
    return model;
}

/// Marks and colours repeat after different numbers, so that 42 differ in one or the other.
function seriesStyle(index, dash = 0) {
    return { colour: index % 6, mark: index % 7, dash: dash % 4 };
}

/// The same everywhere on the page: colour and mark tell the estimators apart, or the variants where
/// there are some, whose estimators then differ in their dashes.
function styleOf(model, result) {
    const estimator = model.estimators.indexOf(result.estimator);
    return result.variant ? seriesStyle(model.variants.indexOf(result.variant), estimator) : seriesStyle(estimator);
}

/// Time for the same error, relative to the first of scene and camera: the inverse of the efficiency's ratio.
function timeRatio(result) {
    const inverse = (value) => (isNumber(value) && value > 0 ? 1 / value : null);
    return { value: inverse(result.efficiencyRatio), low: inverse(result.efficiencyRatioHigh),
             high: inverse(result.efficiencyRatioLow) };
}

/// Whether a picture was taken through a lens. A scene's own camera is "own" in results and may be
/// "scene, own" among the lenses, which know no scenes.
function isThrough(result, lens) {
    return (result.variant || "") === (lens.variant || "") && (result.camera === lens.camera || `${result.scene}, ${result.camera}` === lens.camera);
}

/// Whether the intervals leave open which of two is the more efficient.
function isTied(group, a, b) {
    const first = group.results[0];
    if (a === first || b === first) {
        // The ratio is over the same seeds and times: it tells more than two intervals do.
        const { low, high } = timeRatio(a === first ? b : a);
        if (isNumber(low) && isNumber(high)) return low <= 1 && high >= 1;
    }
    const intervals = [a.efficiencyLow, a.efficiencyHigh, b.efficiencyLow, b.efficiencyHigh];
    if (!intervals.every(isNumber)) return false;
    return a.efficiencyLow <= b.efficiencyHigh && b.efficiencyLow <= a.efficiencyHigh;
}

/// {best, tied}: the most efficient, and those that cannot be told from it; best is null where nothing is known.
function winnerOf(group) {
    const known = group.results.filter((result) => isNumber(result.efficiency));
    if (known.length === 0) return { best: null, tied: [] };
    const best = known.reduce((a, b) => (b.efficiency > a.efficiency ? b : a));
    return { best, tied: known.filter((result) => result !== best && isTied(group, best, result)) };
}
