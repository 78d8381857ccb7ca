// From light to what is shown: the program's tone curves and its palette, so that pictures agree with `render`.
import * as THREE from 'three';
import type {Facts, Triple} from './data';

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
    [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const most_steps = 24;
/** Sources, lit, penumbra, umbra, no class; as `render --shadow-classes` has them. */
export const class_colours: [string, Triple][] = [['source', [255, 255, 255]], ['lit', [246, 226, 138]],
    ['penumbra', [176, 122, 150]], ['umbra', [58, 62, 110]], ['no class', [20, 20, 24]]];
export type Shown = 'picture' | 'radiosity' | 'irradiance' | 'classes';

const vertex = `
attribute vec3 irradiance;
attribute float material;
#ifdef GROUPS
attribute float group;
uniform sampler2D factors;
uniform float factor_count;
#endif
#ifdef CLASSES
attribute float shadow;
varying float S;
#endif
uniform sampler2D materials;
uniform float material_count;
varying vec3 E;
varying vec3 B;
void main() {
    float x = (material + 0.5) / material_count;
    vec3 M = texture2D(materials, vec2(x, 0.75)).rgb;
#ifdef GROUPS
    M *= texture2D(factors, vec2((group + 0.5) / factor_count, 0.5)).r;
#endif
    E = irradiance;
    B = M + texture2D(materials, vec2(x, 0.25)).rgb * irradiance;
#ifdef CLASSES
    S = dot(M, vec3(1.0)) > 0.0 ? 3.0 : shadow;
#endif
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

/** The picture alone is a smaller program, which is made first; values need more. */
const tones = `
uniform int curve;      // 0 filmic, 1 photographic, 2 linear
uniform float scale;
vec3 srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
vec3 toned(vec3 light) {
    vec3 c = max(scale * light, 0.0);
    float level = dot(c, vec3(1.0 / 3.0));
    if (curve == 0) { vec3 x = 0.7232 * min(c, vec3(1e6)); return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }
    if (curve == 1 && level > 0.0) return c * (1.0 + level / 16.0) / (1.0 + level);
    return c;
}
#ifdef VALUES
uniform int shown;      // 0 picture, 1 radiosity, 2 irradiance
uniform bool isolux;
uniform int step_count;
uniform vec3 weights;   // of red, green and blue in one number
uniform float steps[${most_steps}];
uniform vec3 colours[${most_steps}];
vec3 valued(vec3 colour, float value) {
    int band = 0, line = -1;
    float width = 0.75 * max(fwidth(value), 1e-12);
    for (int i = 0; i < ${most_steps}; ++i) {
        if (i >= step_count) break;
        if (i > 0 && i < step_count - 1 && value >= steps[i]) band = i;
        if (abs(value - steps[i]) < width) line = i;
    }
    if (shown > 0) colour = colours[band];
    if (isolux && line >= 0) colour = shown > 0 ? vec3(1.0) : colours[min(line, step_count - 2)];
    return colour;
}
#endif`;

const fragment = `${tones}
varying vec3 E;
varying vec3 B;
#ifdef CLASSES
varying float S;
uniform vec3 classes[5];
#endif
void main() {
#ifdef CLASSES
    vec3 colour = S > 2.5 && S < 3.5 ? classes[0] : S < 0.5 ? classes[1] : S < 1.5 ? classes[2] : S < 2.5 ? classes[3] : classes[4];
#else
    vec3 colour = srgb(min(toned(B), 1.0));
#endif
#ifdef VALUES
    colour = valued(colour, dot(shown == 1 ? B : E, weights));
#endif
    gl_FragColor = vec4(gl_FrontFacing ? colour : srgb(vec3(0.02)), 1.0);
}`;

const frame_vertex = `varying vec2 at; void main() { at = 0.5 * position.xy + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }`;
const frame_fragment = `${tones}
uniform sampler2D light;
uniform sampler2D rest;
varying vec2 at;
void main() {
    vec4 B = texture2D(light, at);
    vec2 E = texture2D(rest, at).rg;
    vec3 colour = srgb(min(B.a * min(toned(B.rgb), 1.0) + 0.02 * E.g, 1.0));
#ifdef VALUES
    if (B.a > 0.0) colour = valued(colour, shown == 1 ? dot(B.rgb, weights) : E.r);
#endif
    gl_FragColor = vec4(colour, B.a + E.g > 0.0 ? 1.0 : 0.0);
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
        return steps.slice(0, most_steps);
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

export const css = (c: Triple) => `rgb(${c.map(x => Math.round(x)).join(', ')})`;

function float_table(width: number, height: number): THREE.DataTexture {
    return new THREE.DataTexture(new Float32Array(4 * width * height), width, height, THREE.RGBAFormat, THREE.FloatType);
}

/** The materials of three.js that show light, all with the same settings. */
export class Shading {
    /** Of elements and of the program's pictures; they change with `show`. */
    material: THREE.ShaderMaterial;
    frame: THREE.ShaderMaterial;
    readonly uniforms: Record<string, THREE.IUniform>;
    private made = new Map<string, THREE.ShaderMaterial>();
    private table: THREE.DataTexture;
    private factors: THREE.DataTexture;
    private grouped = false;
    private shown: Shown = 'picture';
    private isolux = false;
    steps: number[] = [0, 1];
    /** By material, as painted. */
    reflectances: Triple[] = [];

    constructor(private facts: Facts) {
        this.table = float_table(Math.max(1, facts.materials.length), 2);
        this.factors = float_table(facts.groups.length + 1, 1);
        (this.factors.image.data as unknown as Float32Array).fill(1);
        this.uniforms = {materials: {value: this.table}, material_count: {value: this.table.image.width},
            factors: {value: this.factors}, factor_count: {value: facts.groups.length + 1}, shown: {value: 0},
            curve: {value: 0}, scale: {value: facts.exposure}, isolux: {value: false}, step_count: {value: 2},
            steps: {value: new Float32Array(most_steps)}, weights: {value: new THREE.Vector3(...facts.weights)},
            colours: {value: Array.from({length: most_steps}, () => new THREE.Vector3())},
            classes: {value: class_colours.map(([, c]) => new THREE.Vector3(...c).divideScalar(255))},
            light: {value: null}, rest: {value: null}};
        this.material = this.make(false), this.frame = this.make(true);
        this.paint(facts.materials.map(m => m.reflectance));
        this.set_steps([0, 1]);
    }

    private make(frame: boolean): THREE.ShaderMaterial {
        const defines: Record<string, string> = {};
        if (this.shown === 'radiosity' || this.shown === 'irradiance' || this.isolux) defines.VALUES = '1';
        if (this.shown === 'classes' && !frame) defines.CLASSES = '1';
        if (this.grouped && !frame) defines.GROUPS = '1';
        const key = Object.keys(defines).join() + frame;
        let found = this.made.get(key);
        if (!found) {
            found = new THREE.ShaderMaterial({defines, uniforms: this.uniforms, toneMapped: false,
                ...(frame ? {vertexShader: frame_vertex, fragmentShader: frame_fragment, depthTest: false, depthWrite: false,
                    transparent: true}
                    : {vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, polygonOffset: true,
                        polygonOffsetFactor: 1, polygonOffsetUnits: 1})});
            this.made.set(key, found);
        }
        return found;
    }

    private remake(): void { this.material = this.make(false), this.frame = this.make(true); }

    show(shown: Shown, isolux: boolean): void {
        this.shown = shown, this.isolux = isolux;
        this.uniforms.shown.value = shown === 'radiosity' ? 1 : shown === 'irradiance' ? 2 : 0;
        this.uniforms.isolux.value = isolux;
        this.remake();
    }

    /** Reflectances in the first row, exitances in the second. */
    paint(reflectances: Triple[]): void {
        this.reflectances = reflectances;
        const n = this.table.image.width, data = this.table.image.data as unknown as Float32Array;
        this.facts.materials.forEach((m, i) => {
            for (let c = 0; c < 3; ++c) data[4 * i + c] = reflectances[i][c], data[4 * (n + i) + c] = m.exitance[c];
        });
        this.table.needsUpdate = true;
    }

    /** What the exitances of groups are multiplied by; what is in none comes last. */
    dim(factors: number[]): void {
        const data = this.factors.image.data as unknown as Float32Array;
        this.facts.groups.forEach((_, i) => data.fill(factors[i] ?? 1, 4 * i, 4 * i + 4));
        this.factors.needsUpdate = true;
        if (!this.grouped && factors.some(f => f !== 1)) { this.grouped = true; this.remake(); }
    }

    set_steps(steps: number[]): void {
        this.steps = steps;
        const u = this.uniforms, bands = steps.length - 1;
        u.step_count.value = steps.length;
        steps.forEach((s, i) => { u.steps.value[i] = s; });
        for (let i = 0; i < bands; ++i) u.colours.value[i] = colour_at(bands > 1 ? i / (bands - 1) : 0.5);
    }

    /** Colours of bands, or of the lines at their lower ends, from the brightest down, as they stand in a legend. */
    legend(): {colour: string; from: number; to: number}[] {
        return this.steps.slice(0, -1).map((from, i) => {
            const c = this.uniforms.colours.value[i] as THREE.Vector3;
            return {colour: css([255 * c.x, 255 * c.y, 255 * c.z]), from, to: this.steps[i + 1]};
        }).reverse();
    }
}
