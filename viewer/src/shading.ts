// From irradiance to what is shown: the program's tone curves and its palette, so that pictures agree with `render`.
import * as THREE from 'three';
import type {Facts} from './data';

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
    [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const most_steps = 24;

const vertex = `
attribute vec3 irradiance;
attribute float material;
uniform sampler2D materials;
uniform float material_count;
varying vec3 E;
varying vec3 B;
void main() {
    float x = (material + 0.5) / material_count;
    E = irradiance;
    B = texture2D(materials, vec2(x, 0.75)).rgb + texture2D(materials, vec2(x, 0.25)).rgb * irradiance;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const fragment = `
uniform int shown;      // 0 picture, 1 radiosity, 2 irradiance
uniform int curve;      // 0 filmic, 1 photographic, 2 linear
uniform float scale;
uniform bool isolux;
uniform int step_count;
uniform float steps[${most_steps}];
uniform vec3 colours[${most_steps}];
varying vec3 E;
varying vec3 B;
vec3 srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
vec3 toned(vec3 light) {
    vec3 c = max(scale * light, 0.0);
    float level = dot(c, vec3(1.0 / 3.0));
    if (curve == 0) { vec3 x = 0.7232 * min(c, vec3(1e6)); return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }
    if (curve == 1 && level > 0.0) return c * (1.0 + level / 16.0) / (1.0 + level);
    return c;
}
void main() {
    float value = dot(shown == 2 || shown == 0 ? E : B, vec3(1.0 / 3.0));
    vec3 colour = srgb(min(toned(B), 1.0));
    if (shown > 0) {
        colour = colours[0];
        for (int i = 1; i < ${most_steps} - 1; ++i) if (i < step_count - 1 && value >= steps[i]) colour = colours[i];
    }
    float width = max(fwidth(value), 1e-12);
    if (isolux)
        for (int i = 0; i < ${most_steps}; ++i)
            if (i < step_count && abs(value - steps[i]) < 0.75 * width) colour = shown > 0 ? vec3(1.0) : vec3(1.0, 0.45, 0.0);
    gl_FragColor = vec4(gl_FrontFacing ? colour : srgb(vec3(0.02)), 1.0);
}`;

/** Round steps from lo to hi, as the program chooses them: 1, 2 or 5 times a power of ten, or 1-2-5 steps. */
export function round_steps(lo: number, hi: number): number[] {
    const steps: number[] = [];
    if (!(hi > 0)) return [0, 1];
    if (hi > 30 * lo) {
        lo = Math.max(lo, 1e-4 * hi);
        for (let k = Math.floor(Math.log10(lo)); k <= Math.ceil(Math.log10(hi)); ++k)
            for (const digit of [1, 2, 5]) steps.push(Number((digit * 10 ** k).toPrecision(1)));
        while (steps.length > 2 && steps[1] <= lo) steps.shift();
        while (steps.length > 2 && steps[steps.length - 2] >= hi) steps.pop();
        return steps;
    }
    lo = Math.min(lo, 0.98 * hi);
    const raw = (hi - lo) / 9, power = 10 ** Math.floor(Math.log10(raw)), factor = raw / power;
    const width = power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
    const first = Math.floor(lo / width);
    for (let k = first; k <= Math.max(Math.ceil(hi / width), first + 1); ++k) steps.push(Number((k * width).toPrecision(6)));
    return steps.slice(0, most_steps);
}

function colour_at(t: number): THREE.Vector3 {
    const at = Math.min(Math.max(t, 0), 1) * (viridis.length - 1), i = Math.min(Math.floor(at), viridis.length - 2);
    const mix = (c: number) => (viridis[i][c] + (viridis[i + 1][c] - viridis[i][c]) * (at - i)) / 255;
    return new THREE.Vector3(mix(0), mix(1), mix(2));
}

export class Shading {
    readonly material: THREE.ShaderMaterial;
    private table: THREE.DataTexture;
    steps: number[] = [0, 1];

    constructor(private facts: Facts) {
        this.table = new THREE.DataTexture(new Float32Array(8 * Math.max(1, facts.materials.length)),
            Math.max(1, facts.materials.length), 2, THREE.RGBAFormat, THREE.FloatType);
        this.material = new THREE.ShaderMaterial({
            vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, toneMapped: false,
            polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
            uniforms: {materials: {value: this.table}, material_count: {value: this.table.image.width}, shown: {value: 0},
                curve: {value: 0}, scale: {value: facts.exposure}, isolux: {value: false}, step_count: {value: 2},
                steps: {value: new Float32Array(most_steps)},
                colours: {value: Array.from({length: most_steps}, () => new THREE.Vector3())}},
        });
        this.fill();
        this.set_steps([0, 1]);
    }

    /** Reflectances in the first row, exitances in the second. */
    private fill(): void {
        const n = this.table.image.width, data = this.table.image.data as unknown as Float32Array;
        this.facts.materials.forEach((m, i) => {
            for (let c = 0; c < 3; ++c) data[4 * i + c] = m.reflectance[c], data[4 * (n + i) + c] = m.exitance[c];
        });
        this.table.needsUpdate = true;
    }

    set_steps(steps: number[]): void {
        this.steps = steps;
        const u = this.material.uniforms, bands = steps.length - 1;
        u.step_count.value = steps.length;
        steps.forEach((s, i) => { u.steps.value[i] = s; });
        for (let i = 0; i < bands; ++i) u.colours.value[i] = colour_at(bands > 1 ? i / (bands - 1) : 0.5);
    }

    /** Colours from the brightest down, as they stand in a legend. */
    legend(): {colour: string; from: number; to: number}[] {
        return this.steps.slice(0, -1).map((from, i) => {
            const c = this.material.uniforms.colours.value[i] as THREE.Vector3;
            const [r, g, b] = [c.x, c.y, c.z].map(x => Math.round(255 * x));
            return {colour: `rgb(${r}, ${g}, ${b})`, from, to: this.steps[i + 1]};
        }).reverse();
    }
}
