// Pointers, wheel and keys of the viewport.

Viewport.prototype.listen = function listen() {
    this.node.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
    this.node.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    this.node.addEventListener("pointermove", (event) => this.onPointerMove(event));
    for (const name of ["pointerup", "pointercancel"])
        this.node.addEventListener(name, (event) => this.onPointerUp(event, name === "pointerup"));
    this.node.addEventListener("pointerleave", () => { if (this.pointers.size === 0) this.readAt(null); });
    this.divider.addEventListener("keydown", (event) => this.onDividerKey(event));
};

Viewport.prototype.placeOf = function placeOf(event) {
    const box = this.node.getBoundingClientRect();
    return { x: event.clientX - box.left - this.node.clientLeft, y: event.clientY - box.top - this.node.clientTop };
};

/// Zooming out of what is whole already is scrolling the page.
Viewport.prototype.onWheel = function onWheel(event) {
    if (event.deltaY > 0 && this.isFitted()) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    this.zoomAt(Math.exp(-0.0025 * Math.max(-240, Math.min(240, event.deltaY * lines))), this.placeOf(event));
};

Viewport.prototype.onPointerDown = function onPointerDown(event) {
    if (event.button !== 0) return;
    const isOnDivider = event.target === this.divider;
    (isOnDivider ? this.divider : this.node).focus({ preventScroll: true });
    event.preventDefault();
    this.node.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, this.placeOf(event));
    this.drag = { isOnDivider, moved: 0, isPinch: this.pointers.size > 1 };
};

Viewport.prototype.onPointerMove = function onPointerMove(event) {
    const place = this.placeOf(event);
    const before = this.pointers.get(event.pointerId);
    if (!before) {
        this.readAt(place);
        return;
    }
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, other]) => other);
    this.pointers.set(event.pointerId, place);
    this.drag.moved += Math.hypot(place.x - before.x, place.y - before.y);
    if (others.length === 1) {
        const distance = (a, b) => Math.max(10, Math.hypot(a.x - b.x, a.y - b.y));
        const middle = { x: (place.x + others[0].x) / 2, y: (place.y + others[0].y) / 2 };
        this.pan((before.x - place.x) / 2, (before.y - place.y) / 2);
        this.zoomAt(distance(place, others[0]) / distance(before, others[0]), middle);
    } else if (this.drag.isOnDivider) {
        this.moveDivider(place.x / this.width);
    } else if (this.drag.moved > 3) {
        this.pan(before.x - place.x, before.y - place.y);
    }
    if (!this.drag.isOnDivider) this.readAt(place);
};

Viewport.prototype.onPointerUp = function onPointerUp(event, isClick) {
    if (!this.pointers.delete(event.pointerId)) return;
    const { drag } = this;
    if (!isClick || drag.isOnDivider || drag.isPinch || drag.moved > 3) return;
    if (this.state.isWiping) this.moveDivider(this.placeOf(event).x / this.width);
    else this.flip(event.shiftKey ? -1 : 1);
    if (this.pixel) this.readAt(this.placeOf(event));
};

Viewport.prototype.onDividerKey = function onDividerKey(event) {
    const step = event.shiftKey ? 0.1 : 0.02;
    const moves = { ArrowLeft: this.state.divider - step, ArrowRight: this.state.divider + step, ArrowDown: this.state.divider - step,
                    ArrowUp: this.state.divider + step, Home: 0, End: 1 };
    if (!(event.key in moves)) return;
    event.preventDefault();
    event.stopPropagation();
    this.moveDivider(moves[event.key]);
};

/// Keys of the viewport and the buttons around it; true if the key meant something.
Viewport.prototype.onKey = function onKey(event, commands) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.set) return false;
    const { state, set } = this;
    const views = set.hasErrors ? ["picture", "squared", "signed"] : ["picture"];
    const pans = { ArrowLeft: [-40, 0], ArrowRight: [40, 0], ArrowUp: [0, -40], ArrowDown: [0, 40] };
    const actions = {
        ArrowLeft: () => this.flip(-1), ArrowRight: () => this.flip(1), ArrowUp: () => this.flip(-1), ArrowDown: () => this.flip(1),
        "+": () => this.zoomAt(1.5), "=": () => this.zoomAt(1.5), "-": () => this.zoomAt(1 / 1.5), 0: () => this.fit(),
        "[": () => this.moveDivider(state.divider - 0.02), "]": () => this.moveDivider(state.divider + 0.02),
        i: () => this.movePixel(0, -1), k: () => this.movePixel(0, 1), j: () => this.movePixel(-1, 0), l: () => this.movePixel(1, 0),
        e: () => this.change({ view: views[(views.indexOf(state.view) + 1) % views.length] }),
        w: () => { if (set.images.length > 1) this.change({ isWiping: !state.isWiping }); },
        ...commands,
    };
    if (event.shiftKey && event.key in pans) this.pan(...pans[event.key]);
    else if (/^[1-9]$/.test(event.key)) {
        if (Number(event.key) > set.images.length) return false;
        this.change({ shown: Number(event.key) - 1 });
    } else if (event.key in actions) actions[event.key]();
    else return false;
    event.preventDefault();
    return true;
};
