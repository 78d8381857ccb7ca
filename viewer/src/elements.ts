// The elements of one layer as three.js draws them, a part at a time.
import * as THREE from 'three';
import {acceleratedRaycast, MeshBVH, type MeshBVHOptions} from 'three-mesh-bvh';
import {face_words, load_light, load_part, no_group, six_nodes, type Change, type Facts, type Layer, type Part, type Seen, type Triple} from './data';
import {normals_of} from './normals';
import type {Shading} from './shading';

/** Of edges by the order of the discontinuity along them (CurveOrder), as `render --mesh` has them. */
export const order_colours: Record<number, [string, Triple]> = {0: ['border', [230, 230, 230]], 1: ['D0 value', [222, 30, 40]],
    2: ['D1 slope', [0, 150, 90]], 3: ['D2 curvature', [40, 110, 245]], 4: ['conic', [170, 60, 200]]};
const plain: Triple = [64, 64, 72];
const few_values = 50;  // of which percentiles would be chance

interface Loaded { part: Part; mesh: THREE.Mesh; first: Uint32Array; materials: Float32Array; groups: Float32Array; tree: MeshBVH | null }

/** Which vertices make triangles: a fan a face, four a quadratic triangle. */
function triangles_of(faces: Uint32Array): {index: Uint32Array; first: Uint32Array} {
    const first = new Uint32Array(faces.length / face_words);
    let count = 0;
    for (let f = 0; f < first.length; ++f) {
        const shape = faces[face_words * f];
        count += shape === six_nodes ? 12 : 3 * Math.max(0, shape - 2);
    }
    const index = new Uint32Array(count);
    let at = 0, v = 0;
    for (let f = 0; f < first.length; ++f) {
        const shape = faces[face_words * f];
        first[f] = v;
        if (shape === six_nodes) {
            for (const k of [0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5]) index[at++] = v + k;
            v += 6;
        } else {
            for (let i = 1; i + 1 < shape; ++i) index[at++] = v, index[at++] = v + i, index[at++] = v + i + 1;
            v += shape;
        }
    }
    return {index, first};
}

export class Elements {
    readonly whole = new THREE.Group();
    readonly lines = new THREE.Group();
    private loaded: Loaded[] = [];
    private loading: Promise<void> | null = null;
    /** Has the light changed since it was loaded? */
    stale = false;

    constructor(private facts: Facts, private shading: Shading, readonly layer: Layer) { this.lines.visible = false; }

    /** The same elements with the light that they have now. They share the geometry; `shading` has their materials. */
    kept(shading: Shading): Elements {
        const copy = new Elements(this.facts, shading, this.layer);
        for (const l of this.loaded) {
            const irradiance = (l.mesh.geometry.getAttribute('irradiance').array as Float32Array).slice(), geometry = new THREE.BufferGeometry();
            for (const [name, values] of Object.entries(l.mesh.geometry.attributes)) geometry.setAttribute(name, values);
            geometry.setAttribute('irradiance', new THREE.BufferAttribute(irradiance, 3));
            geometry.setIndex(l.mesh.geometry.index);
            geometry.boundsTree = l.mesh.geometry.boundsTree;
            const mesh = new THREE.Mesh(geometry, shading.material);
            mesh.raycast = acceleratedRaycast;
            copy.whole.add(mesh);
            copy.loaded.push({...l, part: {...l.part, irradiance}, mesh});
        }
        copy.loading = Promise.resolve();
        return copy;
    }

    /** How much of it is there, in words; empty when all is. */
    get progress(): string {
        const all = this.facts.parts[this.layer];
        return this.loaded.length === all ? '' : ` ${this.loaded.length}/${all}`;
    }

    /** Once; further calls wait for the same. */
    async load(change: Change, changed: () => void): Promise<void> {
        if (this.loading && this.stale) { await this.refill(change); changed(); }
        this.loading ??= this.load_parts(change, changed);
        return this.loading;
    }

    private async load_parts(change: Change, changed: () => void): Promise<void> {
        // The next part travels while one is made.
        let next = load_part(this.layer, 0, change);
        for (let i = 0; i < this.facts.parts[this.layer]; ++i) {
            const part = await next;
            if (i + 1 < this.facts.parts[this.layer]) { next = load_part(this.layer, i + 1, change); next.catch(() => {}); }
            this.add(part);
            changed();
        }
    }

