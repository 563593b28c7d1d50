// Pictures: half floats to linear values, to what a screen shows, and to errors against a reference.

function halfToFloat(half) {
    const sign = half & 0x8000 ? -1 : 1;
    const exponent = (half >> 10) & 31;
    const mantissa = half & 1023;
    if (exponent === 0) return sign * mantissa * 2 ** -24;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
}

/// Rec. 709 light to the value of an sRGB byte; what is no number becomes 0.
function srgbByte(linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
}

let halfValues = null;
function valueOfHalf() {
    if (!halfValues) halfValues = Float32Array.from({ length: 65536 }, (_, half) => halfToFloat(half));
    return halfValues;
}

const shownHalves = new Map();

/// Bytes of all halves at an exposure: a picture is then shown by looking up.
function bytesOfHalves(stops) {
    if (!shownHalves.has(stops)) {
        if (shownHalves.size > 16) shownHalves.clear();
        const gain = 2 ** stops;
        shownHalves.set(stops, Uint8ClampedArray.from(valueOfHalf(), (value) => srgbByte(value * gain)));
    }
    return shownHalves.get(stops);
}

const decodedPictures = new WeakMap();

/// {width, height, halves, values}, or null for what is no picture.
function decoded(picture) {
    if (!picture || typeof picture.half !== "string") return null;
    if (decodedPictures.has(picture)) return decodedPictures.get(picture);
    let result = null;
    try {
        const bytes = atob(picture.half);
        const count = picture.width * picture.height * 3;
        if (bytes.length >= 2 * count && count > 0) {
            const halves = new Uint16Array(count);
            for (let i = 0; i < count; ++i) halves[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
            const table = valueOfHalf();
            result = { width: picture.width, height: picture.height, halves, values: Float32Array.from(halves, (half) => table[half]) };
        }
    } catch {
        result = null;  // no base64: as if it were not there
    }
    decodedPictures.set(picture, result);
    return result;
}

/// Mean over channels of (a − r)² / (r² + 0.01), per pixel.
function squaredError(values, reference, pixel) {
    let sum = 0;
    for (let c = 3 * pixel; c < 3 * pixel + 3; ++c) sum += (values[c] - reference[c]) ** 2 / (reference[c] ** 2 + 0.01);
    return sum / 3;
}

/// Mean over channels of (a − r) / √(r² + 0.01), per pixel: above 0 is too bright.
function signedError(values, reference, pixel) {
    let sum = 0;
    for (let c = 3 * pixel; c < 3 * pixel + 3; ++c) sum += (values[c] - reference[c]) / Math.sqrt(reference[c] ** 2 + 0.01);
    return sum / 3;
}

function meanSquaredError(picture, reference) {
    const pixels = picture.width * picture.height;
    let sum = 0;
    for (let i = 0; i < pixels; ++i) sum += squaredError(picture.values, reference.values, i);
    return sum / pixels;
}

/// 255 colours between the given ones, as bytes: an odd number, so that the middle one is among them.
function colourTable(colours) {
    const scale = d3.scaleLinear().domain(colours.map((_, i) => i / (colours.length - 1))).range(colours);
    return Array.from({ length: 255 }, (_, i) => scale(i / 254).match(/\d+/g).slice(0, 3).map(Number));
}

// Viridis: even steps of lightness, so that it reads without colours too.
const squaredColours = colourTable(["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"]);
const signedColours = colourTable(["#053061", "#2166ac", "#4393c3", "#92c5de", "#f7f7f7", "#f4a582", "#d6604d", "#b2182b", "#67001f"]);

const squaredDecades = [-4, 0];  // of the legend at no exposure

function squaredColour(error, gain) {
    const place = (Math.log10(error * gain) - squaredDecades[0]) / (squaredDecades[1] - squaredDecades[0]);
    return squaredColours[Number.isNaN(place) ? 254 : Math.round(254 * Math.min(1, Math.max(0, place)))];
}

function signedColour(error, gain) {
    return signedColours[Number.isNaN(error) ? 254 : Math.round(254 * Math.min(1, Math.max(0, 0.5 + 0.5 * error * gain)))];
}

/// A canvas of the picture's own size. `view`: "picture", "squared" or "signed".
function paintedCanvas(picture, reference, view, stops) {
    const canvas = element("canvas", { width: picture.width, height: picture.height });
    const context = canvas.getContext("2d");
    const image = context.createImageData(picture.width, picture.height);
    const pixels = picture.width * picture.height;
    if (view === "picture" || !reference) {
        const bytes = bytesOfHalves(stops);
        for (let i = 0; i < pixels; ++i)
            for (let c = 0; c < 3; ++c) image.data[4 * i + c] = bytes[picture.halves[3 * i + c]];
    } else {
        const gain = 2 ** stops;
        for (let i = 0; i < pixels; ++i) {
            const colour = view === "squared" ? squaredColour(squaredError(picture.values, reference.values, i), gain)
                : signedColour(signedError(picture.values, reference.values, i), gain);
            for (let c = 0; c < 3; ++c) image.data[4 * i + c] = colour[c];
        }
    }
    for (let i = 0; i < pixels; ++i) image.data[4 * i + 3] = 255;
    context.putImageData(image, 0, 0);
    return canvas;
}
