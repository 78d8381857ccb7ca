// From light to what is shown: the program's tone curves and its palettes, so that pictures agree with `render`.
import * as THREE from 'three';
import {colour_at, css, difference_colours, most_steps} from './colours';
import type {Facts, Seen, Triple} from './data';

/** Sources, lit, penumbra, umbra, no class; as `render --shadow-classes` has them. */
export const class_colours: [string, Triple][] = [['source', [255, 255, 255]], ['lit', [246, 226, 138]],
    ['penumbra', [176, 122, 150]], ['umbra', [58, 62, 110]], ['no class', [20, 20, 24]]];
/** Surfaces of two scenes are the same in a pixel if their distances differ by at most this share. */
export const same_place = 0.01;
export type Shown = 'picture' | 'radiosity' | 'irradiance' | 'classes';

/**
 * Light is interpolated at places that a face covers (centroid). Strips along contacts are narrower than a pixel, and their
 * light changes so much across them that at the middle of a pixel beside them it would be black.
 */
const vertex = `
attribute vec3 irradiance;
attribute float material;
#ifdef GROUPS
attribute float group;
uniform sampler2D factors;
uniform float factor_count;
varying float visible;
#endif
#ifdef CLASSES
attribute float shadow;
varying float S;
#endif
#ifdef CUT
varying vec3 place;
#endif
uniform sampler2D materials;
uniform float material_count;
centroid varying vec3 E;
centroid varying vec3 B;
void main() {
    float x = (material + 0.5) / material_count;
    vec3 M = texture2D(materials, vec2(x, 0.75)).rgb;
#ifdef GROUPS
    vec4 of_group = texture2D(factors, vec2((group + 0.5) / factor_count, 0.5));
    M *= of_group.r;
    visible = of_group.g;
#endif
    E = irradiance;
    B = M + texture2D(materials, vec2(x, 0.25)).rgb * irradiance;
#ifdef CLASSES
    S = dot(M, vec3(1.0)) > 0.0 ? 3.0 : shadow;
#endif
#ifdef CUT
    place = position;
#endif
    // Backs step away from the eye, which moves no pixel. At the outlines of bodies they would be as near as the fronts that
    // they join, or show in gaps left by rounding, as dark dots. A step of a twentieth puts most of them behind what the
    // body hides.
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    if (dot(normal, position - cameraPosition) > 0.0) seen.xyz *= 1.05;
    gl_Position = projectionMatrix * seen;
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
uniform float threshold;  // negative: none
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
    if (threshold >= 0.0) {
        if (value < threshold) colour = 0.35 * vec3(dot(colour, vec3(0.2126, 0.7152, 0.0722))) + (mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 2.0 ? 0.25 : 0.1);
        if (abs(value - threshold) < 1.5 * width) colour = vec3(1.0, 0.2, 0.6);
    }
    return colour;
}
#endif`;

const fragment = `${tones}
centroid varying vec3 E;
centroid varying vec3 B;
#ifdef GROUPS
varying float visible;
#endif
#ifdef CLASSES
varying float S;
uniform vec3 classes[5];
#endif
#ifdef CUT
varying vec3 place;
uniform vec4 cut;
#endif
void main() {
#ifdef GROUPS
    if (visible < 0.5) discard;
#endif
#ifdef CUT
    if (dot(cut.xyz, place) > cut.w) discard;
#endif
#ifdef CLASSES
    vec3 colour = S > 2.5 && S < 3.5 ? classes[0] : S < 0.5 ? classes[1] : S < 1.5 ? classes[2] : S < 2.5 ? classes[3] : classes[4];
#else
    vec3 colour = srgb(min(toned(B), 1.0));
#endif
#ifdef VALUES
    colour = valued(colour, dot(shown == 1 ? B : E, weights));
#endif
#ifdef NUMBERS
    gl_FragColor = vec4(dot(shown == 1 ? B : E, weights), 1.0 / gl_FragCoord.w, gl_FrontFacing ? 1.0 : 0.0, 1.0);
#else
    gl_FragColor = vec4(gl_FrontFacing ? colour : srgb(vec3(0.02)), 1.0);
#endif
}`;

/**
 * Present light minus other light, each a value, a distance and whether it is of a front. Where only one of them shows a
 * surface, or one at another distance, a pixel is hatched.
 */
const difference_fragment = `
uniform sampler2D present;
uniform sampler2D other;
uniform int difference_count;
uniform float difference_steps[${most_steps}];
uniform vec3 difference_colours[${most_steps}];
varying vec2 at;
void main() {
    vec4 a = texture2D(present, at), b = texture2D(other, at);
    if (a.a < 0.5 && b.a < 0.5) discard;
    bool apart = a.a < 0.5 || b.a < 0.5 || abs(a.g - b.g) > ${same_place} * max(a.g, b.g);
    vec3 colour = difference_colours[0];
    for (int i = 1; i < ${most_steps}; ++i) if (i < difference_count && a.r - b.r >= difference_steps[i - 1]) colour = difference_colours[i];
    if (apart) colour = vec3(mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 2.0 ? 0.55 : 0.35);
    else if (min(a.b, b.b) < 0.5) colour = vec3(0.15);
    gl_FragColor = vec4(colour, 1.0);
}`;