    /** New light on the same elements. */
    async refill(change: Change): Promise<void> {
        if (!this.loading) return;
        await this.loading;
        this.stale = false;
        const all = await Promise.all(this.loaded.map((_, i) => load_light(this.layer, i, change)));
        all.forEach((light, i) => {
            const attribute = this.loaded[i].mesh.geometry.getAttribute('irradiance') as THREE.BufferAttribute;
            if (light.length !== attribute.array.length) throw new Error('the light is of other elements');
            (attribute.array as Float32Array).set(light);
            attribute.needsUpdate = true;
        });
    }

    dispose(): void {
        for (const group of [this.whole, this.lines])
            for (const child of group.children) (child as THREE.Mesh).geometry.dispose();
        this.whole.clear();
        this.lines.clear();
        this.loaded = [];
    }

    private add(part: Part): void {
        const {index, first} = triangles_of(part.faces), count = part.positions.length / 3;
        const materials = new Float32Array(count), groups = new Float32Array(count), shadow = new Float32Array(count);
        const none = this.facts.groups.length;
        for (let f = 0; f < first.length; ++f) {
            const at = face_words * f, end = f + 1 < first.length ? first[f + 1] : count;
            materials.fill(part.faces[at + 1], first[f], end);
            groups.fill(part.faces[at + 3] === no_group ? none : part.faces[at + 3], first[f], end);
            shadow.fill(part.faces[at + 4] & 255, first[f], end);
        }
        const geometry = new THREE.BufferGeometry();
        const scalars = {material: materials, group: groups, shadow};
        geometry.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
        geometry.setAttribute('irradiance', new THREE.BufferAttribute(part.irradiance, 3));
        geometry.setAttribute('normal', new THREE.BufferAttribute(normals_of(part.positions, part.faces, first), 4, true));
        for (const [name, values] of Object.entries(scalars)) geometry.setAttribute(name, new THREE.BufferAttribute(values, 1));
        geometry.setIndex(new THREE.BufferAttribute(index, 1));
        const mesh = new THREE.Mesh(geometry, this.shading.material);
        mesh.raycast = acceleratedRaycast;
        this.whole.add(mesh);
        this.loaded.push({part, mesh, first, materials, groups, tree: null});
        if (this.lines.visible) this.add_lines(this.loaded.length - 1);
    }

    /** Materials of three.js may have changed. `numbers`: values are drawn, for differences. */
    shade(numbers = false): void {
        for (const {mesh} of this.loaded) mesh.material = numbers ? this.shading.numbers : this.shading.material;
    }

    /** Edges are made when they are asked for. */
    show_lines(visible: boolean): void {
        this.lines.visible = visible;
        while (visible && this.lines.children.length < this.loaded.length) this.add_lines(this.lines.children.length);
    }

