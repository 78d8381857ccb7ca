// What the program sends: facts as JSON, elements as arrays of numbers (viewer_data.hpp tells their order).
export type Triple = [number, number, number];

export interface Facts {
    file: string; photometric: boolean; surfaces: number; elements: number; method: string;
    materials: {name: string; reflectance: Triple; exitance: Triple}[];
    exposure: number; camera: {eye: Triple; target: Triple; fov: number}; box: [Triple, Triple];
    parts: {exported: number; method: number}; error: number | null; links: number;
}

export interface Part {
    positions: Float32Array; irradiance: Float32Array; materials: Uint32Array; elements: Uint32Array;
    triangles: Uint32Array; edges: Uint32Array; orders: Uint32Array;
}

export interface Light {
    irradiance: Triple; direct: Triple; indirect: Triple; radiosity?: Triple; surface?: number; line?: number;
    material?: string; group?: string; element?: number | null; links?: {outline: Triple[]; form_factor: number}[];
}

async function answer(path: string, method = 'GET'): Promise<Response> {
    const response = await fetch(path, {method});
    if (!response.ok) throw new Error(`${path}: ${response.status} ${await response.text()}`);
    return response;
}

export const post = (path: string) => answer(path, 'POST').then(r => r.text());
export const load_facts = () => answer('/data/scene').then(r => r.json() as Promise<Facts>);
export const load_point = (at: number[]) => answer(`/data/point?at=${at.join(',')}`).then(r => r.json() as Promise<Light>);
export const load_line = (at: number[]) =>
    answer(`/data/line?at=${at.join(',')}`).then(r => r.json() as Promise<{length: number; values: number[]}>);

export async function load_part(layer: string, part: number): Promise<Part> {
    const bytes = await (await answer(`/data/part?layer=${layer}&part=${part}`)).arrayBuffer();
    const counts = new Uint32Array(bytes, 4, 3);
    if (new TextDecoder().decode(new Uint8Array(bytes, 0, 4)) !== 'EXV1') throw new Error('not a part of a mesh');
    const [v, t, e] = counts;
    let at = 16;
    const floats = (n: number) => { const out = new Float32Array(bytes, at, n); at += 4 * n; return out; };
    const whole = (n: number) => { const out = new Uint32Array(bytes, at, n); at += 4 * n; return out; };
    return {positions: floats(3 * v), irradiance: floats(3 * v), materials: whole(v), elements: whole(v),
        triangles: whole(3 * t), edges: whole(2 * e), orders: whole(e)};
}
