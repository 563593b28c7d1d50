// Elements of the page. Text from the data only ever enters as text nodes.

function element(tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (value === null || value === undefined || (value === false && !name.startsWith("aria-"))) continue;
        if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
        else node.setAttribute(name, value === true ? "" : value);
    }
    node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== ""));
    return node;
}

function byId(id) {
    return document.getElementById(id);
}

let controlCount = 0;

/// One of a few values, as radio buttons in a row. `choices`: [value, label].
function radioGroup(legend, choices, chosen, onChange) {
    const name = `choice-${++controlCount}`;
    return element("fieldset", { class: "choices" }, element("legend", {}, legend),
        choices.map(([value, label]) => element("label", {},
            element("input", { type: "radio", name, value, checked: value === chosen, onchange: () => onChange(value) }),
            element("span", {}, label))));
}

/// `choices`: [value, label]; `onChange` gets the value's index too.
function selectBox(label, choices, onChange) {
    const id = `select-${++controlCount}`;
    const select = element("select", { id, onchange: () => onChange(choices[select.selectedIndex][0], select.selectedIndex) },
        choices.map(([, text], i) => element("option", { value: i }, text)));
    return element("span", { class: "control" }, element("label", { for: id }, label), select);
}

/// An exposure in stops. `show` moves the slider without a word to `onInput`.
function exposureSlider(label, onInput) {
    const id = `range-${++controlCount}`;
    const shown = element("output", { for: id }, "0");
    const input = element("input", { id, type: "range", min: -8, max: 8, step: 0.25, value: 0 });
    const show = (stops) => {
        input.value = stops;
        shown.textContent = (stops > 0 ? "+" : stops < 0 ? "−" : "") + Math.abs(stops);
    };
    input.addEventListener("input", () => { show(Number(input.value)); onInput(Number(input.value)); });
    return { node: element("span", { class: "control" }, element("label", { for: id }, label), input, shown), show };
}

/// Calls `draw(container, width in CSS pixels)` now and whenever the width changes.
function drawToWidth(container, draw) {
    let width = 0;
    const redraw = () => {
        const next = Math.floor(container.clientWidth);
        if (next === 0 || next === width) return;
        width = next;
        container.replaceChildren();
        draw(container, width);
    };
    new ResizeObserver(redraw).observe(container);
    redraw();
    return { redraw: () => { width = 0; redraw(); } };
}

/// `columns`: {head, text(row), sort(row)?, isText?}. Headings sort by a click.
function dataTable(caption, columns, rows) {
    const body = element("tbody");
    const fill = (ordered) => body.replaceChildren(...ordered.map((row) => element("tr", {},
        columns.map((column, i) => element(i === 0 ? "th" : "td",
            { scope: i === 0 ? "row" : null, class: column.isText ? "text" : null }, column.text(row))))));
    const heads = columns.map((column) => {
        const head = element("th", { scope: "col", class: column.isText ? "text" : null });
        head.append(column.sort ? element("button", { type: "button", onclick: () => sortBy(column, head) }, column.head)
                                : column.head);
        return head;
    });
    const sortBy = (column, head) => {
        const isUp = head.getAttribute("aria-sort") !== "ascending";
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", isUp ? "ascending" : "descending");
        const keyed = rows.map((row) => ({ row, key: column.sort(row) }));
        const order = (a, b) => {
            if (a === b) return 0;
            if (a === null || a === undefined) return 1;  // what cannot be told comes last either way
            if (b === null || b === undefined) return -1;
            return (a < b ? -1 : 1) * (isUp ? 1 : -1);
        };
        fill(keyed.sort((a, b) => order(a.key, b.key)).map(({ row }) => row));
    };
    fill(rows);
    return element("div", { class: "wide", tabindex: 0, role: "region", "aria-label": caption },
        element("table", {}, element("caption", {}, caption), element("thead", {}, element("tr", {}, heads)), body));
}
