// What the page of `etendue bench` says and draws, and how it answers mouse, keys and narrow windows.
"use strict";

const { test, before, after } = require("node:test");
const assert = require("node:assert/strict");
const fs = require("node:fs");
const { start, stop, withPage } = require("./browser.js");
const { fixture, bareFixture, hostileFixture, hostileText } = require("./fixture.js");

before(start);
after(stop);
require("./flipper_cases.js");
require("./numbers_cases.js");

const data = fixture();
const groups = [["cornell-box", "own"], ["glass-caustic", "own"], ["open-sky", "own"], ["still-life", "fisheye"]];
const resultsOf = ([scene, camera], from = data) => from.results.filter((r) => r.scene === scene && r.camera === camera);

/// The page's numbers back from its text: "1.2 × 10⁻⁶", "−0.99", "12 300".
function parsed(text) {
    const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    if (/^10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]/.test(text)) return parsed(`1 × ${text}`);
    if (text.includes("·")) return parsed(text.replace("·", " × "));
    const [, mantissa, power] = text.replace(/\u202f/g, "").match(/([−]?[\d.]+)(?:\s×\s10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?/);
    const exponent = power ? Number([...power].map((c) => (c === "⁻" ? "-" : digits.indexOf(c))).join("")) : 0;
    return Number(mantissa.replace("−", "-")) * 10 ** exponent;
}

const near = (actual, expected, relative, what) => assert.ok(Math.abs(actual - expected) <= relative * Math.abs(expected), `${what}: ${actual} is not ${expected}`);

test("the first screen tells the winner and by how much", () => withPage("fixture", data, {}, async (page) => {
    const rows = page.locator("#answer .answers").first().locator(".answer");
    assert.equal(await rows.count(), groups.length);
    for (const [i, group] of groups.slice(0, 3).entries()) {
        const text = await rows.nth(i).innerText();
        const results = resultsOf(group);
        const best = results.reduce((a, b) => (b.efficiency > a.efficiency ? b : a));
        assert.equal(await rows.nth(i).locator(".winner").innerText(), best.estimator);
        const [, value, low, high] = text.match(/bdpt needs ([\d.]+)\s× the time of pt \(([\d.]+)–([\d.]+)\)/);
        const bdpt = results.find((r) => r.estimator === "bdpt");
        near(Number(value), 1 / bdpt.efficiencyRatio, 0.03, "ratio");
        near(Number(low), 1 / bdpt.efficiencyRatioHigh, 0.03, "low end");
        near(Number(high), 1 / bdpt.efficiencyRatioLow, 0.03, "high end");
    }
    assert.match(await rows.nth(1).innerText(), /reference is too noisy: its own error is 31 %/);
    assert.match(await rows.nth(3).innerText(), /which of these \d is not to be told/);
    const answer = await page.locator("#answer").innerText();
    assert.match(answer, /\d+ terms.*Fit error 0\.\d+ mrad/);
    for (const text of [data.command, data.machine.processor, "Load at the start", "target relMSE 0.01", "complete: 19 configurations"])
        assert.ok(answer.includes(text), text);
    const bottom = await page.locator("#answer .facts").evaluate((node) => node.getBoundingClientRect().bottom);
    assert.ok(bottom < 860, `the first screen ends at ${bottom}`);
}));

/// Mark positions by series: [[x, y], …] in the order of the figure's results.
const marksOf = (figure) => figure.locator("svg g.marks").evaluateAll((layers) => layers.filter((layer) => layer.closest(".plot"))
    .map((layer) => [...layer.children].map((mark) => mark.getAttribute("transform").match(/[-\d.]+/g).map(Number))));

/// Where a value lies on an axis, from the ticks' texts alone.
async function axisOf(figure, name) {
    const ticks = await figure.locator(`.plot svg .grid text.${name}`).evaluateAll((texts, axis) => texts.map((text) => [text.textContent, Number(text.getAttribute(axis))]), name);
    const [first, last] = [ticks[0], ticks[ticks.length - 1]].map(([text, place]) => [Math.log(parsed(text)), place]);
    return (value) => first[1] + ((Math.log(value) - first[0]) / (last[0] - first[0])) * (last[1] - first[1]);
}

