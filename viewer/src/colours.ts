// Palettes and the steps of a colour scale, as `render` has them for a given range (false_colour.cpp).
import type {Triple} from './data';

export const palettes: Record<string, Triple[]> = {
    viridis: [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]],
    inferno: [[0, 0, 4], [31, 12, 72], [85, 15, 109], [136, 34, 106], [186, 54, 85], [227, 89, 51], [249, 140, 10], [249, 201, 50], [252, 255, 164]],
    turbo: [[48, 18, 59], [70, 107, 227], [40, 187, 236], [49, 242, 153], [162, 252, 60], [237, 208, 58], [251, 128, 34], [210, 49, 5], [122, 4, 3]],
    grey: [[16, 16, 16], [46, 46, 46], [76, 76, 76], [106, 106, 106], [136, 136, 136], [166, 166, 166], [196, 196, 196], [226, 226, 226], [255, 255, 255]],
};
export const most_steps = 24;

export const css = (c: Triple) => `rgb(${c.map(x => Math.round(x)).join(', ')})`;

/** A number in three digits, without exponents where people write none. */
export const short = (x: number) => Math.abs(x) >= 100 && Math.abs(x) < 1e6 ? x.toFixed(0) : String(Number(x.toPrecision(3)));

export function colour_at(palette: string, t: number): Triple {
    const anchors = palettes[palette] ?? palettes.viridis;
    const at = Math.min(Math.max(t, 0), 1) * (anchors.length - 1), i = Math.min(Math.floor(at), anchors.length - 2);
    const mix = (c: number) => anchors[i][c] + (anchors[i + 1][c] - anchors[i][c]) * (at - i);
    return [mix(0), mix(1), mix(2)];
}

/** The lower end of a logarithmic scale, which cannot be 0. */
export const above_zero = (lo: number, hi: number) => Math.max(lo, 1e-3 * hi);

function steps_by_ratio(lo: number, hi: number): number[] {
    const steps: number[] = [];
    lo = above_zero(lo, hi);
    for (let k = Math.floor(Math.log10(lo)); k <= Math.ceil(Math.log10(hi)); ++k)
        for (const digit of [1, 2, 5]) steps.push(Number((digit * 10 ** k).toPrecision(1)));
    while (steps.length > 2 && steps[1] <= lo) steps.shift();
    while (steps.length > 2 && steps[steps.length - 2] >= hi) steps.pop();
    return steps;
}

function even_steps(lo: number, hi: number): number[] {
    const steps: number[] = [];
    lo = Math.min(lo, 0.98 * hi);
    const raw = (hi - lo) / 9, power = 10 ** Math.floor(Math.log10(raw)), factor = raw / power;
    const width = power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
    const first = Math.floor(lo / width);
    for (let k = first; k <= Math.max(Math.ceil(hi / width), first + 1); ++k) steps.push(Number((k * width).toPrecision(6)));
    return steps;
}

/** Round steps that include the range: 1, 2 or 5 times a power of ten, or 1-2-5 steps. */
export function round_steps(lo: number, hi: number, by_ratio = false): number[] {
    if (!(hi > 0)) return [0, 1];
    return (by_ratio ? steps_by_ratio(lo, hi) : even_steps(lo, hi)).slice(0, most_steps);
}

/** Round steps inside a chosen range, with its ends. */
export function steps_within(lo: number, hi: number, by_ratio: boolean): number[] {
    const near = 1e-6 * (hi - lo), inner = round_steps(lo, hi, by_ratio).filter(s => s > lo + near && s < hi - near);
    return [lo, ...inner.slice(0, most_steps - 2), hi];
}

/** From blue (less) over white to red (more). */
const diverging: Triple[] = [[33, 80, 160], [67, 147, 195], [146, 197, 222], [209, 229, 240], [247, 247, 247], [253, 219, 199], [244, 165, 130], [214, 96, 77], [165, 20, 40]];
const most_on_a_side = 5;

/** Bands of a difference: the middle one includes 0, the outer ones are open. One colour more than there are steps. */
export function difference_colours(most: number): {steps: number[]; colours: Triple[]} {
    const raw = Math.max(most, 1e-9) / (most_on_a_side - 0.5), power = 10 ** Math.floor(Math.log10(raw)), factor = raw / power;
    const width = power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 4 ? 4 : 10);
    const side = Math.min(most_on_a_side, Math.max(1, Math.ceil(most / width - 0.5)));
    const steps = Array.from({length: 2 * side}, (_, i) => Number(((i - side + 0.5) * width).toPrecision(6)));
    const colours = Array.from({length: 2 * side + 1}, (_, i) => {
        const at = i / (2 * side) * (diverging.length - 1), k = Math.min(Math.floor(at), diverging.length - 2);
        return [0, 1, 2].map(c => diverging[k][c] + (diverging[k + 1][c] - diverging[k][c]) * (at - k)) as Triple;
    });
    return {steps, colours};
}

/** A difference with its sign. */
export const signed = (x: number) => (x > 0 ? '+' : x < 0 ? '−' : '') + short(Math.abs(x));
