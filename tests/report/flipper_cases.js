// The image flipper and the technique pyramid.
"use strict";

const { test } = require("node:test");
const assert = require("node:assert/strict");
const { withPage, shownPixel, shownSum } = require("./browser.js");
const { fixture, unpacked } = require("./fixture.js");

const data = fixture();
const [width, height] = [96, 64];
const pictures = ["pt", "lt", "bdpt"].map((name) => data.results.find((r) => r.scene === "cornell-box" && r.estimator === name).picture);
const values = [data.references[0].picture, ...pictures].map((index) => unpacked(data.pictures[index]));  // as the buttons' order
const rgbAt = (picture, x, y) => values[picture].slice(3 * (y * width + x), 3 * (y * width + x) + 3);

/// The sRGB curve of IEC 61966-2-1.
const srgb = (linear) => Math.round(255 * Math.min(1, linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
const shownAs = (picture, x, y, stops = 0) => rgbAt(picture, x, y).map((value) => srgb(Math.max(0, value) * 2 ** stops));
const errorsAt = (picture, x, y) => {
    const reference = rgbAt(0, x, y);
    const terms = rgbAt(picture, x, y).map((value, c) => (value - reference[c]) / Math.sqrt(reference[c] ** 2 + 0.01));
    return { squared: terms.reduce((sum, term) => sum + term ** 2, 0) / 3, signed: terms.reduce((sum, term) => sum + term, 0) / 3 };
};
const probes = [[5, 30], [40, 40], [60, 20], [90, 50], [48, 2], [30, 60]];

async function assertShows(page, picture, stops = 0) {
    for (const [x, y] of probes) assert.deepEqual(await shownPixel(page, x, y), shownAs(picture, x, y, stops), `picture ${picture} at ${x}, ${y}`);
}

const onFlipper = (use, options = {}) => withPage("fixture", data, options, async (page) => {
    const viewport = page.locator(".viewport");
    await viewport.scrollIntoViewIfNeeded();
    await use(page, viewport, await viewport.boundingBox());
});

/// The middle of a picture's pixel on the screen, at "fit".
const placeOf = (box, x, y) => [box.x + ((x + 0.5) * box.width) / width, box.y + ((y + 0.5) * box.height) / height];
const pressed = (page) => page.locator(".names button").evaluateAll((buttons) => buttons.findIndex((button) => button.getAttribute("aria-pressed") === "true"));

test("flipper: pictures are tone-mapped to the byte, and flip by key, button and click", () => onFlipper(async (page, viewport) => {
    await assertShows(page, 0);
    await viewport.focus();
    for (const [key, shown] of [["2", 1], ["ArrowRight", 2], ["ArrowRight", 3], ["ArrowRight", 0], ["ArrowLeft", 3], ["1", 0], ["9", 0]]) {
        await page.keyboard.press(key);
        await assertShows(page, shown);
        assert.equal(await pressed(page), shown);
    }
    await page.locator(".names button").nth(2).click();
    await assertShows(page, 2);
    await page.keyboard.press("ArrowRight");  // focus is on the button
    await assertShows(page, 3);
    await viewport.click({ position: { x: 5, y: 5 } });
    await page.mouse.move(0, 0);  // away: the outline of the pixel read is in no picture
    await assertShows(page, 0);
    await viewport.click({ position: { x: 5, y: 5 }, modifiers: ["Shift"] });
    await page.mouse.move(0, 0);
    await assertShows(page, 3);
}));

test("flipper: exposure scales light before the tone curve", () => onFlipper(async (page) => {
    const slider = page.locator("#pictures").getByLabel("Exposure");
    for (let i = 0; i < 6; ++i) await slider.press("ArrowRight");
    await assertShows(page, 0, 1.5);
    for (let i = 0; i < 18; ++i) await slider.press("ArrowLeft");
    await assertShows(page, 0, -3);
}));

test("flipper: values under the pointer and by keys are those of the picture, and its errors", () => onFlipper(async (page, viewport, box) => {
    await viewport.focus();
    await page.keyboard.press("2");
    const read = async () => {
        const text = (await page.locator(".readout.mono").innerText()).replace(/\u202f/g, "");
        const number = (part) => {
            const [, mantissa, power] = part.match(/([−\d.]+)(?:\s×\s10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?/);
            const exponent = power ? Number([...power].map((c) => (c === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c))).join("")) : 0;
            return Number(mantissa.replace("−", "-")) * 10 ** exponent;
        };
        const parts = text.split("·").map((part) => part.trim());
        return { place: parts[0], rgb: parts[1].replace("pt ", "").split(", ").map(number), squared: number(parts[3].replace("squared error", "")),
                 signed: number(parts[4].replace("signed", "")) };
    };
    const near = (actual, expected) => assert.ok(Math.abs(actual - expected) <= 0.006 * Math.abs(expected), `${actual} is not ${expected}`);  // three digits
    const assertReads = async (x, y) => {
        const got = await read();
        assert.equal(got.place, `(${x}, ${y})`);
        rgbAt(1, x, y).forEach((value, c) => near(got.rgb[c], value));
        near(got.squared, errorsAt(1, x, y).squared);
        near(got.signed, errorsAt(1, x, y).signed);
    };
    for (const [x, y] of probes) {
        await page.mouse.move(...placeOf(box, x, y));
        await assertReads(x, y);
    }
    await page.mouse.move(...placeOf(box, 40, 40));
    for (const key of ["l", "l", "k", "j", "i", "i"]) await page.keyboard.press(key);
    await assertReads(41, 39);
}));

test("flipper: error views colour what the test reckons", () => onFlipper(async (page, viewport) => {
    await viewport.focus();
    await page.keyboard.press("2");
    await page.getByLabel("squared error").check();
    // Viridis gets lighter all along: the order of the errors is that of the greens.
    const all = [];
    for (let i = 0; i < 40; ++i) {
        const [x, y] = [(i * 37) % width, (i * 23) % height];
        const place = Math.min(1, Math.max(0, (Math.log10(errorsAt(1, x, y).squared) + 4) / 4));
        all.push({ place, green: (await shownPixel(page, x, y))[1] });
    }
    const viridis = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"].map((hex) => parseInt(hex.slice(3, 5), 16));
    for (const { place, green } of all) {
        const i = Math.min(8, Math.floor(place * 9));
        const expected = viridis[i] + (viridis[i + 1] - viridis[i]) * (place * 9 - i);
        assert.ok(Math.abs(green - expected) <= 2, `green ${green}, not ${expected}`);  // 255 steps of at most 1.6, rounded twice
    }
    assert.ok(new Set(all.map(({ green }) => green)).size > 20);
    await viewport.focus();
    await page.keyboard.press("e");
    assert.ok(await page.getByLabel("signed error").isChecked());
    for (let i = 0; i < 40; ++i) {
        const [x, y] = [(i * 37) % width, (i * 23) % height];
        const { signed } = errorsAt(1, x, y);
        const [red, , blue] = await shownPixel(page, x, y);
        if (Math.abs(signed) > 0.02) assert.equal(red > blue, signed > 0, `${signed} is shown as ${red}, ${blue}`);
    }
    await page.keyboard.press("1");  // the reference against itself
    assert.deepEqual(await shownPixel(page, 40, 40), [247, 247, 247]);
    assert.match(await page.locator(".colour-bar").innerText(), /too dark\s*0\s*\+0\.\d+ too bright/);
}));

test("flipper: the wipe shows one picture left and another right, by mouse and keys", () => onFlipper(async (page, viewport, box) => {
    await viewport.focus();
    await page.keyboard.press("2");
    await page.keyboard.press("w");
    await page.locator("#pictures").getByLabel("against").selectOption({ label: "bdpt" });
    const assertDivided = async (column) => {
        for (const [x, y] of probes) if (Math.abs(x - column) > 1) assert.deepEqual(await shownPixel(page, x, y), shownAs(x < column ? 1 : 3, x, y));
    };
    await assertDivided(48);
    const divider = page.getByRole("slider", { name: "Divider" });
    await divider.focus();
    for (let i = 0; i < 10; ++i) await page.keyboard.press("ArrowLeft");
    assert.equal(await divider.getAttribute("aria-valuenow"), "30");
    await assertDivided(0.3 * width);
    const grip = await divider.boundingBox();
    await page.mouse.move(grip.x + grip.width / 2, grip.y + grip.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.8 * box.width, box.y + 20, { steps: 4 });
    await page.mouse.up();
    await page.mouse.move(0, 0);
    await assertDivided(0.8 * width);
    await viewport.focus();
    await page.keyboard.press("[");
    assert.equal(await divider.getAttribute("aria-valuenow"), "78");
    await assertDivided(0.78 * width);
    await page.keyboard.press("w");
    await assertShows(page, 1);
}));

test("flipper: zoom and pan by wheel, keys and dragging keep pixels square and sharp", () => onFlipper(async (page, viewport, box) => {
    await viewport.focus();
    const fitted = await shownSum(page);
    const centre = [box.x + box.width / 2, box.y + box.height / 2];
    const zoomOf = async () => Number((await page.locator("#pictures output[aria-label=Zoom]").innerText()).replace(" ×", ""));
    const before = await zoomOf();
    await page.mouse.move(...centre);
    for (let i = 0; i < 12; ++i) await page.mouse.wheel(0, -240);
    await page.waitForTimeout(100);
    assert.ok(await zoomOf() > 8 * before);
    await page.mouse.move(0, 0);
    // At the middle lie the pixels around (48, 32), each as a square of one colour, with sharp edges; 40 below and
    // right of it is within that pixel, wherever in its own pixel the pointer was.
    const found = await page.evaluate(() => {
        const canvas = document.querySelector("canvas.picture");
        const { data: bytes } = canvas.getContext("2d").getImageData(0, Math.floor(canvas.height / 2) + 40, canvas.width, 1);
        const runs = [];
        for (let x = 0; x < canvas.width; ++x) {
            const colour = [...bytes.slice(4 * x, 4 * x + 3)].join();
            if (runs.length && runs[runs.length - 1].colour === colour) runs[runs.length - 1].length += 1;
            else runs.push({ colour, length: 1 });
        }
        return runs;
    });
    const zoom = await zoomOf();
    const expected = new Set(Array.from({ length: width }, (_, x) => shownAs(0, x, 32).join()));
    for (const { colour } of found) assert.ok(expected.has(colour), `${colour} is no pixel's colour`);
    for (const { length } of found.slice(1, -1)) assert.ok(length >= zoom * 0.97 - 1, `${length} of ${zoom}`);
    // Dragging left shows what lies to the right; arrows with Shift the other way.
    const middle = () => page.evaluate(() => {
        const canvas = document.querySelector("canvas.picture");
        return [...canvas.getContext("2d").getImageData(canvas.width / 2 + 40, canvas.height / 2 + 40, 1, 1).data.slice(0, 3)];
    });
    assert.deepEqual(await middle(), shownAs(0, 48, 32));
    await page.mouse.move(...centre);
    await page.mouse.down();
    await page.mouse.move(centre[0] - zoom * 2, centre[1], { steps: 5 });
    await page.mouse.up();
    await page.mouse.move(0, 0);
    assert.deepEqual(await middle(), shownAs(0, 50, 32));
    assert.equal(await pressed(page), 0, "dragging is no click");
    await viewport.focus();
    await page.keyboard.press("0");
    assert.equal(await shownSum(page), fitted);
    await page.keyboard.press("+");
    assert.notEqual(await shownSum(page), fitted);
    const zoomed = await shownSum(page);
    await page.keyboard.press("Shift+ArrowRight");
    assert.notEqual(await shownSum(page), zoomed);
    await page.keyboard.press("Shift+ArrowLeft");
    assert.equal(await shownSum(page), zoomed);
    await page.keyboard.press("-");
    assert.equal(await shownSum(page), fitted);
}));

test("flipper: two fingers zoom", () => onFlipper(async (page, viewport, box) => {
    const before = await shownSum(page);
    await viewport.evaluate((node, [x, y]) => {
        const send = (type, pointerId, dx) => node.dispatchEvent(new PointerEvent(type, { pointerId, pointerType: "touch", isPrimary: pointerId === 1, button: type === "pointermove" ? -1 : 0,
            clientX: x + dx, clientY: y, bubbles: true, cancelable: true }));
        node.setPointerCapture = () => {};  // made-up pointers cannot be captured
        send("pointerdown", 1, -20);
        send("pointerdown", 2, 20);
        for (const dx of [30, 40, 60, 80]) { send("pointermove", 1, -dx); send("pointermove", 2, dx); }
        send("pointerup", 1, -80);
        send("pointerup", 2, 80);
    }, [box.x + box.width / 2, box.y + box.height / 2]);
    assert.notEqual(await shownSum(page), before);
    const zoom = Number((await page.locator("#pictures output[aria-label=Zoom]").innerText()).replace(" ×", ""));
    const fit = box.width / width;
    assert.ok(Math.abs(zoom / fit - 4) < 0.1, `${zoom / fit} for four times the distance`);
    assert.equal(await pressed(page), 0, "pinching is no click");
}));

test("flipper: sharp on a screen of two pixels to one, too", () => onFlipper(async (page, viewport, box) => {
    await assertShows(page, 0);
    assert.equal(await page.locator("canvas.picture").evaluate((canvas) => canvas.width), 2 * box.width);
}, { deviceScaleFactor: 2, viewport: { width: 390, height: 800 } }));

test("techniques: a picture at each (s, t), weighted or not, and each enlarges", () => withPage("fixture", data, {}, async (page) => {
    const { images } = data.techniques[0];
    const cells = await page.locator("table.pyramid tbody tr").evaluateAll((rows) => rows.map((row) => [...row.querySelectorAll("td")].map((cell) => cell.innerText.trim())));
    assert.equal(cells.length, 5);
    cells.forEach((row, i) => row.forEach((text, s) => assert.equal(text, s <= i + 1 ? `t = ${i + 2 - s}` : "")));
    const thumbnail = (i) => page.evaluate((index) => {
        const canvas = document.querySelectorAll("table.pyramid canvas")[index];
        return [...canvas.getContext("2d").getImageData(40, 40, 1, 1).data.slice(0, 3)];
    }, i);
    const expected = (picture) => unpacked(data.pictures[picture]).slice(3 * (40 * width + 40), 3 * (40 * width + 40) + 3).map(srgb);
    assert.equal(await page.locator("table.pyramid canvas").count(), images.length);
    for (const i of [0, 7, 19]) assert.deepEqual(await thumbnail(i), expected(images[i].picture));
    await page.getByLabel("unweighted", { exact: true }).check();
    for (const i of [0, 7, 19]) assert.deepEqual(await thumbnail(i), expected(images[i].unweighted));
    await page.getByRole("button", { name: `Enlarge s = ${images[7].s}, t = ${images[7].t}, unweighted` }).press("Enter");
    assert.deepEqual(await shownPixel(page, 40, 40), expected(images[7].unweighted));
    assert.ok(await page.getByLabel("squared error").isDisabled());
    assert.equal(await page.evaluate(() => document.activeElement.className.split(" ")[0]), "viewport");
    await page.keyboard.press("ArrowRight");
    assert.deepEqual(await shownPixel(page, 40, 40), expected(images[8].unweighted));
    await page.locator("#pictures").getByLabel("Scene").selectOption({ label: "open-sky" });
    assert.equal(await page.locator(".names button").count(), 4);
}));
