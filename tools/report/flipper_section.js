// The flipper with its controls: which set, which picture, which view, and what is under the pointer.

function pictureOf(model, index) {
    return isNumber(index) ? decoded(model.pictures[index]) : null;
}

function flipperSets(model) {
    return model.groups.map((group) => {
        const reference = group.reference ? pictureOf(model, group.reference.picture) : null;
        const images = reference ? [{ label: "reference", picture: reference, note: referenceNote(group.reference) }] : [];
        for (const result of group.results) {
            const picture = pictureOf(model, result.picture);
            if (picture) images.push({ label: labelOf(result), picture, note: pictureNote(result) });
        }
        return pictureSet(group.title, reference, images, true);
    }).filter(Boolean);
}

/// Pictures of another size than the first cannot be laid over it and are left out.
function pictureSet(title, reference, images, isCompared) {
    if (images.length === 0) return null;
    const { width, height } = images[0].picture;
    const isAlike = ({ picture }) => picture.width === width && picture.height === height;
    const hasErrors = isCompared && reference !== null && isAlike({ picture: reference });
    const set = { title, width, height, reference, images: images.filter(isAlike), hasErrors };
    return { ...set, signedStops: hasErrors ? signedStopsOf(set) : 0 };
}

/// A gain for signed errors that shows four times the root mean square of the worst picture in full colour.
function signedStopsOf({ images, reference }) {
    const worst = d3.max(images, ({ picture }) => meanSquaredError(picture, reference));
    return worst > 0 ? Math.min(8, Math.max(-8, Math.floor(-Math.log2(4 * Math.sqrt(worst))))) : 0;
}

function referenceNote(reference) {
    return `${reference.estimator || "?"}, ${formatCount(reference.samples)} samples a pixel, relMSE ${formatNumber(reference.relMse, 2)}`;
}

function pictureNote(result) {
    const { equalTime } = result;
    if (!equalTime || !isNumber(equalTime.relMse)) return "";
    return `relMSE ${formatNumber(equalTime.relMse)} after ${formatSeconds(equalTime.seconds)}`;
}

function rgbText(values, pixel) {
    return [0, 1, 2].map((c) => formatNumber(values[3 * pixel + c])).join(", ");
}

class Flipper {
    constructor(model, sets) {
        this.sets = sets;
        this.view = new Viewport(() => this.update());
        this.names = element("div", { class: "names", role: "group", "aria-label": "Pictures" });
        this.readout = element("output", { class: "readout mono", "aria-live": "off" });
        this.note = element("p", { class: "small muted note", "aria-live": "polite" });
        this.colourBar = element("div", { class: "colour-bar", hidden: true });
        this.views = radioGroup("Show", [["picture", "picture"], ["squared", "squared error"], ["signed", "signed error"]], "picture",
            (view) => this.view.change({ view }));
        this.setBox = selectBox("Scene", sets.map((set) => [set, set.title]), (set) => this.view.show(set));
        this.exposure = exposureSlider("Exposure", (stops) => this.view.expose(stops));
        this.wipe = element("input", { type: "checkbox", onchange: (event) => this.view.change({ isWiping: event.target.checked }) });
        this.against = element("span", { class: "control" });
        const button = (text, label, onclick) => element("button", { type: "button", "aria-label": label, onclick }, text);
        this.node = element("div", { class: "flipper", onkeydown: (event) => this.onKey(event) },
            element("div", { class: "controls" }, this.setBox, this.views),
            this.names, this.view.frame, this.colourBar, this.readout, this.note,
            element("div", { class: "controls" }, this.exposure.node,
                element("span", { class: "control" }, button("−", "Zoom out", () => this.view.zoomAt(1 / 1.5)),
                    button("fit", "Fit the whole picture", () => this.view.fit()), button("+", "Zoom in", () => this.view.zoomAt(1.5)),
                    this.zoomText = element("output", { "aria-label": "Zoom" })),
                element("label", { class: "control" }, this.wipe, element("span", {}, "wipe")), this.against),
            element("details", { class: "help" }, element("summary", {}, "Keys and gestures"), element("p", { id: "viewer-help" },
                "1 to 9, arrow keys or a click flip through the pictures; + and −, wheel or pinch zoom, 0 fits; drag or Shift + arrow keys pan; ",
                "i j k l move the pixel that is read; e changes between picture and errors; w wipes, [ and ] move the divider. In the views of errors the exposure is their gain. ",
                "Errors are against the reference: squared is the mean over channels of (a − r)² / (r² + 0.01), signed of (a − r) / √(r² + 0.01).")));
    }

