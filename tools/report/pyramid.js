// Bidirectional path tracing's techniques: a row for each path length, a column for each s.

class Pyramid {
    constructor(model, flipper, section, groups) {
        Object.assign(this, { model, flipper, section, groups });
        this.group = groups[0];
        this.isWeighted = true;
        this.stops = 0;
        this.isLifted = false;
        this.grid = element("div", { class: "wide pyramid-frame", tabindex: 0, role: "region", "aria-label": "Technique pyramid" });
    }

    indexOf(image) {
        return this.isWeighted ? image.picture : image.unweighted;
    }

    draw() {
        const images = this.group.techniques.filter(({ s, t }) => isNumber(s) && isNumber(t));
        const lengths = [...new Set(images.map(({ s, t }) => s + t - 1))].sort((a, b) => a - b);
        const columns = d3.range(0, (d3.max(images, ({ s }) => s) || 0) + 1);
        const head = element("tr", {}, element("th", { scope: "col" }, element("span", { class: "muted" }, "edges")),
            columns.map((s) => element("th", { scope: "col" }, `s = ${s}`)));
        const rows = lengths.map((length) => element("tr", {}, element("th", { scope: "row" }, String(length)),
            columns.map((s) => element("td", {}, this.cell(images.find((image) => image.s === s && s + image.t - 1 === length))))));
        // As wide as fits, within reason; below that the table scrolls.
        this.grid.style.setProperty("--thumbnail", `calc((100cqw - 58px) / ${columns.length} - 7px)`);
        this.grid.replaceChildren(element("table", { class: "pyramid" }, element("thead", {}, head), element("tbody", {}, rows)));
    }

    cell(image) {
        if (!image) return null;
        const name = `s = ${image.s}, t = ${image.t}`;
        const picture = pictureOf(this.model, this.indexOf(image));
        if (!picture) return element("span", { class: "muted small" }, `t = ${image.t}`, element("br"), notTold);
        const canvas = paintedCanvas(picture, null, "picture", this.stops + (this.isLifted ? image.s + image.t - 2 : 0));
        canvas.setAttribute("aria-hidden", "true");
        return element("button", { type: "button", class: "thumbnail", "aria-label": `Enlarge ${name}, ${this.isWeighted ? "weighted" : "unweighted"}`,
            onclick: () => this.enlarge(image) }, canvas, element("span", {}, `t = ${image.t}`));
    }

    /// In the flipper, beside the reference: the techniques in the order of the pyramid.
    enlarge(chosen) {
        const reference = this.group.reference ? pictureOf(this.model, this.group.reference.picture) : null;
        const order = [...this.group.techniques].sort((a, b) => a.s + a.t - b.s - b.t || a.s - b.s);
        const shown = order.map((image) => ({ image, picture: pictureOf(this.model, this.indexOf(image)) })).filter(({ picture }) => picture);
        const images = shown.map(({ image, picture }) => ({ label: `s ${image.s}, t ${image.t}`, picture, note: this.isWeighted ? "weighted" : "unweighted" }));
        if (reference) images.push({ label: "reference", picture: reference, note: "all paths" });
        const title = `techniques of ${this.group.title}, ${this.isWeighted ? "weighted" : "unweighted"}`;
        this.group.sets = this.group.sets || new Map();
        if (!this.group.sets.has(title)) this.group.sets.set(title, pictureSet(title, reference, images, false));
        const set = this.group.sets.get(title);
        const picture = pictureOf(this.model, this.indexOf(chosen));
        this.flipper.open(set, Math.max(0, set.images.findIndex((image) => image.picture === picture)));
        this.flipper.view.node.scrollIntoView({ block: "center" });
        this.flipper.view.node.focus({ preventScroll: true });
    }
}

function drawTechniques(model, section, flipper) {
    const groups = model.groups.filter((group) => group.techniques.length > 0);
    if (groups.length === 0 || !flipper) return false;
    const pyramid = new Pyramid(model, flipper, section, groups);
    section.append(
        element("p", {}, "What each technique of bdpt gives: s vertices from the light, t from the camera, s + t − 1 edges in all. ",
            "Weighted pictures add up to the whole; unweighted, each row estimates the same light. A click enlarges."),
        element("div", { class: "controls" },
            groups.length < 2 ? null : selectBox("Scene", groups.map((group) => [group, group.title]), (group) => { pyramid.group = group; pyramid.draw(); }),
            radioGroup("Pictures", [["weighted", "weighted"], ["unweighted", "unweighted"]], "weighted",
                (value) => { pyramid.isWeighted = value === "weighted"; pyramid.draw(); }),
            exposureSlider("Exposure", (stops) => { pyramid.stops = stops; pyramid.draw(); }).node,
            element("label", { class: "control" }, element("input", { type: "checkbox", onchange: (event) => { pyramid.isLifted = event.target.checked; pyramid.draw(); } }),
                element("span", {}, "one stop more for each further edge"))),
        groups.length === 1 ? element("p", { class: "small muted" }, groups[0].title) : "",
        pyramid.grid);
    pyramid.draw();
    return true;
}