for (const isOverTime of [false, true])
    test(`convergence over ${isOverTime ? "seconds" : "samples"}: every checkpoint has its mark at its place`, () => withPage("fixture", data, {}, async (page) => {
        if (isOverTime) await page.getByLabel("seconds", { exact: true }).check();
        const figures = page.locator("figure.convergence");
        assert.equal(await figures.count(), groups.length);
        for (const [i, group] of groups.entries()) {
            const results = resultsOf(group);
            const marks = await marksOf(figures.nth(i));
            assert.deepEqual(marks.map((series) => series.length), results.map((r) => r.curve.length));
            assert.equal(await figures.nth(i).locator("path.band").count(), results.length);
            assert.equal(await figures.nth(i).locator(".plot path.line").count(), results.length);
            const [x, y] = [await axisOf(figures.nth(i), "x"), await axisOf(figures.nth(i), "y")];
            results.forEach((result, r) => result.curve.forEach((step, k) => {
                assert.ok(Math.abs(marks[r][k][0] - x(isOverTime ? step.seconds : step.samples)) < 0.5);
                assert.ok(Math.abs(marks[r][k][1] - y(step.relMse)) < 0.5);
            }));
            // The guide falls as 1/N: as far in log error as it goes in log samples.
            const guide = await figures.nth(i).locator(".plot path.guide").getAttribute("d");
            const [x0, y0, x1, y1] = guide.match(/[-\d.]+(e-?\d+)?/g).map(Number);
            const decade = (axis) => axis(10) - axis(1);
            near((y1 - y0) / decade(y), -(x1 - x0) / decade(x), 0.01, "guide");
        }
    }));

test("convergence: legends tell slopes, the reference's own error and when it is too large", () => withPage("fixture", data, {}, async (page) => {
    const figures = page.locator("figure.convergence");
    const legend = await figures.nth(1).locator(".legend").innerText();
    assert.match(legend, /pt\s+slope −0\.72 \(−0\.76 to −0\.68\), not −1/);
    assert.match(legend, /lt\s+slope −0\.99 \(−1\.03 to −0\.95\)\n/);
    assert.match(legend, /reference’s own error: 0\.0016$/);
    assert.equal(await figures.nth(1).locator(".plot path.floor").count(), 1);
    assert.match(await figures.nth(1).innerText(), /too noisy .*its own error is 31 %/);
    assert.equal(await figures.nth(0).locator(".plot path.floor").count(), 0);
    assert.match(await figures.nth(0).locator(".legend").innerText(), /1\.2\s×\s10⁻⁶, below this plot/);
}));

test("convergence: keys read values, series hide, other errors and scenes can be chosen", () => withPage("fixture", data, {}, async (page) => {
    const figure = page.locator("figure.convergence").first();
    await figure.locator(".plot").focus();
    for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
    const readout = await figure.locator("output").innerText();
    assert.match(readout, /^relMSE at 4 samples a pixel\s*: pt /);
    assert.match(await figure.locator(".legend li").first().innerText(), /^pt\s+0\.\d+ \(0\.\d+–0\.\d+\)$/);
    const pt = resultsOf(groups[0])[0].curve[2];
    near(parsed(readout.split("pt ")[1]), pt.relMse, 0.02, "value read");
    assert.equal(await figure.locator(".cursor circle").count(), 3);

    await figure.locator("button.series").nth(1).press("Enter");
    assert.equal((await marksOf(figure)).length, 2);
    assert.equal(await figure.locator("button.series").nth(1).getAttribute("aria-pressed"), "false");
    await figure.locator("button.series").nth(1).press("Enter");
    assert.equal((await marksOf(figure)).length, 3);

    await page.getByLabel("Error", { exact: true }).selectOption({ label: "HDR-FLIP" });
    assert.deepEqual((await marksOf(figure)).map((series) => series.length), resultsOf(groups[0]).map((r) => r.curve.length - 2));
    assert.equal(await figure.locator("path.band").count(), 0);
    await page.locator("#convergence").getByLabel("Scene").selectOption({ label: "open-sky" });
    assert.equal(await page.locator("figure.convergence:visible").count(), 1);
}));