    private add_lines(number: number): void {
        const {part, first} = this.loaded[number], edges: number[] = [], colours: number[] = [];
        for (let f = 0; f < first.length; ++f) {
            const shape = part.faces[face_words * f], labels = part.faces[face_words * f + 4];
            const corners = shape === six_nodes ? 3 : shape;
            for (let i = 0; i < corners; ++i) {
                const order = i < 3 ? (labels >>> (8 * (i + 1))) & 255 : 255;
                const colour = order_colours[order]?.[1] ?? plain;
                for (const v of [first[f] + i, first[f] + (i + 1) % corners]) {
                    edges.push(part.positions[3 * v], part.positions[3 * v + 1], part.positions[3 * v + 2]);
                    colours.push(colour[0] / 255, colour[1] / 255, colour[2] / 255);
                }
            }
        }
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(edges), 3));
        geometry.setAttribute('color', new THREE.BufferAttribute(Float32Array.from(colours), 3));
        this.lines.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({vertexColors: true, toneMapped: false})));
    }

    /** Trees for rays, made when the first ray needs them. */
    trees(): MeshBVH[] {
        return this.loaded.map(l => l.tree ??= l.mesh.geometry.boundsTree = new MeshBVH(l.mesh.geometry, {indirect: true} as MeshBVHOptions));
    }

    /** The first hit of a ray on something that is seen. */
    hit(ray: THREE.Raycaster, seen: Seen): THREE.Intersection | null {
        this.trees();
        return ray.intersectObjects(this.whole.children, false).find(hit => {
            if (!hit.face) return false;
            const {cut} = seen;
            if (cut && cut[0] * hit.point.x + cut[1] * hit.point.y + cut[2] * hit.point.z > cut[3]) return false;
            return (seen.backs || hit.face.normal.dot(ray.ray.direction) < 0) && !seen.hidden.includes(this.group(hit));
        }) ?? null;
    }

    private of(hit: THREE.Intersection): Loaded { return this.loaded.find(l => l.mesh === hit.object)!; }

    /** The name of the material that a ray has hit. */
    material(hit: THREE.Intersection): string { return this.facts.materials[this.of(hit).materials[hit.face!.a]].name; }

    /** The group of the face that a ray has hit; the number of groups if it is in none. */
    group(hit: THREE.Intersection): number { return this.of(hit).groups[hit.face!.a]; }

    /** Irradiance as one number. */
    value(hit: THREE.Intersection): number {
        return this.light(hit)?.reduce((sum, e, c) => sum + this.facts.weights[c] * e, 0) ?? NaN;
    }

    /** Irradiance at a hit, interpolated between the corners as the picture is. */
    light(hit: THREE.Intersection): Triple | null {
        const {a, b, c} = hit.face!, {part} = this.of(hit), corner = (v: number) => new THREE.Vector3().fromArray(part.positions, 3 * v);
        const light = (v: number) => new THREE.Vector3().fromArray(part.irradiance, 3 * v);
        const found = THREE.Triangle.getInterpolation(hit.point, corner(a), corner(b), corner(c), light(a), light(b), light(c), new THREE.Vector3());
        return found && found.toArray() as Triple;
    }

    /** The corners of the face that a hit of a ray is on. */
    outline(hit: THREE.Intersection): THREE.Vector3[] {
        const found = this.of(hit);
        if (!hit.face) return [];
        let low = 0, high = found.first.length - 1;
        while (low < high) {
            const middle = (low + high + 1) >> 1;
            if (found.first[middle] <= hit.face.a) low = middle; else high = middle - 1;
        }
        const shape = found.part.faces[face_words * low], corners = shape === six_nodes ? 3 : shape;
        return Array.from({length: corners}, (_, i) => new THREE.Vector3().fromArray(found.part.positions, 3 * (found.first[low] + i)));
    }

    /** The number that is shown at a hit of a ray, or null on an emitter. */
    shown_value(hit: THREE.Intersection, radiosity: boolean): number | null {
        const number = this.of(hit).materials[hit.face!.a];
        if (Math.max(...this.facts.materials[number].exitance) > 0) return null;
        const E = this.light(hit), rho = this.shading.reflectances[number];
        return E && E.reduce((sum, e, c) => sum + (radiosity ? rho[c] : 1) * this.facts.weights[c] * e, 0);
    }

    /** Values of all surfaces, some tens of thousands of them; emitters left out. */
    private values(radiosity: boolean): number[] {
        const values: number[] = [];
        for (const {part, materials} of this.loaded) {
            const E = part.irradiance, every = Math.max(1, Math.floor(materials.length / 20000));
            for (let v = 0; v < materials.length; v += every) {
                const m = this.facts.materials[materials[v]];
                if (Math.max(...m.exitance) > 0) continue;
                let sum = 0;
                const rho = this.shading.reflectances[materials[v]];
                for (let c = 0; c < 3; ++c) sum += (radiosity ? rho[c] : 1) * this.facts.weights[c] * E[3 * v + c];
                values.push(sum);
            }
            if (values.length > 200000) break;
        }
        return values.sort((a, b) => a - b);
    }

    /** Percentiles 2 and 98 of `visible`, sorted values in the picture, or of all surfaces if few are visible. */
    range(radiosity: boolean, visible: number[]): [number, number] {
        const values = visible.length >= few_values ? visible : this.values(radiosity);
        if (values.length === 0) return [0, 1];
        const cut = Math.floor(values.length / 50);
        return [values[cut], values[values.length - 1 - cut]];
    }
}
