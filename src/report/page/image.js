// Embedded images: from text to half floats, and from these to what a screen shows.

const loaded = new Map();  // by name: a promise of {width, height, red, green, blue: bits of halves, scale}

function raw_text(name) { return document.getElementById(files[name].id).textContent; }

async function inflate(text) {
  const packed = atob(text), bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Planes of the bits of G, R - G, B - G; of each first the high bytes, then the low ones; each byte less the one
 * before.
 */
function unpack(bytes, count) {
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1];
  const plane = p =>
      Uint16Array.from({length: count}, (_, i) => bytes[2 * p * count + i] << 8 | bytes[(2 * p + 1) * count + i]);
  const green = plane(0), red = plane(1), blue = plane(2);
  for (let i = 0; i < count; ++i) {
    red[i] += green[i];
    blue[i] += green[i];
  }
  return {red, green, blue};
}

function load(name) {
  if (!loaded.has(name)) {
    const {width, height, exponent} = files[name];
    loaded.set(
        name,
        inflate(raw_text(name))
            .then(bytes => ({width, height, scale: 2 ** -exponent, ...unpack(bytes, width * height)})));
  }
  return loaded.get(name);
}

const half_values = Float32Array.from({length: 65536}, (_, bits) => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
});

/** Linear values of a pixel. */
function values_at({red, green, blue, scale}, i) {
  return [red[i], green[i], blue[i]].map(bits => half_values[bits] * scale);
}

/** Bytes of a PNG by the tone curve of docs/notation.md: stops of exposure, clipping, sRGB. By the bits of a half. */
function tone_table(exposure, scale) {
  const factor = scale * 2 ** exposure;
  return Uint8Array.from(half_values, value => {
    const x = Math.min(Math.max(value * factor, 0), 1) || 0;
    return Math.floor(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055) + 0.5);
  });
}

const fault = [255, 0, 255];  // the colour of what is not a number

/** ImageData of a picture whose pixel i has the colour of(i). */
function painted({width, height}, of) {
  const data = new ImageData(width, height), words = data.data;
  for (let i = 0, k = 0; i < width * height; ++i) {
    const [r, g, b] = of(i);
    words[k++] = r;
    words[k++] = g;
    words[k++] = b;
    words[k++] = 255;
  }
  return data;
}

function toned(image, exposure) {
  const tone = tone_table(exposure, image.scale), {red, green, blue, width, height} = image;
  const data = new ImageData(width, height),
        out = new Uint32Array(data.data.buffer);  // bytes R, G, B, A from the lowest
  for (let i = 0; i < out.length; ++i) out[i] = 0xff000000 | tone[blue[i]] << 16 | tone[green[i]] << 8 | tone[red[i]];
  for (let i = 0; i < out.length; ++i)
    if (half_values[red[i]] !== half_values[red[i]] || half_values[green[i]] !== half_values[green[i]] ||
        half_values[blue[i]] !== half_values[blue[i]])
      out[i] = 0xffff00ff;
  return data;
}

const luminance = ([r, g, b]) => 0.212671 * r + 0.71516 * g + 0.072169 * b;

/** (I - R) / (|R| + 0.01) of the luminances, as `ajar compare --diff` has it. */
function relative_difference(image, reference, i) {
  const r = luminance(values_at(reference, i));
  return (luminance(values_at(image, i)) - r) / (Math.abs(r) + 0.01);
}

/** (I - R)^2 / (R^2 + 0.01), mean of the channels. */
function relative_square(image, reference, i) {
  const a = values_at(image, i), r = values_at(reference, i);
  return a.reduce((sum, value, c) => sum + (value - r[c]) ** 2 / (r[c] ** 2 + 0.01), 0) / 3;
}

/**
 * White for none, red where the image is brighter, blue where darker; grows with the square root, full at the given
 * range.
 */
function signed_colour(difference, range) {
  if (Number.isNaN(difference)) return fault;
  const tint = Math.sqrt(Math.min(Math.abs(difference) / range, 1)),
        end = difference > 0 ? [178, 24, 43] : [33, 102, 172];
  return end.map(channel => Math.round(255 + tint * (channel - 255)));
}

const heat = [
  [0, 0, 4], [40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39], [252, 255, 164]
];

/** Black to yellow over four decades up to the given range. */
function heat_colour(square, range) {
  if (Number.isNaN(square)) return fault;
  const at = Math.min(Math.max(1 + Math.log10(square / range) / 4, 0), 1) * (heat.length - 1),
        i = Math.min(Math.floor(at), heat.length - 2);
  return heat[i].map((channel, c) => Math.round(channel + (at - i) * (heat[i + 1][c] - channel)));
}