test("efficiency: bars are as long as the logarithm of their ratio, from 1", () => withPage("fixture", data, {}, async (page) => {
    const bars = await page.locator("#efficiency rect.bar").evaluateAll((nodes) => nodes.map((node) => [Number(node.getAttribute("x")), Number(node.getAttribute("width"))]));
    assert.equal(bars.length, data.results.length);
    const longest = bars[data.results.findIndex((r) => r.scene === "glass-caustic" && r.estimator === "bdpt")];
    const perLog = longest[1] / Math.log(resultsOf(groups[1])[2].efficiencyRatio);
    data.results.forEach((result, i) => {
        if (result.efficiencyRatio === 1) return;
        assert.ok(Math.abs(bars[i][1] - Math.max(1.5, Math.abs(Math.log(result.efficiencyRatio)) * perLog)) < 0.1);
        const one = longest[0];
        assert.ok(Math.abs((result.efficiencyRatio > 1 ? bars[i][0] : bars[i][0] + bars[i][1]) - one) < 0.1);
    });
    assert.equal(await page.locator("#efficiency path.whisker").count(), data.results.length - groups.length);
    const rows = page.locator("#efficiency tbody tr");
    assert.equal(await rows.count(), data.results.length);
    for (const [i, result] of data.results.entries()) {
        const cell = rows.nth(i).locator("td").nth(2);
        assert.equal((await cell.innerText()).endsWith("†"), result.isExtrapolated);
        near(parsed(await cell.innerText()), result.secondsToTarget, 0.06, "time to error");
    }
    // Sorted by a click, upwards then downwards.
    const head = page.locator("#efficiency thead button").filter({ hasText: "time to relMSE 0.01" });
    const first = () => rows.first().locator("td").nth(2).innerText().then(parsed);
    const times = data.results.map((r) => r.secondsToTarget);
    await head.click();
    near(await first(), Math.min(...times), 0.06, "least");
    await head.click();
    near(await first(), Math.max(...times), 0.06, "most");
}));

test("lenses: a mark for every fit in every panel, and a row for every lens", () => withPage("fixture", data, {}, async (page) => {
    const panels = page.locator("figure.lens");
    const counts = [];
    for (let i = 0; i < await panels.count(); ++i) counts.push((await marksOf(panels.nth(i))).flat().length);
    assert.deepEqual(counts, [4, 4, 4, 4, 3, 8, 8]);
    const [x, y] = [await axisOf(panels.nth(2), "x"), await axisOf(panels.nth(2), "y")];
    (await marksOf(panels.nth(2)))[0].forEach(([px, py], i) => {
        assert.ok(Math.abs(px - x(data.lenses[i].terms)) < 0.5);
        assert.ok(Math.abs(py - y(data.lenses[i].rayNs)) < 0.5);
    });
    assert.equal(await panels.nth(2).locator("path.level").count(), 1);
    const row = await page.locator("#lenses tbody tr").nth(2).innerText();
    assert.match(row, /32 terms\s+two-point, 32 terms, degree 11\s+32\s+0\.22\s+1\.9\s+41\.0\s+308\s+/);
    assert.match(await page.locator("#lenses tbody tr").nth(3).innerText(), /< 7\.0\s×\s10⁻⁶/);  // not to be told from zero
    // The advice is the fewest terms whose picture of equal time no further ones beat, in any comparison.
    const advised = ["pt", "bdpt"].map((estimator) => {
        const points = data.lenses.slice(0, 4).map((lens) => {
            const result = data.results.find((r) => r.variant === lens.variant && r.estimator === estimator);
            const last = result.curve[result.curve.length - 1];
            return { terms: lens.terms, low: last.relMseLow, high: last.relMseHigh, error: last.relMse };
        });
        const best = points.reduce((a, b) => (b.error < a.error ? b : a));
        return points.find((point) => point.low <= best.high).terms;
    });
    assert.equal(await page.locator("#answer .answers").last().locator(".winner").innerText(), `${Math.max(...advised)} terms`);
    assert.match(await page.locator("#lenses tbody tr").nth(4).innerText(), /traced\s+exact trace of 16 surfaces\s+–\s+–\s+–\s+415/);
}));

