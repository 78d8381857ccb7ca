// What the program sends: facts as JSON, elements and pictures as arrays of numbers (viewer_part.hpp and viewer_frame.hpp
// tell their order). A shared page holds them itself.
import {shared, shared_part} from './shared';

export type Triple = [number, number, number];
export type Layer = 'exported' | 'method' | 'raw';

export interface Facts {
    file: string; lux: boolean; units: {irradiance: string; radiosity: string}; weights: Triple; surfaces: number; elements: number; method: string; basis: string;
    materials: {name: string; reflectance: Triple; exitance: Triple}[]; groups: string[];
    exposure: number; camera: {eye: Triple; target: Triple; fov: number}; box: [Triple, Triple];
    parts: Record<Layer, number>; error: number | null; links: number;
    shadow_classes: boolean; discontinuities: boolean;
}

/** Faces have their corners one after the other among the vertices. */
export interface Part {
    positions: Float32Array; irradiance: Float32Array; faces: Uint32Array;
}

/** What stands in `faces`: five numbers a face. */
export const face_words = 5, six_nodes = 262, no_group = 0xffffffff;

export interface Light {
    irradiance: Triple; direct?: Triple; indirect?: Triple; radiosity?: Triple; surface?: number; line?: number;
    material?: string; group?: string; element?: number | null; links?: {outline: Triple[]; form_factor: number}[];
}

/** A picture of the program's renderer, rows from the bottom up. */
export interface Frame { width: number; height: number; light: Float32Array; rest: Float32Array }

/** What is seen: backs of faces or what is behind them; hidden groups of faces; a plane (n, d) beyond which all is hidden. */
export interface Seen { backs: boolean; hidden: number[]; cut: number[] | null }

/**
 * Dimmed groups and painted materials, as requests tell them; empty: the light as it was solved. `of`: the second of two
 * solutions that are compared, which is always shown as it was solved.
 */
export interface Change { dim: string; paint: string; of?: 'other' }
export const unchanged: Change = {dim: '', paint: ''};

/** What can be dimmed and repainted; empty where the solution keeps nothing for it. */
export interface Changes { groups: {name: string; factor: number}[]; materials: {name: string; reflectance: Triple}[] }

export class Refused extends Error {
    constructor(readonly status: number, message: string) { super(message); }
}

function query(path: string, words: Record<string, string>, change: Change): string {
    const all = new URLSearchParams(words);
    if (change.dim) all.set('dim', change.dim);
    if (change.paint) all.set('paint', change.paint);
    if (change.of) all.set('of', change.of);
    return `${path}?${all}`;
}

async function answer(path: string, method = 'GET'): Promise<Response> {
    const response = await fetch(path, {method});
    if (response.status === 204) throw new Refused(204, `${path.split('?')[0]}: nothing yet`);
    if (!response.ok) throw new Refused(response.status, `${path.split('?')[0]}: ${await response.text()}`);
    return response;
}

const bytes_of = async (path: string) => (await answer(path)).arrayBuffer();
const letters = (bytes: ArrayBuffer) => new TextDecoder().decode(new Uint8Array(bytes, 0, 4));

export const post = (path: string) => answer(path, 'POST').then(r => r.text());
/** `files`: of two solutions that are compared; null: there is one. */
export interface State { solving: boolean; files: [string, string] | null }
export const load_state = (): Promise<State> =>
    shared ? Promise.resolve({solving: false, files: null}) : answer('/data/state').then(r => r.json() as Promise<State>);
export async function load_facts(change: Change = unchanged): Promise<Facts> {
    const facts = shared?.scene ?? await (await answer(query('/data/scene', {}, change))).json() as Facts;
    return {...facts, units: facts.lux ? {irradiance: 'lx', radiosity: 'lm/m²'} : {irradiance: 'W/m²', radiosity: 'W/m²'}};
}
/** The page with the light of a change as one file, without the state of the page. */
export const load_share = (change: Change) => answer(query('/share', {}, change)).then(r => r.text());
export const load_point = (at: number[], change: Change) =>
    answer(query('/data/point', {at: at.join(',')}, change)).then(r => r.json() as Promise<Light>);
export const load_line = (at: number[], change: Change) =>
    answer(query('/data/line', {at: at.join(',')}, change)).then(r => r.json() as Promise<{length: number; values: number[]}>);

export async function load_changes(): Promise<Changes> {
    if (shared) return {groups: [], materials: []};
    try {
        const found = await (await answer('/groups')).json() as Partial<Changes>;
        return {groups: found.groups ?? [], materials: found.materials ?? []};
    } catch (error) {
        if (error instanceof Refused && [204, 404].includes(error.status)) return {groups: [], materials: []};
        throw error;
    }
}

export async function load_part(layer: Layer, part: number, change: Change): Promise<Part> {
    const bytes = shared ? shared_part(part) : await bytes_of(query('/data/part', {layer, part: String(part)}, change));
    if (letters(bytes) !== 'EXV2') throw new Error('not a part of a mesh');
    const [v, f] = new Uint32Array(bytes, 4, 2);
    return {positions: new Float32Array(bytes, 12, 3 * v), irradiance: new Float32Array(bytes, 12 + 12 * v, 3 * v),
        faces: new Uint32Array(bytes, 12 + 24 * v, face_words * f)};
}

/** The irradiance of a part alone. */
export async function load_light(layer: Layer, part: number, change: Change): Promise<Float32Array> {
    const bytes = await bytes_of(query('/data/part', {layer, part: String(part), only: 'light'}, change));
    if (letters(bytes) === 'EXV2') return new Float32Array(bytes, 12 + 12 * new Uint32Array(bytes, 4, 1)[0], 3 * new Uint32Array(bytes, 4, 1)[0]);
    if (letters(bytes) !== 'EXL1') throw new Error('not the light of a part');
    return new Float32Array(bytes, 8);
}

export async function load_frame(camera: number[], width: number, height: number, samples: number, change: Change): Promise<Frame> {
    const words = {camera: camera.join(','), size: `${width},${height}`, samples: String(samples)};
    const bytes = await bytes_of(query('/data/frame', words, change));
    if (letters(bytes) !== 'EXF1') throw new Error('not a picture');
    const n = width * height;
    return {width, height, light: new Float32Array(bytes, 12, 4 * n), rest: new Float32Array(bytes, 12 + 16 * n, 2 * n)};
}

/** One request at a time, the newest of those that wait; what a newer one made stale is dropped. */
export class Newest {
    private running = false;
    private waiting: (() => Promise<void>) | null = null;

    ask(work: () => Promise<void>): void {
        this.waiting = work;
        if (!this.running) void this.run();
    }

    get idle(): boolean { return !this.running; }

    private async run(): Promise<void> {
        this.running = true;
        while (this.waiting) {
            const work = this.waiting;
            this.waiting = null;
            try { await work(); } catch (error) { if (!(error instanceof Refused && error.status === 409)) console.warn(String(error)); }
        }
        this.running = false;
    }
}