const frame_vertex = `varying vec2 at; void main() { at = 0.5 * position.xy + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }`;
const frame_fragment = `${tones}
uniform sampler2D light;
uniform sampler2D rest;
uniform float opacity;
varying vec2 at;
void main() {
    vec4 B = texture2D(light, at);
    vec2 E = texture2D(rest, at).rg;
    vec3 colour = srgb(min(B.a * min(toned(B.rgb), 1.0) + 0.02 * E.g, 1.0));
#ifdef VALUES
    if (B.a > 0.0) colour = valued(colour, shown == 1 ? dot(B.rgb, weights) : E.r);
#endif
    gl_FragColor = vec4(colour, B.a + E.g > 0.0 ? opacity : 0.0);
}`;

function float_table(width: number, height: number): THREE.DataTexture {
    return new THREE.DataTexture(new Float32Array(4 * width * height), width, height, THREE.RGBAFormat, THREE.FloatType);
}

/** The materials of three.js that show light, all with the same settings. */
export class Shading {
    /** Of elements and of the program's pictures; they change with `show`. */
    material: THREE.ShaderMaterial;
    frame: THREE.ShaderMaterial;
    /** Values instead of colours, and what is made of two of them. */
    numbers: THREE.ShaderMaterial;
    readonly difference: THREE.ShaderMaterial;
    readonly uniforms: Record<string, THREE.IUniform>;
    readonly seen: Seen = {backs: true, hidden: [], cut: null};
    private made = new Map<string, THREE.ShaderMaterial>();
    private table: THREE.DataTexture;
    private factors: THREE.DataTexture;
    private grouped = false;
    private shown: Shown = 'picture';
    private isolux = false;
    private threshold = -1;
    private under_lines = false;
    steps: number[] = [0, 1];
    /** Bounds of the bands of differences; the outer bands are open. */
    difference_steps: number[] = [];
    /** By material, as painted. */
    reflectances: Triple[] = [];
    /** Of other light in the same picture: it has materials and lamps of its own, and these settings. */
    private twin: Shading | null = null;

    constructor(private facts: Facts, leader: Shading | null = null) {
        this.table = float_table(Math.max(1, facts.materials.length), 2);
        this.factors = float_table(facts.groups.length + 1, 1);
        (this.factors.image.data as unknown as Float32Array).fill(1);
        this.uniforms = {materials: {value: this.table}, material_count: {value: this.table.image.width},
            factors: {value: this.factors}, factor_count: {value: facts.groups.length + 1}, shown: {value: 0},
            curve: {value: 0}, scale: {value: facts.exposure}, isolux: {value: false}, step_count: {value: 2}, threshold: {value: -1},
            steps: {value: new Float32Array(most_steps)}, weights: {value: new THREE.Vector3(...facts.weights)},
            colours: {value: Array.from({length: most_steps}, () => new THREE.Vector3())},
            classes: {value: class_colours.map(([, c]) => new THREE.Vector3(...c).divideScalar(255))},
            light: {value: null}, rest: {value: null}, opacity: {value: 1}, cut: {value: new THREE.Vector4()},
            present: {value: null}, other: {value: null}, difference_count: {value: 0}, difference_steps: {value: new Float32Array(most_steps)},
            difference_colours: {value: Array.from({length: most_steps}, () => new THREE.Vector3())}};
        if (leader) for (const name of ['shown', 'curve', 'scale', 'isolux', 'step_count', 'threshold', 'steps', 'colours', 'cut'])
            this.uniforms[name] = leader.uniforms[name];
        this.difference = new THREE.ShaderMaterial({uniforms: this.uniforms, toneMapped: false, vertexShader: frame_vertex,
            fragmentShader: difference_fragment, depthTest: false, depthWrite: false});
        this.material = this.make(false), this.frame = this.make(true), this.numbers = this.make(false, true);
        this.paint(facts.materials.map(m => m.reflectance));
        if (!leader) this.set_steps([0, 1], 'viridis');
    }

    /** A shading of other light, of this scene or another. It has the lamps and materials of now and follows none of the settings yet. */
    make_twin(facts: Facts): Shading {
        const twin = new Shading(facts, this);
        if (facts === this.facts) {
            twin.paint(this.reflectances);
            (twin.factors.image.data as unknown as Float32Array).set(this.factors.image.data as unknown as Float32Array);
            twin.use_groups(this.grouped);
        }
        return twin;
    }

    /** Has the shading of other light follow all settings but lamps and materials. */
    lead(twin: Shading | null): void {
        this.twin = twin;
        if (!twin) return;
        twin.see_backs(this.seen.backs);
        twin.leave_room_for_lines(this.under_lines);
        twin.show(this.shown, this.isolux, this.threshold);
        twin.cut(this.seen.cut);
        this.hide_in_twin();
    }