test("data: saved JSON is the data, CSV has a row for each", () => withPage("hostile", hostileFixture(), {}, async (page) => {
    const saved = async (name) => {
        const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name, exact: true }).click()]);
        return fs.readFileSync(await download.path(), "utf8");
    };
    assert.deepEqual(JSON.parse(await saved("Save JSON")), hostileFixture());
    const rows = csvRows(await saved("Save CSV of curves"));
    const steps = hostileFixture().results.flatMap((r) => r.curve.map((step) => ({ ...r, ...step })));
    assert.equal(rows.length, 1 + steps.length);
    const column = (name) => rows[0].indexOf(name);
    steps.forEach((step, i) => {
        for (const key of ["scene", "variant", "estimator"]) assert.equal(rows[i + 1][column(key)], step[key]);
        for (const key of ["samples", "seconds", "relMse", "relMseLow"]) assert.equal(Number(rows[i + 1][column(key)]), step[key]);
        assert.equal(rows[i + 1][column("flip")], step.flip === null ? "" : String(step.flip));
    });
    for (const details of await page.locator("#data details").all()) await details.locator("summary").click();
    await page.waitForTimeout(50);
    assert.deepEqual(await page.locator("#data tbody").evaluateAll((bodies) => bodies.map((body) => body.children.length)),
                     [data.results.length, steps.length, data.references.length, data.lenses.length, data.fitErrors.length]);
}));

/// RFC 4180.
function csvRows(text) {
    const rows = [[]];
    for (const [, quoted, plain, end] of text.matchAll(/(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r\n)/g)) {
        rows[rows.length - 1].push(quoted === undefined ? plain : quoted.replace(/""/g, '"'));
        if (end !== ",") rows.push([]);
    }
    return rows.slice(0, -1);
}

test("hostile texts are shown as they are and do nothing", () => withPage("hostile", hostileFixture(), {}, async (page) => {
    assert.equal(await page.evaluate(() => window.wasHacked), undefined);
    assert.equal(await page.locator("h1").evaluate((node) => node.textContent), hostileText);
    assert.equal(await page.locator("img, main script, main style").count(), 0);
    assert.equal(await page.locator("script").count(), 4);
    assert.equal(await page.locator("#answer .scene").first().evaluate((node) => node.textContent), "cornell-box" + hostileText);
}));

const widths = [320, 390, 768, 1280];
for (const [name, make] of [["fixture", fixture], ["bare", bareFixture], ["hostile", hostileFixture]])
    test(`${name}: no width scrolls sideways`, () => withPage(name, make(), {}, async (page) => {
        for (const details of await page.locator("details").all()) await details.locator("summary").click();
        for (const width of widths) {
            await page.setViewportSize({ width, height: 800 });
            await page.waitForTimeout(200);
            assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
            // Nothing sticks out of the page but into boxes that scroll by themselves.
            const outside = await page.evaluate(() => [...document.querySelectorAll("main *")].filter((node) => node.getClientRects().length > 0
                && !node.closest(".wide, svg, .viewport") && node.getBoundingClientRect().right > innerWidth + 0.5).map((node) => node.outerHTML.slice(0, 120)));
            assert.deepEqual(outside, []);
        }
    }));

