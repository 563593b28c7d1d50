// The viewport of the image flipper: what is shown, where, and how pointers and keys move it.

/// A set of pictures of one size: {title, reference, images: [{label, picture, note}], hasErrors}.
class Viewport {
    constructor(onChange) {
        this.onChange = onChange;
        this.state = { shown: 0, other: 0, isWiping: false, divider: 0.5, view: "picture" };
        this.stopsOf = { picture: 0, squared: 0, signed: 0 };
        this.set = null;
        this.pixel = null;
        this.canvas = element("canvas", { class: "picture", "aria-hidden": "true" });
        this.divider = element("div", { class: "divider", role: "slider", tabindex: 0, "aria-label": "Divider between the two pictures",
            "aria-valuemin": 0, "aria-valuemax": 100, "aria-orientation": "horizontal", hidden: true });
        this.frame = element("div");
        this.node = element("div", { class: "viewport", tabindex: 0, role: "application", "aria-label": "Picture viewer",
            "aria-describedby": "viewer-help" }, this.canvas, this.divider);
        this.painted = new Map();
        this.pointers = new Map();
        this.listen();
        this.frame.append(this.node);
        new ResizeObserver(() => this.resize()).observe(this.frame);
    }

    show(set, shown = 0) {
        const hadSize = this.set && this.set.width === set.width && this.set.height === set.height;
        this.set = set;
        this.painted.clear();
        this.state.shown = Math.min(shown, set.images.length - 1);
        this.state.other = set.images.length > 1 && this.state.shown === 0 ? 1 : 0;
        if (!set.hasErrors) this.state.view = "picture";
        this.stopsOf.signed = set.signedStops || 0;
        this.pixel = null;
        if (!hadSize) this.room = 0;
        this.resize();
        this.changed();
    }

    change(values) {
        Object.assign(this.state, values);
        // A picture wiped against itself shows nothing.
        const { isWiping, shown, other } = this.state;
        if (values.isWiping && isWiping && other === shown) this.state.other = shown === 0 ? 1 : 0;
        this.changed();
    }

    changed() {
        this.divider.hidden = !this.state.isWiping;
        this.divider.style.left = `${100 * this.state.divider}%`;
        this.divider.setAttribute("aria-valuenow", Math.round(100 * this.state.divider));
        this.draw();
        this.onChange(this);
    }

    /// Each view has its own exposure: an error's is its gain.
    stops() {
        return this.stopsOf[this.state.view];
    }

    expose(stops) {
        this.stopsOf[this.state.view] = stops;
        this.changed();
    }

    resize() {
        const room = this.frame.clientWidth;
        if (!this.set || room === 0 || room === this.room) return;
        this.room = room;
        const aspect = this.set.width / this.set.height;
        this.height = Math.round(Math.min(Math.max(220, Math.min(0.72 * window.innerHeight, 640)), room / aspect));
        this.width = Math.min(room, Math.round(this.height * aspect));
        Object.assign(this.node.style, { width: `${this.width}px`, height: `${this.height}px` });
        this.fit();
    }

    fitScale() {
        return Math.min(this.width / this.set.width, this.height / this.set.height);
    }

    fit() {
        this.zoom = this.fitScale();
        this.centre = { x: this.set.width / 2, y: this.set.height / 2 };
        this.draw();
        this.onChange(this);
    }

    isFitted() {
        return this.zoom <= this.fitScale() * 1.001;
    }

    /// Picture coordinates of a place in the viewport, and back.
    toPicture(place) {
        return { x: this.centre.x + (place.x - this.width / 2) / this.zoom, y: this.centre.y + (place.y - this.height / 2) / this.zoom };
    }

    zoomAt(factor, place = { x: this.width / 2, y: this.height / 2 }) {
        const before = this.toPicture(place);
        this.zoom = Math.min(128, Math.max(this.fitScale(), this.zoom * factor));
        const after = this.toPicture(place);
        this.moveTo(this.centre.x + before.x - after.x, this.centre.y + before.y - after.y);
    }

