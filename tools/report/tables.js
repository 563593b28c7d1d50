// All numbers, as tables and as files to save.

function valueColumns(entries) {
    return entries.map(([head, get, isText]) => ({
        head, isText: Boolean(isText), get,
        text: (row) => cellText(get(row)),
        sort: (row) => get(row),
    }));
}

function cellText(value) {
    if (value === null || value === undefined) return "–";
    if (typeof value === "boolean") return value ? "yes" : "no";
    return typeof value === "number" ? (Number.isInteger(value) ? formatCount(value) : formatNumber(value, 4)) : String(value);
}

const resultKeys = ["slope", "slopeLow", "slopeHigh", "efficiency", "efficiencyLow", "efficiencyHigh", "efficiencyRatio",
    "efficiencyRatioLow", "efficiencyRatioHigh", "secondsToTarget", "secondsToTargetLow", "secondsToTargetHigh", "isExtrapolated"];
const stepKeys = ["samples", "seconds", "relMse", "relMseLow", "relMseHigh", "relMseTrimmed", "mse", "mae", "meanError", "meanErrorHalfWidth", "flip"];

function dataSets(model) {
    const own = (key, isText) => [key, (row) => row[key], isText];
    const names = ["scene", "camera", "variant", "estimator"];
    const inner = (outer, key, head) => [head, (row) => (row[outer] ? row[outer][key] : null)];
    return [
        { name: "results", title: "Results, one row a configuration", rows: model.results, columns: valueColumns([
            ...names.map((key) => own(key, true)), ...resultKeys.map((key) => own(key)),
            inner("equalSamples", "samples", "equalSamples"), inner("equalSamples", "relMse", "equalSamplesRelMse"),
            inner("equalTime", "seconds", "equalTimeSeconds"), inner("equalTime", "relMse", "equalTimeRelMse"), own("badSamples")]) },
        { name: "curves", title: "Curves, one row a checkpoint",
          rows: model.results.flatMap((result) => (result.curve || []).map((step) => ({ result, step }))),
          columns: valueColumns([...names.map((key) => [key, (row) => row.result[key], true]), ...stepKeys.map((key) => [key, (row) => row.step[key]])]) },
        { name: "references", title: "References", rows: model.references, columns: valueColumns([
            own("scene", true), own("camera", true), own("estimator", true), own("samples"), own("seconds"), own("relMse"), own("isTooNoisy"), own("verdict", true)]) },
        { name: "lenses", title: "Lenses", rows: model.lenses, columns: valueColumns([
            own("camera", true), own("variant", true), own("description", true), own("terms"), own("fitErrorMrad"), own("fitErrorMicrons"), own("rayNs"), own("connectNs")]) },
        { name: "fits", title: "What fits alone do to pictures", rows: model.fitErrors, columns: valueColumns([
            own("scene", true), own("camera", true), own("variant", true), own("relMse"), own("relMseLow"), own("relMseHigh")]) },
    ].filter((set) => set.rows.length > 0);
}

function csvCell(value) {
    if (value === null || value === undefined) return "";
    const text = String(value);
    return /[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function csvOf({ columns, rows }) {
    return [columns.map((column) => csvCell(column.head)), ...rows.map((row) => columns.map((column) => csvCell(column.get(row))))]
        .map((cells) => cells.join(",")).join("\r\n") + "\r\n";
}

function saveFile(name, type, text) {
    const address = URL.createObjectURL(new Blob([text], { type }));
    const link = element("a", { href: address, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
}

function drawData(model, section, sourceText) {
    const stem = String(model.data.title || "report").replace(/[^\w.-]+/g, "-").slice(0, 60);
    const save = (text, onclick) => element("button", { type: "button", onclick }, text);
    const sets = dataSets(model);
    section.append(
        element("p", {}, "Everything that this page was drawn from, by the names it has in the files. – is what cannot be told."),
        element("div", { class: "controls" }, save("Save JSON", () => saveFile(`${stem}.json`, "application/json", sourceText)),
            sets.map((set) => save(`Save CSV of ${set.name}`, () => saveFile(`${stem}-${set.name}.csv`, "text/csv", csvOf(set))))),
        ...sets.map((set) => {
            // The tables are long: each is made when it is first opened.
            const details = element("details", { ontoggle: () => {
                if (details.open && details.children.length === 1) details.append(dataTable(set.title, set.columns, set.rows));
            } }, element("summary", {}, `${set.title} (${formatCount(set.rows.length)})`));
            return details;
        }));
    return true;
}