test("empty lists and nulls leave a tidy page", async () => {
    await withPage("bare", bareFixture(), {}, async (page) => {
        const text = await page.locator("main").innerText();
        assert.match(text, /The suite was interrupted/);
        assert.match(text, /pt\s+The only one measured; its efficiency is not to be told/);
        assert.doesNotMatch(text, /NaN|undefined|null|Infinity|\[object/);
        assert.deepEqual(await page.locator("nav a").allInnerTexts(), ["Answers", "Convergence", "Efficiency", "Data"]);
    });
    await withPage("nothing", { title: "nothing", results: [] }, {}, async (page) => {
        assert.match(await page.locator("main").innerText(), /Nothing was measured/);
        assert.doesNotMatch(await page.locator("main").innerText(), /NaN|undefined|null|\[object/);
    });
    await withPage("fixture", data, {}, async (page) => assert.doesNotMatch(await page.locator("body").innerText(), /NaN|undefined|null|\[object/));
});

/// Relative luminance by WCAG, of "rgb(…)" or "#rrggbb".
function luminance(colour) {
    const bytes = colour.startsWith("#") ? colour.slice(1).match(/../g).map((hex) => parseInt(hex, 16)) : colour.match(/\d+/g).slice(0, 3).map(Number);
    const [r, g, b] = bytes.map((byte) => byte / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

for (const colorScheme of ["light", "dark"])
    test(`${colorScheme}: the system's choice, then the reader's; contrasts suffice in both`, () => withPage("fixture", data, { colorScheme }, async (page) => {
        const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor).then(luminance);
        const isDark = colorScheme === "dark";
        assert.equal((await background()) < 0.2, isDark);
        const colours = await page.evaluate(() => Object.fromEntries(["paper", "card", "ink", "muted", "accent", "caution", "caution-paper", "c0", "c1", "c2", "c3", "c4", "c5"]
            .map((name) => [name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim()])));
        const contrast = (a, b) => {
            const [high, low] = [luminance(colours[a]), luminance(colours[b])].sort((p, q) => q - p);
            return (high + 0.05) / (low + 0.05);
        };
        for (const name of ["ink", "muted", "accent", "caution"]) assert.ok(contrast(name, "paper") >= 4.5, name);
        for (const name of ["ink", "muted"]) assert.ok(contrast(name, "card") >= 4.5, name);
        assert.ok(contrast("ink", "caution-paper") >= 4.5);
        for (const name of ["c0", "c1", "c2", "c3", "c4", "c5"]) assert.ok(contrast(name, "paper") >= 3, name);
        await page.getByRole("button", { name: isDark ? "Switch to light colours" : "Switch to dark colours" }).press("Enter");
        assert.equal((await background()) < 0.2, !isDark);
        await page.reload();
        assert.equal((await background()) < 0.2, !isDark, "the choice outlasts a reload");
    }).catch((error) => {
        // A reload is a second request of the same page, and no other.
        if (error.code !== "ERR_ASSERTION" || !/requests/.test(error.message) || error.actual.length !== 2 || error.actual[0] !== error.actual[1]) throw error;
    }));

test("every control has a name, takes the focus by Tab and shows it", () => withPage("fixture", data, {}, async (page) => {
    await page.locator("#pictures").getByLabel("wipe").press("Space");
    const nameless = await page.evaluate(() => [...document.querySelectorAll("button, select, input, [tabindex], summary, a")]
        .filter((node) => !(node.getAttribute("aria-label") || node.textContent.trim() || (node.labels && node.labels.length)))
        .map((node) => node.outerHTML.slice(0, 100)));
    assert.deepEqual(nameless, []);
    await page.locator("a.skip").focus();
    const reached = new Set();
    for (let i = 0; i < 300; ++i) {
        if (i > 0) await page.keyboard.press("Tab");
        const focus = await page.evaluate(() => {
            const node = document.activeElement;
            const all = [...document.querySelectorAll("button, select, input, [tabindex], summary, a")];
            return { index: all.indexOf(node), outline: getComputedStyle(node).outlineStyle, html: node.outerHTML.slice(0, 100) };
        });
        if (focus.index < 0 || reached.has(focus.index)) break;
        reached.add(focus.index);
        assert.notEqual(focus.outline, "none", `no outline: ${focus.html}`);
    }
    // Of radio buttons Tab reaches the checked one; the rest are for the arrow keys. Hidden ones are not reached.
    const expected = await page.evaluate(() => [...document.querySelectorAll("button, select, input, [tabindex], summary, a")]
        .filter((node) => node.getClientRects().length > 0 && !node.disabled && !(node.type === "radio" && !node.checked)).length);
    assert.equal(reached.size, expected);
}));