    /** Hides the groups of the same names in other light. */
    private hide_in_twin(): void {
        if (!this.twin) return;
        const {groups} = this.twin.facts, names = new Set(this.seen.hidden.map(g => this.facts.groups[g] ?? ''));
        const hidden = [...groups, ''].flatMap((name, g) => names.has(name) ? [g] : []);
        this.twin.hide(hidden);
    }

    private make(frame: boolean, numbers = false): THREE.ShaderMaterial {
        const defines: Record<string, string> = {};
        if (numbers) defines.VALUES = defines.NUMBERS = '1';
        if (this.shown === 'radiosity' || this.shown === 'irradiance' || this.isolux || this.threshold >= 0) defines.VALUES = '1';
        if (this.shown === 'classes' && !frame && !numbers) defines.CLASSES = '1';
        if (this.grouped && !frame) defines.GROUPS = '1';
        if (this.seen.cut && !frame) defines.CUT = '1';
        const key = Object.keys(defines).join() + frame;
        let found = this.made.get(key);
        if (!found) {
            found = new THREE.ShaderMaterial({defines, uniforms: this.uniforms, toneMapped: false,
                ...(frame ? {vertexShader: frame_vertex, fragmentShader: frame_fragment, depthTest: false, depthWrite: false,
                    transparent: true}
                    : {vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, polygonOffsetFactor: 1, polygonOffsetUnits: 1})});
            this.made.set(key, found);
        }
        if (!frame) found.side = this.seen.backs ? THREE.DoubleSide : THREE.FrontSide, found.polygonOffset = this.under_lines;
        return found;
    }

    private remake(): void { this.material = this.make(false), this.frame = this.make(true), this.numbers = this.make(false, true); }

    show(shown: Shown, isolux: boolean, threshold: number): void {
        this.shown = shown, this.isolux = isolux, this.threshold = threshold;
        this.uniforms.shown.value = shown === 'radiosity' ? 1 : shown === 'irradiance' ? 2 : 0;
        this.uniforms.isolux.value = isolux;
        this.uniforms.threshold.value = threshold;
        this.remake();
        this.twin?.show(shown, isolux, threshold);
    }

    /**
     * Lines lie on faces, which then step back by their slope. Without lines they must not: steep faces would step behind
     * the backs of their neighbours, which would show as dark dashes along the edges of bodies.
     */
    leave_room_for_lines(lines: boolean): void {
        this.twin?.leave_room_for_lines(lines);
        if (lines === this.under_lines) return;
        this.under_lines = lines;
        this.remake();
    }

    /** Backs of faces are nearly black, or what is behind them is seen. */
    see_backs(backs: boolean): void {
        this.twin?.see_backs(backs);
        if (backs === this.seen.backs) return;
        this.seen.backs = backs;
        this.remake();
    }

    /** Hides what is beyond a plane (n, d): points x with n . x > d. */
    cut(plane: number[] | null): void {
        this.seen.cut = plane;
        if (plane) (this.uniforms.cut.value as THREE.Vector4).fromArray(plane);
        this.remake();
        this.twin?.cut(plane);
    }

    hide(groups: number[]): void {
        this.seen.hidden = [...groups];
        const data = this.factors.image.data as unknown as Float32Array;
        for (let g = 0; g <= this.facts.groups.length; ++g) data[4 * g + 1] = groups.includes(g) ? 0 : 1;
        this.use_groups(groups.length > 0);
        this.hide_in_twin();
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
        this.facts.groups.forEach((_, i) => { data[4 * i] = factors[i] ?? 1; });
        this.use_groups(factors.some(f => f !== 1));
    }

    private use_groups(needed: boolean): void {
        this.factors.needsUpdate = true;
        if (needed) this.grouped = true;
        this.remake();
    }

    /** Colours of the differences up to `most` either way. */
    set_differences(most: number): void {
        const {steps, colours} = difference_colours(most), u = this.uniforms;
        this.difference_steps = steps;
        u.difference_count.value = colours.length;
        steps.forEach((s, i) => { u.difference_steps.value[i] = s; });
        colours.forEach((c, i) => { (u.difference_colours.value[i] as THREE.Vector3).set(...c).divideScalar(255); });
    }

    /** What `dim` and `paint` were last given. */
    get dimmed(): number[] {
        const data = this.factors.image.data as unknown as Float32Array;
        return this.facts.groups.map((_, i) => data[4 * i]);
    }

    set_steps(steps: number[], palette: string): void {
        this.steps = steps;
        const u = this.uniforms, bands = steps.length - 1;
        u.step_count.value = steps.length;
        steps.forEach((s, i) => { u.steps.value[i] = s; });
        for (let i = 0; i < bands; ++i)
            u.colours.value[i] = new THREE.Vector3(...colour_at(palette, bands > 1 ? i / (bands - 1) : 0.5)).divideScalar(255);
    }

    /** Colours of bands, or of the lines at their lower ends, from the brightest down, as they stand in a legend. */
    legend(): {colour: string; from: number; to: number}[] {
        return this.steps.slice(0, -1).map((from, i) => {
            const c = this.uniforms.colours.value[i] as THREE.Vector3;
            return {colour: css([255 * c.x, 255 * c.y, 255 * c.z]), from, to: this.steps[i + 1]};
        }).reverse();
    }
}
