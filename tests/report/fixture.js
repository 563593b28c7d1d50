// Report data with made-up numbers that behave as measured ones do: errors that fall as 1/N, intervals,
// fits whose misfit ends the fall, a lens for every number of terms.
"use strict";

/// Mulberry32: the same numbers everywhere.
function generator(seed) {
    let state = seed >>> 0;
    return () => {
        state = (state + 0x6d2b79f5) >>> 0;
        let t = state;
        t = Math.imul(t ^ (t >>> 15), t | 1);
        t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

function normal(random) {
    return Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
}

/// The nearest half float, ties to even, as the program writes it.
function toHalf(value) {
    const sign = value < 0 || Object.is(value, -0) ? 0x8000 : 0;
    const size = Math.abs(value);
    if (Number.isNaN(value)) return 0x7e00;
    if (size >= 65520) return sign | 0x7c00;
    const exponent = size < 2 ** -14 ? -14 : Math.floor(Math.log2(size));
    const scaled = size / 2 ** (exponent - 10);  // exact: by a power of two
    let rounded = Math.floor(scaled);
    if (scaled - rounded > 0.5 || (scaled - rounded === 0.5 && rounded % 2 === 1)) rounded += 1;
    // A carry runs into the exponent's bits, as it should.
    return sign | (size < 2 ** -14 ? rounded : ((exponent + 14) << 10) + rounded);
}

function fromHalf(half) {
    const exponent = (half >> 10) & 31;
    const mantissa = half & 1023;
    const size = exponent === 0 ? mantissa * 2 ** -24 : exponent === 31 ? (mantissa ? NaN : Infinity) : (1024 + mantissa) * 2 ** (exponent - 25);
    return half & 0x8000 ? -size : size;
}

function packed(width, height, values) {
    const bytes = Buffer.alloc(values.length * 2);
    values.forEach((value, i) => bytes.writeUInt16LE(toHalf(value), 2 * i));
    return { width, height, half: bytes.toString("base64") };
}

function unpacked(picture) {
    const bytes = Buffer.from(picture.half, "base64");
    return Array.from({ length: bytes.length / 2 }, (_, i) => fromHalf(bytes.readUInt16LE(2 * i)));
}

/// A ball in a box with a lamp, without light transport.
function drawnScene(width, height, hue) {
    const values = [];
    const wall = [[0.55, 0.12, 0.1], [0.12, 0.42, 0.14], [0.15, 0.2, 0.5], [0.5, 0.4, 0.12]];
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x) {
            const u = (x + 0.5) / width;
            const v = (y + 0.5) / height;
            const light = 0.25 + 0.9 * Math.exp(-6 * ((u - 0.5) ** 2 + (v - 0.1) ** 2));
            let colour = v > 0.74 ? [0.5, 0.48, 0.45] : u < 0.22 ? wall[hue % 4] : u > 0.78 ? wall[(hue + 1) % 4] : [0.62, 0.6, 0.56];
            const dx = (u - 0.42) * (width / height);
            const dy = v - 0.62;
            const inside = 0.2 ** 2 - dx * dx - dy * dy;
            let shade = light;
            if (inside > 0) {
                const z = Math.sqrt(inside);
                shade = 0.06 + 1.1 * Math.max(0, (0.3 * dx - 0.8 * dy + 0.5 * z) / 0.2);
                colour = [0.75, 0.68, 0.3 + 0.1 * hue];
            } else if (v > 0.74 && Math.abs(dx) < 0.24) shade *= 0.45;
            if (v < 0.07 && Math.abs(u - 0.5) < 0.13) { shade = 1; colour = [6, 5.4, 4.2]; }
            values.push(...colour.map((c) => c * shade));
        }
    return values;
}

function withNoise(values, relMse, random, shift = 0) {
    const noisy = [];
    for (let i = 0; i < values.length; i += 3) {
        const z = normal(random) * Math.sqrt(relMse);
        for (let c = 0; c < 3; ++c)
            noisy.push(Math.max(0, values[i + c] + (z + shift + 0.2 * Math.sqrt(relMse) * normal(random)) * Math.sqrt(values[i + c] ** 2 + 0.01)));
    }
    return noisy;
}

function curveOf(random, { error, secondsPerSample, power = -1, misfit = 0 }) {
    const curve = [];
    for (let samples = 1; samples <= 4096; samples *= 2) {
        const seconds = 0.004 + samples * secondsPerSample;
        if (seconds > 2.6) break;
        const relMse = (error * samples ** power + misfit) * Math.exp(0.05 * normal(random));
        const width = 0.07 + 0.1 * random();
        curve.push({ samples, seconds, relMse, relMseLow: relMse * (1 - width), relMseHigh: relMse * (1 + width), relMseTrimmed: 0.9 * relMse,
                     mse: 0.7 * relMse, mae: 0.35 * Math.sqrt(relMse), meanError: 0.002 * normal(random), meanErrorHalfWidth: 0.004,
                     flip: samples > 2 ? 0.5 * relMse ** 0.3 : null });
    }
    return curve;
}

function resultOf(random, names, cost, targetRelMse) {
    const curve = curveOf(random, cost);
    const last = curve[curve.length - 1];
    const efficiency = 1 / (last.relMse * last.seconds);
    const crossing = curve.find((step) => step.relMse < targetRelMse);
    const seconds = crossing ? crossing.seconds : (last.relMse / targetRelMse) * last.seconds;
    return { ...names, curve, slope: cost.power === undefined ? -0.99 : cost.power, slopeLow: (cost.power || -0.99) - 0.04, slopeHigh: (cost.power || -0.99) + 0.04,
             efficiency, efficiencyLow: efficiency * 0.93, efficiencyHigh: efficiency * 1.07,
             secondsToTarget: seconds, secondsToTargetLow: seconds * 0.9, secondsToTargetHigh: seconds * 1.12, isExtrapolated: !crossing,
             equalSamples: { samples: 64, relMse: curve[Math.min(6, curve.length - 1)].relMse }, equalTime: { seconds: 2, relMse: last.relMse },
             badSamples: 0, picture: null };
}

function setRatios(results) {
    const first = results[0];
    results.forEach((result, i) => {
        const ratio = result.efficiency / first.efficiency;
        result.efficiencyRatio = ratio;
        result.efficiencyRatioLow = i === 0 ? 1 : ratio * 0.91;
        result.efficiencyRatioHigh = i === 0 ? 1 : ratio * 1.09;
    });
}

/// `data.pictures` gets a picture; its index comes back.
function addPicture(data, width, height, values) {
    data.pictures.push(packed(width, height, values));
    return data.pictures.length - 1;
}

function addGroup(data, random, scene, camera, hue, configurations, relMseOfReference) {
    const { width, height, targetRelMse } = data.settings;
    const truth = drawnScene(width, height, hue);
    const results = configurations.map(({ estimator, variant = "", ...cost }) => {
        const result = resultOf(random, { scene, camera, variant, estimator }, cost, targetRelMse);
        result.picture = addPicture(data, width, height, withNoise(truth, result.equalTime.relMse, random, Math.sqrt(cost.misfit || 0)));
        return result;
    });
    setRatios(results);
    data.results.push(...results);
    const isTooNoisy = relMseOfReference > 1e-3;
    data.references.push({ scene, camera, estimator: "bdpt", samples: 65536, seconds: 60.1, relMse: relMseOfReference, isTooNoisy,
        verdict: isTooNoisy ? "its own error is 31 % of the smallest measured here" : "its own error is 0.4 % of the smallest measured here",
        picture: addPicture(data, width, height, withNoise(truth, relMseOfReference, random)) });
}

function addTechniques(data, random, scene, camera, hue) {
    const { width, height } = data.settings;
    const truth = drawnScene(width, height, hue);
    const images = [];
    for (let edges = 1; edges <= 5; ++edges)
        for (let s = 0; s <= edges; ++s) {
            const share = 0.6 ** edges / (edges + 1) * (1 + (s % 2));
            const values = withNoise(truth.map((value) => value * share * 2), 0.02 * (1 + s), random);
            images.push({ s, t: edges + 1 - s, picture: addPicture(data, width, height, values),
                          unweighted: addPicture(data, width, height, withNoise(truth.map((value) => value * 0.6 ** edges * 2), 0.3 * (1 + s), random)) });
        }
    data.techniques.push({ scene, camera, images });
}

function fixture() {
    const random = generator(7);
    const data = {
        title: "estimators", command: "etendue bench scenes/suites/estimators.toml -o out/bench", version: "0.1.0", started: "2026-11-28T22:50:00Z",
        settings: { width: 96, height: 64, seeds: 4, seconds: 2.0, samples: 4096, targetRelMse: 0.01, threads: 2 },
        machine: { processor: "AMD EPYC 9454 48-Core Processor", cores: 2, isa: "x86-64-v3", compiler: "GNU 12.2.0", build: "Release", system: "Linux 6.1", load: 0.4 },
        isComplete: true, references: [], lenses: [], results: [], techniques: [], pictures: [],
    };
    addGroup(data, random, "cornell-box", "own", 0, [{ estimator: "pt", error: 1.1, secondsPerSample: 0.004 },
        { estimator: "lt", error: 4.2, secondsPerSample: 0.0032 }, { estimator: "bdpt", error: 0.19, secondsPerSample: 0.0079 }], 1.2e-6);
    addGroup(data, random, "glass-caustic", "own", 1, [{ estimator: "pt", error: 38, secondsPerSample: 0.0044, power: -0.72 },
        { estimator: "lt", error: 2.2, secondsPerSample: 0.0035 }, { estimator: "bdpt", error: 0.52, secondsPerSample: 0.009 }], 1.6e-3);
    addGroup(data, random, "open-sky", "own", 2, [{ estimator: "pt", error: 0.31, secondsPerSample: 0.0021 },
        { estimator: "lt", error: 21, secondsPerSample: 0.002 }, { estimator: "bdpt", error: 0.155, secondsPerSample: 0.0042 }], 4e-7);
    const fits = [[8, 1.9, 17, 22], [16, 0.42, 3.1, 29], [32, 0.22, 1.9, 41], [64, 0.19, 1.8, 78]];
    for (const [terms, mrad, microns, ns] of fits)
        data.lenses.push({ camera: "fisheye", variant: `${terms} terms`, description: `two-point, ${terms} terms, degree 11`, terms,
                           fitErrorMrad: mrad, fitErrorMicrons: microns, rayNs: ns, connectNs: 7.5 * ns });
    data.lenses.push({ camera: "fisheye", variant: "traced", description: "exact trace of 16 surfaces", terms: null, fitErrorMrad: null,
                       fitErrorMicrons: null, rayNs: 415, connectNs: 3900 });
    data.fitErrors = fits.map(([terms, mrad], i) => ({ scene: "still-life", camera: "fisheye", variant: `${terms} terms`, relMse: i === 3 ? -1e-6 : 4e-3 * mrad ** 2.4,
        relMseLow: i === 3 ? -8e-6 : 3.4e-3 * mrad ** 2.4, relMseHigh: i === 3 ? 7e-6 : 4.6e-3 * mrad ** 2.4 }));
    const through = (estimator, error, cost) => [...fits.map(([terms, mrad, , ns]) => ({ estimator, variant: `${terms} terms`, error,
        secondsPerSample: cost * (1 + ns / 300), misfit: 4e-3 * mrad ** 2.4 })), { estimator, variant: "traced", error, secondsPerSample: cost * 2.4 }];
    addGroup(data, random, "still-life", "fisheye", 3, [...through("pt", 0.9, 0.0045), ...through("bdpt", 0.24, 0.0095)], 2.3e-6);
    addTechniques(data, random, "cornell-box", "own", 0);
    return data;
}

/// Nothing that can be left out is there, and what can be null is.
function bareFixture() {
    const data = fixture();
    const result = data.results[0];
    return { title: "bare", command: "etendue bench", settings: {}, machine: {}, isComplete: false, references: [], lenses: [], techniques: [], pictures: [],
             results: [{ scene: "cornell-box", camera: "own", variant: "", estimator: "pt", curve: [{ ...result.curve[0], flip: null, relMseLow: null, relMseHigh: null }],
                 slope: null, slopeLow: null, slopeHigh: null, efficiency: null, efficiencyLow: null, efficiencyHigh: null,
                 secondsToTarget: null, secondsToTargetLow: null, secondsToTargetHigh: null, isExtrapolated: false,
                 efficiencyRatio: null, efficiencyRatioLow: null, efficiencyRatioHigh: null, equalSamples: null, equalTime: null, badSamples: 0, picture: null }] };
}

const hostileText = `</script><script>window.wasHacked = true</script><!-- <img src=x onerror="window.wasHacked=true"> & "'\u2028{{scripts}}`;

/// Names and texts that would be markup if they were put into the page as they are.
function hostileFixture() {
    const data = fixture();
    const rename = (entry, keys) => { for (const key of keys) if (typeof entry[key] === "string" && entry[key] !== "own") entry[key] += hostileText; };
    data.title = data.command = hostileText;
    rename(data.machine, Object.keys(data.machine));
    data.references.forEach((entry) => rename(entry, ["scene", "camera", "estimator", "verdict"]));
    data.results.forEach((entry) => rename(entry, ["scene", "camera", "variant", "estimator"]));
    data.lenses.forEach((entry) => rename(entry, ["camera", "variant", "description"]));
    data.techniques.forEach((entry) => rename(entry, ["scene", "camera"]));
    return data;
}

module.exports = { fixture, bareFixture, hostileFixture, hostileText, toHalf, fromHalf, packed, unpacked };
