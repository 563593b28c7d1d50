// The browser, pages of made data in it, and what their canvases show.
"use strict";

const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const assert = require("node:assert/strict");
const { chromium } = require("playwright-core");

const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
               "--disable-component-update", "--disable-sync"];
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "etendue-report-"));
const written = new Map();
let browser = null;

async function start() {
    browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: flags });
}

async function stop() {
    await browser.close();
    fs.rmSync(folder, { recursive: true });
}

/// The file of a page of `data`, written by the program's own benchPage.
function fileOf(name, data) {
    if (!written.has(name)) {
        const file = path.join(folder, `${name}.html`);
        fs.writeFileSync(file, execFileSync(process.env.WRITE_PAGE, { input: JSON.stringify(data), maxBuffer: 2 ** 30 }));
        written.set(name, file);
    }
    return written.get(name);
}

/// Calls `use(page)` with the page opened from its file, then sees that nothing was loaded and nothing complained.
async function withPage(name, data, options, use) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, ...options });
    const page = await context.newPage();
    const complaints = [];
    const requests = [];
    // The hint about reading canvases back is about this test, which does that.
    page.on("console", (message) => { if (!/willReadFrequently/.test(message.text())) complaints.push(message.text()); });
    page.on("pageerror", (error) => complaints.push(error.stack));
    page.on("request", (request) => requests.push(request.url()));
    const url = pathToFileURL(fileOf(name, data)).href;
    await page.goto(url);
    await page.waitForTimeout(150);  // plots are drawn when their widths are known
    try {
        await use(page);
        assert.equal(await page.locator("#failure").isVisible(), false, "the page says that it cannot be drawn");
    } finally {
        await context.close();
    }
    assert.deepEqual(complaints, [], "errors and warnings in the console");
    assert.deepEqual(requests.filter((request) => !/^(data|blob):/.test(request)), [url], "requests but for the page itself");
}

/// The byte triple of the flipper's canvas in the middle of a pixel of the picture, as it lies at "fit".
function shownPixel(page, x, y, width = 96, height = 64) {
    return page.evaluate(([px, py, w, h]) => {
        const canvas = document.querySelector("canvas.picture");
        const at = (value, size, room) => Math.floor(((value + 0.5) * room) / size);
        return [...canvas.getContext("2d").getImageData(at(px, w, canvas.width), at(py, h, canvas.height), 1, 1).data.slice(0, 3)];
    }, [x, y, width, height]);
}

/// A number for all that the canvas shows.
function shownSum(page, selector = "canvas.picture") {
    return page.evaluate((chosen) => {
        const canvas = document.querySelector(chosen);
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        let sum = 17;
        for (const byte of data) sum = (Math.imul(sum, 31) + byte) >>> 0;
        return sum;
    }, selector);
}

module.exports = { start, stop, withPage, shownPixel, shownSum };