    /// The picture's edges stay at or outside the viewport's, as far as it is large enough.
    moveTo(x, y) {
        const held = (value, size, room) => {
            const half = room / 2 / this.zoom;
            return 2 * half >= size ? size / 2 : Math.min(size - half, Math.max(half, value));
        };
        this.centre = { x: held(x, this.set.width, this.width), y: held(y, this.set.height, this.height) };
        this.draw();
        this.onChange(this);
    }

    pan(dx, dy) {
        this.moveTo(this.centre.x + dx / this.zoom, this.centre.y + dy / this.zoom);
    }

    canvasOf(index) {
        const image = this.set.images[index];
        const { view } = this.state;
        const stops = this.stops();
        const key = `${index} ${view} ${stops}`;
        if (!this.painted.has(key)) {
            if (this.painted.size > 40) this.painted.clear();
            this.painted.set(key, paintedCanvas(image.picture, this.set.hasErrors ? this.set.reference : null, view, stops));
        }
        return this.painted.get(key);
    }

    draw() {
        if (!this.set || !this.width) return;
        const ratio = window.devicePixelRatio || 1;
        const context = this.canvas.getContext("2d");
        const width = Math.round(this.width * ratio);
        const height = Math.round(this.height * ratio);
        if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
        context.clearRect(0, 0, width, height);
        context.imageSmoothingEnabled = this.zoom * ratio < 1;
        const { shown, other, isWiping, divider } = this.state;
        this.drawPart(context, ratio, shown, 0, isWiping ? Math.round(divider * width) : width);
        if (isWiping) this.drawPart(context, ratio, other, Math.round(divider * width), width);
        this.node.classList.toggle("fitted", this.isFitted());
        if (this.pixel && this.zoom >= 5) this.outline(context, ratio);
    }

    drawPart(context, ratio, index, left, right) {
        if (right <= left) return;
        const scale = this.zoom * ratio;
        const corner = { x: (this.width / 2) * ratio - this.centre.x * scale, y: (this.height / 2) * ratio - this.centre.y * scale };
        context.save();
        context.beginPath();
        context.rect(left, 0, right - left, this.canvas.height);
        context.clip();
        context.drawImage(this.canvasOf(index), corner.x, corner.y, this.set.width * scale, this.set.height * scale);
        context.restore();
    }

    outline(context, ratio) {
        const scale = this.zoom * ratio;
        const x = (this.width / 2) * ratio + (this.pixel.x - this.centre.x) * scale;
        const y = (this.height / 2) * ratio + (this.pixel.y - this.centre.y) * scale;
        for (const [colour, width] of [["#000", 3], ["#fff", 1]]) {
            context.strokeStyle = colour;
            context.lineWidth = width * Math.max(1, ratio / 1.5);
            context.strokeRect(x, y, scale, scale);
        }
    }

    /// Which of the two pictures lies at a place.
    indexAt(place) {
        return this.state.isWiping && place && place.x > this.state.divider * this.width ? this.state.other : this.state.shown;
    }

    readAt(place) {
        const { x, y } = place ? this.toPicture(place) : { x: -1, y: -1 };
        const isInside = x >= 0 && y >= 0 && x < this.set.width && y < this.set.height;
        this.pixel = isInside ? { x: Math.floor(x), y: Math.floor(y), index: this.indexAt(place) } : null;
        this.draw();
        this.onChange(this);
    }

    movePixel(dx, dy) {
        const from = this.pixel || { x: Math.floor(this.centre.x), y: Math.floor(this.centre.y) };
        const held = (value, size) => Math.min(size - 1, Math.max(0, value));
        this.pixel = { x: held(from.x + dx, this.set.width), y: held(from.y + dy, this.set.height), index: this.state.shown };
        const half = { x: this.width / 2 / this.zoom, y: this.height / 2 / this.zoom };
        const near = (centre, value, room) => Math.min(value + room - 0.5, Math.max(value - room + 1.5, centre));
        this.moveTo(near(this.centre.x, this.pixel.x, half.x), near(this.centre.y, this.pixel.y, half.y));
    }

    flip(by) {
        const count = this.set.images.length;
        this.change({ shown: (this.state.shown + by + count) % count });
    }

    moveDivider(to) {
        this.change({ divider: Math.min(1, Math.max(0, to)) });
    }
}
