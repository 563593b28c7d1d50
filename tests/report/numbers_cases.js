// How numbers are written, by the page's own functions.
"use strict";

const { test } = require("node:test");
const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");
const vm = require("node:vm");

const page = vm.createContext({});
vm.runInContext(fs.readFileSync(path.join(__dirname, "../../tools/report/numbers.js"), "utf8"), page);
const shown = (text) => text.replace(/\u00a0/g, " ");
const { formatNumber, formatInterval, formatChosen, formatCount, formatSeconds } = page;

test("numbers: three digits, powers of ten where they are easier to read", () => {
    const cases = [[0, "0"], [1, "1.00"], [0.0316, "0.0316"], [123.4, "123"], [1234, "1230"], [98765, "98\u202f800"], [1234567, "1.23 × 10⁶"], [-0.5, "−0.500"],
                   [0.00012345, "1.23 × 10⁻⁴"], [999.7, "1000"], [null, "not to be told"], [NaN, "not to be told"], [Infinity, "not to be told"], ["5", "not to be told"]];
    for (const [value, text] of cases) assert.equal(shown(formatNumber(value)), text);
    assert.equal(formatChosen(0.01), "0.01");
    assert.equal(formatChosen(100), "100");
    assert.equal(formatCount(65536), "65\u202f536");
    assert.equal(formatSeconds(2), "2 s");
});

test("numbers: intervals set the digits of their values", () => {
    const cases = [[0.312, 0.281, 0.339, "0.31 (0.28–0.34)"], [310.4, 289.6, 330.2, "310 (290–330)"], [1.5, 1.43, 1.64, "1.50 (1.43–1.64)"],
                   [-0.99, -1.031, -0.949, "−0.99 (−1.03 to −0.95)"], [1.234e-6, 1.21e-6, 1.26e-6, "1.23 × 10⁻⁶ (1.21–1.26 × 10⁻⁶)"],
                   // Measured: an estimator that met a firefly in one of three seeds.
                   [0.0129, 0.00477, 2.43, "0.013 (0.0048–2.4)"], [77.5, 0.4115, 209.6, "78 (0.41–210)"], [550, 317, 812, "550 (320–810)"], [0.39, 0.36, 1.2, "0.39 (0.36–1.2)"],
                   [0.1, -0.9, 1.1, "0.10 (−0.90 to 1.10)"], [0.5, null, 0.7, "0.500"], [1, 1, 1, "1.00"], [null, 1, 2, "not to be told"], [123456, 120000, 127000, "123\u202f000 (120\u202f000–127\u202f000)"]];
    for (const [value, low, high, text] of cases) assert.equal(shown(formatInterval(value, low, high)), text);
});