    onKey(event) {
        if (event.target.matches("select, input, summary")) return;
        // Space and Enter stay the buttons' own; arrows among names flip.
        if (this.view.onKey(event) && this.names.contains(event.target)) this.names.children[this.view.state.shown].focus();
    }

    /// Shows a set that may not be in the list (techniques), picture by picture.
    open(set, shown) {
        if (!this.sets.includes(set)) {
            this.sets.push(set);
            this.setBox.querySelector("select").append(element("option", { value: this.sets.length - 1 }, set.title));
        }
        this.node.hidden = false;
        this.setBox.querySelector("select").selectedIndex = this.sets.indexOf(set);
        this.view.show(set, shown);
    }

    update() {
        const { set, state } = this.view;
        if (!set) return;
        if (this.drawnSet !== set) this.drawSet(set);
        [...this.names.children].forEach((button, i) => button.setAttribute("aria-pressed", i === state.shown));
        this.views.querySelectorAll("input").forEach((input) => {
            input.checked = input.value === state.view;
            input.disabled = input.value !== "picture" && !set.hasErrors;
        });
        this.wipe.checked = state.isWiping;
        this.wipe.disabled = set.images.length < 2;
        this.against.hidden = !state.isWiping;
        this.against.querySelector("select").selectedIndex = state.other;
        const image = set.images[state.shown];
        this.note.textContent = `${image.label}${image.note ? ": " + image.note : ""}`
            + (state.isWiping ? `; right of the divider: ${set.images[state.other].label}` : "");
        this.zoomText.textContent = this.view.zoom ? `${formatNumber(this.view.zoom, 2)} ×` : "";
        this.readout.textContent = this.pixelText();
        this.exposure.show(this.view.stops());
        this.drawColourBar();
    }

    drawSet(set) {
        this.drawnSet = set;
        this.names.replaceChildren(...set.images.map((image, i) => element("button",
            { type: "button", "aria-pressed": false, onclick: () => this.view.change({ shown: i }) },
            i < 9 ? element("kbd", {}, String(i + 1)) : null, element("span", {}, image.label))));
        this.against.replaceChildren(selectBox("against", set.images.map((image, i) => [i, image.label]), (other) => this.view.change({ other })));
    }

    pixelText() {
        const { set, pixel, state } = this.view;
        if (!pixel) return "Point at the picture to read values.";
        const at = pixel.y * set.width + pixel.x;
        const image = set.images[state.isWiping ? pixel.index : state.shown];
        const parts = [`(${pixel.x}, ${pixel.y})`, `${image.label} ${rgbText(image.picture.values, at)}`];
        if (set.hasErrors && image.picture !== set.reference) {
            parts.push(`reference ${rgbText(set.reference.values, at)}`);
            parts.push(`squared error ${formatNumber(squaredError(image.picture.values, set.reference.values, at))}`);
            parts.push(`signed ${formatNumber(signedError(image.picture.values, set.reference.values, at))}`);
        }
        return parts.join("  ·  ");
    }

    drawColourBar() {
        const { view } = this.view.state;
        const stops = this.view.stops();
        const key = `${view} ${stops}`;
        if (this.drawnBar === key) return;
        this.drawnBar = key;
        this.colourBar.hidden = view === "picture";
        if (view === "picture") return;
        const colours = view === "squared" ? squaredColours : signedColours;
        const gain = 2 ** stops;
        const labels = view === "squared"
            ? d3.range(squaredDecades[0], squaredDecades[1] + 1).map((decade) => formatNumber(10 ** decade / gain, 1))
            : [`−${formatNumber(1 / gain, 2)} too dark`, "0", `+${formatNumber(1 / gain, 2)} too bright`];
        const stopsOf = colours.filter((_, i) => i % 2 === 0).map((colour) => `rgb(${colour.join(",")})`);
        this.colourBar.replaceChildren(
            element("div", { class: "ramp", style: `background:linear-gradient(to right,${stopsOf.join(",")})`, "aria-hidden": "true" }),
            element("div", { class: "labels" }, labels.map((text) => element("span", {}, text))));
    }
}

/// Returns the flipper, for other sections to show pictures in; null without any picture.
function drawPictures(model, section) {
    const sets = flipperSets(model);
    const flipper = new Flipper(model, sets);
    if (sets.length === 0 && !model.groups.some((group) => group.techniques.length > 0)) return null;
    section.append(element("p", {}, "Means over seeds of the pictures after equal time, beside the reference of each scene and camera. ",
        "Tone curve: sRGB after the exposure, nothing else."), flipper.node);
    flipper.node.hidden = sets.length === 0;  // until a technique is enlarged
    if (sets.length > 0) flipper.view.show(sets[0]);
    return flipper;
}
